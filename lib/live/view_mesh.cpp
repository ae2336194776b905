// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "exchange.hpp"
#include "extend.hpp"
#include "prefetch.hpp"
#include "view_state.hpp"

namespace vsplit {
namespace {

constexpr std::size_t kAhead = 12;  // places between the one fetched and the one looked at

}  // namespace

void ViewMesh::State::add_triangle(std::uint32_t t) {
    slot[t] = std::uint32_t(drawn.size());
    dirty_triangles.mark(slot[t]);
    drawn.push_back(mesh.triangles[t]);
    number.push_back(t);
    if (!mesh.groups.empty()) drawn_groups.push_back(mesh.groups[t]);
}

void ViewMesh::State::remove_triangle(std::uint32_t t) {
    const std::uint32_t hole = slot[t];
    drawn[hole] = drawn.back();
    number[hole] = number.back();
    slot[number[hole]] = hole;
    dirty_triangles.mark(hole);
    drawn.pop_back();
    number.pop_back();
    if (!mesh.groups.empty()) {
        drawn_groups[hole] = drawn_groups.back();
        drawn_groups.pop_back();
    }
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
float ViewMesh::State::pixels(const Frame& frame, const ViewNode& node) {
    const View& view = frame.view;
    constexpr float kAll = std::numeric_limits<float>::infinity();
    const Float3& p = node.centre;
    const float x = view.eye.x - p.x, y = view.eye.y - p.y, z = view.eye.z - p.z;
    const float square = x * x + y * y + z * z;
    // Most are too small from this far, which takes neither a root nor a plane to see.
    const float reach = node.radius + node.error * frame.reach;
    if (square >= reach * reach && square > node.radius * node.radius) return 0;
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

/// Looks at one place of the ring of splits without a parent and of active vertices.
void ViewMesh::State::visit(const Frame& frame, std::size_t at, std::size_t most, ViewUpdated& result) {
    const auto left = [&] { return most - result.refined - result.coarsened; };
    if (at < plan.returning.size()) {
        const std::uint32_t k = plan.returning[at];
        const ViewNode& node = plan.nodes[k];
        if (!applied[k]) {
            if (wanted(frame, node)) result.refined += force(k, left());
        } else if (users[k] == 0 && unwanted(frame, node)) {
            undo(k);
            ++result.coarsened;
        }
        return;
    }
    const Front& seen = active[at - plan.returning.size()];
    const bool finer = seen.following != kNoSplit && wanted(frame, seen.after);
    if (!finer && (seen.current == kNoSplit || users[seen.current] != 0 || !unwanted(frame, seen.done)))
        return;
    const std::uint32_t v = seen.vertex;
    const std::size_t changed_before = result.refined + result.coarsened;
    // Its place may change with every split.
    const auto front = [&]() -> const Front& { return active[place[v]]; };
    while (left() > 0 && front().following != kNoSplit && wanted(frame, front().after))
        result.refined += force(front().following, left());
    if (result.refined + result.coarsened == changed_before)
        while (left() > 0 && front().current != kNoSplit && unwanted(frame, front().done) &&
               users[front().current] == 0) {
            undo(front().current);
            ++result.coarsened;
        }
}

ViewUpdated ViewMesh::update(const View& view, const ViewBudget& budget) {
    State& s = *state_;
    ViewUpdated result;
    Clock clock(budget.out_of_time);
    const Frame frame(view);
    bool whole = true;
    for (std::size_t i = 0; i < s.plan.returning.size() + s.active.size(); ++i, ++result.visits) {
        const std::size_t changes = result.refined + result.coarsened;
        if (changes >= budget.max_splits || result.visits >= budget.max_visits ||
            clock.late(result.visits + changes)) {
            whole = false;
            break;
        }
        if (s.cursor >= s.plan.returning.size() + s.active.size()) s.cursor = 0;
        if (const std::size_t ahead = s.cursor + kAhead - s.plan.returning.size(); ahead < s.active.size())
            if (const std::uint32_t current = s.active[ahead].current; current != kNoSplit)
                prefetch(&s.users[current]);
        s.visit(frame, s.cursor++, budget.max_splits, result);
    }
    result.settled = whole && result.refined + result.coarsened == 0;
    if (result.refined + result.coarsened > 0) s.forget_place();
    return result;
}

std::span<const Triangle> ViewMesh::triangles() const {
    return state_->drawn;
}
std::span<const std::uint32_t> ViewMesh::groups() const {
    return state_->drawn_groups;
}
std::span<const std::uint32_t> ViewMesh::parents() const {
    return state_->mesh.parents;
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
    for (const auto* v :
         {&p.needs_begin, &p.needs, &p.vertex, &p.next, &p.previous, &p.first, &p.born, &p.returning,
          &s.users, &s.number, &s.slot, &s.drawn_groups, &s.place, &s.stack, &s.changed})
        bytes += bytes_of(*v);
    for (const auto* v : {&p.own_error, &s.of_vertex, &s.of_split}) bytes += bytes_of(*v);
    if (s.planner) bytes += s.planner->memory();
    return bytes + bytes_of(s.active) + bytes_of(p.nodes) + bytes_of(s.applied) + bytes_of(s.drawn) +
           s.order.memory() + s.dirty_triangles.memory() + s.dirty_vertices.memory();
}

}  // namespace vsplit
