// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// How far an edge's collapse takes the surface from the input.
#pragma once

#include <vector>

#include "edge_star.hpp"

namespace vsplit::bake {

struct Deviation {
    double largest = 0;  ///< Working units.
    float at_place = 0;  ///< Of the new vertex.
    Float3 witness;      ///< The farther away of the ends' witnesses.
};

/// The exact distances of the two ends and of their witnesses to the new triangles, and of the new vertex to
/// the old ones, which comes on top of what the ends had.
Deviation deviation_of(const EdgeStar& star, Double3 place, const std::vector<VertexHistory>& histories);

}  // namespace vsplit::bake
