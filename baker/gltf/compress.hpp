// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A primitive as a Draco stream.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pack.hpp"
#include "vsplit/result.hpp"

namespace vsplit::bake {

struct Grid;

struct DracoStream {
    std::vector<std::byte> bytes;
    std::vector<std::uint32_t> ids;         ///< Draco's, one per attribute.
    std::size_t vertices = 0, corners = 0;  ///< Once decoded.
    std::vector<double> min, max;           ///< Of POSITION, once decoded.
};

/// `names` and `values` are the same attributes, POSITION first. Positions are rounded to 14 bits within the
/// box, which primitives that touch share, so that they still do; normals to 10 bits, texture coordinates to
/// 12, float colours and tangents to 10; all else is exact. `keep_order`: the decoded vertices have this
/// order.
Result<DracoStream> encode_draco(std::span<const VertexValues* const> names,
                                 std::span<const PackedValues> values, std::span<const std::uint32_t> corners,
                                 const Grid& box, bool keep_order);

}  // namespace vsplit::bake
