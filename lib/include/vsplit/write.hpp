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

struct WriteOptions {
    std::uint32_t block_bytes = 48 * 1024;  ///< Stored size that blocks aim at, 1 KiB to 16 MiB.
    int zstd_level = 9;                     ///< 1 (fast) to 19 (small).
};

/// The file's bytes: lossless, the same for the same mesh and options. Errors: kArgument for an unsound mesh
/// or options out of range.
Result<std::vector<std::byte>> write_progressive_mesh(const ProgressiveMesh& mesh,
                                                      const WriteOptions& options = {});

}  // namespace vsplit
