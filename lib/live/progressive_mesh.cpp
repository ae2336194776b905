// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "vsplit/progressive_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace vsplit {
namespace {

bool finite(const Float3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

bool names_twice(const Triangle& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// The last level whose key is at most `limit`, keys growing with the level.
template <class Key>
std::size_t last_level(const ProgressiveMesh& mesh, std::uint64_t limit, Key key) {
    const auto it =
        std::upper_bound(mesh.splits.begin(), mesh.splits.end(), limit,
                         [&](std::uint64_t value, const Split& split) { return value < key(split); });
    return static_cast<std::size_t>(it - mesh.splits.begin());
}

}  // namespace

std::uint32_t vertices_at(const ProgressiveMesh& mesh, std::size_t level) {
    return level == 0 ? mesh.base_vertices : mesh.splits[level - 1].vertices_end;
}

std::uint32_t triangles_at(const ProgressiveMesh& mesh, std::size_t level) {
    return level == 0 ? mesh.base_triangles : mesh.splits[level - 1].triangles_end;
}

double error_at(const ProgressiveMesh& mesh, std::size_t level) {
    return level < mesh.splits.size() ? static_cast<double>(mesh.splits[level].error) : 0.0;
}

std::size_t level_for_triangles(const ProgressiveMesh& mesh, std::uint64_t count) {
    return last_level(mesh, count, [](const Split& s) { return std::uint64_t{s.triangles_end}; });
}

std::size_t level_for_vertices(const ProgressiveMesh& mesh, std::uint64_t count) {
    return last_level(mesh, count, [](const Split& s) { return std::uint64_t{s.vertices_end}; });
}

std::size_t level_for_error(const ProgressiveMesh& mesh, double error) {
    const auto it = std::partition_point(mesh.splits.begin(), mesh.splits.end(), [&](const Split& split) {
        return static_cast<double>(split.error) > error;
    });
    return static_cast<std::size_t>(it - mesh.splits.begin());
}

const char* progressive_mesh_fault(const ProgressiveMesh& mesh) {
    const std::size_t vertex_count = mesh.positions.size(), triangle_count = mesh.triangles.size();
    if (vertex_count >= kNoVertex || triangle_count >= kNoVertex / 3)
        return "there are too many vertices or triangles";
    if (mesh.base_vertices > vertex_count || mesh.base_triangles > triangle_count)
        return "the base mesh is larger than the full mesh";
    if (!mesh.weights.empty() && mesh.weights.size() != vertex_count)
        return "there are not as many weights as vertices";
    if (mesh.parents.size() != vertex_count) return "there are not as many parents as vertices";
    for (const Float3& p : mesh.positions)
        if (!finite(p)) return "a position is not finite";
    for (const float w : mesh.weights)
        if (!(w >= 0)) return "a weight is negative or not a number";
    for (std::uint32_t v = 0; v < mesh.base_vertices; ++v)
        if (mesh.parents[v] != kNoVertex) return "a vertex of the base mesh has a parent";
    const Split base{mesh.base_vertices, mesh.base_triangles, 0, 0, 0};
    const Split& last = mesh.splits.empty() ? base : mesh.splits.back();
    if (last.vertices_end != vertex_count || last.triangles_end != triangle_count ||
        last.corners_end != mesh.corner_changes.size() || last.moves_end != mesh.moves.size())
        return "the last split does not end where the arrays end";

    if (!mesh.groups.empty() && mesh.groups.size() != triangle_count)
        return "there are not as many groups as triangles";
    for (const double x : mesh.origin)
        if (!std::isfinite(x)) return "the origin is not finite";
    if (const char* fault = attributes_fault(mesh.attributes, vertex_count)) return fault;
    if (mesh.moved_values.size() != mesh.attributes.size())
        return "moves do not have the attributes of the vertices";
    for (std::size_t i = 0; i < mesh.attributes.size(); ++i) {
        if (mesh.moved_values[i].size() != mesh.attributes[i].components * mesh.moves.size())
            return "moves do not have the attributes of the vertices";
        for (const float value : mesh.moved_values[i])
            if (!std::isfinite(value)) return "an attribute is not finite";
    }

    std::vector<Triangle> corners(mesh.triangles);
    for (std::uint32_t t = 0; t < mesh.base_triangles; ++t) {
        for (const std::uint32_t v : corners[t])
            if (v >= mesh.base_vertices)
                return "a triangle of the base mesh names a vertex that does not exist";
        if (names_twice(corners[t])) return "a triangle of the base mesh names a vertex twice";
    }
    Split before = base;
    float error_before = std::numeric_limits<float>::infinity();
    for (const Split& split : mesh.splits) {
        if (split.vertices_end < before.vertices_end || split.triangles_end < before.triangles_end ||
            split.corners_end < before.corners_end || split.moves_end < before.moves_end)
            return "a split ends before it begins";
        if (split.vertices_end > vertex_count || split.triangles_end > triangle_count ||
            split.corners_end > mesh.corner_changes.size() || split.moves_end > mesh.moves.size())
            return "a split ends behind the arrays";
        if (!(split.error >= 0) || !(split.error <= error_before) || std::isinf(split.error))
            return "an error is negative, not finite, or grows";
        for (std::uint32_t v = before.vertices_end; v < split.vertices_end; ++v)
            if (mesh.parents[v] != kNoVertex && mesh.parents[v] >= before.vertices_end)
                return "a vertex is not younger than its parent";
        for (std::uint32_t i = before.corners_end; i < split.corners_end; ++i) {
            const CornerChange& change = mesh.corner_changes[i];
            if (change.corner / 3 >= before.triangles_end)
                return "a corner change names a triangle that does not exist";
            if (change.vertex < before.vertices_end || change.vertex >= split.vertices_end)
                return "a corner change names a vertex that its split did not make";
            std::uint32_t& corner = corners[change.corner / 3][change.corner % 3];
            if (mesh.parents[change.vertex] != corner)
                return "a corner does not hold the parent of its new vertex";
            corner = change.vertex;
        }
        for (std::uint32_t i = before.corners_end; i < split.corners_end; ++i)
            if (names_twice(corners[mesh.corner_changes[i].corner / 3]))
                return "a triangle names a vertex twice after a split";
        for (std::uint32_t t = before.triangles_end; t < split.triangles_end; ++t) {
            for (const std::uint32_t v : corners[t])
                if (v >= split.vertices_end) return "a new triangle names a vertex that does not exist";
            if (names_twice(corners[t])) return "a new triangle names a vertex twice";
        }
        for (std::uint32_t i = before.moves_end; i < split.moves_end; ++i) {
            if (mesh.moves[i].vertex >= before.vertices_end)
                return "a move names a vertex that does not exist";
            if (!finite(mesh.moves[i].position)) return "a position is not finite";
            if (!(mesh.moves[i].weight >= 0)) return "a weight is negative or not a number";
        }
        before = split;
        error_before = split.error;
    }
    return nullptr;
}

std::vector<float> inherit_weights(const ProgressiveMesh& mesh, std::size_t level,
                                   const std::vector<float>& weights) {
    std::vector<float> all(weights);
    all.resize(mesh.positions.size(), 1.0f);
    for (std::size_t v = vertices_at(mesh, level); v < all.size(); ++v)
        if (mesh.parents[v] != kNoVertex) all[v] = all[mesh.parents[v]];
    return all;
}

}  // namespace vsplit
