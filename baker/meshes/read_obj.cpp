// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Wavefront OBJ (Alias|Wavefront, Advanced Visualizer manual, appendix B1): positions and faces.
#include <algorithm>
#include <array>

#include "readers.hpp"
#include "text_scan.hpp"

namespace vsplit::bake {
namespace {

// What the format knows beside v and f, and what exporters add. Any other word is an error: a flipped bit
// that turned a vertex into a comment would shift every index after it.
constexpr auto kOtherWords = std::to_array<std::string_view>(
    {"vt",     "vn",     "vp",     "vw",     "vc",     "g",        "o",        "s",          "mg",
     "usemtl", "mtllib", "usemat", "usemap", "maplib", "l",        "p",        "deg",        "bmat",
     "step",   "cstype", "curv",   "curv2",  "surf",   "parm",     "trim",     "hole",       "scrv",
     "sp",     "end",    "con",    "bevel",  "lod",    "c_interp", "d_interp", "shadow_obj", "trace_obj",
     "ctech",  "stech",  "call",   "csh",    "bsp",    "bzp",      "cdc",      "cdp",        "res"});

bool is_other_word(std::string_view word) {
    return std::find(kOtherWords.begin(), kOtherWords.end(), word) != kOtherWords.end();
}

struct ObjReader {
    TextScan scan;
    const Origin& origin;
    PolygonSoup soup{};
    /// Faces may name vertices that come later, so the real limit is known at the end only: a second pass
    /// finds the line.
    std::uint64_t vertex_limit = std::numeric_limits<std::uint32_t>::max();
    std::uint64_t vertices_needed = 0;

    Status read() {
        for (;;) {
            scan.skip_space_and_comments();
            if (scan.at_end()) return Ok{};
            const std::uint64_t line = scan.line();
            const TextScan at_word = scan;
            const std::string_view word = scan.word();
            Status status = Ok{};
            if (word == "v")
                status = vertex();
            else if (word == "f" || word == "fo")
                status = face();
            else if (!is_other_word(word))
                return Error{ErrorCode::kMalformed, "not a line of an OBJ file: " + at_word.quote(),
                             Error::kNowhere, line};
            if (!status) return status;
            scan.next_line(true);
        }
    }

    Status vertex() {
        float xyz[3];
        for (int axis = 0; axis < 3; ++axis) {
            scan.skip_blanks(true);
            if (!scan.coordinate(xyz[axis], origin[axis])) return scan.expected("a coordinate");
        }
        if (soup.positions.size() + 1 >= std::numeric_limits<std::uint32_t>::max())
            return scan.error(ErrorCode::kLimit, "more than 4,294,967,294 vertices");
        soup.positions.push_back({xyz[0], xyz[1], xyz[2]});
        return Ok{};
    }

    Status face() {
        const std::size_t first = soup.corners.size();
        for (;;) {
            scan.skip_blanks(true);
            if (scan.at_line_end_or_comment()) break;
            std::int64_t index = 0;
            if (!scan.integer_prefix(index)) return scan.expected("a vertex index");
            // Texture and normal indices: "1/2", "1//3", "1/2/3", "1/" as some write it.
            for (int slashes = 0; scan.peek() == '/' && slashes < 2; ++slashes) {
                scan.advance();
                std::int64_t other = 0;
                scan.integer_prefix(other);
            }
            if (!scan.at_delimiter()) return scan.expected("a blank after the vertex index");
            const auto known = static_cast<std::int64_t>(soup.positions.size());
            const std::int64_t vertex = index < 0 ? known + index : index - 1;
            if (index == 0 || vertex < 0 || static_cast<std::uint64_t>(vertex) >= vertex_limit)
                return scan.error(ErrorCode::kMalformed, "a face names vertex " + std::to_string(index) +
                                                             " of " + std::to_string(known));
            vertices_needed = std::max(vertices_needed, static_cast<std::uint64_t>(vertex) + 1);
            soup.corners.push_back(static_cast<std::uint32_t>(vertex));
        }
        if (soup.corners.size() == first) return scan.expected("the vertices of a face");
        soup.face_starts.push_back(soup.corners.size());
        return Ok{};
    }
};

}  // namespace

Result<SoupFile> read_obj(std::span<const std::byte> bytes, const Origin& origin) {
    ObjReader reader{TextScan(bytes), origin};
    if (Status status = reader.read(); !status) return status.error();
    if (reader.vertices_needed > reader.soup.positions.size()) {
        ObjReader again{TextScan(bytes), origin};
        again.vertex_limit = reader.soup.positions.size();
        Status status = again.read();
        if (!status) return status.error();
    }
    SoupFile file{std::move(reader.soup), {}, true};
    file.report.format = "OBJ";
    return file;
}

bool is_obj(std::span<const std::byte> bytes) {
    TextScan scan(bytes);
    scan.skip_space_and_comments();
    const std::string_view word = scan.word();
    return word == "v" || word == "f" || is_other_word(word);
}

}  // namespace vsplit::bake
