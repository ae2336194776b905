// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Whole files in and out. The only place of the baker that opens a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "vsplit/result.hpp"

namespace vsplit::bake {

/// The whole file. Errors: kIo with the system's reason, kLimit if it is longer than `max_bytes`.
Result<std::vector<std::byte>> read_file(const std::string& path,
                                         std::uint64_t max_bytes = std::uint64_t{1} << 36);

/// Writes `bytes` to `path` so that a reader sees the old file or the whole new one: a temporary file in the
/// same folder, synced, then renamed. Errors: kExists if the file is there and `overwrite` is false (nothing
/// is touched), kIo. Devices and pipes (/dev/stdout) are written straight.
Status write_file(const std::string& path, std::span<const std::byte> bytes, bool overwrite);

}  // namespace vsplit::bake
