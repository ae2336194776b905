// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// CGAL's point-set processing, behind plain vectors.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "points/vec3.hpp"

namespace vsplit::bake {

/// Each point onto a quadric fitted to its neighbours.
void smooth_jet(std::vector<Vec3>& points, int neighbours);

/// Normals are estimated if `normals` is empty (their sign does not matter).
void smooth_bilateral(std::vector<Vec3>& points, std::vector<Vec3> normals, int neighbours);

/// The indices, ascending, of one point for each cell of a grid: the one nearest to the mean of the cell's
/// points. Own code: CGAL's picks the first it meets, which follows the order of the file. `points` lie
/// within [-4, 4].
std::vector<std::uint32_t> thin_grid(std::span<const Vec3> points, double cell);

/// New points.
std::vector<Vec3> thin_wlop(std::span<const Vec3> points, double share, double spacing);

}  // namespace vsplit::bake
