// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Where things are in a .pmesh file of version 1 (formats/spec/pmesh-1.md), and the little-endian numbers in
// it.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "vsplit/mesh.hpp"

namespace vsplit {

inline constexpr std::array<unsigned char, 8> kMagic = {0x8F, 'p', 'm', 'e', 's', 'h', '\r', '\n'};
inline constexpr std::uint32_t kVersion = 1;
inline constexpr std::uint32_t kFlagWeights = 1, kFlagLossless = 2;
inline constexpr std::size_t kHeaderBytes = 124;
// In the header.
inline constexpr std::size_t kVersionAt = 8, kFlagsAt = 12, kBaseVerticesAt = 16, kBaseTrianglesAt = 20,
                             kBoundsAt = 24, kDetailsBytesAt = 48, kBaseBytesAt = 52, kDracoBytesAt = 56,
                             kTableBytesAt = 60, kBaseErrorAt = 64, kLargestGroupAt = 68,
                             kPositionBitsAt = 72, kLatticeAt = 76, kDetailsChecksumAt = 108,
                             kBaseChecksumAt = 112, kTableChecksumAt = 116, kHeaderChecksumAt = 120;
/// A block holds at most so many births, triangles, corner changes, moves and splits a byte of it.
inline constexpr std::uint64_t kPartsPerByte = 256;
inline constexpr std::uint32_t kMostPositionBits = 20;

static_assert(std::endian::native == std::endian::little, "numbers are copied as they are");

/// Of the full mesh; zeros for none.
struct Bounds {
    Float3 low, high;
};
inline Bounds bounds_of(std::span<const Float3> positions) {
    Bounds box;
    if (!positions.empty()) box = {positions[0], positions[0]};
    for (const Float3& p : positions) {
        box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
        box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
    }
    return box;
}

/// Appends numbers, little-endian.
class ByteWriter {
  public:
    template <class T>
    void put(T value) {
        const auto at = bytes_.size();
        bytes_.resize(at + sizeof(T));
        std::memcpy(bytes_.data() + at, &value, sizeof(T));
    }
    std::vector<std::byte>& bytes() { return bytes_; }

  private:
    std::vector<std::byte> bytes_;
};

/// Reads numbers at known places; the caller has checked that they are there.
template <class T>
T get(std::span<const std::byte> bytes, std::size_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof(T));
    return value;
}

/// Is there nothing but padding?
inline bool only_zeros(std::span<const std::byte> bytes) {
    return std::all_of(bytes.begin(), bytes.end(), [](std::byte b) { return b == std::byte{0}; });
}

}  // namespace vsplit
