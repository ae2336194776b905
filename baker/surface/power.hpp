// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// The power diagram of weighted points, as its dual, the regular triangulation.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "points/tetrahedra.hpp"

namespace vsplit::bake {

/// Ordered as Tetrahedra is. Points that are hidden, by others with larger balls around them, are in no cell.
struct PowerDiagram {
    std::vector<Corners> cells, neighbours;
};

PowerDiagram regular_triangulation(std::span<const Vec3> points, std::span<const double> weights);

}  // namespace vsplit::bake
