// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the readers of point files share.
#pragma once

#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "vsplit/bake/points.hpp"

namespace vsplit::bake {

Result<PointFile> parse_text_points(std::string_view text, const PointReadOptions& options);
Result<PointFile> parse_ply_points(std::span<const std::byte> bytes, const PointReadOptions& options);
Result<PointFile> parse_pcd_points(std::span<const std::byte> bytes, const PointReadOptions& options);

inline Error error_at_line(ErrorCode code, std::string message, std::uint64_t line) {
    return {code, std::move(message), Error::kNowhere, line};
}
inline Error error_at_offset(ErrorCode code, std::string message, std::uint64_t offset) {
    return {code, std::move(message), offset, 0};
}

/// A number as text; nothing if `word` is not one number and nothing else. Numbers too large for a double are
/// infinite.
std::optional<double> parse_number(std::string_view word);
/// A count: decimal digits only, below 2^63.
std::optional<std::uint64_t> parse_count(std::string_view word);

/// Walks over lines, told by \n, \r\n or \r; counts them from 1.
class Lines {
  public:
    explicit Lines(std::string_view text) : text_(text) {}
    bool next(std::string_view& line);
    std::uint64_t number() const { return number_; }
    std::size_t offset() const { return at_; }  ///< First byte after the line.

  private:
    std::string_view text_;
    std::size_t at_ = 0;
    std::uint64_t number_ = 0;
};

/// Cuts the next word off `rest`; empty at the end. `separators` besides blanks and tabs.
std::string_view next_word(std::string_view& rest, std::string_view separators = {});

/// Scalar types of PLY and PCD.
enum class Scalar : std::uint8_t { kI8, kU8, kI16, kU16, kI32, kU32, kI64, kU64, kF32, kF64 };
std::size_t scalar_size(Scalar type);
/// Reads one, as it lies there or with its bytes reversed.
double read_scalar(const std::byte* at, Scalar type, bool reversed = false);

/// Where a cloud's coordinates, normals and colours are found among a record's columns, -1 for nowhere.
struct Columns {
    std::array<int, 3> position{-1, -1, -1}, normal{-1, -1, -1}, colour{-1, -1, -1};
    bool has_normal() const { return normal[0] >= 0 && normal[1] >= 0 && normal[2] >= 0; }
    bool has_colour() const { return colour[0] >= 0 && colour[1] >= 0 && colour[2] >= 0; }
};

/// Adds one record, unless a coordinate is not finite (counted). `colour_scale` brings colours to 0..255.
void add_point(PointFile& file, std::span<const double> record, const Columns& columns, double colour_scale);

}  // namespace vsplit::bake
