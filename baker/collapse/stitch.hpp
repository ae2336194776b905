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

/// Makes one point of the ends of boundary edges that lie on each other: both ends at most
/// `share` times the diagonal of their part apart, and little against the boundary edges there. Never of the
/// corners of one triangle. `points` is that of `mesh`; a point that becomes another is left without
/// triangles. Returns the vertices of `mesh` that are now somewhere else, with their new places; ascending.
std::vector<VertexMove> stitch_borders(PointMesh& points, const Mesh& mesh, double share);

/// Appends splits that put the vertices of `stitched` where `input` has them, farthest first, and adds their
/// distance to the errors before. `births`: of each vertex of the input, its number in `mesh`.
void unstitch(ProgressiveMesh& mesh, const Mesh& input, std::span<const VertexMove> stitched,
              std::span<const std::uint32_t> births);

}  // namespace vsplit::bake
