// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What a PLY file says about itself (G. Turk, The PLY Polygon File Format, 1994). Private to this room.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vsplit/result.hpp"

namespace vsplit::bake {

enum class PlyType : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

constexpr std::uint64_t size_of(PlyType type) {
    switch (type) {
        case PlyType::kInt8:
        case PlyType::kUint8:
            return 1;
        case PlyType::kInt16:
        case PlyType::kUint16:
            return 2;
        case PlyType::kInt32:
        case PlyType::kUint32:
        case PlyType::kFloat:
            return 4;
        case PlyType::kDouble:
            return 8;
    }
    return 1;
}

enum class PlyEncoding : std::uint8_t { kText, kLittleEndian, kBigEndian };

struct PlyProperty {
    std::string name;
    PlyType type{};
    bool is_list = false;
    PlyType count_type{};  ///< An integer type; lists only.
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;

    /// Index of a property, or properties.size().
    std::size_t find(std::string_view property) const;
    /// Bytes of a binary row with all its lists empty.
    std::uint64_t least_bytes() const;
    bool has_list() const;
};

struct PlyHeader {
    PlyEncoding encoding{};
    std::vector<PlyElement> elements;
    std::size_t body = 0;         ///< Offset of the first byte after the header.
    std::uint64_t body_line = 0;  ///< Its line, from 1.

    const PlyElement* find(std::string_view element) const;
};

/// The header, with every element's count held against the bytes that follow: believing them cannot exhaust
/// the memory.
Result<PlyHeader> parse_ply_header(std::span<const std::byte> bytes);

}  // namespace vsplit::bake
