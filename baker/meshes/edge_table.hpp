// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Every undirected edge of a triangle list with the triangles that run along it. Private to this room.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "vsplit/mesh.hpp"

namespace vsplit::bake {

/// One triangle's side, filed under the smaller of its two vertices.
struct EdgeUse {
    std::uint32_t far;        ///< The larger vertex.
    std::uint32_t half_edge;  ///< 3 * triangle + corner that the side leaves from.
    friend auto operator<=>(const EdgeUse&, const EdgeUse&) = default;
};

/// Half edges are counted in 32 bits.
inline constexpr std::uint64_t kMaxTriangles = 0xFFFFFFFFu / 3;

/// Calls `visit(near, far, uses)` once per undirected edge, near < far, ascending; uses in the order of
/// triangles. Buckets by vertex instead of one global sort: linear but for vertices of huge valence. Sides
/// between equal vertices are left out.
template <class Visit>
void for_each_edge(std::size_t vertices, std::span<const Triangle> triangles, Visit&& visit) {
    std::vector<std::uint32_t> starts(vertices + 2, 0);
    const auto each_side = [&](auto&& side) {
        for (std::size_t t = 0; t < triangles.size(); ++t)
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t a = triangles[t][k], b = triangles[t][k == 2 ? 0 : k + 1];
                if (a != b) side(std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(3 * t + k));
            }
    };
    each_side([&](std::uint32_t near, std::uint32_t, std::uint32_t) { ++starts[near + 2]; });
    for (std::size_t v = 2; v < starts.size(); ++v) starts[v] += starts[v - 1];
    std::vector<EdgeUse> uses(starts.back());
    each_side([&](std::uint32_t near, std::uint32_t far, std::uint32_t half) {
        uses[starts[near + 1]++] = {far, half};
    });
    for (std::uint32_t v = 0; v < vertices; ++v) {
        const std::span<EdgeUse> bucket(uses.data() + starts[v], uses.data() + starts[v + 1]);
        std::sort(bucket.begin(), bucket.end());
        for (std::size_t i = 0, j = 0; i < bucket.size(); i = j) {
            while (j < bucket.size() && bucket[j].far == bucket[i].far) ++j;
            visit(v, bucket[i].far, std::span<const EdgeUse>(bucket.subspan(i, j - i)));
        }
    }
}

}  // namespace vsplit::bake
