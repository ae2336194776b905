// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// PCD 0.7, the Point Cloud Library's format: ascii, binary and binary_compressed (LZF, one field after the
// other).
#include <algorithm>

#include "points/parse.hpp"

namespace vsplit::bake {
namespace {

struct Field {
    std::string name;
    std::uint64_t size = 4;
    char type = 'F';
    std::uint64_t count = 1;
    Scalar scalar = Scalar::kF32;
    std::uint64_t offset = 0;  ///< In a point's record; its first column in text.
};

struct Header {
    std::vector<Field> fields;
    std::uint64_t points = 0, record = 0, columns = 0, lines = 0;
    std::string encoding;
    std::size_t end = 0;
};

std::optional<Scalar> scalar_of(char type, std::uint64_t size) {
    if (type == 'F')
        return size == 4   ? std::optional(Scalar::kF32)
               : size == 8 ? std::optional(Scalar::kF64)
                           : std::nullopt;
    const bool is_signed = type == 'I';
    if (!is_signed && type != 'U') return std::nullopt;
    switch (size) {
        case 1:
            return is_signed ? Scalar::kI8 : Scalar::kU8;
        case 2:
            return is_signed ? Scalar::kI16 : Scalar::kU16;
        case 4:
            return is_signed ? Scalar::kI32 : Scalar::kU32;
        case 8:
            return is_signed ? Scalar::kI64 : Scalar::kU64;
        default:
            return std::nullopt;
    }
}

Result<Header> parse_header(std::string_view text) {
    Header header;
    Lines lines(text);
    std::string_view line;
    std::uint64_t width = 0, height = 1;
    bool has_points = false;
    while (lines.next(line)) {
        const auto bad = [&](const char* what) {
            return error_at_line(ErrorCode::kMalformed, what, lines.number());
        };
        if (lines.number() > 1000) return bad("the PCD header does not end");
        std::string_view rest = line;
        const std::string_view key = next_word(rest);
        if (key.empty() || key[0] == '#' || key == "VERSION" || key == "VIEWPOINT") continue;
        const auto for_each_field = [&](auto&& set) {
            for (Field& field : header.fields) {
                const std::string_view word = next_word(rest);
                if (word.empty() || !set(field, word)) return false;
            }
            return !header.fields.empty();
        };
        const auto number = [](std::uint64_t& target, std::uint64_t most) {
            return [&target, most](std::string_view word) {
                const std::optional<std::uint64_t> value = parse_count(word);
                if (!value || *value > most) return false;
                target = *value;
                return true;
            };
        };
        constexpr std::uint64_t kMost = std::uint64_t{1} << 40;
        if (key == "FIELDS" || key == "COLUMNS") {
            for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
                if (header.fields.size() >= 256) return bad("more than 256 fields");
                header.fields.emplace_back();
                header.fields.back().name = word;
            }
        } else if (key == "SIZE") {
            if (!for_each_field([&](Field& f, std::string_view w) { return number(f.size, 8)(w); }))
                return bad("SIZE does not fit the fields");
        } else if (key == "TYPE") {
            if (!for_each_field([&](Field& f, std::string_view w) {
                    f.type = w[0];
                    return w.size() == 1;
                }))
                return bad("TYPE does not fit the fields");
        } else if (key == "COUNT") {
            if (!for_each_field([&](Field& f, std::string_view w) { return number(f.count, 1 << 16)(w); }))
                return bad("COUNT does not fit the fields");
        } else if (key == "WIDTH") {
            if (!number(width, kMost)(next_word(rest))) return bad("WIDTH is not a count");
        } else if (key == "HEIGHT") {
            if (!number(height, 1 << 20)(next_word(rest))) return bad("HEIGHT is not a count");
        } else if (key == "POINTS") {
            if (!number(header.points, kMost)(next_word(rest))) return bad("POINTS is not a count");
            has_points = true;
        } else if (key == "DATA") {
            header.encoding = next_word(rest);
            header.end = lines.offset();
            header.lines = lines.number();
            if (!has_points) header.points = width * height;
            for (Field& field : header.fields) {
                const std::optional<Scalar> scalar = scalar_of(field.type, field.size);
                if (!scalar) return bad("a field of an unknown type");
                field.scalar = *scalar;
                field.offset = header.encoding == "ascii" ? header.columns : header.record;
                header.record += field.size * field.count;
                header.columns += field.count;
            }
            return header;
        } else {
            return bad("an unknown line in the PCD header");
        }
    }
    return error_at_offset(ErrorCode::kTruncated, "the PCD header does not end", text.size());
}

/// LZF (Lehmann), which the Point Cloud Library compresses with. False if the bytes are not what they should
/// be.
bool expand(std::span<const std::byte> from, std::vector<std::byte>& to) {
    std::size_t in = 0, out = 0;
    const auto byte = [&](std::size_t i) { return std::to_integer<std::size_t>(from[i]); };
    while (in < from.size()) {
        const std::size_t control = byte(in++);
        if (control < 32) {
            const std::size_t run = control + 1;
            if (run > from.size() - in || run > to.size() - out) return false;
            std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(in), run,
                        to.begin() + static_cast<std::ptrdiff_t>(out));
            in += run;
            out += run;
            continue;
        }
        std::size_t run = control >> 5;
        if (run == 7) {
            if (in >= from.size()) return false;
            run += byte(in++);
        }
        run += 2;
        if (in >= from.size()) return false;
        const std::size_t back = ((control & 31) << 8 | byte(in++)) + 1;
        if (back > out || run > to.size() - out) return false;
        for (; run > 0; --run, ++out) to[out] = to[out - back];
    }
    return out == to.size();
}

}  // namespace

Result<PointFile> parse_pcd_points(std::span<const std::byte> bytes, const PointReadOptions& options) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    Result<Header> parsed = parse_header(text);
    if (!parsed) return parsed.error();
    const Header& header = *parsed;
    PointFile file;
    file.report.format = "PCD (" + header.encoding + ")";
    file.report.points_in = header.points;
    const auto fail = [&](ErrorCode code, std::string what) {
        return error_at_line(code, std::move(what), header.lines);
    };
    if (header.points == 0) return fail(ErrorCode::kMalformed, "the PCD file holds no points");
    if (header.points > options.max_points)
        return fail(ErrorCode::kLimit, "more than " + std::to_string(options.max_points) + " points");
    const auto find = [&](const char* name) -> const Field* {
        for (const Field& f : header.fields)
            if (f.name == name && f.count > 0) return &f;
        return nullptr;
    };
    // Coordinates, then a normal, then a packed colour, in the order of `columns` below.
    std::vector<const Field*> wanted{find("x"), find("y"), find("z")};
    if (!wanted[0] || !wanted[1] || !wanted[2])
        return fail(ErrorCode::kMalformed, "the points have no x, y and z");
    Columns columns;
    columns.position = {0, 1, 2};
    if (find("normal_x") && find("normal_y") && find("normal_z")) {
        columns.normal = {3, 4, 5};
        for (const char* name : {"normal_x", "normal_y", "normal_z"}) wanted.push_back(find(name));
    }
    const Field* packed = find("rgb") ? find("rgb") : find("rgba");
    if (packed && packed->size != 4) packed = nullptr;
    const std::size_t plain = wanted.size();
    if (packed) {
        const int at = static_cast<int>(plain);
        columns.colour = {at, at + 1, at + 2};
    }
    file.report.columns_ignored = header.columns - plain - (packed ? 1 : 0);
    std::vector<double> record(plain + 3);
    const auto unpack = [&](std::uint32_t rgb) {
        for (std::uint32_t k = 0; k < 3; ++k) record[plain + k] = rgb >> (16 - 8 * k) & 255;
    };

    if (header.encoding == "ascii") {
        Lines lines(text.substr(header.end));
        std::string_view line;
        if (header.points > (bytes.size() - header.end + 1) / 2)
            return fail(ErrorCode::kTruncated, "the file is too short for its points");
        std::vector<std::string_view> words;
        for (std::uint64_t i = 0; i < header.points;) {
            if (!lines.next(line))
                return error_at_line(ErrorCode::kTruncated,
                                     "the file ends after " + std::to_string(i) + " of " +
                                         std::to_string(header.points) + " points",
                                     header.lines + lines.number());
            words.clear();
            std::string_view rest = line;
            for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest))
                words.push_back(word);
            if (words.empty() || words[0][0] == '#') continue;
            const auto bad = [&](const char* what) {
                return error_at_line(ErrorCode::kMalformed, what, header.lines + lines.number());
            };
            if (words.size() < header.columns)
                return bad("the line has fewer columns than the header's fields");
            for (std::size_t k = 0; k < plain; ++k) {
                const std::optional<double> value = parse_number(words[wanted[k]->offset]);
                if (!value) return bad("a field is not a number");
                record[k] = *value;
            }
            if (packed) {
                const std::string_view word = words[packed->offset];
                std::uint32_t rgb = 0;
                const std::optional<double> value = parse_number(word);
                if (!value) return bad("a colour is not a number");
                if (packed->type == 'F') {
                    const auto bits = static_cast<float>(std::abs(*value) < 3e38 ? *value : 0);
                    std::memcpy(&rgb, &bits, 4);
                } else if (*value >= 0 && *value < 4294967296.0) {
                    rgb = static_cast<std::uint32_t>(*value);
                }
                unpack(rgb);
            }
            add_point(file, record, columns, 1);
            ++i;
        }
        return file;
    }

    std::vector<std::byte> expanded;
    std::span<const std::byte> data = bytes.subspan(header.end);
    const bool compressed = header.encoding == "binary_compressed";
    if (!compressed && header.encoding != "binary")
        return fail(ErrorCode::kUnsupported, "PCD data \"" + header.encoding + "\" is not read");
    if (compressed) {
        if (data.size() < 8)
            return error_at_offset(ErrorCode::kTruncated, "the compressed sizes are missing", bytes.size());
        const auto packed_size = static_cast<std::uint64_t>(read_scalar(data.data(), Scalar::kU32));
        const auto size = static_cast<std::uint64_t>(read_scalar(data.data() + 4, Scalar::kU32));
        if (packed_size > data.size() - 8)
            return error_at_offset(ErrorCode::kTruncated, "the compressed points are cut off", bytes.size());
        // LZF cannot grow its input by more than 264 bytes for 3.
        if (size / 100 > packed_size || size != header.record * header.points)
            return error_at_offset(ErrorCode::kMalformed,
                                   "the compressed points do not have the size that the header says",
                                   header.end);
        expanded.resize(size);
        if (!expand(data.subspan(8, packed_size), expanded))
            return error_at_offset(ErrorCode::kMalformed, "the compressed points are damaged",
                                   header.end + 8);
        data = expanded;
    }
    if (header.record == 0 || header.points > data.size() / header.record)
        return error_at_offset(ErrorCode::kTruncated,
                               "the file is too short for its " + std::to_string(header.points) + " points",
                               bytes.size());
    file.cloud.positions.reserve(header.points);
    // Compressed, a field's values lie together; else a point's do.
    const auto place = [&](const Field& f, std::uint64_t i) {
        return data.data() +
               (compressed ? f.offset * header.points + i * f.size * f.count : i * header.record + f.offset);
    };
    for (std::uint64_t i = 0; i < header.points; ++i) {
        for (std::size_t k = 0; k < plain; ++k)
            record[k] = read_scalar(place(*wanted[k], i), wanted[k]->scalar);
        if (packed) {
            std::uint32_t rgb = 0;
            std::memcpy(&rgb, place(*packed, i), 4);
            unpack(rgb);
        }
        add_point(file, record, columns, 1);
    }
    return file;
}

}  // namespace vsplit::bake
