// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The samples' exact surfaces and how they are meshed and sampled. Private to this room.
#pragma once

#include <cstddef>
#include <vector>

#include "dual.hpp"
#include "vsplit/mesh.hpp"

namespace vsplit::bake {

struct Double3 {
    double x = 0, y = 0, z = 0;
};

/// The whale: negative inside, its slope nowhere above kWhaleSlope. About 4.3 long (x, nose at the positive
/// end), y up, z to its left.
double whale_field(const Double3& p);
Dual whale_field_with_gradient(const Double3& p);
inline constexpr double kWhaleSlope = 2.5;
inline constexpr Double3 kWhaleLow{-2.9, -1.2, -1.9}, kWhaleHigh{2.4, 1.2, 1.9};

/// Newton steps along the gradient onto the whale. From farther than `reach` it gives up and returns `p`.
Double3 project_on_whale(const Double3& p, double reach);

/// The ocean over [0, 1] x [0, 1]: kOceanWidth x kOceanDepth, y up. Waves move points sideways, too, so its
/// edge is not quite straight.
Double3 ocean_point(double u, double v);
inline constexpr double kOceanWidth = 14, kOceanDepth = 10;

/// One closed manifold of genus 0 around the whale's inside, with about `triangles` of them.
Mesh mesh_whale(std::size_t triangles);
/// A grid over the ocean, row by row; vertex i is at column i % (columns + 1), row i / (columns + 1).
struct OceanGrid {
    std::size_t columns, rows;  ///< Cells.
};
OceanGrid ocean_grid(std::size_t triangles);
Mesh mesh_ocean(const OceanGrid& grid);

/// Exactly `count` of the points, no two of them close (Yuksel, Sample Elimination for Generating Poisson
/// Disk Sample Sets, 2015), in their order. `area` is that of the surface they cover evenly. Takes all if
/// there are fewer.
std::vector<Double3> eliminate_samples(const std::vector<Double3>& points, std::size_t count, double area);

}  // namespace vsplit::bake
