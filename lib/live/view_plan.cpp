// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "view_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vsplit {
namespace {

/// Triangles looked at in all: some seconds.
constexpr std::uint64_t kMostVisits = std::uint64_t{1} << 29;

Float3 operator-(const Float3& a, const Float3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Float3 operator+(const Float3& a, const Float3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
Float3 operator*(float s, const Float3& a) {
    return {s * a.x, s * a.y, s * a.z};
}
float dot(const Float3& a, const Float3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
Float3 cross(const Float3& a, const Float3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
float length(const Float3& a) {
    return std::sqrt(dot(a, a));
}
Float3 unit(const Float3& a) {
    const float l = length(a);
    return l > 0 ? (1 / l) * a : Float3{};
}

float distance_to_segment(const Float3& p, const Float3& a, const Float3& b) {
    const Float3 ab = b - a;
    const float l = dot(ab, ab);
    const float t = l > 0 ? std::clamp(dot(p - a, ab) / l, 0.0f, 1.0f) : 0.0f;
    return length(p - (a + t * ab));
}

float distance_to_triangle(const Float3& p, const Float3& a, const Float3& b, const Float3& c) {
    const Float3 n = cross(b - a, c - a);
    const float square = dot(n, n);
    if (square > 0 && dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 &&
        dot(cross(a - c, p - c), n) >= 0)
        return std::abs(dot(p - a, n)) / std::sqrt(square);
    return std::min(
        {distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

/// Rings of corners that name the same vertex.
class Stars {
  public:
    Stars(std::size_t vertices, std::size_t triangles)
        : head_(vertices, kNone), next_(3 * triangles, kNone), previous_(3 * triangles, kNone) {}

    void link(std::uint32_t corner, std::uint32_t vertex) {
        next_[corner] = head_[vertex];
        previous_[corner] = kNone;
        if (head_[vertex] != kNone) previous_[head_[vertex]] = corner;
        head_[vertex] = corner;
    }
    void unlink(std::uint32_t corner, std::uint32_t vertex) {
        const std::uint32_t before = previous_[corner], after = next_[corner];
        (before == kNone ? head_[vertex] : next_[before]) = after;
        if (after != kNone) previous_[after] = before;
    }
    template <class Visit>
    void each(std::uint32_t vertex, Visit visit) const {
        for (std::uint32_t c = head_[vertex]; c != kNone; c = next_[c]) visit(c / 3);
    }

  private:
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};
    std::vector<std::uint32_t> head_, next_, previous_;
};

/// Replays the sequence once.
class Planner {
  public:
    Planner(ProgressiveMesh& mesh, ViewPlan& plan)
        : mesh_(mesh),
          plan_(plan),
          corners_(mesh.triangles),
          places_(mesh.positions),
          stars_(mesh.positions.size(), mesh.triangles.size()),
          touched_(mesh.triangles.size(), kNoSplit),
          last_(mesh.positions.size(), kNoSplit),
          seen_(mesh.positions.size(), kNoSplit) {}

    bool run();

  private:
    void split(std::uint32_t k, const Split& before);
    void need(std::uint32_t k, std::uint32_t other) {
        if (other != kNoSplit && other != k) plan_.needs.push_back(other);
    }
    void need_star(std::uint32_t k, std::uint32_t vertex);
    void measure(ViewNode& node, const Float3& p) const;
    Float3 place_of(std::uint32_t k, const Split& before) const;
    void cone(ViewNode& node);
    void write(std::uint32_t k, std::uint32_t triangle) { touched_[triangle] = k; }
    void gather();

    ProgressiveMesh& mesh_;
    ViewPlan& plan_;
    std::vector<Triangle> corners_;
    std::vector<Float3> places_;
    Stars stars_;
    std::vector<std::uint32_t> touched_;  ///< The split that last wrote a triangle.
    std::vector<std::uint32_t> last_;     ///< The split that last had a vertex as a parent, or moved it.
    std::vector<std::uint32_t> seen_;     ///< The split in whose stars a vertex was last.
    std::vector<std::uint32_t> around_, anchors_;
    std::vector<float> half_angles_;
    std::uint64_t visits_ = 0;
};

/// What the star of an older vertex waits for. A triangle that was last written before this vertex's own last
/// split was waited for by that split, for it was in the star then: so every write is waited for three times
/// at most, however large a star is.
void Planner::need_star(std::uint32_t k, std::uint32_t vertex) {
    const std::uint32_t own = last_[vertex];
    need(k, own);
    stars_.each(vertex, [&](std::uint32_t t) {
        ++visits_;
        around_.push_back(t);
        for (const std::uint32_t v : corners_[t]) seen_[v] = k;
        if (touched_[t] != kNoSplit && (own == kNoSplit || touched_[t] > own)) need(k, touched_[t]);
    });
    last_[vertex] = k;
}

void Planner::measure(ViewNode& node, const Float3& p) const {
    float nearest = std::numeric_limits<float>::infinity();
    for (const std::uint32_t t : around_) {
        const Triangle& c = corners_[t];
        nearest = std::min(nearest, distance_to_triangle(p, places_[c[0]], places_[c[1]], places_[c[2]]));
    }
    if (nearest < std::numeric_limits<float>::infinity()) node.error = std::max(node.error, nearest);
}

/// The middle of a split's sphere: its parent, or what it makes first.
Float3 Planner::place_of(std::uint32_t k, const Split& before) const {
    const std::uint32_t anchor = plan_.vertex[k];
    return mesh_.positions[anchor != kNoVertex
                               ? anchor
                               : std::min<std::size_t>(before.vertices_end, mesh_.positions.size() - 1)];
}

void Planner::cone(ViewNode& node) {
    Float3 sum;
    for (const std::uint32_t t : around_) {
        const Triangle& c = corners_[t];
        sum = sum + cross(places_[c[1]] - places_[c[0]], places_[c[2]] - places_[c[0]]);
    }
    node.normal = unit(sum);
}

void Planner::split(std::uint32_t k, const Split& before) {
    const Split& now = mesh_.splits[k];
    plan_.needs_begin.push_back(std::uint32_t(plan_.needs.size()));
    ViewNode& node = plan_.nodes[k];
    around_.clear();
    anchors_.clear();
    for (std::uint32_t v = before.vertices_end; v < now.vertices_end; ++v) {
        plan_.born[v] = k;
        if (mesh_.parents[v] != kNoVertex) anchors_.push_back(mesh_.parents[v]);
    }
    for (std::uint32_t i = before.moves_end; i < now.moves_end; ++i)
        anchors_.push_back(mesh_.moves[i].vertex);
    std::sort(anchors_.begin(), anchors_.end());
    anchors_.erase(std::unique(anchors_.begin(), anchors_.end()), anchors_.end());

    // The parent whose place stands for the split, and its chain.
    std::uint32_t anchor = kNoVertex;
    if (!anchors_.empty()) {
        anchor = anchors_.front();
        for (std::uint32_t v = before.vertices_end; v < now.vertices_end; ++v)
            if (mesh_.parents[v] != kNoVertex) {
                anchor = mesh_.parents[v];
                break;
            }
    }
    plan_.vertex[k] = anchor;
    if (anchor == kNoVertex) plan_.returning.push_back(k);

    for (const std::uint32_t v : anchors_) {
        if (last_[v] == kNoSplit) need(k, plan_.born[v]);
        seen_[v] = k;
        need_star(k, v);
    }
    for (std::uint32_t t = before.triangles_end; t < now.triangles_end; ++t)
        for (const std::uint32_t v : mesh_.triangles[t])
            if (seen_[v] != k) need(k, last_[v] != kNoSplit ? last_[v] : plan_.born[v]);

    for (std::uint32_t v = before.vertices_end; v < now.vertices_end; ++v) measure(node, places_[v]);
    for (std::uint32_t i = before.moves_end; i < now.moves_end; ++i) measure(node, mesh_.moves[i].position);
    if (anchors_.empty()) node.error = now.error;
    node.error = std::min(node.error, now.error);

    for (std::uint32_t i = before.corners_end; i < now.corners_end; ++i) {
        const CornerChange& change = mesh_.corner_changes[i];
        std::uint32_t& corner = corners_[change.corner / 3][change.corner % 3];
        stars_.unlink(change.corner, corner);
        corner = change.vertex;
        stars_.link(change.corner, corner);
        write(k, change.corner / 3);
        around_.push_back(change.corner / 3);
    }
    for (std::uint32_t t = before.triangles_end; t < now.triangles_end; ++t) {
        for (std::uint32_t i = 0; i < 3; ++i) stars_.link(3 * t + i, mesh_.triangles[t][i]);
        write(k, t);
        around_.push_back(t);
    }
    for (std::uint32_t i = before.moves_end; i < now.moves_end; ++i) {
        const VertexMove& move = mesh_.moves[i];
        places_[move.vertex] = move.position;
        stars_.each(move.vertex, [&](std::uint32_t t) {
            ++visits_;
            write(k, t);
        });
    }

    const auto begin = plan_.needs.begin() + std::ptrdiff_t(plan_.needs_begin.back());
    std::sort(begin, plan_.needs.end());
    plan_.needs.erase(std::unique(begin, plan_.needs.end()), plan_.needs.end());

    // The finer star as the camera sees it.
    cone(node);
    const Float3 centre = node.centre = place_of(k, before);
    float half_angle = 0;
    for (const std::uint32_t t : around_) {
        const Triangle& c = corners_[t];
        const Float3 normal = unit(cross(places_[c[1]] - places_[c[0]], places_[c[2]] - places_[c[0]]));
        half_angle = std::max(half_angle, std::acos(std::clamp(dot(normal, node.normal), -1.0f, 1.0f)));
        for (const std::uint32_t v : c) node.radius = std::max(node.radius, length(places_[v] - centre));
    }
    half_angles_[k] = half_angle;
}

/// From the last split to the first: a split answers for those below it, of its vertex and of its children.
void Planner::gather() {
    std::vector<std::uint32_t>& first = plan_.first;
    for (std::size_t k = plan_.nodes.size(); k-- > 0;) {
        ViewNode& node = plan_.nodes[k];
        const std::uint32_t anchor = plan_.vertex[k];
        const std::uint32_t born_begin = k == 0 ? mesh_.base_vertices : mesh_.splits[k - 1].vertices_end;
        const Float3 own = node.centre;
        const auto take = [&](std::uint32_t below, const Float3& centre) {
            const ViewNode& other = plan_.nodes[below];
            node.error = std::max(node.error, other.error);
            node.radius = std::max(node.radius, length(centre - own) + other.radius);
            half_angles_[k] = std::max(
                half_angles_[k],
                half_angles_[below] + std::acos(std::clamp(dot(node.normal, other.normal), -1.0f, 1.0f)));
        };
        for (std::uint32_t v = born_begin; v < mesh_.splits[k].vertices_end; ++v)
            if (first[v] != kNoSplit) take(first[v], mesh_.positions[v]);
        if (anchor != kNoVertex) {
            const std::uint32_t later = first[anchor];
            plan_.next[k] = later;
            if (later != kNoSplit) {
                plan_.previous[later] = std::uint32_t(k);
                take(later, own);
            }
            first[anchor] = std::uint32_t(k);
        }
        node.error = std::min(node.error, mesh_.splits[k].error);
        node.spread = half_angles_[k] < 1.5707f ? std::sin(half_angles_[k]) : 1;
    }
}

bool Planner::run() {
    const std::size_t vertices = mesh_.positions.size(), splits = mesh_.splits.size();
    plan_.nodes.resize(splits);
    plan_.vertex.assign(splits, kNoVertex);
    plan_.next.assign(splits, kNoSplit);
    plan_.previous.assign(splits, kNoSplit);
    plan_.first.assign(vertices, kNoSplit);
    plan_.born.assign(vertices, kNoSplit);
    plan_.needs_begin.reserve(splits + 1);
    half_angles_.assign(splits, 0);
    for (std::uint32_t t = 0; t < mesh_.base_triangles; ++t)
        for (std::uint32_t i = 0; i < 3; ++i) stars_.link(3 * t + i, mesh_.triangles[t][i]);
    Split before{mesh_.base_vertices, mesh_.base_triangles, 0, 0, 0};
    for (std::uint32_t k = 0; k < splits; ++k) {
        split(k, before);
        before = mesh_.splits[k];
        if (visits_ > kMostVisits) return false;
    }
    plan_.needs_begin.push_back(std::uint32_t(plan_.needs.size()));
    plan_.needs.shrink_to_fit();
    gather();
    plan_.born = {};
    return true;
}

}  // namespace

bool plan_view(ProgressiveMesh& mesh, ViewPlan& plan) {
    return Planner(mesh, plan).run();
}

}  // namespace vsplit
