// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "reorder.hpp"

#include <algorithm>
#include <numeric>

namespace vsplit::bake {
namespace {

/// values[i], `width` of them, to where they come in `order`.
template <class Value>
void permute(std::vector<Value>& values, const std::vector<std::uint32_t>& order, std::size_t width = 1) {
    if (values.empty()) return;
    std::vector<Value> moved(values.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        std::copy_n(values.begin() + std::ptrdiff_t(order[i] * width), width,
                    moved.begin() + std::ptrdiff_t(i * width));
    values.swap(moved);
}

/// The order of what splits bring, of each split from its begin to its end; what the base has comes first.
template <class Member>
std::vector<std::uint32_t> order_of(const ProgressiveMesh& mesh, const std::vector<std::uint32_t>& splits,
                                    std::uint32_t base, std::size_t total, Member end) {
    std::vector<std::uint32_t> order(base);
    order.reserve(total);
    std::iota(order.begin(), order.end(), 0u);
    for (const std::uint32_t s : splits)
        for (std::uint32_t i = s == 0 ? base : mesh.splits[s - 1].*end; i < mesh.splits[s].*end; ++i)
            order.push_back(i);
    return order;
}

std::vector<std::uint32_t> inverse(const std::vector<std::uint32_t>& order) {
    std::vector<std::uint32_t> place(order.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
    return place;
}

}  // namespace

void reorder_splits(ProgressiveMesh& mesh, const std::vector<std::uint32_t>& splits) {
    std::vector<std::uint32_t> place;
    {
        const auto vertices =
            order_of(mesh, splits, mesh.base_vertices, mesh.positions.size(), &Split::vertices_end);
        permute(mesh.positions, vertices);
        permute(mesh.weights, vertices);
        permute(mesh.parents, vertices);
        for (Attribute& attribute : mesh.attributes)
            permute(attribute.values, vertices, attribute.components);
        place = inverse(vertices);
    }
    for (std::uint32_t& parent : mesh.parents)
        if (parent != kNoVertex) parent = place[parent];
    {
        const auto moves = order_of(mesh, splits, 0, mesh.moves.size(), &Split::moves_end);
        permute(mesh.moves, moves);
        for (std::size_t a = 0; a < mesh.moved_values.size(); ++a)
            permute(mesh.moved_values[a], moves, mesh.attributes[a].components);
    }
    for (VertexMove& move : mesh.moves) move.vertex = place[move.vertex];
    permute(mesh.corner_changes, order_of(mesh, splits, 0, mesh.corner_changes.size(), &Split::corners_end));
    for (CornerChange& change : mesh.corner_changes) change.vertex = place[change.vertex];
    {
        const auto triangles =
            order_of(mesh, splits, mesh.base_triangles, mesh.triangles.size(), &Split::triangles_end);
        permute(mesh.triangles, triangles);
        permute(mesh.groups, triangles);
        for (Triangle& triangle : mesh.triangles)
            for (std::uint32_t& v : triangle) v = place[v];
        place = inverse(triangles);
    }
    for (CornerChange& change : mesh.corner_changes)
        change.corner = 3 * place[change.corner / 3] + change.corner % 3;

    // What each split brings, then the sums.
    Split before{mesh.base_vertices, mesh.base_triangles, 0, 0, 0};
    for (Split& split : mesh.splits) {
        const Split end = split;
        split = {end.vertices_end - before.vertices_end, end.triangles_end - before.triangles_end,
                 end.corners_end - before.corners_end, end.moves_end - before.moves_end, end.error};
        before = end;
    }
    permute(mesh.splits, splits);
    Split sum{mesh.base_vertices, mesh.base_triangles, 0, 0, 0};
    for (Split& split : mesh.splits) {
        std::sort(mesh.corner_changes.begin() + sum.corners_end,
                  mesh.corner_changes.begin() + sum.corners_end + split.corners_end,
                  [](const CornerChange& a, const CornerChange& b) { return a.corner < b.corner; });
        sum = {sum.vertices_end + split.vertices_end, sum.triangles_end + split.triangles_end,
               sum.corners_end + split.corners_end, sum.moves_end + split.moves_end, split.error};
        split = sum;
    }
}

}  // namespace vsplit::bake
