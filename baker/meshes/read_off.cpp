// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// OFF (Geomview manual, "OFF: Object File Format"), text, with one vertex or face a line as everybody writes
// it.
#include <algorithm>

#include "readers.hpp"
#include "text_scan.hpp"

namespace vsplit::bake {
namespace {

constexpr int kMaxColumns = 3 + 3 + 4 + 2;  // Position, normal, colour, texture.

/// The keyword's parts: [ST][C][N][4][n]OFF. Some files glue the first count to it ("OFF490 518 0").
struct Keyword {
    bool found = false;
    std::size_t length = 0;
    bool texture = false, colour = false, normal = false, four = false, many = false;
};

Keyword parse_keyword(std::string_view word) {
    Keyword k;
    std::string_view rest = word;
    const auto eat = [&rest](std::string_view prefix) {
        if (!rest.starts_with(prefix)) return false;
        rest.remove_prefix(prefix.size());
        return true;
    };
    k.texture = eat("ST");
    k.colour = eat("C");
    k.normal = eat("N");
    k.four = eat("4");
    k.many = eat("n");
    k.found = eat("OFF") && (rest.empty() || (rest[0] >= '0' && rest[0] <= '9'));
    k.length = word.size() - rest.size();
    return k;
}

struct OffReader {
    TextScan scan;
    const Origin& origin;
    PolygonSoup soup{};

    Result<std::uint64_t> count(const char* what) {
        scan.skip_blanks();
        std::int64_t value = 0;
        if (!scan.integer(value) || value < 0) return scan.expected(std::string("the number of ") + what);
        return static_cast<std::uint64_t>(value);
    }

    Status vertices(std::uint64_t n, int least_columns) {
        soup.positions.reserve(n);
        for (std::uint64_t v = 0; v < n; ++v) {
            scan.skip_space_and_comments();
            float xyz[3];
            for (int axis = 0; axis < 3; ++axis) {
                scan.skip_blanks();
                if (!scan.coordinate(xyz[axis], origin[axis]))
                    return scan.expected("a coordinate of vertex " + std::to_string(v));
            }
            int columns = 3;
            for (scan.skip_blanks(); !scan.at_line_end_or_comment(); scan.skip_blanks()) {
                scan.word();
                if (++columns > kMaxColumns)
                    return scan.error(ErrorCode::kUnsupported, "more columns than a vertex has");
            }
            if (columns < least_columns)
                return scan.expected(std::to_string(least_columns) + " columns for vertex " +
                                     std::to_string(v));
            scan.next_line();
            soup.positions.push_back({xyz[0], xyz[1], xyz[2]});
        }
        return Ok{};
    }

    Status faces(std::uint64_t n) {
        soup.face_starts.reserve(n + 1);
        for (std::uint64_t f = 0; f < n; ++f) {
            scan.skip_space_and_comments();
            std::int64_t corners = 0;
            if (!scan.integer(corners) || corners < 0)
                return scan.expected("the number of corners of face " + std::to_string(f));
            for (std::int64_t k = 0; k < corners; ++k) {
                scan.skip_blanks();
                std::int64_t vertex = 0;
                if (!scan.integer(vertex)) return scan.expected("a corner of face " + std::to_string(f));
                if (vertex < 0 || static_cast<std::uint64_t>(vertex) >= soup.positions.size())
                    return scan.error(ErrorCode::kMalformed, "face " + std::to_string(f) + " names vertex " +
                                                                 std::to_string(vertex) + " of " +
                                                                 std::to_string(soup.positions.size()));
                soup.corners.push_back(static_cast<std::uint32_t>(vertex));
            }
            soup.face_starts.push_back(soup.corners.size());
            scan.next_line();  // Colours of the face.
        }
        return Ok{};
    }
};

}  // namespace

bool is_off(std::span<const std::byte> bytes) {
    TextScan scan(bytes);
    scan.skip_space_and_comments();
    return parse_keyword(scan.word()).found;
}

Result<SoupFile> read_off(std::span<const std::byte> bytes, const Origin& origin) {
    OffReader reader{TextScan(bytes), origin};
    TextScan& scan = reader.scan;
    scan.skip_space_and_comments();
    TextScan after = scan;
    const std::string_view word = after.word();
    const Keyword keyword = parse_keyword(word);
    // The keyword may be missing: then the counts come first.
    if (keyword.found)
        for (std::size_t i = 0; i < keyword.length; ++i) scan.advance();
    else if (word.empty() || word[0] < '0' || word[0] > '9')
        return scan.expected("the keyword OFF");
    if (keyword.four || keyword.many)
        return scan.error(ErrorCode::kUnsupported, "an OFF file of other than three dimensions");
    scan.skip_blanks();
    after = scan;
    if (after.word() == "BINARY") return scan.error(ErrorCode::kUnsupported, "a binary OFF file");
    scan.skip_space_and_comments();

    const Result<std::uint64_t> vertices = reader.count("vertices");
    if (!vertices) return vertices.error();
    const Result<std::uint64_t> faces = reader.count("faces");
    if (!faces) return faces.error();
    scan.skip_blanks();
    if (!scan.at_line_end_or_comment())  // The number of edges is often left out; nobody uses it.
        if (const Result<std::uint64_t> edges = reader.count("edges"); !edges) return edges.error();
    // The shortest vertex is "0 0 0\n", the shortest face "0\n"; the last line may lack its end.
    const std::uint64_t room = scan.bytes_left() + 1;
    if (*vertices > room / 6 || *faces > (room - 6 * *vertices) / 2)
        return scan.error(ErrorCode::kTruncated, "announces " + std::to_string(*vertices) + " vertices and " +
                                                     std::to_string(*faces) +
                                                     " faces, more than the file can hold");
    scan.skip_blanks();
    if (!scan.at_line_end_or_comment()) return scan.expected("the end of the line after the counts");

    const int least_columns =
        3 + (keyword.normal ? 3 : 0) + (keyword.colour ? 3 : 0) + (keyword.texture ? 2 : 0);
    if (Status status = reader.vertices(*vertices, least_columns); !status) return status.error();
    if (Status status = reader.faces(*faces); !status) return status.error();
    scan.skip_space_and_comments();
    if (!scan.at_end())
        return scan.error(ErrorCode::kMalformed, "more lines than the announced vertices and faces");

    SoupFile file{std::move(reader.soup), {}, true};
    file.report.format = "OFF";
    return file;
}

}  // namespace vsplit::bake
