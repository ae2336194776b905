// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "live_arrays.hpp"

#include <algorithm>
#include <cmath>

namespace vsplit::web {

LiveArrays::LiveArrays(const FileInfo& info, const ProgressiveMesh& mesh, bool with_normals) : mesh_(mesh) {
    const auto prepare = [&](VertexArray& array, std::uint32_t components) {
        array.components = components;
        array.values.resize(std::size_t(components) * info.vertices);
        array.changes.resize(array.values.size());
    };
    prepare(positions, 3);
    if (info.has_weights) prepare(weights, 1);
    attributes.resize(info.attributes.size());
    stride_ = 3 + info.has_weights;
    for (std::size_t i = 0; i < attributes.size(); ++i) {
        prepare(attributes[i], info.attributes[i].components);
        stride_ += info.attributes[i].components;
    }
    if (with_normals) {
        normals.resize(std::size_t{4} * info.vertices);
        sums_.resize(std::size_t{3} * info.vertices);
    }
    groups.resize(std::size_t(info.largest_group) + 1);
    if (groups.size() > 1)
        place_.resize(info.triangles);
    else {
        groups[0].corners.reserve(std::size_t{3} * info.triangles);
        groups[0].changes.resize(std::size_t{3} * info.triangles);
    }
    before_.resize(stride_ * info.moves);
    for (std::uint32_t v = 0; v < mesh.base_vertices; ++v) set_vertex(v, mesh.positions[v]);
    shown_vertices_ = mesh.base_vertices;
    for (std::uint32_t t = 0; t < mesh.base_triangles; ++t) add_triangle(t);
    shown_triangles_ = mesh.base_triangles;
}

void LiveArrays::set_scale(std::uint32_t group, float scale) {
    if (group >= groups.size()) return;
    scale_of_group_.resize(groups.size(), 1.0f);
    scale_of_vertex.resize(positions.values.size() / 3, 1.0f);
    scale_of_group_[group] = scale;
    for (const std::uint32_t v : groups[group].corners) scale_of_vertex[v] = scale;
}

void LiveArrays::set_vertex(std::uint32_t vertex, const Float3& p) {
    float* to = &positions.values[std::size_t{3} * vertex];
    to[0] = p.x, to[1] = p.y, to[2] = p.z;
    positions.changes.mark(std::size_t{3} * vertex, std::size_t{3} * vertex + 3);
    if (weights.values.size() > 0) {
        weights.values[vertex] = mesh_.weights[vertex];
        weights.changes.mark(vertex);
    }
    for (std::size_t i = 0; i < attributes.size(); ++i) {
        VertexArray& array = attributes[i];
        const std::size_t begin = std::size_t(array.components) * vertex;
        std::copy_n(&mesh_.attributes[i].values[begin], array.components, &array.values[begin]);
        array.changes.mark(begin, begin + array.components);
    }
}

void LiveArrays::set_corner(std::uint32_t corner, std::uint32_t vertex) {
    const std::uint32_t triangle = corner / 3;
    GroupIndex& group = groups[place_.empty() ? 0 : mesh_.groups[triangle]];
    const std::size_t at = place_.empty() ? corner : std::size_t{3} * place_[triangle] + corner % 3;
    group.corners[at] = vertex;
    group.changes.mark(at);
}

void LiveArrays::add_triangle(std::size_t triangle) {
    const std::uint32_t g = place_.empty() ? 0 : mesh_.groups[triangle];
    GroupIndex& group = groups[g];
    const std::size_t begin = std::size_t{3} * group.triangles;
    if (!place_.empty()) place_[triangle] = group.triangles;
    if (group.corners.size() < begin + 3) {
        group.corners.resize(begin + 3);
        if (!place_.empty()) group.changes.resize(group.corners.capacity());
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = mesh_.triangles[triangle][k];
        group.corners[begin + k] = vertex;
        if (!scale_of_group_.empty()) scale_of_vertex[vertex] = scale_of_group_[g];
    }
    group.changes.mark(begin, begin + 3);
    ++group.triangles;
}

void LiveArrays::exchange(std::size_t move) {
    // Values of a move and what they overwrite are kept in one array, since the mesh is not ours to write in.
    const std::uint32_t vertex = mesh_.moves[move].vertex;
    float* kept = &before_[stride_ * move];
    const auto swap = [&](VertexArray& array) {
        const std::size_t begin = std::size_t(array.components) * vertex;
        for (std::uint32_t c = 0; c < array.components; ++c) std::swap(array.values[begin + c], *kept++);
        array.changes.mark(begin, begin + array.components);
    };
    swap(positions);
    if (weights.values.size() > 0) swap(weights);
    for (VertexArray& array : attributes) swap(array);
}

void LiveArrays::refine() {
    const Split& split = mesh_.splits[level_];
    const Split from =
        level_ > 0 ? mesh_.splits[level_ - 1] : Split{mesh_.base_vertices, mesh_.base_triangles, 0, 0, 0};
    for (std::uint32_t v = from.vertices_end; v < split.vertices_end; ++v) set_vertex(v, mesh_.positions[v]);
    for (std::uint32_t m = from.moves_end; m < split.moves_end; ++m) {
        const VertexMove& move = mesh_.moves[m];
        float* to = &before_[stride_ * m];
        *to++ = move.position.x, *to++ = move.position.y, *to++ = move.position.z;
        if (weights.values.size() > 0) *to++ = move.weight;
        for (std::size_t i = 0; i < attributes.size(); ++i)
            to = std::copy_n(&mesh_.moved_values[i][std::size_t(attributes[i].components) * m],
                             attributes[i].components, to);
        exchange(m);
    }
    for (std::uint32_t c = from.corners_end; c < split.corners_end; ++c)
        set_corner(mesh_.corner_changes[c].corner, mesh_.corner_changes[c].vertex);
    for (std::uint32_t t = from.triangles_end; t < split.triangles_end; ++t) add_triangle(t);
    shown_vertices_ = split.vertices_end;
    shown_triangles_ = split.triangles_end;
    ++level_;
}

void LiveArrays::coarsen() {
    const Split& split = mesh_.splits[--level_];
    const Split from =
        level_ > 0 ? mesh_.splits[level_ - 1] : Split{mesh_.base_vertices, mesh_.base_triangles, 0, 0, 0};
    for (std::uint32_t t = from.triangles_end; t < split.triangles_end; ++t)
        --groups[place_.empty() ? 0 : mesh_.groups[t]].triangles;
    for (std::uint32_t c = split.corners_end; c-- > from.corners_end;) {
        const CornerChange& change = mesh_.corner_changes[c];
        set_corner(change.corner, mesh_.parents[change.vertex]);
    }
    for (std::uint32_t m = split.moves_end; m-- > from.moves_end;) exchange(m);
    shown_vertices_ = from.vertices_end;
    shown_triangles_ = from.triangles_end;
}

void LiveArrays::go_towards(std::size_t level, std::size_t most) {
    for (; most > 0 && level_ < level; --most) refine();
    for (; most > 0 && level_ > level; --most) coarsen();
}

void LiveArrays::update_normals() {
    std::fill_n(sums_.begin(), std::size_t{3} * shown_vertices_, 0.0f);
    const float* p = positions.values.data();
    for (const GroupIndex& group : groups) {
        for (std::size_t t = 0; t < group.triangles; ++t) {
            const std::uint32_t* v = &group.corners[3 * t];
            const float *a = p + std::size_t{3} * v[0], *b = p + std::size_t{3} * v[1],
                        *c = p + std::size_t{3} * v[2];
            const float ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
            const float wx = c[0] - a[0], wy = c[1] - a[1], wz = c[2] - a[2];
            const float nx = uy * wz - uz * wy, ny = uz * wx - ux * wz, nz = ux * wy - uy * wx;
            for (int k = 0; k < 3; ++k) {
                float* sum = &sums_[std::size_t{3} * v[k]];
                sum[0] += nx, sum[1] += ny, sum[2] += nz;
            }
        }
    }
    for (std::size_t v = 0; v < shown_vertices_; ++v) {
        const float* sum = &sums_[3 * v];
        const float length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
        const float scale = length > 0 && std::isfinite(length) ? 32767 / length : 0;
        for (std::size_t k = 0; k < 3; ++k)
            normals[4 * v + k] = scale > 0 ? static_cast<std::int16_t>(std::lround(sum[k] * scale))
                                 : k == 2  ? 32767
                                           : 0;
    }
}

}  // namespace vsplit::web
