// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Many points, few triangles: which is nearest to each.
#pragma once

#include <cstdint>
#include <vector>

#include "vec.hpp"
#include "vsplit/mesh.hpp"

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

    /// In each of four lanes, one of every four triangles. The alignment is what wide registers expect.
    struct Nearest {
        alignas(32) Lanes distance2;
        alignas(32) Lanes index;
    };

  private:
    std::vector<Nearest> found_;
};

/// Points, each with the squared distance to the nearest of some triangles.
struct FarPoints {
    std::vector<Double3> points;
    std::vector<double> distance2;

    /// Drops the points within `enough2` (squared) of one of the triangles; sets the distances of the others,
    /// which keep their order.
    void drop_near(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, double enough2);
};

}  // namespace vsplit::bake
