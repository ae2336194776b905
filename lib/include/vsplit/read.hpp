// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// .pmesh bytes in. Every function here accepts hostile bytes: an Error with its offset, never a crash.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vsplit/progressive_mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit {

/// What a reader may spend. Checked against the file's own announcements before anything is allocated.
struct Limits {
    std::uint64_t max_bytes = std::uint64_t{1} << 30;  ///< Memory for all that is returned, 1 GiB.
};

/// One block of splits, as the table at the front of the file announces it.
struct BlockInfo {
    std::uint64_t offset = 0;      ///< In the file.
    std::uint32_t bytes = 0;       ///< As stored.
    std::uint32_t raw_bytes = 0;   ///< Decompressed.
    std::uint64_t checksum = 0;    ///< XXH64 of the stored bytes.
    std::uint32_t splits_end = 0;  ///< Counts at the end of the block, from the start of the file.
    std::uint32_t vertices_end = 0;
    std::uint32_t triangles_end = 0;
    std::uint32_t corners_end = 0;
    std::uint32_t moves_end = 0;
    float error = 0;  ///< Geometric error after the block, in the object's units.
};

/// What the front of the file says: everything but the mesh itself.
struct FileInfo {
    std::uint32_t version = 0;
    bool has_weights = false;
    std::uint64_t file_bytes = 0;
    std::uint64_t data_offset = 0;  ///< End of the table.
    Float3 bounds_min, bounds_max;  ///< Of the full mesh.
    std::uint64_t base_offset = 0;
    std::uint32_t base_bytes = 0;
    std::uint64_t base_checksum = 0;
    std::uint32_t base_vertices = 0, base_triangles = 0;
    float base_error = 0;  ///< Geometric error of the base mesh.
    std::uint32_t vertices = 0, triangles = 0, splits = 0, corner_changes = 0, moves = 0;
    std::vector<BlockInfo> blocks;
};

/// Reads header and table. `bytes` may be the whole file or a beginning of it that holds the table;
/// `file_bytes` is not compared with bytes.size(). Errors: kTruncated, kMalformed, kChecksum, kUnsupported (a
/// newer version), kLimit.
Result<FileInfo> read_info(std::span<const std::byte> bytes, const Limits& limits = {});

/// Reads a whole file. The result is sound: progressive_mesh_fault() is null.
Result<ProgressiveMesh> read_progressive_mesh(std::span<const std::byte> bytes, const Limits& limits = {});

}  // namespace vsplit
