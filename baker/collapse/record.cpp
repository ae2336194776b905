// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "record.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace vsplit::bake {
namespace {

/// How many steps ahead memory is asked for.
constexpr std::size_t kAhead = 12;

}  // namespace

void Record::reserve(std::size_t vertices, std::size_t triangles) {
    // Of a closed mesh three corners a collapse change hands, a few more with the valences at hand.
    steps_.reserve(vertices);
    corners_changed.reserve(7 * vertices / 2);
    removed.reserve(triangles);
}

void Record::add(std::uint32_t child, std::uint32_t parent, const Float3& parent_position,
                 float parent_weight, bool moved, float error) {
    error_ = std::max(error_, error);
    steps_.push_back({child, parent, moved, std::uint32_t(corners_changed.size()),
                      std::uint32_t(removed.size()), parent_position, error_});
    if (has_weights_) parent_weights_.push_back(parent_weight);
}

void Record::add_vanished(const std::vector<std::uint32_t>& vertices, float error) {
    error_ = std::max(error_, error);
    const auto number = std::uint32_t(vanished_begins_.size());
    vanished_begins_.push_back(std::uint32_t(vanished_.size()));
    vanished_.insert(vanished_.end(), vertices.begin(), vertices.end());
    steps_.push_back({kNoVertex,
                      number,
                      false,
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
                                to = other.vanished_end(step.parent);
            step.parent = std::uint32_t(vanished_begins_.size()) & 0x7FFFFFFFu;
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
    std::uint32_t base_vertices = 0;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
        base_vertices += mesh.kind(v) != VertexKind::kDead;
    out.base_vertices = base_vertices;
    out.base_triangles = mesh.triangle_count() - std::uint32_t(removed.size());

    // How much each split brings says where it stands; all the rest is then filled in at once.
    const std::size_t count = steps_.size();
    out.splits.reserve(count);
    Split end{out.base_vertices, out.base_triangles, 0, 0, 0};
    for (std::size_t i = count; i-- > 0;) {
        const Step &step = steps_[i], before = i == 0 ? Step{} : steps_[i - 1];
        end.triangles_end += step.removed_end - before.removed_end;
        end.corners_end += step.corners_end - before.corners_end;
        if (step.child == kNoVertex) {
            end.vertices_end += vanished_end(step.parent) - vanished_begins_[step.parent];
        } else {
            ++end.vertices_end;
            end.moves_end += step.moved;
        }
        end.error = step.error;
        out.splits.push_back(end);
    }
    const Split base{out.base_vertices, out.base_triangles, 0, 0, 0};
    const auto each_split = [&](const auto& body) {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 4096),
                          [&](const tbb::blocked_range<std::size_t>& range) {
                              for (std::size_t s = range.begin(); s < range.end(); ++s)
                                  body(count - 1 - s, s == 0 ? base : out.splits[s - 1]);
                          });
    };
    const auto removed_begin = [&](std::size_t i) { return i == 0 ? 0 : steps_[i - 1].removed_end; };

    // A vertex that died has its last place and weight in the mesh: those it is born with.
    out.positions.resize(end.vertices_end);
    out.parents.resize(end.vertices_end, kNoVertex);
    if (has_weights_) out.weights.resize(end.vertices_end);
    if (births) births->resize(end.vertices_end);
    std::vector<std::uint32_t> vertex_birth(mesh.vertex_count(), kNoVertex),
        triangle_birth(mesh.triangle_count(), kNoVertex);
    const auto bear_vertex = [&](std::uint32_t v, std::uint32_t birth) {
        vertex_birth[v] = birth;
        out.positions[birth] = mesh.raw_position(v);
        if (has_weights_) out.weights[birth] = weights[v];
        if (births) (*births)[birth] = v;
    };
    std::uint32_t birth = 0;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
        if (mesh.kind(v) != VertexKind::kDead) bear_vertex(v, birth++);
    each_split([&](std::size_t i, const Split& begin) {
        if (i >= kAhead && steps_[i - kAhead].child != kNoVertex)
            mesh.prefetch_vertex(steps_[i - kAhead].child);
        const Step& step = steps_[i];
        for (std::uint32_t j = removed_begin(i); j < step.removed_end; ++j)
            triangle_birth[removed[j]] = begin.triangles_end + j - removed_begin(i);
        if (step.child != kNoVertex) return bear_vertex(step.child, begin.vertices_end);
        const std::uint32_t first = vanished_begins_[step.parent];
        for (std::uint32_t j = first; j < vanished_end(step.parent); ++j)
            bear_vertex(vanished_[j], begin.vertices_end + j - first);
    });

    out.triangles.resize(mesh.triangle_count());
    if (mesh.copies().any()) out.groups.resize(mesh.triangle_count());
    out.corner_changes.resize(end.corners_end);
    out.moves.resize(end.moves_end);
    const auto bear_triangle = [&](std::uint32_t t) {
        const Triangle& c = mesh.triangle(t);
        out.triangles[triangle_birth[t]] = {vertex_birth[c[0]], vertex_birth[c[1]], vertex_birth[c[2]]};
        if (mesh.copies().any()) out.groups[triangle_birth[t]] = mesh.copies().tag(t);
    };
    birth = 0;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
        if (triangle_birth[t] == kNoVertex) {
            triangle_birth[t] = birth++;
            bear_triangle(t);
        }
    each_split([&](std::size_t i, const Split& begin) {
        if (i >= kAhead) {
            const Step& later = steps_[i - kAhead];
            if (later.child != kNoVertex) fetch_ahead(&vertex_birth[later.parent]);
            const std::uint32_t corner = i == kAhead ? 0 : steps_[i - kAhead - 1].corners_end;
            for (std::uint32_t j = corner; j < std::min(corner + 4, later.corners_end); ++j)
                fetch_ahead(&triangle_birth[corners_changed[j] / 3]);
            const std::uint32_t first = removed_begin(i - kAhead);
            for (std::uint32_t j = first; j < std::min(first + 2, later.removed_end); ++j)
                mesh.prefetch_triangle(removed[j]);
        }
        const Step& step = steps_[i];
        for (std::uint32_t j = removed_begin(i); j < step.removed_end; ++j) bear_triangle(removed[j]);
        if (step.child == kNoVertex) return;
        const std::uint32_t parent = vertex_birth[step.parent];
        out.parents[begin.vertices_end] = parent;
        if (step.moved)
            out.moves[begin.moves_end] = {parent, step.parent_position,
                                          has_weights_ ? parent_weights_[i] : 1.0f};
        const auto first = out.corner_changes.begin() + begin.corners_end;
        auto change = first;
        for (std::uint32_t j = i == 0 ? 0 : steps_[i - 1].corners_end; j < step.corners_end; ++j, ++change) {
            const std::uint32_t corner = corners_changed[j];
            *change = {3 * triangle_birth[corner / 3] + corner % 3, begin.vertices_end};
        }
        std::sort(first, change,
                  [](const CornerChange& a, const CornerChange& b) { return a.corner < b.corner; });
    });
    std::vector<Step>().swap(steps_);
    std::vector<std::uint32_t>().swap(corners_changed);
    std::vector<std::uint32_t>().swap(removed);
    return out;
}

}  // namespace vsplit::bake
