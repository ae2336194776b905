// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// A surface while it is being made: triangles in double precision, and their adjacency.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "points/vec3.hpp"
#include "vsplit/mesh.hpp"

namespace vsplit::bake {

inline constexpr std::uint32_t kNoEdge = 0xFFFFFFFFu;

struct Crust {
    std::vector<Vec3> points;
    std::vector<Triangle> triangles;  ///< Counter-clockwise seen from outside.
};

/// Half-edge 3t+k runs from corner k of triangle t to corner k+1.
inline std::uint32_t next_edge(std::uint32_t h) {
    return h % 3 == 2 ? h - 2 : h + 1;
}
inline std::uint32_t previous_edge(std::uint32_t h) {
    return h % 3 == 0 ? h + 2 : h - 1;
}
inline std::uint32_t edge_from(const Crust& crust, std::uint32_t h) {
    return crust.triangles[h / 3][h % 3];
}
inline std::uint32_t edge_to(const Crust& crust, std::uint32_t h) {
    return crust.triangles[h / 3][(h + 1) % 3];
}

/// For each half-edge the one that runs the other way, or kNoEdge at a boundary.
/// The crust must be an oriented manifold (boundary allowed); a half-edge met twice has no opposite.
std::vector<std::uint32_t> pair_edges(const Crust& crust);

/// One half-edge that leaves each vertex (at a boundary the one without an opposite, so that turning by
/// opposite(previous(h)) meets the whole fan), or kNoEdge.
std::vector<std::uint32_t> leaving_edges(const Crust& crust, std::span<const std::uint32_t> opposite);

/// Twice the area times the unit normal.
inline Vec3 area_normal(const Crust& crust, const Triangle& t) {
    return cross(crust.points[t[1]] - crust.points[t[0]], crust.points[t[2]] - crust.points[t[0]]);
}

/// What becomes of one triangle that is divided; never more than six.
struct Pieces {
    std::array<Triangle, 6> triangles;
    std::size_t count = 0;
    void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) { triangles[count++] = {a, b, c}; }
};

/// Divides a triangle whose edge k may have a point middle[k] (kNoEdge if not); `centre` is used only if all
/// three have one.
Pieces divide(const std::vector<Vec3>& points, const Triangle& corner,
              const std::array<std::uint32_t, 3>& middle, std::uint32_t centre);

/// Removes points that no triangle names; order is kept.
void drop_unused(Crust& crust);

}  // namespace vsplit::bake
