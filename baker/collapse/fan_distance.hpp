// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Many points, few triangles: which is nearest to each.
#pragma once

#include <cstdint>
#include <vector>

#include "vec.hpp"

namespace vsplit::bake {

/// Triangles as three places each, and points; then, for each point, the nearest triangle.
struct FanDistance {
    std::vector<Double3> corners;  ///< Three a triangle; at least one triangle.
    std::vector<Double3> points;
    std::vector<double> distance2;       ///< Set by find().
    std::vector<std::uint32_t> nearest;  ///< Set by find().

    void clear() {
        corners.clear();
        points.clear();
    }
    void find();
};

}  // namespace vsplit::bake
