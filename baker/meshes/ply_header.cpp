// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "ply_header.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

namespace vsplit::bake {
namespace {

constexpr std::size_t kMaxLine = 4096, kMaxElements = 256, kMaxProperties = 4096;

std::optional<PlyType> type_named(std::string_view name) {
    constexpr struct {
        std::string_view name;
        PlyType type;
    } names[] = {
        {"char", PlyType::kInt8},      {"uchar", PlyType::kUint8},   {"short", PlyType::kInt16},
        {"ushort", PlyType::kUint16},  {"int", PlyType::kInt32},     {"uint", PlyType::kUint32},
        {"float", PlyType::kFloat},    {"double", PlyType::kDouble}, {"int8", PlyType::kInt8},
        {"uint8", PlyType::kUint8},    {"int16", PlyType::kInt16},   {"uint16", PlyType::kUint16},
        {"int32", PlyType::kInt32},    {"uint32", PlyType::kUint32}, {"float32", PlyType::kFloat},
        {"float64", PlyType::kDouble},
    };
    for (const auto& entry : names)
        if (entry.name == name) return entry.type;
    return std::nullopt;
}

bool is_integer(PlyType type) {
    return type != PlyType::kFloat && type != PlyType::kDouble;
}

std::string quoted(std::string_view word) {
    std::string text = "'";
    for (const char c : word.substr(0, 32)) text += c >= ' ' && c < 127 ? c : '?';
    return text + (word.size() > 32 ? "...'" : "'");
}

struct HeaderReader {
    std::string_view text;
    bool returns_only;  ///< Old Macintosh: lines end in "\r".
    std::size_t at = 0;
    std::uint64_t line = 0;

    Error error(std::string message, ErrorCode code = ErrorCode::kMalformed) const {
        return {code, "PLY header: " + message, Error::kNowhere, line};
    }

    /// The next line as words.
    Result<std::vector<std::string_view>> words() {
        ++line;
        const std::size_t end = text.substr(at, kMaxLine).find(returns_only ? '\r' : '\n');
        if (end == text.npos) {
            if (text.size() - at < kMaxLine) return error("ends before end_header", ErrorCode::kTruncated);
            return error("a line of more than " + std::to_string(kMaxLine) + " bytes");
        }
        std::string_view row = text.substr(at, end);
        at += end + 1;
        std::vector<std::string_view> found;
        for (;;) {
            const std::size_t first = row.find_first_not_of(" \t\r");
            if (first == row.npos) return found;
            row.remove_prefix(first);
            const std::size_t length = std::min(row.find_first_of(" \t\r"), row.size());
            found.push_back(row.substr(0, length));
            row.remove_prefix(length);
        }
    }

    Result<PlyHeader> read() {
        PlyHeader header;
        bool has_format = false;
        for (;;) {
            const auto row = words();
            if (!row) return row.error();
            const std::vector<std::string_view>& w = *row;
            if (line == 1) {
                if (w.size() != 1 || w[0] != "ply") return error("expected 'ply'");
                continue;
            }
            if (w.empty() || w[0] == "comment" || w[0] == "obj_info") continue;
            Status status = Ok{};
            if (w[0] == "format") {
                if (has_format) return error("a second format line");
                has_format = true;
                status = format(w, header);
            } else if (w[0] == "element")
                status = element(w, header);
            else if (w[0] == "property")
                status = property(w, header);
            else if (w[0] == "end_header") {
                if (!has_format) return error("no format line");
                header.body = at;
                header.body_line = line + 1;
                return header;
            } else
                return error("unknown word " + quoted(w[0]));
            if (!status) return status.error();
        }
    }

    Status format(const std::vector<std::string_view>& w, PlyHeader& header) {
        if (w.size() != 3) return error("expected a format and a version");
        if (w[1] == "ascii")
            header.encoding = PlyEncoding::kText;
        else if (w[1] == "binary_little_endian")
            header.encoding = PlyEncoding::kLittleEndian;
        else if (w[1] == "binary_big_endian")
            header.encoding = PlyEncoding::kBigEndian;
        else
            return error("unknown format " + quoted(w[1]));
        if (w[2] != "1.0")
            return error("version " + quoted(w[2]) + " instead of 1.0", ErrorCode::kUnsupported);
        return Ok{};
    }

    Status element(const std::vector<std::string_view>& w, PlyHeader& header) {
        PlyElement element;
        if (w.size() != 3) return error("expected an element's name and count");
        element.name = w[1];
        const auto [last, problem] = std::from_chars(w[2].data(), w[2].data() + w[2].size(), element.count);
        if (problem != std::errc() || last != w[2].data() + w[2].size())
            return error("a count of " + quoted(w[2]) + " for element " + quoted(w[1]));
        if (header.find(w[1]) != nullptr) return error("a second element " + quoted(w[1]));
        if (header.elements.size() >= kMaxElements) return error("too many elements", ErrorCode::kLimit);
        header.elements.push_back(std::move(element));
        return Ok{};
    }

    Status property(const std::vector<std::string_view>& w, PlyHeader& header) {
        const bool is_list = w.size() > 1 && w[1] == "list";
        if (w.size() != (is_list ? 5 : 3)) return error("expected a property's type and name");
        if (header.elements.empty()) return error("a property before any element");
        PlyElement& element = header.elements.back();
        const auto type = type_named(w[is_list ? 3 : 1]);
        const auto count_type = is_list ? type_named(w[2]) : PlyType::kUint8;
        if (!type || !count_type || !is_integer(*count_type))
            return error("no such type: " + quoted(!type ? w[is_list ? 3 : 1] : w[2]));
        if (element.find(w.back()) != element.properties.size())
            return error("a second property " + quoted(w.back()));
        if (element.properties.size() >= kMaxProperties)
            return error("too many properties", ErrorCode::kLimit);
        element.properties.push_back({std::string(w.back()), *type, is_list, *count_type});
        return Ok{};
    }
};

}  // namespace

std::size_t PlyElement::find(std::string_view property) const {
    return static_cast<std::size_t>(std::find_if(properties.begin(), properties.end(),
                                                 [&](const PlyProperty& p) { return p.name == property; }) -
                                    properties.begin());
}

std::uint64_t PlyElement::least_bytes() const {
    std::uint64_t bytes = 0;
    for (const PlyProperty& p : properties) bytes += size_of(p.is_list ? p.count_type : p.type);
    return bytes;
}

bool PlyElement::has_list() const {
    return std::any_of(properties.begin(), properties.end(), [](const PlyProperty& p) { return p.is_list; });
}

const PlyElement* PlyHeader::find(std::string_view element) const {
    const auto it = std::find_if(elements.begin(), elements.end(),
                                 [&](const PlyElement& e) { return e.name == element; });
    return it == elements.end() ? nullptr : &*it;
}

Result<PlyHeader> parse_ply_header(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const bool returns_only = text.size() > 4 && text[3] == '\r' && text[4] != '\n';
    Result<PlyHeader> header = HeaderReader{text, returns_only}.read();
    if (!header) return header;
    // In a text a value takes a digit and a blank at least; the last blank may be missing.
    std::uint64_t room = bytes.size() - header->body + (header->encoding == PlyEncoding::kText ? 1 : 0);
    for (const PlyElement& element : header->elements) {
        const std::uint64_t row =
            header->encoding == PlyEncoding::kText ? 2 * element.properties.size() : element.least_bytes();
        if (row > 0 && element.count > room / row) {
            Error error{ErrorCode::kTruncated,
                        "announces " + std::to_string(element.count) + " of " + quoted(element.name) +
                            ", more than the " + std::to_string(room) + " bytes left can hold",
                        bytes.size(), 0};
            return error;
        }
        room -= row * element.count;
    }
    return header;
}

}  // namespace vsplit::bake
