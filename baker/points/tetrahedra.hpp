// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// A Delaunay tetrahedralisation as flat arrays, in an order that depends on the points alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "points/vec3.hpp"

namespace vsplit::bake {

using Corners = std::array<std::uint32_t, 4>;
inline constexpr std::uint32_t kNoCell = 0xFFFFFFFFu;

/// Cells are sorted by their vertices, each cell's vertices (a, b, c, d) so that a < b < c, d and
/// (b-a)x(c-a).(d-a) > 0. CGAL breaks ties between cospherical points by their coordinates (Devillers and
/// Teillaud, "Perturbations for Delaunay and weighted Delaunay 3D triangulations", 2011), so the cells are
/// the same whatever the threads did.
struct Tetrahedra {
    std::vector<Vec3> points;         ///< As given: samples, then the box corners if any.
    std::size_t samples = 0;          ///< points[samples..] are corners of the box around them.
    std::vector<Corners> cells;       ///< Finite cells.
    std::vector<Corners> neighbours;  ///< Cell opposite to corner i, or kNoCell across the convex hull.
};

/// The three corners of facet `i` (opposite to corner i), counter-clockwise seen from outside the cell.
inline constexpr int kFacetCorner[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

/// Delaunay tetrahedralisation of `points`, all different and best in spatial order. `threads` 1 or less:
/// sequential. No cells if they are coplanar.
Tetrahedra tetrahedralise(std::vector<Vec3> points, std::size_t samples, int threads);

}  // namespace vsplit::bake
