// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The Range header of a request for bytes (RFC 9110, section 14).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace vsplit::app {

/// Bytes first to last, both included, of a file that is longer than `last`.
struct ByteRange {
    std::uint64_t first = 0, last = 0;
    std::uint64_t bytes() const { return last - first + 1; }
};

/// What the header asks for of a file of `size` bytes, in the order asked. Nothing if it is to be ignored and
/// the whole file sent: another unit, bad syntax, more ranges than are worth answering one by one, or ranges
/// that overlap. An empty list if no byte of the file is asked for (416).
std::optional<std::vector<ByteRange>> parse_ranges(std::string_view header, std::uint64_t size);

}  // namespace vsplit::app
