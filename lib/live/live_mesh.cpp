// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "vsplit/live_mesh.hpp"

#include <algorithm>
#include <utility>

#include "exchange.hpp"

namespace vsplit {
LiveMesh::LiveMesh(ProgressiveMesh mesh) : mesh_(std::move(mesh)) {}

void LiveMesh::refine() {
    const Split& split = mesh_.splits[level_];
    const std::uint32_t corners = level_ == 0 ? 0 : mesh_.splits[level_ - 1].corners_end;
    const std::uint32_t moves = level_ == 0 ? 0 : mesh_.splits[level_ - 1].moves_end;
    for (std::uint32_t i = corners; i < split.corners_end; ++i) {
        const CornerChange& change = mesh_.corner_changes[i];
        mesh_.triangles[change.corner / 3][change.corner % 3] = change.vertex;
    }
    for (std::uint32_t i = moves; i < split.moves_end; ++i) exchange_move(mesh_, i);
    ++level_;
}

void LiveMesh::coarsen() {
    --level_;
    const Split& split = mesh_.splits[level_];
    const std::uint32_t corners = level_ == 0 ? 0 : mesh_.splits[level_ - 1].corners_end;
    const std::uint32_t moves = level_ == 0 ? 0 : mesh_.splits[level_ - 1].moves_end;
    for (std::uint32_t i = split.moves_end; i-- > moves;) exchange_move(mesh_, i);
    for (std::uint32_t i = split.corners_end; i-- > corners;) {
        const CornerChange& change = mesh_.corner_changes[i];
        mesh_.triangles[change.corner / 3][change.corner % 3] = mesh_.parents[change.vertex];
    }
}

void LiveMesh::go_to(std::size_t level) {
    level = std::min(level, max_level());
    while (level_ < level) refine();
    while (level_ > level) coarsen();
}

std::span<const Float3> LiveMesh::positions() const {
    return std::span(mesh_.positions).first(vertices_at(mesh_, level_));
}

std::span<const Triangle> LiveMesh::triangles() const {
    return std::span(mesh_.triangles).first(triangles_at(mesh_, level_));
}

std::span<const float> LiveMesh::weights() const {
    return mesh_.weights.empty() ? std::span<const float>{}
                                 : std::span(mesh_.weights).first(vertices_at(mesh_, level_));
}

Mesh LiveMesh::snapshot() const {
    const auto p = positions();
    const auto t = triangles();
    const auto w = weights();
    Mesh mesh{{p.begin(), p.end()}, {t.begin(), t.end()}, {w.begin(), w.end()}};
    for (const Attribute& a : mesh_.attributes)
        mesh.attributes.push_back(
            {a.name,
             a.semantic,
             a.components,
             {a.values.begin(), a.values.begin() + std::ptrdiff_t(a.components * p.size())}});
    if (!mesh_.groups.empty())
        mesh.groups.assign(mesh_.groups.begin(), mesh_.groups.begin() + std::ptrdiff_t(t.size()));
    mesh.origin = mesh_.origin;
    return mesh;
}

ProgressiveMesh LiveMesh::release() {
    go_to(0);
    return std::exchange(mesh_, {});
}

Mesh cut(const ProgressiveMesh& mesh, std::size_t level) {
    LiveMesh live(mesh);
    live.go_to(level);
    return live.snapshot();
}

}  // namespace vsplit
