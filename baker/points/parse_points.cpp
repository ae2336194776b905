// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <charconv>
#include <limits>

#include "points/parse.hpp"

namespace vsplit::bake {

std::optional<double> parse_number(std::string_view word) {
    if (!word.empty() && word[0] == '+') word.remove_prefix(1);
    double value = 0;
    const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end != word.data() + word.size() || word.empty()) return std::nullopt;
    if (status == std::errc::result_out_of_range) {
        // from_chars tells neither overflow from underflow nor the sign.
        const std::size_t mantissa_end = word.find_first_of("eE");
        const bool tiny = mantissa_end != std::string_view::npos && mantissa_end + 1 < word.size() &&
                          word[mantissa_end + 1] == '-';
        return tiny ? 0 : std::numeric_limits<double>::infinity();
    }
    if (status != std::errc()) return std::nullopt;
    return value;
}

std::optional<std::uint64_t> parse_count(std::string_view word) {
    std::int64_t value = 0;
    const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || status != std::errc() || end != word.data() + word.size() || value < 0)
        return std::nullopt;
    return static_cast<std::uint64_t>(value);
}

bool Lines::next(std::string_view& line) {
    if (at_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
    line = text_.substr(at_, end - at_);
    at_ = end + 1;
    if (end + 1 < text_.size() && text_[end] == '\r' && text_[end + 1] == '\n') ++at_;
    at_ = std::min(at_, text_.size());
    ++number_;
    return true;
}

std::string_view next_word(std::string_view& rest, std::string_view separators) {
    const auto separates = [&](char c) {
        return c == ' ' || c == '\t' || c == '\v' || c == '\f' ||
               separators.find(c) != std::string_view::npos;
    };
    std::size_t first = 0;
    while (first < rest.size() && separates(rest[first])) ++first;
    std::size_t last = first;
    while (last < rest.size() && !separates(rest[last])) ++last;
    const std::string_view word = rest.substr(first, last - first);
    rest.remove_prefix(last);
    return word;
}

std::size_t scalar_size(Scalar type) {
    switch (type) {
        case Scalar::kI8:
        case Scalar::kU8:
            return 1;
        case Scalar::kI16:
        case Scalar::kU16:
            return 2;
        case Scalar::kI32:
        case Scalar::kU32:
        case Scalar::kF32:
            return 4;
        case Scalar::kI64:
        case Scalar::kU64:
        case Scalar::kF64:
            return 8;
    }
    return 1;
}

namespace {

template <class T>
double read_as(const std::byte* at, bool reversed) {
    std::array<std::byte, sizeof(T)> raw;
    std::memcpy(raw.data(), at, sizeof(T));
    if (reversed) std::reverse(raw.begin(), raw.end());
    T value;
    std::memcpy(&value, raw.data(), sizeof(T));
    return static_cast<double>(value);
}

}  // namespace

double read_scalar(const std::byte* at, Scalar type, bool reversed) {
    switch (type) {
        case Scalar::kI8:
            return read_as<std::int8_t>(at, reversed);
        case Scalar::kU8:
            return read_as<std::uint8_t>(at, reversed);
        case Scalar::kI16:
            return read_as<std::int16_t>(at, reversed);
        case Scalar::kU16:
            return read_as<std::uint16_t>(at, reversed);
        case Scalar::kI32:
            return read_as<std::int32_t>(at, reversed);
        case Scalar::kU32:
            return read_as<std::uint32_t>(at, reversed);
        case Scalar::kI64:
            return read_as<std::int64_t>(at, reversed);
        case Scalar::kU64:
            return read_as<std::uint64_t>(at, reversed);
        case Scalar::kF32:
            return read_as<float>(at, reversed);
        case Scalar::kF64:
            return read_as<double>(at, reversed);
    }
    return 0;
}

void add_point(PointFile& file, std::span<const double> record, const Columns& columns, double colour_scale) {
    const auto value = [&](int column) { return record[static_cast<std::size_t>(column)]; };
    const std::array<double, 3> p{value(columns.position[0]), value(columns.position[1]),
                                  value(columns.position[2])};
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) {
        ++file.report.points_dropped_non_finite;
        return;
    }
    file.cloud.positions.push_back(p);
    if (columns.has_normal()) {
        std::array<float, 3> n{};
        for (std::size_t k = 0; k < 3; ++k) {
            const double v = value(columns.normal[k]);
            n[k] = std::abs(v) < 1e30 ? static_cast<float>(v) : 0.0f;
        }
        file.cloud.normals.push_back(n);
    }
    if (columns.has_colour()) {
        std::array<std::uint8_t, 3> c{};
        for (std::size_t k = 0; k < 3; ++k) {
            const double v = value(columns.colour[k]) * colour_scale;
            c[k] = static_cast<std::uint8_t>(v > 0 ? std::min(v + 0.5, 255.0) : 0.0);
        }
        file.cloud.colours.push_back(c);
    }
}

Result<PointFile> parse_points(std::span<const std::byte> bytes, std::string_view extension,
                               const PointReadOptions& options) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (bytes.empty()) return error_at_offset(ErrorCode::kTruncated, "the file is empty", 0);
    if (text.starts_with("ply") && (text.size() == 3 || text[3] == '\n' || text[3] == '\r' || text[3] == ' '))
        return parse_ply_points(bytes, options);
    std::string_view head = text;
    while (!head.empty() && (head[0] == ' ' || head[0] == '\n' || head[0] == '\r')) head.remove_prefix(1);
    if (head.starts_with("# .PCD") || head.starts_with("VERSION")) return parse_pcd_points(bytes, options);
    std::string lower(extension);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (lower == ".ply") return error_at_offset(ErrorCode::kMalformed, "a PLY file starts with \"ply\"", 0);
    if (lower == ".pcd") return parse_pcd_points(bytes, options);
    if (text.starts_with("LASF"))
        return error_at_offset(ErrorCode::kUnsupported,
                               "LAS files are not read; convert the file to PLY or text", 0);
    return parse_text_points(text, options);
}

}  // namespace vsplit::bake
