// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "record.hpp"

#include <algorithm>
#include <cstring>

namespace vsplit::bake {
namespace {

/// How many steps ahead memory is asked for.
constexpr std::size_t kAhead = 12;

}  // namespace

void Record::add(std::uint32_t child, std::uint32_t parent, const Float3& parent_position,
                 float parent_weight, float error) {
    error_ = std::max(error_, error);
    steps_.push_back({child, parent, std::uint32_t(corners_changed.size()), std::uint32_t(removed.size()),
                      parent_position, error_});
    if (has_weights_) parent_weights_.push_back(parent_weight);
}

void Record::add_vanished(const std::vector<std::uint32_t>& vertices, float error) {
    error_ = std::max(error_, error);
    const auto number = std::uint32_t(vanished_begins_.size());
    vanished_begins_.push_back(std::uint32_t(vanished_.size()));
    vanished_.insert(vanished_.end(), vertices.begin(), vertices.end());
    steps_.push_back({kNoVertex,
                      number,
                      std::uint32_t(corners_changed.size()),
                      std::uint32_t(removed.size()),
                      {},
                      error_});
    if (has_weights_) parent_weights_.push_back(1);
}

void Record::append(const Record& other, std::size_t begin, std::size_t end) {
    if (begin == end) return;
    const auto ends_before = [&](std::size_t step, auto member) {
        return step == 0 ? 0u : other.steps_[step - 1].*member;
    };
    const std::uint32_t corners = ends_before(begin, &Step::corners_end),
                        triangles = ends_before(begin, &Step::removed_end);
    const auto corners_now = std::uint32_t(corners_changed.size()),
               triangles_now = std::uint32_t(removed.size());
    corners_changed.insert(corners_changed.end(), other.corners_changed.begin() + corners,
                           other.corners_changed.begin() + ends_before(end, &Step::corners_end));
    removed.insert(removed.end(), other.removed.begin() + triangles,
                   other.removed.begin() + ends_before(end, &Step::removed_end));
    for (std::size_t i = begin; i < end; ++i) {
        Step step = other.steps_[i];
        step.corners_end += corners_now - corners;
        step.removed_end += triangles_now - triangles;
        error_ = step.error = std::max(error_, step.error);
        if (step.child == kNoVertex) {
            const std::uint32_t from = other.vanished_begins_[step.parent],
                                to = step.parent + 1 < other.vanished_begins_.size()
                                         ? other.vanished_begins_[step.parent + 1]
                                         : std::uint32_t(other.vanished_.size());
            step.parent = std::uint32_t(vanished_begins_.size());
            vanished_begins_.push_back(std::uint32_t(vanished_.size()));
            vanished_.insert(vanished_.end(), other.vanished_.begin() + from, other.vanished_.begin() + to);
        }
        steps_.push_back(step);
    }
    if (has_weights_)
        parent_weights_.insert(parent_weights_.end(), other.parent_weights_.begin() + std::ptrdiff_t(begin),
                               other.parent_weights_.begin() + std::ptrdiff_t(end));
}

ProgressiveMesh Record::finish(const StarMesh& mesh, const std::vector<float>& weights,
                               std::vector<std::uint32_t>* births) {
    ProgressiveMesh out;
    std::vector<std::uint32_t> vertex_birth(mesh.vertex_count(), kNoVertex),
        triangle_birth(mesh.triangle_count(), kNoVertex);
    std::vector<std::uint32_t> order;  // StarMesh vertex of each birth
    std::size_t total_vertices = mesh.live_vertices();
    std::uint32_t vanished_end = std::uint32_t(vanished_.size());
    total_vertices += vanished_.size();
    for (const Step& step : steps_) total_vertices += step.child != kNoVertex;
    order.reserve(total_vertices);
    out.parents.reserve(total_vertices);
    out.triangles.reserve(mesh.triangle_count());
    const auto bear_vertex = [&](std::uint32_t v, std::uint32_t parent) {
        vertex_birth[v] = std::uint32_t(order.size());
        order.push_back(v);
        out.parents.push_back(parent);
    };
    const auto bear_triangle = [&](std::uint32_t t) {
        triangle_birth[t] = std::uint32_t(out.triangles.size());
        const Triangle& c = mesh.triangle(t);
        out.triangles.push_back({vertex_birth[c[0]], vertex_birth[c[1]], vertex_birth[c[2]]});
        if (mesh.copies().any()) out.groups.push_back(mesh.copies().tag(t));
    };
    std::vector<bool> is_removed(mesh.triangle_count(), false);
    for (const std::uint32_t t : removed) is_removed[t] = true;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
        if (mesh.kind(v) != VertexKind::kDead) bear_vertex(v, kNoVertex);
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
        if (!is_removed[t]) bear_triangle(t);
    std::vector<bool>().swap(is_removed);
    out.base_vertices = std::uint32_t(order.size());
    out.base_triangles = std::uint32_t(out.triangles.size());

    out.splits.reserve(steps_.size());
    out.corner_changes.reserve(corners_changed.size());
    out.moves.reserve(steps_.size());
    for (std::size_t i = steps_.size(); i-- > 0;) {
        const Step& step = steps_[i];
        if (i >= kAhead) {
            const Step& later = steps_[i - kAhead];
            if (later.parent < vertex_birth.size()) fetch_ahead(&vertex_birth[later.parent]);
            const std::uint32_t corner = corners_changed.empty() ? 0 : later.corners_end,
                                first = later.removed_end;
            for (std::uint32_t j = corner; j < std::min(corner + 4, std::uint32_t(corners_changed.size()));
                 ++j)
                fetch_ahead(&triangle_birth[corners_changed[j] / 3]);
            for (std::uint32_t j = first; j < std::min(first + 2, std::uint32_t(removed.size())); ++j)
                mesh.prefetch_triangle(removed[j]);
        }
        const std::uint32_t corners_begin = i == 0 ? 0 : steps_[i - 1].corners_end;
        const std::uint32_t removed_begin = i == 0 ? 0 : steps_[i - 1].removed_end;
        if (step.child == kNoVertex) {
            const std::uint32_t begin = vanished_begins_.back();
            vanished_begins_.pop_back();
            for (std::uint32_t j = begin; j < vanished_end; ++j) bear_vertex(vanished_[j], kNoVertex);
            vanished_end = begin;
        } else {
            const std::uint32_t parent = vertex_birth[step.parent];
            bear_vertex(step.child, parent);
            // Positions at birth are filled in below; what a move changes is known now.
            out.moves.push_back({parent, step.parent_position, has_weights_ ? parent_weights_[i] : 1.0f});
            for (std::uint32_t j = corners_begin; j < step.corners_end; ++j) {
                const std::uint32_t corner = corners_changed[j];
                out.corner_changes.push_back(
                    {3 * triangle_birth[corner / 3] + corner % 3, vertex_birth[step.child]});
            }
            std::sort(out.corner_changes.end() - (step.corners_end - corners_begin), out.corner_changes.end(),
                      [](const CornerChange& a, const CornerChange& b) { return a.corner < b.corner; });
        }
        for (std::uint32_t j = removed_begin; j < step.removed_end; ++j) bear_triangle(removed[j]);
        out.splits.push_back({std::uint32_t(order.size()), std::uint32_t(out.triangles.size()),
                              std::uint32_t(out.corner_changes.size()), std::uint32_t(out.moves.size()),
                              step.error});
    }
    std::vector<Step>().swap(steps_);
    std::vector<std::uint32_t>().swap(corners_changed);
    std::vector<std::uint32_t>().swap(removed);
    std::vector<std::uint32_t>().swap(vertex_birth);
    std::vector<std::uint32_t>().swap(triangle_birth);

    // A vertex that died has its last place in the mesh: the one it is born at.
    out.positions.reserve(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i + kAhead < order.size()) mesh.prefetch_vertex(order[i + kAhead]);
        out.positions.push_back(mesh.raw_position(order[i]));
    }
    if (has_weights_) {
        out.weights.reserve(order.size());
        for (const std::uint32_t v : order) out.weights.push_back(weights[v]);
    }
    // A vertex that does not move in a split needs no move.
    std::vector<Float3> place(out.positions);
    std::vector<float> weight(out.weights);
    std::uint32_t from = 0, kept = 0;
    for (Split& split : out.splits) {
        for (; from < split.moves_end; ++from) {
            const VertexMove move = out.moves[from];
            const bool same = std::memcmp(&place[move.vertex], &move.position, sizeof(Float3)) == 0 &&
                              (!has_weights_ || weight[move.vertex] == move.weight);
            place[move.vertex] = move.position;
            if (has_weights_) weight[move.vertex] = move.weight;
            if (!same) out.moves[kept++] = move;
        }
        split.moves_end = kept;
    }
    out.moves.resize(kept);
    if (births) *births = std::move(order);
    return out;
}

}  // namespace vsplit::bake
