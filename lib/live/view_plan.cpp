// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "view_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "extend.hpp"

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
    void resize(std::size_t vertices, std::size_t triangles) {
        head_.resize(vertices, kNone);
        next_.resize(3 * triangles, kNone);
        previous_.resize(3 * triangles, kNone);
    }
    std::size_t memory() const {
        return sizeof(std::uint32_t) * (head_.capacity() + next_.capacity() + previous_.capacity());
    }

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

}  // namespace

struct ViewPlanner::State {
    explicit State(ViewPlan& plan) : plan_(plan) {}

    bool extend(const ProgressiveMesh& mesh, std::span<const float> weight,
                std::vector<std::uint32_t>& changed);
    void split(const ProgressiveMesh& mesh, std::uint32_t k, const Split& before);
    void need(std::uint32_t k, std::uint32_t other) {
        if (other != kNoSplit && other != k) plan_.needs.push_back(other);
    }
    void need_star(std::uint32_t k, std::uint32_t vertex);
    void measure(float& error, const Float3& p) const;
    void cone(ViewNode& node);
    void write(std::uint32_t k, std::uint32_t triangle) { touched_[triangle] = k; }
    void link(std::uint32_t k);
    bool take(std::uint32_t k, std::uint32_t below);

    ViewPlan& plan_;
    bool begun_ = false;
    std::vector<Triangle> corners_;
    std::vector<Float3> places_;
    Stars stars_;
    std::vector<std::uint32_t> touched_;  ///< The split that last wrote a triangle.
    std::vector<std::uint32_t> last_;     ///< The split that last had a vertex as a parent, or moved it.
    std::vector<std::uint32_t> seen_;     ///< The split in whose stars a vertex was last.
    std::vector<std::uint32_t> tail_;     ///< Of each vertex: the last split of its chain.
    std::vector<std::uint32_t> around_, anchors_;
    std::vector<float> half_angles_;
    std::uint64_t visits_ = 0;
};

/// What the star of an older vertex waits for. A triangle that was last written before this vertex's own last
/// split was waited for by that split, for it was in the star then: so every write is waited for three times
/// at most, however large a star is.
void ViewPlanner::State::need_star(std::uint32_t k, std::uint32_t vertex) {
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

void ViewPlanner::State::measure(float& error, const Float3& p) const {
    float nearest = std::numeric_limits<float>::infinity();
    for (const std::uint32_t t : around_) {
        const Triangle& c = corners_[t];
        nearest = std::min(nearest, distance_to_triangle(p, places_[c[0]], places_[c[1]], places_[c[2]]));
    }
    if (nearest < std::numeric_limits<float>::infinity()) error = std::max(error, nearest);
}

void ViewPlanner::State::cone(ViewNode& node) {
    Float3 sum;
    for (const std::uint32_t t : around_) {
        const Triangle& c = corners_[t];
        sum = sum + cross(places_[c[1]] - places_[c[0]], places_[c[2]] - places_[c[0]]);
    }
    node.normal = unit(sum);
}

void ViewPlanner::State::split(const ProgressiveMesh& mesh, std::uint32_t k, const Split& before) {
    const Split& now = mesh.splits[k];
    ViewNode& node = plan_.nodes[k];
    around_.clear();
    anchors_.clear();
    for (std::uint32_t v = before.vertices_end; v < now.vertices_end; ++v) {
        plan_.born[v] = k;
        if (mesh.parents[v] != kNoVertex) anchors_.push_back(mesh.parents[v]);
    }
    for (std::uint32_t i = before.moves_end; i < now.moves_end; ++i) anchors_.push_back(mesh.moves[i].vertex);
    std::sort(anchors_.begin(), anchors_.end());
    anchors_.erase(std::unique(anchors_.begin(), anchors_.end()), anchors_.end());

    // The parent whose place stands for the split, and its chain.
    std::uint32_t anchor = kNoVertex;
    if (!anchors_.empty()) {
        anchor = anchors_.front();
        for (std::uint32_t v = before.vertices_end; v < now.vertices_end; ++v)
            if (mesh.parents[v] != kNoVertex) {
                anchor = mesh.parents[v];
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
        for (const std::uint32_t v : mesh.triangles[t])
            if (seen_[v] != k) need(k, last_[v] != kNoSplit ? last_[v] : plan_.born[v]);

    float& error = plan_.own_error[k];
    for (std::uint32_t v = before.vertices_end; v < now.vertices_end; ++v) measure(error, places_[v]);
    for (std::uint32_t i = before.moves_end; i < now.moves_end; ++i) measure(error, mesh.moves[i].position);
    if (anchors_.empty()) error = now.error;
    error = std::min(error, now.error);

    for (std::uint32_t i = before.corners_end; i < now.corners_end; ++i) {
        const CornerChange& change = mesh.corner_changes[i];
        std::uint32_t& corner = corners_[change.corner / 3][change.corner % 3];
        stars_.unlink(change.corner, corner);
        corner = change.vertex;
        stars_.link(change.corner, corner);
        write(k, change.corner / 3);
        around_.push_back(change.corner / 3);
    }
    for (std::uint32_t t = before.triangles_end; t < now.triangles_end; ++t) {
        for (std::uint32_t i = 0; i < 3; ++i) stars_.link(3 * t + i, mesh.triangles[t][i]);
        write(k, t);
        around_.push_back(t);
    }
    for (std::uint32_t i = before.moves_end; i < now.moves_end; ++i) {
        const VertexMove& move = mesh.moves[i];
        places_[move.vertex] = move.position;
        stars_.each(move.vertex, [&](std::uint32_t t) {
            ++visits_;
            write(k, t);
        });
    }

    const auto begin = plan_.needs.begin() + std::ptrdiff_t(plan_.needs_begin.back());
    std::sort(begin, plan_.needs.end());
    plan_.needs.erase(std::unique(begin, plan_.needs.end()), plan_.needs.end());
    plan_.needs_begin.push_back(std::uint32_t(plan_.needs.size()));

    // The finer star as the camera sees it.
    cone(node);
    // The middle of its sphere: its parent, or what it makes first.
    if (!mesh.positions.empty())
        node.centre = mesh.positions[anchor != kNoVertex ? anchor
                                                         : std::min<std::size_t>(before.vertices_end,
                                                                                 mesh.positions.size() - 1)];
    const Float3 centre = node.centre;
    float half_angle = 0;
    for (const std::uint32_t t : around_) {
        const Triangle& c = corners_[t];
        const Float3 normal = unit(cross(places_[c[1]] - places_[c[0]], places_[c[2]] - places_[c[0]]));
        half_angle = std::max(half_angle, std::acos(std::clamp(dot(normal, node.normal), -1.0f, 1.0f)));
        for (const std::uint32_t v : c) node.radius = std::max(node.radius, length(places_[v] - centre));
    }
    half_angles_[k] = half_angle;
    node.spread = half_angle < 1.5707f ? std::sin(half_angle) : 1;
}

/// Appends a split to its vertex's chain.
void ViewPlanner::State::link(std::uint32_t k) {
    const std::uint32_t anchor = plan_.vertex[k];
    if (anchor == kNoVertex) return;
    const std::uint32_t before = std::exchange(tail_[anchor], k);
    plan_.previous[k] = before;
    (before == kNoSplit ? plan_.first[anchor] : plan_.next[before]) = k;
}

/// A split answers for those below it, of its vertex and of its children. False if it did already.
bool ViewPlanner::State::take(std::uint32_t k, std::uint32_t below) {
    ViewNode& node = plan_.nodes[k];
    const ViewNode& other = plan_.nodes[below];
    const float radius = length(other.centre - node.centre) + other.radius;
    const float half_angle =
        half_angles_[below] + std::acos(std::clamp(dot(node.normal, other.normal), -1.0f, 1.0f));
    const bool same =
        node.error >= other.error && node.radius >= radius &&
        (half_angles_[k] >= half_angle || (half_angles_[k] >= 1.5708f && half_angle >= 1.5708f));
    if (same) return false;
    node.error = std::max(node.error, other.error);
    node.radius = std::max(node.radius, radius);
    // All from a right angle on are one to a camera.
    half_angles_[k] = std::min(std::max(half_angles_[k], half_angle), 1.5708f);
    node.spread = half_angles_[k] < 1.5707f ? std::sin(half_angles_[k]) : 1;
    return true;
}

bool ViewPlanner::State::extend(const ProgressiveMesh& mesh, std::span<const float> weight,
                                std::vector<std::uint32_t>& changed) {
    const std::size_t vertices = mesh.positions.size(), triangles = mesh.triangles.size(),
                      splits = mesh.splits.size(), begin = plan_.nodes.size();
    vsplit::extend(corners_, mesh.triangles);
    vsplit::extend(places_, mesh.positions);
    stars_.resize(vertices, triangles);
    touched_.resize(triangles, kNoSplit);
    for (auto* of_vertices : {&last_, &seen_, &tail_, &plan_.first, &plan_.born})
        of_vertices->resize(vertices, kNoSplit);
    plan_.nodes.resize(splits);
    plan_.own_error.resize(splits, 0);
    half_angles_.resize(splits, 0);
    plan_.vertex.resize(splits, kNoVertex);
    plan_.next.resize(splits, kNoSplit);
    plan_.previous.resize(splits, kNoSplit);
    if (!std::exchange(begun_, true))
        for (std::uint32_t t = 0; t < mesh.base_triangles; ++t)
            for (std::uint32_t i = 0; i < 3; ++i) stars_.link(3 * t + i, mesh.triangles[t][i]);

    Split before =
        begin == 0 ? Split{mesh.base_vertices, mesh.base_triangles, 0, 0, 0} : mesh.splits[begin - 1];
    for (auto k = std::uint32_t(begin); k < splits; ++k) {
        split(mesh, k, before);
        plan_.nodes[k].error = weight.empty() ? plan_.own_error[k] : weight[k] * plan_.own_error[k];
        link(k);
        before = mesh.splits[k];
        if (visits_ > kMostVisits) return false;
    }
    // From the last to the first; what is older takes from them at once.
    for (std::size_t k = splits; k-- > begin;) {
        std::uint32_t below = std::uint32_t(k), above = plan_.above(below);
        while (above != kNoSplit && take(above, below) && above < begin) {
            changed.push_back(above);
            below = above;
            above = plan_.above(below);
        }
    }
    return true;
}

ViewPlanner::ViewPlanner(ViewPlan& plan) : state_(std::make_unique<State>(plan)) {}
ViewPlanner::~ViewPlanner() = default;

bool ViewPlanner::extend(const ProgressiveMesh& mesh, std::span<const float> weight,
                         std::vector<std::uint32_t>& changed) {
    return state_->extend(mesh, weight, changed);
}

std::size_t ViewPlanner::memory() const {
    const State& s = *state_;
    std::size_t bytes = sizeof(Triangle) * s.corners_.capacity() + sizeof(Float3) * s.places_.capacity() +
                        s.stars_.memory() + sizeof(float) * s.half_angles_.capacity();
    for (const auto* v : {&s.touched_, &s.last_, &s.seen_, &s.tail_, &s.around_, &s.anchors_})
        bytes += sizeof(std::uint32_t) * v->capacity();
    return bytes;
}

void ViewPlan::weigh(std::span<const float> weights) {
    for (std::size_t k = 0; k < nodes.size(); ++k)
        nodes[k].error = (weights.empty() ? 1 : weights[k]) * own_error[k];
    for (std::size_t k = nodes.size(); k-- > 0;)
        if (const std::uint32_t up = above(std::uint32_t(k)); up != kNoSplit)
            nodes[up].error = std::max(nodes[up].error, nodes[k].error);
}

}  // namespace vsplit
