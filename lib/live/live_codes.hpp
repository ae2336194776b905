// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The splits as patch lists. Nearly all of them give birth to one vertex and at most three triangles, change
// at most 15 corners and move nothing or the parent: their counts are one byte, the vertex born is the next
// one, and what a changed corner held before is that vertex's parent. The others are `specials`.
#pragma once

#include <cstdint>

namespace vsplit {

inline constexpr unsigned kCornerBits = 0x0f, kTriangleShift = 4, kTriangleBits = 3, kMoveBit = 0x40,
                          kSpecialBit = 0x80;

/// Reads a byte beyond a corner of three. Compilers make one load of it.
template <unsigned kBytes>
inline std::uint32_t load(const std::uint8_t* p) {
    const std::uint32_t four = std::uint32_t{p[0]} | std::uint32_t{p[1]} << 8 | std::uint32_t{p[2]} << 16 |
                               std::uint32_t{p[3]} << 24;
    return kBytes == 3 ? four & 0xffffff : four;
}

}  // namespace vsplit
