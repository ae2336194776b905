// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// The vertices of a PLY file (Turk 1994); whatever else it holds is passed over.
#include <algorithm>

#include "points/parse.hpp"

namespace vsplit::bake {
namespace {

struct Property {
    std::string name;
    Scalar type = Scalar::kF32;
    bool list = false;
    Scalar count_type = Scalar::kU8;
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

enum class Encoding : std::uint8_t { kText, kLittle, kBig };

struct Header {
    Encoding encoding = Encoding::kText;
    std::vector<Element> elements;
    std::size_t end = 0;
    std::uint64_t lines = 0;
};

std::optional<Scalar> scalar_named(std::string_view name) {
    constexpr std::pair<std::string_view, Scalar> names[] = {
        {"char", Scalar::kI8},     {"int8", Scalar::kI8},     {"uchar", Scalar::kU8},
        {"uint8", Scalar::kU8},    {"short", Scalar::kI16},   {"int16", Scalar::kI16},
        {"ushort", Scalar::kU16},  {"uint16", Scalar::kU16},  {"int", Scalar::kI32},
        {"int32", Scalar::kI32},   {"uint", Scalar::kU32},    {"uint32", Scalar::kU32},
        {"float", Scalar::kF32},   {"float32", Scalar::kF32}, {"double", Scalar::kF64},
        {"float64", Scalar::kF64},
    };
    for (const auto& [text, type] : names)
        if (text == name) return type;
    return std::nullopt;
}

Result<Header> parse_header(std::string_view text) {
    Header header;
    Lines lines(text);
    std::string_view line;
    bool format = false;
    while (lines.next(line)) {
        const auto bad = [&](const char* what) {
            return error_at_line(ErrorCode::kMalformed, what, lines.number());
        };
        if (lines.number() > 1000) return bad("the PLY header does not end");
        std::string_view rest = line;
        const std::string_view word = next_word(rest);
        if (word.empty() || word == "comment" || word == "obj_info" || (word == "ply" && lines.number() == 1))
            continue;
        if (word == "format") {
            const std::string_view name = next_word(rest);
            if (name == "ascii")
                header.encoding = Encoding::kText;
            else if (name == "binary_little_endian")
                header.encoding = Encoding::kLittle;
            else if (name == "binary_big_endian")
                header.encoding = Encoding::kBig;
            else
                return bad("unknown PLY format");
            format = true;
        } else if (word == "element") {
            Element element;
            element.name = next_word(rest);
            const std::optional<std::uint64_t> count = parse_count(next_word(rest));
            if (!count) return bad("an element without a count");
            element.count = *count;
            header.elements.push_back(std::move(element));
        } else if (word == "property") {
            if (header.elements.empty()) return bad("a property before any element");
            Property property;
            std::string_view type = next_word(rest);
            property.list = type == "list";
            if (property.list) {
                const std::optional<Scalar> count_type = scalar_named(next_word(rest));
                if (!count_type || *count_type == Scalar::kF32 || *count_type == Scalar::kF64)
                    return bad("a list counted by an unknown type");
                property.count_type = *count_type;
                type = next_word(rest);
            }
            const std::optional<Scalar> scalar = scalar_named(type);
            if (!scalar) return bad("a property of an unknown type");
            property.type = *scalar;
            property.name = next_word(rest);
            header.elements.back().properties.push_back(std::move(property));
        } else if (word == "end_header") {
            if (!format) return bad("a PLY header without a format");
            header.end = lines.offset();
            header.lines = lines.number();
            return header;
        } else {
            return bad("an unknown line in the PLY header");
        }
    }
    return error_at_offset(ErrorCode::kTruncated, "the PLY header does not end", text.size());
}

Columns name_columns(const Element& vertex) {
    Columns columns;
    const auto find = [&](std::initializer_list<const char*> names) {
        for (const char* name : names)
            for (std::size_t i = 0; i < vertex.properties.size(); ++i)
                if (!vertex.properties[i].list && vertex.properties[i].name == name)
                    return static_cast<int>(i);
        return -1;
    };
    columns.position = {find({"x"}), find({"y"}), find({"z"})};
    columns.normal = {find({"nx", "normal_x"}), find({"ny", "normal_y"}), find({"nz", "normal_z"})};
    columns.colour = {find({"red", "r", "diffuse_red"}), find({"green", "g", "diffuse_green"}),
                      find({"blue", "b", "diffuse_blue"})};
    return columns;
}

/// The least that one record of an element takes, in bytes.
std::size_t least_size(const Element& element, Encoding encoding) {
    std::size_t size = 0;
    for (const Property& p : element.properties)
        size += encoding == Encoding::kText ? 2 : p.list ? scalar_size(p.count_type) : scalar_size(p.type);
    return size;
}

}  // namespace

Result<PointFile> parse_ply_points(std::span<const std::byte> bytes, const PointReadOptions& options) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    Result<Header> parsed = parse_header(text);
    if (!parsed) return parsed.error();
    const Header& header = *parsed;
    PointFile file;
    file.report.format = header.encoding == Encoding::kText     ? "PLY (ascii)"
                         : header.encoding == Encoding::kLittle ? "PLY (binary little endian)"
                                                                : "PLY (binary big endian)";
    const auto vertex = std::find_if(header.elements.begin(), header.elements.end(),
                                     [](const Element& e) { return e.name == "vertex"; });
    if (vertex == header.elements.end() || vertex->count == 0)
        return error_at_line(ErrorCode::kMalformed, "the PLY file holds no vertices", header.lines);
    const Columns columns = name_columns(*vertex);
    if (columns.position[0] < 0 || columns.position[1] < 0 || columns.position[2] < 0)
        return error_at_line(ErrorCode::kMalformed, "the vertices have no x, y and z", header.lines);
    if (vertex->count > options.max_points)
        return error_at_line(ErrorCode::kLimit, "more than " + std::to_string(options.max_points) + " points",
                             header.lines);
    std::uint64_t room = bytes.size() - header.end;
    for (const Element& e : header.elements) {
        const std::size_t least = least_size(e, header.encoding);
        if (least > 0 && e.count > (room + 1) / least)
            return error_at_offset(
                ErrorCode::kTruncated,
                "the file is too short for the " + std::to_string(e.count) + " records of \"" + e.name + "\"",
                bytes.size());
        if (e.name == "vertex") break;
    }
    double colour_scale = 1;
    file.report.points_in = vertex->count;
    file.report.columns_ignored =
        vertex->properties.size() - 3 - (columns.has_normal() ? 3u : 0u) - (columns.has_colour() ? 3u : 0u);
    if (columns.has_colour()) {
        const Scalar type = vertex->properties[static_cast<std::size_t>(columns.colour[0])].type;
        if (type == Scalar::kF32 || type == Scalar::kF64) colour_scale = 255;
        if (type == Scalar::kU16) colour_scale = 255.0 / 65535.0;
    }
    file.cloud.positions.reserve(vertex->count);
    std::vector<double> record(vertex->properties.size());

    if (header.encoding == Encoding::kText) {
        Lines lines(text.substr(header.end));
        std::string_view line;
        for (const Element& e : header.elements) {
            for (std::uint64_t i = 0; i < e.count; ++i) {
                std::string_view rest;
                do {
                    if (!lines.next(line))
                        return error_at_line(ErrorCode::kTruncated,
                                             "the file ends after " + std::to_string(i) + " of " +
                                                 std::to_string(e.count) + " records of \"" + e.name + "\"",
                                             header.lines + lines.number());
                    rest = line;
                } while (next_word(rest).empty());
                if (e.name != "vertex") continue;
                rest = line;
                const auto bad = [&](const char* what) {
                    return error_at_line(ErrorCode::kMalformed, what, header.lines + lines.number());
                };
                for (std::size_t p = 0; p < e.properties.size(); ++p) {
                    const std::string_view word = next_word(rest);
                    if (word.empty()) return bad("the line has fewer columns than the vertex has properties");
                    if (e.properties[p].list) {
                        const std::optional<std::uint64_t> count = parse_count(word);
                        if (!count || *count > rest.size()) return bad("a list's count is not a count");
                        for (std::uint64_t k = 0; k < *count; ++k) next_word(rest);
                        continue;
                    }
                    const std::optional<double> value = parse_number(word);
                    if (!value) return bad("a property is not a number");
                    record[p] = *value;
                }
                add_point(file, record, columns, colour_scale);
            }
            if (e.name == "vertex") break;
        }
        return file;
    }

    const bool reversed = header.encoding == Encoding::kBig;
    std::size_t at = header.end;
    const auto fits = [&](std::uint64_t size) { return size <= bytes.size() - at; };
    for (const Element& e : header.elements) {
        for (std::uint64_t i = 0; i < e.count && !e.properties.empty(); ++i)
            for (std::size_t p = 0; p < e.properties.size(); ++p) {
                const Property& property = e.properties[p];
                std::uint64_t size = scalar_size(property.list ? property.count_type : property.type);
                if (!fits(size))
                    return error_at_offset(
                        ErrorCode::kTruncated,
                        "the file ends inside \"" + e.name + "\" record " + std::to_string(i), at);
                const double value = read_scalar(
                    bytes.data() + at, property.list ? property.count_type : property.type, reversed);
                at += size;
                if (property.list) {
                    if (value < 0)
                        return error_at_offset(ErrorCode::kMalformed, "a list of negative length", at - size);
                    size = static_cast<std::uint64_t>(value) * scalar_size(property.type);
                    if (!fits(size))
                        return error_at_offset(ErrorCode::kTruncated, "the file ends inside a list", at);
                    at += size;
                } else if (e.name == "vertex") {
                    record[p] = value;
                }
                if (e.name == "vertex" && p + 1 == e.properties.size())
                    add_point(file, record, columns, colour_scale);
            }
        if (e.name == "vertex") break;
    }
    return file;
}

}  // namespace vsplit::bake
