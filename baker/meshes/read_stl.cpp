// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// STL (3D Systems, StereoLithography Interface Specification, 1989), text and binary.
#include <algorithm>
#include <bit>
#include <cstring>

#include "readers.hpp"
#include "text_scan.hpp"

static_assert(std::endian::native == std::endian::little,
              "the binary readers copy little-endian values as they are");

namespace vsplit::bake {
namespace {

constexpr std::uint64_t kHead = 84, kRecord = 50;

std::uint32_t announced_triangles(std::span<const std::byte> bytes) {
    std::uint32_t n = 0;
    std::memcpy(&n, bytes.data() + 80, 4);
    return n;
}

bool same_word(std::string_view word, std::string_view lower) {
    return std::equal(word.begin(), word.end(), lower.begin(), lower.end(),
                      [](char a, char b) { return (a >= 'A' && a <= 'Z' ? char(a - 'A' + 'a') : a) == b; });
}

struct StlTextReader {
    TextScan scan;
    const Origin& origin;
    PolygonSoup soup{};

    bool take(std::string_view lower) {
        scan.skip_space();
        TextScan ahead = scan;
        if (!same_word(ahead.word(), lower)) return false;
        scan = ahead;
        return true;
    }
    Status must_take(std::string_view lower) {
        if (take(lower)) return Ok{};
        return scan.expected("'" + std::string(lower) + "'");
    }
    Status numbers(float (&xyz)[3], const Origin& from) {
        for (int axis = 0; axis < 3; ++axis) {
            scan.skip_space();
            if (!scan.coordinate(xyz[axis], from[axis])) return scan.expected("a number");
        }
        return Ok{};
    }
    Status facet() {
        float xyz[3];
        if (Status s = must_take("normal"); !s) return s;
        if (Status s = numbers(xyz, {}); !s) return s;  // Normals follow from the corners.
        if (Status s = must_take("outer"); !s) return s;
        if (Status s = must_take("loop"); !s) return s;
        while (take("vertex")) {
            if (Status s = numbers(xyz, origin); !s) return s;
            soup.corners.push_back(static_cast<std::uint32_t>(soup.positions.size()));
            soup.positions.push_back({xyz[0], xyz[1], xyz[2]});
        }
        if (Status s = must_take("endloop"); !s) return s;
        if (Status s = must_take("endfacet"); !s) return s;
        soup.face_starts.push_back(soup.corners.size());
        return Ok{};
    }
    Status read() {
        do {
            if (Status s = must_take("solid"); !s) return s;
            scan.next_line();
            while (take("facet"))
                if (Status s = facet(); !s) return s;
            if (!take("endsolid")) return scan.expected("'facet' or 'endsolid'");
            scan.next_line();
            scan.skip_space();
        } while (!scan.at_end());
        return Ok{};
    }
};

}  // namespace

bool is_stl_binary(std::span<const std::byte> bytes) {
    return bytes.size() >= kHead + kRecord && bytes.size() == kHead + kRecord * announced_triangles(bytes);
}

bool is_stl_text(std::span<const std::byte> bytes) {
    TextScan scan(bytes);
    scan.skip_space();
    if (!same_word(scan.word(), "solid") || is_stl_binary(bytes)) return false;
    // A binary file's head may say "solid" as well. Its count and floats hold bytes that no text does.
    const auto head = bytes.first(std::min<std::size_t>(bytes.size(), 4096));
    return std::find(head.begin(), head.end(), std::byte{0}) == head.end();
}

Result<SoupFile> read_stl_text(std::span<const std::byte> bytes, const Origin& origin) {
    StlTextReader reader{TextScan(bytes), origin};
    if (Status status = reader.read(); !status) return status.error();
    SoupFile file{std::move(reader.soup), {}, true};
    file.report.format = "STL (ascii)";
    return file;
}

Result<SoupFile> read_stl_binary(std::span<const std::byte> bytes) {
    if (bytes.size() < kHead)
        return Error{ErrorCode::kTruncated, "an STL file of less than 84 bytes", bytes.size(), 0};
    const std::uint64_t n = announced_triangles(bytes), room = (bytes.size() - kHead) / kRecord;
    if (n > room)
        return Error{ErrorCode::kTruncated,
                     "announces " + std::to_string(n) + " triangles, has bytes for " + std::to_string(room),
                     80, 0};
    // Some writers pad the end. A whole record more, unless it is blank, is a triangle that the count forgot.
    const auto rest = bytes.subspan(kHead + n * kRecord);
    if (rest.size() >= kRecord &&
        std::any_of(rest.begin(), rest.end(), [](std::byte b) { return b != std::byte{0}; }))
        return Error{ErrorCode::kMalformed,
                     "announces " + std::to_string(n) + " triangles, has bytes for " + std::to_string(room),
                     kHead + n * kRecord, 0};
    SoupFile file;
    file.report.format = "STL (binary)";
    file.soup.positions.resize(3 * n);
    file.soup.corners.resize(3 * n);
    file.soup.face_starts.resize(n + 1);
    for (std::uint64_t t = 0; t < n; ++t) {
        std::memcpy(&file.soup.positions[3 * t], bytes.data() + kHead + t * kRecord + 12, 36);
        for (std::uint64_t k = 3 * t; k < 3 * t + 3; ++k)
            file.soup.corners[k] = static_cast<std::uint32_t>(k);
        file.soup.face_starts[t + 1] = 3 * t + 3;
    }
    return file;
}

}  // namespace vsplit::bake
