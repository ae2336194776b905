// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The columns that a block of splits is stored in: variable-length integers and floats as differences of
// ordered integers.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace vsplit {

/// The columns of a block, in the order in which they are stored.
enum class Column : std::uint8_t {
    kNewVertices,
    kNewTriangles,
    kCornerCount,
    kMoveCount,
    kErrors,
    kParents,
    kBirthX,
    kBirthY,
    kBirthZ,
    kMovedVertices,
    kMoveX,
    kMoveY,
    kMoveZ,
    kCorners,
    kCornerVertices,
    kTriangles,
    kWeights,
};
inline constexpr std::size_t kColumnCount = 17;

/// Differences of neighbours in the order of the reals are small numbers: a float as an integer of the same
/// order.
inline std::uint32_t ordered_bits(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    return (bits & 0x80000000u) ? ~bits : bits | 0x80000000u;
}
inline float from_ordered_bits(std::uint32_t bits) {
    return std::bit_cast<float>((bits & 0x80000000u) ? bits & 0x7FFFFFFFu : ~bits);
}

inline std::uint32_t zigzag(std::uint32_t difference) {
    return (difference << 1) ^ (0u - (difference >> 31));
}
inline std::uint32_t unzigzag(std::uint32_t code) {
    return (code >> 1) ^ (0u - (code & 1));
}

/// Unsigned LEB128, at most five bytes.
inline void put_varint(std::vector<std::byte>& out, std::uint32_t value) {
    for (; value >= 0x80; value >>= 7) out.push_back(static_cast<std::byte>(value | 0x80));
    out.push_back(static_cast<std::byte>(value));
}

/// Reads a column; after the last byte `ok` turns false and zeros follow.
struct ColumnReader {
    std::span<const std::byte> bytes;
    bool ok = true;

    std::uint32_t varint() {
        std::uint32_t value = 0;
        for (int shift = 0; shift < 35; shift += 7) {
            if (bytes.empty()) break;
            const auto byte = static_cast<std::uint32_t>(bytes.front());
            bytes = bytes.subspan(1);
            if (shift == 28 && byte > 0x0F) break;
            value |= (byte & 0x7F) << shift;
            if (byte < 0x80) return value;
        }
        ok = false;
        return 0;
    }
};

}  // namespace vsplit
