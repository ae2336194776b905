// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Polygons into triangles. Private to this room.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vsplit/mesh.hpp"

namespace vsplit::bake {

/// Cuts a polygon of n >= 3 corners, all finite, into exactly n - 2 triangles with its orientation: by ears
/// on the plane of its Newell normal, convex or not. What has no ear (crossing sides, zero area) is closed as
/// a fan. Deterministic; the work is at most a constant times n, so that a hostile face of millions of
/// corners cannot stall the reader.
class Triangulator {
  public:
    void add(std::span<const std::uint32_t> corners, std::span<const Float3> positions,
             std::vector<Triangle>& out);

  private:
    struct Point {
        double x, y;
    };
    void flatten(std::span<const std::uint32_t> corners, std::span<const Float3> positions);
    bool is_ear(std::uint32_t a, std::uint32_t b, std::uint32_t c);
    double turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;

    // Kept between calls so that a mesh of polygons does not allocate for each.
    std::vector<Point> points_;
    std::vector<std::uint32_t> next_, previous_, reflex_;
    std::uint64_t budget_ = 0;
};

}  // namespace vsplit::bake
