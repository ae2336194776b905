// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// .pmesh bytes out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vsplit/progressive_mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit {

/// How places and triangles of the base mesh are written.
enum class BaseCoding {
    kLeast,  ///< In whatever takes fewer bytes: the file's own stream, as a rule.
    kDraco,  ///< As Draco's bytes, unless it cannot code them: no triangles, or hardly any for the vertices.
};

struct WriteOptions {
    std::uint32_t block_bytes = 48 * 1024;  ///< Stored size that blocks aim at, 1 KiB to 16 MiB.
    /// Places lie on a lattice of 2^position_bits points along the longest side of the bounding box, 2 to 20.
    /// 0 is lossless: every float of places and attributes comes back, and the other bits below do not count.
    std::uint32_t position_bits = 14;
    std::uint32_t normal_bits = 10;  ///< Of each of the two numbers of a normal or tangent, 2 to 16.
    std::uint32_t texcoord_bits =
        12;  ///< Of each texture coordinate, between the least and the greatest, 2 to 24.
    std::uint32_t color_bits = 8;  ///< Of each part of a colour between 0 and 1, 2 to 16.
    BaseCoding base_coding = BaseCoding::kLeast;
};

/// The file's bytes, the same for the same mesh and options. Painted weights, joints and attributes of no
/// known meaning are kept exactly. Errors: kArgument for an unsound mesh or options out of range;
/// kUnsupported from a library built without Draco.
Result<std::vector<std::byte>> write_progressive_mesh(const ProgressiveMesh& mesh,
                                                      const WriteOptions& options = {});

/// What reading the written file gives, byte for byte: places and attributes as they are rounded, and splits
/// in the order of the file. Splits that do not touch each other are free to change places, so vertices and
/// triangles have other numbers, and a split's error is that of the batch that it is in, which is never less
/// than its own, and within a block up to 2^-8 of it more.
Result<ProgressiveMesh> canonical_progressive_mesh(const ProgressiveMesh& mesh,
                                                   const WriteOptions& options = {});

}  // namespace vsplit
