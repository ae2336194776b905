// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The splits as patch lists. Nearly all of them give birth to one vertex and at most three triangles, change
// at most 15 corners and move nothing or the parent: their counts are one byte, the vertex born is the next
// one, and what a changed corner held before is that vertex's parent. The others are `specials`.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "vsplit/live_buffers.hpp"

namespace vsplit {

inline constexpr unsigned kCornerBits = 0x0f, kTriangleShift = 4, kTriangleBits = 3, kMoveBit = 0x40,
                          kSpecialBit = 0x80;

inline constexpr std::size_t kInterval = 128;  // splits between checkpoints

/// Points of the grid are within this, and rounded without a branch.
inline constexpr double kGridReach = 1 << 24;

inline std::int32_t grid_point(double origin, double inverse, float value) {
    return std::int32_t((double(value) - origin) * inverse + (kGridReach + 0.5)) - std::int32_t(kGridReach);
}
inline std::array<std::int32_t, 3> grid_point(const PlaceGrid& grid, const Float3& place) {
    const double inverse = 1 / grid.step;
    return {grid_point(grid.origin[0], inverse, place.x), grid_point(grid.origin[1], inverse, place.y),
            grid_point(grid.origin[2], inverse, place.z)};
}
inline Float3 grid_place(const PlaceGrid& grid, const std::array<std::int32_t, 3>& at) {
    return {float(grid.origin[0] + grid.step * at[0]), float(grid.origin[1] + grid.step * at[1]),
            float(grid.origin[2] + grid.step * at[2])};
}

/// Reads a byte beyond a corner of three.
template <unsigned kBytes>
std::uint32_t load(const std::uint8_t* p) {
    std::uint32_t four = 0;
    std::memcpy(&four, p, sizeof four);
    if constexpr (std::endian::native == std::endian::big)
        four = four << 24 | (four & 0xff00) << 8 | (four >> 8 & 0xff00) | four >> 24;
    return kBytes == 3 ? four & 0xffffff : four;
}

}  // namespace vsplit
