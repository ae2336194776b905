// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace vsplit {

/// XXH64 with seed 0 (Collet, xxHash specification 0.1.1).
std::uint64_t checksum64(std::span<const std::byte> bytes);
/// Its low half: what files have.
inline std::uint32_t checksum32(std::span<const std::byte> bytes) {
    return static_cast<std::uint32_t>(checksum64(bytes));
}

}  // namespace vsplit
