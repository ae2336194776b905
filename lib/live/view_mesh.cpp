// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "vsplit/view_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "exchange.hpp"
#include "view_plan.hpp"

namespace vsplit {
namespace {

constexpr std::uint32_t kPage = 64;

/// Pages of a buffer that changed.
class Pages {
  public:
    void resize(std::size_t elements) { pages_.assign((elements + kPage - 1) / kPage, 1); }
    void mark(std::uint32_t element) { pages_[element / kPage] = 1; }
    void take(std::size_t alive, std::vector<ViewMesh::Range>& ranges) {
        for (std::size_t page = 0; page < pages_.size(); ++page) {
            if (!std::exchange(pages_[page], std::uint8_t{0}) || page * kPage >= alive) continue;
            const auto begin = std::uint32_t(page * kPage);
            const auto end = std::uint32_t(std::min<std::size_t>(alive, (page + 1) * kPage));
            if (!ranges.empty() && ranges.back().end == begin)
                ranges.back().end = end;
            else
                ranges.push_back({begin, end});
        }
    }
    std::size_t memory() const { return pages_.capacity(); }

  private:
    std::vector<std::uint8_t> pages_;
};

/// An active vertex with what a camera must know of it, side by side: a frame reads them in a row.
struct Front {
    std::uint32_t vertex = 0;
    std::uint32_t following = kNoSplit, current = kNoSplit;  ///< In its chain of splits: to do, and done.
    ViewNode after, done;                                    ///< Of these two.
};

template <class T>
std::size_t bytes_of(const std::vector<T>& v) {
    return v.capacity() * sizeof(T);
}

}  // namespace

struct ViewMesh::State {
    ProgressiveMesh mesh;
    ViewPlan plan;
    std::vector<std::uint8_t> applied;  ///< Of each split.
    std::vector<std::uint32_t> users;   ///< Of each split: applied ones that need it.
    std::vector<Triangle> drawn;
    std::vector<std::uint32_t> number, slot;  ///< Of a drawn triangle its number, and back.
    std::vector<Front> active;
    std::vector<std::uint32_t> place;  ///< Of an active vertex: where it is among them.
    std::vector<std::uint32_t> stack;
    std::size_t applied_count = 0, cursor = 0, returning_cursor = 0;
    Pages dirty_triangles, dirty_vertices;

    void begin();
    Split before(std::uint32_t k) const {
        return k == 0 ? Split{mesh.base_vertices, mesh.base_triangles, 0, 0, 0} : mesh.splits[k - 1];
    }
    void add_triangle(std::uint32_t t);
    void remove_triangle(std::uint32_t t);
    void apply(std::uint32_t k);
    void undo(std::uint32_t k);
    std::size_t force(std::uint32_t k, std::size_t most);
    void add_vertex(std::uint32_t v);
    void turn(std::uint32_t anchor, std::uint32_t following, std::uint32_t current);
    bool wanted(const View& view, const ViewNode& node) const {
        return pixels(view, node) > std::max(view.pixels, 0.0f);
    }
    bool unwanted(const View& view, const ViewNode& node) const {
        return !(pixels(view, node) > std::max(view.pixels, 0.0f) * view.hysteresis);
    }
    static float pixels(const View& view, const ViewNode& node);
};

void ViewMesh::State::add_triangle(std::uint32_t t) {
    slot[t] = std::uint32_t(drawn.size());
    dirty_triangles.mark(slot[t]);
    drawn.push_back(mesh.triangles[t]);
    number.push_back(t);
}

void ViewMesh::State::remove_triangle(std::uint32_t t) {
    const std::uint32_t hole = slot[t];
    drawn[hole] = drawn.back();
    number[hole] = number.back();
    slot[number[hole]] = hole;
    dirty_triangles.mark(hole);
    drawn.pop_back();
    number.pop_back();
}

void ViewMesh::State::add_vertex(std::uint32_t v) {
    place[v] = std::uint32_t(active.size());
    active.push_back({v, kNoSplit, kNoSplit, {}, {}});
    turn(v, plan.first[v], kNoSplit);
}

/// Moves a vertex along its chain.
void ViewMesh::State::turn(std::uint32_t anchor, std::uint32_t following, std::uint32_t current) {
    Front& front = active[place[anchor]];
    front.following = following;
    front.current = current;
    if (following != kNoSplit) front.after = plan.nodes[following];
    if (current != kNoSplit) front.done = plan.nodes[current];
}

void ViewMesh::State::begin() {
    const std::size_t vertices = mesh.positions.size(), triangles = mesh.triangles.size();
    applied.assign(mesh.splits.size(), 0);
    users.assign(mesh.splits.size(), 0);
    drawn.reserve(triangles);
    number.reserve(triangles);
    slot.resize(triangles);
    active.reserve(vertices);
    place.resize(vertices);
    stack.reserve(mesh.splits.size());
    dirty_triangles.resize(triangles);
    dirty_vertices.resize(vertices);
    for (std::uint32_t t = 0; t < mesh.base_triangles; ++t) add_triangle(t);
    for (std::uint32_t v = 0; v < mesh.base_vertices; ++v) add_vertex(v);
}

void ViewMesh::State::apply(std::uint32_t k) {
    const Split from = before(k);
    const Split& to = mesh.splits[k];
    for (std::uint32_t i = from.corners_end; i < to.corners_end; ++i) {
        const CornerChange& change = mesh.corner_changes[i];
        const std::uint32_t at = slot[change.corner / 3];
        drawn[at][change.corner % 3] = change.vertex;
        dirty_triangles.mark(at);
    }
    for (std::uint32_t t = from.triangles_end; t < to.triangles_end; ++t) add_triangle(t);
    for (std::uint32_t i = from.moves_end; i < to.moves_end; ++i) {
        exchange_move(mesh, i);
        dirty_vertices.mark(mesh.moves[i].vertex);
    }
    for (std::uint32_t v = from.vertices_end; v < to.vertices_end; ++v) add_vertex(v);
    if (const std::uint32_t anchor = plan.vertex[k]; anchor != kNoVertex) turn(anchor, plan.next[k], k);
    for (std::uint32_t i = plan.needs_begin[k]; i < plan.needs_begin[k + 1]; ++i) ++users[plan.needs[i]];
    applied[k] = 1;
    ++applied_count;
}

void ViewMesh::State::undo(std::uint32_t k) {
    const Split from = before(k);
    const Split& to = mesh.splits[k];
    for (std::uint32_t v = to.vertices_end; v-- > from.vertices_end;) {
        const std::uint32_t hole = place[v];
        active[hole] = active.back();
        place[active[hole].vertex] = hole;
        active.pop_back();
    }
    for (std::uint32_t i = to.moves_end; i-- > from.moves_end;) {
        exchange_move(mesh, i);
        dirty_vertices.mark(mesh.moves[i].vertex);
    }
    for (std::uint32_t t = to.triangles_end; t-- > from.triangles_end;) remove_triangle(t);
    for (std::uint32_t i = to.corners_end; i-- > from.corners_end;) {
        const CornerChange& change = mesh.corner_changes[i];
        const std::uint32_t at = slot[change.corner / 3];
        drawn[at][change.corner % 3] = mesh.parents[change.vertex];
        dirty_triangles.mark(at);
    }
    if (const std::uint32_t anchor = plan.vertex[k]; anchor != kNoVertex) turn(anchor, k, plan.previous[k]);
    for (std::uint32_t i = plan.needs_begin[k]; i < plan.needs_begin[k + 1]; ++i) --users[plan.needs[i]];
    applied[k] = 0;
    --applied_count;
}

/// Applies a split after all that it waits for; how many that were. Stops early at `most`.
std::size_t ViewMesh::State::force(std::uint32_t k, std::size_t most) {
    std::size_t done = 0;
    stack.assign(1, k);
    while (!stack.empty() && done < most) {
        const std::uint32_t top = stack.back();
        std::uint32_t missing = kNoSplit;
        // Needs are older than what needs them: this ends, and the stack grows with each step down.
        for (std::uint32_t i = plan.needs_begin[top]; i < plan.needs_begin[top + 1] && missing == kNoSplit;
             ++i)
            if (!applied[plan.needs[i]]) missing = plan.needs[i];
        if (missing != kNoSplit) {
            stack.push_back(missing);
            continue;
        }
        apply(top);
        ++done;
        stack.pop_back();
    }
    return done;
}

/// What a split's error spans on the screen (Hoppe 1997, section 4: sphere against frustum, cone of normals
/// against the eye, deviation over distance).
float ViewMesh::State::pixels(const View& view, const ViewNode& node) {
    constexpr float kAll = std::numeric_limits<float>::infinity();
    const Float3& p = node.centre;
    const float x = view.eye.x - p.x, y = view.eye.y - p.y, z = view.eye.z - p.z;
    const float square = x * x + y * y + z * z;
    // Most are too small from this far, which takes neither a root nor a plane to see.
    if (const float low = view.pixels * view.hysteresis; low > 0) {
        const float reach = node.radius + node.error * view.pixels_at_distance_1 / low;
        if (square >= reach * reach && square > node.radius * node.radius) return 0;
    }
    for (const ViewPlane& plane : view.planes)
        if (plane.x * p.x + plane.y * p.y + plane.z * p.z + plane.w < -node.radius) return 0;
    if (!(view.pixels > 0)) return kAll;
    if (node.error <= 0) return 0;
    const float far = std::sqrt(square);
    if (far <= node.radius) return kAll;
    const float all = node.error * view.pixels_at_distance_1 / (far - node.radius);
    // Angles to the normal: of the eye, and how far normals and directions stray from these.
    const float stray = node.spread + node.radius / far;
    if (!(stray < 1)) return all;
    const float cosine = (x * node.normal.x + y * node.normal.y + z * node.normal.z) / far;
    if (cosine < -stray) return 0;
    if (cosine <= stray) return all;
    const float sine =
        std::sqrt(std::max(0.0f, 1 - cosine * cosine)) * std::sqrt(1 - stray * stray) + cosine * stray;
    return all * std::clamp(sine, view.facing, std::max(view.facing, 1.0f));
}

ViewMesh::ViewMesh(std::unique_ptr<State> state) : state_(std::move(state)) {}
ViewMesh::ViewMesh(ViewMesh&&) noexcept = default;
ViewMesh& ViewMesh::operator=(ViewMesh&&) noexcept = default;
ViewMesh::~ViewMesh() = default;

Result<ViewMesh> ViewMesh::make(ProgressiveMesh mesh) {
    auto state = std::make_unique<State>();
    state->mesh = std::move(mesh);
    if (state->mesh.positions.empty()) state->mesh.splits.clear();  // They have nothing to do.
    if (!plan_view(state->mesh, state->plan))
        return Error{ErrorCode::kLimit, "too many triangles meet where the mesh is split", Error::kNowhere,
                     0};
    state->begin();
    return ViewMesh(std::move(state));
}

ViewUpdated ViewMesh::update(const View& view, const ViewBudget& budget) {
    State& s = *state_;
    ViewUpdated result;
    const auto left = [&] { return budget.max_splits - result.refined - result.coarsened; };
    const auto refine = [&](std::uint32_t k) { result.refined += s.force(k, left()); };
    bool whole = true;
    const std::size_t returning = s.plan.returning.size();
    for (std::size_t i = 0; i < returning; ++i, ++result.visits) {
        if (left() == 0 || result.visits >= budget.max_visits) {
            whole = false;
            break;
        }
        if (s.returning_cursor >= returning) s.returning_cursor = 0;
        const std::uint32_t k = s.plan.returning[s.returning_cursor++];
        const ViewNode& node = s.plan.nodes[k];
        if (!s.applied[k]) {
            if (s.wanted(view, node)) refine(k);
        } else if (s.users[k] == 0 && s.unwanted(view, node)) {
            s.undo(k);
            ++result.coarsened;
        }
    }
    for (std::size_t i = 0; i < s.active.size(); ++i, ++result.visits) {
        if (left() == 0 || result.visits >= budget.max_visits) {
            whole = false;
            break;
        }
        if (s.cursor >= s.active.size()) s.cursor = 0;
        const Front& seen = s.active[s.cursor++];
        const bool finer = seen.following != kNoSplit && s.wanted(view, seen.after);
        if (!finer && (seen.current == kNoSplit || !s.unwanted(view, seen.done))) continue;
        const std::uint32_t v = seen.vertex;
        const std::size_t changed = result.refined + result.coarsened;
        // Its place may change with every split.
        const auto front = [&]() -> const Front& { return s.active[s.place[v]]; };
        while (left() > 0 && front().following != kNoSplit && s.wanted(view, front().after))
            refine(front().following);
        if (result.refined + result.coarsened == changed)
            while (left() > 0 && front().current != kNoSplit && s.unwanted(view, front().done) &&
                   s.users[front().current] == 0) {
                s.undo(front().current);
                ++result.coarsened;
            }
    }
    result.settled = whole && result.refined + result.coarsened == 0;
    return result;
}

std::span<const Triangle> ViewMesh::triangles() const {
    return state_->drawn;
}
std::span<const Float3> ViewMesh::positions() const {
    return state_->mesh.positions;
}
std::span<const float> ViewMesh::weights() const {
    return state_->mesh.weights;
}
const std::vector<Attribute>& ViewMesh::attributes() const {
    return state_->mesh.attributes;
}
std::uint32_t ViewMesh::triangle_number(std::size_t index) const {
    return state_->number[index];
}
std::size_t ViewMesh::active_vertices() const {
    return state_->active.size();
}
std::size_t ViewMesh::active_splits() const {
    return state_->applied_count;
}

ViewMesh::Dirty ViewMesh::take_dirty() {
    Dirty dirty;
    state_->dirty_triangles.take(state_->drawn.size(), dirty.triangles);
    state_->dirty_vertices.take(state_->mesh.positions.size(), dirty.vertices);
    return dirty;
}

std::size_t ViewMesh::memory() const {
    const State& s = *state_;
    const ProgressiveMesh& m = s.mesh;
    std::size_t bytes = bytes_of(m.positions) + bytes_of(m.weights) + bytes_of(m.parents) +
                        bytes_of(m.triangles) + bytes_of(m.splits) + bytes_of(m.corner_changes) +
                        bytes_of(m.moves) + bytes_of(m.groups);
    for (const Attribute& attribute : m.attributes) bytes += bytes_of(attribute.values);
    for (const auto& values : m.moved_values) bytes += bytes_of(values);
    const ViewPlan& p = s.plan;
    for (const auto* v : {&p.needs_begin, &p.needs, &p.vertex, &p.next, &p.previous, &p.first, &p.born,
                          &p.returning, &s.users, &s.number, &s.slot, &s.place, &s.stack})
        bytes += bytes_of(*v);
    return bytes + bytes_of(s.active) + bytes_of(p.nodes) + bytes_of(s.applied) + bytes_of(s.drawn) +
           s.dirty_triangles.memory() + s.dirty_vertices.memory();
}

}  // namespace vsplit
