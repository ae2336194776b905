// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// The working frame: centred, and scaled by a power of two to a size near 1, where neither squares overflow
// nor differences of large coordinates cancel.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "points/vec3.hpp"

namespace vsplit::bake {

struct Frame {
    Vec3 origin;
    double scale = 1;

    /// `positions` are finite.
    explicit Frame(std::span<const std::array<double, 3>> positions);
    /// Every coordinate then lies within [-2, 2].
    std::vector<Vec3> into(std::span<const std::array<double, 3>> positions) const;
    Vec3 out_of(Vec3 p) const { return p * (1 / scale) + origin; }
};

/// Different points in spatial order, and where each given one went.
struct UniquePoints {
    std::vector<Vec3> points;
    std::vector<std::uint32_t> place;  ///< given[i] == points[place[i]]
    std::vector<std::uint32_t> first;  ///< The lowest index among those given that points[j] stands for.
};

UniquePoints unique_points(std::span<const Vec3> given);

}  // namespace vsplit::bake
