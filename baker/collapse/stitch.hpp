// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Borders that meet, but not bit by bit: sheets of a CAD model that were triangulated one by one differ there
// by rounding. They collapse as if stitched together, lest gaps open, and come apart in the last splits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vsplit/mesh.hpp"
#include "vsplit/progressive_mesh.hpp"
#include "wedges.hpp"

namespace vsplit::bake {

/// A vertex of the input that has become another, at that one's place.
struct Stitch {
    std::uint32_t vertex, other;
};

/// False if stitch_borders() surely finds nothing; much faster.
bool may_have_boundary(const Mesh& mesh);

/// Makes one point of the ends of boundary edges that lie on each other: both ends at most `share` times the
/// diagonal of their part apart, and little against the boundary edges there. Never of the corners of one
/// triangle, nor of points with different weights. A point that becomes another is left without triangles.
/// `points` is that of a mesh whose vertices are the corners; returns those that are now somewhere else,
/// ascending.
std::vector<Stitch> stitch_borders(PointMesh& points, double share);

/// Appends splits that put the stitched vertices where `input` has them, farthest first, and adds their
/// distance to the errors before. `births`: of each vertex of the input, its number in `mesh`. `are_wedges`:
/// they are there already, beside the others; else each is born of the other and takes its corners back.
void unstitch(ProgressiveMesh& mesh, const Mesh& input, std::span<const Stitch> stitched,
              std::span<const std::uint32_t> births, bool are_wedges);

}  // namespace vsplit::bake
