// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// ViewMesh: taking splits, and the order in which priorities want them.
#include <algorithm>
#include <cmath>
#include <utility>

#include "extend.hpp"
#include "view_state.hpp"

namespace vsplit {
namespace {

constexpr float kMostPriority = 1e18f;

}  // namespace

/// For all that is to come.
void ViewMesh::State::reserve() {
    mesh.positions.reserve(room.vertices);
    mesh.parents.reserve(room.vertices);
    if (!mesh.weights.empty()) mesh.weights.reserve(room.vertices);
    mesh.triangles.reserve(room.triangles);
    if (!mesh.groups.empty()) mesh.groups.reserve(room.triangles), drawn_groups.reserve(room.triangles);
    mesh.splits.reserve(room.splits);
    mesh.corner_changes.reserve(room.corner_changes);
    mesh.moves.reserve(room.moves);
    for (std::size_t i = 0; i < mesh.attributes.size(); ++i) {
        mesh.attributes[i].values.reserve(std::size_t{mesh.attributes[i].components} * room.vertices);
        mesh.moved_values[i].reserve(std::size_t{mesh.attributes[i].components} * room.moves);
    }
    applied.reserve(room.splits);
    users.reserve(room.splits);
    stack.reserve(room.splits);
    drawn.reserve(room.triangles);
    number.reserve(room.triangles);
    slot.reserve(room.triangles);
    active.reserve(room.vertices);
    place.reserve(room.vertices);
    dirty_triangles.reserve(room.triangles);
    dirty_vertices.reserve(room.vertices);
}

/// Plans the splits of `source` from those known on; mesh has them, too.
Status ViewMesh::State::extend(const ProgressiveMesh& source) {
    const std::size_t splits = applied.size(), vertices = place.size();
    weigh(vertices, splits);
    changed.clear();
    if (!planner->extend(source, of_split, changed))
        return Error{ErrorCode::kLimit, "too many triangles meet where the mesh is split", Error::kNowhere,
                     0};
    applied.resize(mesh.splits.size(), 0);
    users.resize(mesh.splits.size(), 0);
    slot.resize(mesh.triangles.size());
    place.resize(mesh.positions.size());
    dirty_triangles.resize(mesh.triangles.size());
    dirty_vertices.resize(mesh.positions.size());
    for (const std::uint32_t k : changed) refresh(k);
    for (std::size_t k = splits; k < mesh.splits.size(); ++k) refresh(std::uint32_t(k));
    if (mesh.splits.size() >= room.splits) planner.reset();
    return Ok{};
}

/// A split's node is new, or not what it was: its vertex may be waiting for it.
void ViewMesh::State::refresh(std::uint32_t k) {
    const std::uint32_t v = plan.vertex[k];
    if (v == kNoVertex || place[v] >= active.size() || active[place[v]].vertex != v) return;
    const std::uint32_t current = active[place[v]].current;
    const std::uint32_t following = current == kNoSplit ? plan.first[v] : plan.next[current];
    if (k == current || k == following) turn(v, following, current);
}

/// Priorities of vertices and splits from some on.
void ViewMesh::State::weigh(std::size_t from_vertex, std::size_t from_split) {
    if (priority == Priority::kAlike) return;
    const std::size_t known = of_vertex.size();
    of_vertex.resize(mesh.positions.size(), 1);
    for (std::size_t v = std::max(from_vertex, known); v < of_vertex.size(); ++v) {
        if (priority == Priority::kWeights)
            of_vertex[v] = std::min(mesh.weights[v], kMostPriority);  // not yet moved
        else if (mesh.parents[v] != kNoVertex)
            of_vertex[v] = of_vertex[mesh.parents[v]];
    }
    of_split.resize(mesh.splits.size());
    for (auto k = std::uint32_t(from_split); k < of_split.size(); ++k) {
        const Split from = before(k);
        const Split& to = mesh.splits[k];
        float most = from.vertices_end < to.vertices_end || from.moves_end < to.moves_end ? 0.0f : 1.0f;
        for (std::uint32_t v = from.vertices_end; v < to.vertices_end; ++v)
            most = std::max(most, of_vertex[v]);
        if (from.vertices_end == to.vertices_end)
            for (std::uint32_t i = from.moves_end; i < to.moves_end; ++i)
                most = std::max(most, of_vertex[mesh.moves[i].vertex]);
        of_split[k] = most;
        largest = std::max(largest, most);
    }
}

/// What the file says of vertices whose weights splits may have changed since.
std::vector<float> ViewMesh::State::weights_at_birth() const {
    std::vector<float> weights = mesh.weights;
    if (weights.empty()) return weights;
    for (auto k = std::uint32_t(applied.size()); k-- > 0;)
        if (applied[k])
            for (std::uint32_t i = before(k).moves_end; i < mesh.splits[k].moves_end; ++i)
                weights[mesh.moves[i].vertex] = mesh.moves[i].weight;
    return weights;
}

Result<ViewMesh> ViewMesh::make(ProgressiveMesh mesh, const ViewRoom& room) {
    auto state = std::make_unique<State>();
    State& s = *state;
    s.mesh = std::move(mesh);
    if (s.mesh.positions.empty()) s.mesh.splits.clear();  // They have nothing to do.
    s.room = {std::max(room.vertices, std::uint32_t(s.mesh.positions.size())),
              std::max(room.triangles, std::uint32_t(s.mesh.triangles.size())),
              std::max(room.splits, std::uint32_t(s.mesh.splits.size())),
              std::max(room.corner_changes, std::uint32_t(s.mesh.corner_changes.size())),
              std::max(room.moves, std::uint32_t(s.mesh.moves.size()))};
    s.reserve();
    s.planner = std::make_unique<ViewPlanner>(s.plan);
    if (Status planned = s.extend(s.mesh); !planned) return planned.error();
    for (std::uint32_t t = 0; t < s.mesh.base_triangles; ++t) s.add_triangle(t);
    for (std::uint32_t v = 0; v < s.mesh.base_vertices; ++v) s.add_vertex(v);
    return ViewMesh(std::move(state));
}

Status ViewMesh::append(const ProgressiveMesh& mesh) {
    State& s = *state_;
    if (mesh.splits.size() <= s.mesh.splits.size()) return Ok{};
    if (!s.planner || mesh.splits.size() > s.room.splits)
        return Error{ErrorCode::kArgument, "more splits than there is room for", Error::kNowhere, 0};
    extend(s.mesh.positions, mesh.positions);
    extend(s.mesh.parents, mesh.parents);
    extend(s.mesh.weights, mesh.weights);
    extend(s.mesh.triangles, mesh.triangles);
    extend(s.mesh.groups, mesh.groups);
    extend(s.mesh.splits, mesh.splits);
    extend(s.mesh.corner_changes, mesh.corner_changes);
    extend(s.mesh.moves, mesh.moves);
    for (std::size_t i = 0; i < s.mesh.attributes.size(); ++i) {
        extend(s.mesh.attributes[i].values, mesh.attributes[i].values);
        extend(s.mesh.moved_values[i], mesh.moved_values[i]);
    }
    return s.extend(mesh);
}

// ---- Priorities

Status ViewMesh::set_priority(std::span<const float> of_vertices) {
    State& s = *state_;
    if (of_vertices.size() > s.mesh.positions.size())
        return Error{ErrorCode::kArgument, "more priorities than vertices", Error::kNowhere, 0};
    for (const float p : of_vertices)
        if (!(p >= 0) || std::isinf(p))
            return Error{ErrorCode::kArgument, "a priority is negative or not finite", Error::kNowhere, 0};
    s.priority = of_vertices.empty() ? State::Priority::kAlike : State::Priority::kGiven;
    s.prioritise({of_vertices.begin(), of_vertices.end()});
    return Ok{};
}

void ViewMesh::use_weights() {
    State& s = *state_;
    s.priority = s.mesh.weights.empty() ? State::Priority::kAlike : State::Priority::kWeights;
    s.prioritise(s.weights_at_birth());
}

/// Starts anew with the priorities of the first vertices.
void ViewMesh::State::prioritise(std::vector<float> first) {
    of_vertex = std::move(first);
    for (float& p : of_vertex) p = std::clamp(p, 0.0f, kMostPriority);
    of_split.clear();
    largest = priority == Priority::kAlike ? 1.0f : 0.0f;
    weigh(0, 0);
    plan.weigh(of_split);
    for (std::uint32_t v = 0; v < place.size(); ++v)
        if (place[v] < active.size() && active[place[v]].vertex == v)
            turn(v, active[place[v]].following, active[place[v]].current);
    order = {};
    forget_place();
}

float ViewMesh::largest_priority() const {
    return state_->largest;
}
std::size_t ViewMesh::available() const {
    return state_->applied.size();
}
std::size_t ViewMesh::ranked() const {
    return state_->order.splits.size();
}

void ViewMesh::rank() {
    State& s = *state_;
    if (s.order.splits.size() == s.applied.size()) return;
    s.order.build(s.mesh, s.plan, s.of_split);
    s.forget_place();
}

/// How many ranks stay within `count`.
std::size_t ViewMesh::State::last_rank(const std::vector<std::uint32_t>& ends, std::uint64_t count) const {
    return std::size_t(std::upper_bound(ends.begin(), ends.end(), count) - ends.begin());
}

std::size_t ViewMesh::rank_for_triangles(std::uint64_t count) const {
    return state_->last_rank(state_->order.triangles_end, count);
}
std::size_t ViewMesh::rank_for_vertices(std::uint64_t count) const {
    return state_->last_rank(state_->order.vertices_end, count);
}

std::size_t ViewMesh::rank_for_error(double error) const {
    const std::vector<float>& errors = state_->order.error;
    return std::size_t(
        std::partition_point(errors.begin(), errors.end(), [&](float e) { return double(e) > error; }) -
        errors.begin());
}

float ViewMesh::error_at_rank(std::size_t rank) const {
    return rank < ranked() ? state_->order.error[rank] : 0;
}

ViewUpdated ViewMesh::refine_to(std::size_t rank, const ViewBudget& budget) {
    State& s = *state_;
    ViewUpdated result;
    const std::vector<std::uint32_t>& splits = s.order.splits;
    rank = std::min(rank, splits.size());
    Clock clock(budget.out_of_time);
    const auto may = [&] {
        const std::size_t changes = result.refined + result.coarsened;
        return changes < budget.max_splits && result.visits < budget.max_visits &&
               !clock.late(result.visits + changes);
    };
    // What the order does not know waits for what it does, and so goes first.
    for (; s.late > splits.size() && may(); ++result.visits) {
        if (!s.applied[--s.late]) continue;
        s.undo(std::uint32_t(s.late));
        ++result.coarsened;
    }
    if (s.late > splits.size()) return result;
    for (; s.high > rank && may(); ++result.visits) {
        const std::uint32_t k = splits[--s.high];
        if (!s.applied[k]) continue;
        s.undo(k);
        ++result.coarsened;
    }
    s.low = std::min(s.low, s.high);
    for (; s.high <= rank && s.low < rank && may(); ++result.visits) {
        const std::uint32_t k = splits[s.low++];
        if (s.applied[k]) continue;
        s.apply(k);
        ++result.refined;
        s.high = std::max(s.high, s.low);
    }
    s.high = std::max(s.high, s.low);
    result.settled = s.low == rank && s.high == rank;
    return result;
}

}  // namespace vsplit
