// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The table of blocks: their checksums, then a stream of what else there is, each entry against the one
// before it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vsplit/read.hpp"

namespace vsplit {

/// Reads a number of 7 bits a byte, the lowest first, from `at` on; false, and `at` stays, if the bytes end
/// within it, or if it has more than 64 bits or a byte that it does not need.
bool take_number(std::span<const std::byte> bytes, std::size_t& at, std::uint64_t& value);

/// Of blocks that follow each other; any counts and errors, though a decoder refuses some.
std::vector<std::byte> encode_table(const FileInfo& front, std::span<const BlockInfo> blocks);

/// Where the checksums begin, and how many there are; false if the bytes do not hold them.
bool table_checksums(std::span<const std::byte> table, std::size_t& at, std::uint64_t& count);

/// Fills `info.blocks` from the table's bytes, and the counts and the length of the file with what they come
/// to. The front is known up to `data_offset`. The reason if the table contradicts itself; `at` is then where
/// in it.
const char* decode_table(std::span<const std::byte> table, FileInfo& info, std::size_t& at);

}  // namespace vsplit
