// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Readers of point files: what they take, what they refuse, and that nothing crashes them.
#include <catch2/catch.hpp>
#include <cstring>
#include <limits>
#include <random>
#include <string>

#include "vsplit/bake/points.hpp"

using namespace vsplit;
using namespace vsplit::bake;

namespace {

Result<PointFile> parse(const std::string& text, const char* extension = ".xyz",
                        const PointReadOptions& options = {}) {
    return parse_points(std::as_bytes(std::span(text)), extension, options);
}

template <class T>
void put(std::string& to, T value) {
    to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string binary_ply() {
    std::string s =
        "ply\nformat binary_little_endian 1.0\ncomment made by hand\nelement camera 1\nproperty float fov\n"
        "element vertex 3\nproperty double x\nproperty double y\nproperty double z\nproperty list uchar int "
        "tags\n"
        "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar "
        "green\nproperty uchar blue\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    put(s, 45.0f);
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) put(s, i * 10.0 + k);
        put(s, static_cast<unsigned char>(i));
        for (int k = 0; k < i; ++k) put(s, 7);
        put(s, 0.0f), put(s, 0.0f), put(s, 1.0f);
        for (int k = 0; k < 3; ++k) put(s, static_cast<unsigned char>(100 + i));
    }
    put(s, static_cast<unsigned char>(3)), put(s, 0), put(s, 1), put(s, 2);
    return s;
}

std::string pcd_header(const char* encoding, int points) {
    return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F "
           "F F U\n"
           "COUNT 1 1 1 1\nWIDTH " +
           std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points) +
           "\nDATA " + encoding + "\n";
}

std::string binary_pcd(bool compressed) {
    constexpr int n = 40;
    std::string data;
    if (!compressed) {
        for (int i = 0; i < n; ++i)
            put(data, float(i)), put(data, 2.0f * float(i)), put(data, 3.0f), put(data, 0x010203u);
        return pcd_header("binary", n) + data;
    }
    std::string fields;
    for (int i = 0; i < n; ++i) put(fields, float(i));
    for (int i = 0; i < n; ++i) put(fields, 2.0f * float(i));
    // z: a run that LZF says as a literal and two references; the rest as literals of up to 32 bytes.
    std::string packed;
    const auto literals = [&](const std::string& s) {
        for (std::size_t at = 0; at < s.size(); at += 32) {
            const std::string part = s.substr(at, 32);
            packed += static_cast<char>(part.size() - 1);
            packed += part;
        }
    };
    literals(fields);
    std::string three;
    put(three, 3.0f);
    literals(three);
    // 39 more copies of four bytes: 156 = 7 + 2 + 147, four bytes back.
    packed += static_cast<char>(7 << 5);
    packed += static_cast<char>(147);
    packed += static_cast<char>(3);
    std::string colours;
    for (int i = 0; i < n; ++i) put(colours, 0x010203u);
    literals(colours);
    std::string s = pcd_header("binary_compressed", n);
    put(s, static_cast<std::uint32_t>(packed.size()));
    put(s, static_cast<std::uint32_t>(n * 16));
    return s + packed;
}

}  // namespace

TEST_CASE("text points: columns, comments, counts, separators") {
    auto file = parse("# a comment\n\n3\n1 2 3\n4,5;6\r\n  7\t8 9 # tail\n");
    REQUIRE(file.ok());
    CHECK(file->cloud.positions.size() == 3);
    CHECK(file->cloud.positions[2] == std::array<double, 3>{7, 8, 9});
    CHECK(file->report.lines_skipped == 3);

    file = parse("x y z nx ny nz\n1 2 3 0 0 1\n4 5 6 0.6 0.8 0\n");
    REQUIRE(file.ok());
    CHECK(file->cloud.normals.size() == 2);
    CHECK(file->cloud.normals[1][1] == 0.8f);
    CHECK(file->cloud.colours.empty());

    file = parse("1 2 3 255 0 10\n4 5 6 1 2 3\n", ".TXT");
    REQUIRE(file.ok());
    CHECK(file->cloud.normals.empty());
    CHECK(file->cloud.colours[0] == std::array<std::uint8_t, 3>{255, 0, 10});

    // .pts: two scans, each with its count; intensity, then colour.
    file = parse("2\n1 2 3 -1200 10 20 30\n1 2 4 -900 10 20 30\n1\n1 2 5 -3 1 2 3\n", ".pts");
    REQUIRE(file.ok());
    CHECK(file->cloud.positions.size() == 3);
    CHECK(file->cloud.colours[2] == std::array<std::uint8_t, 3>{1, 2, 3});
    CHECK(file->report.columns_ignored == 1);

    file = parse("nan 0 0\n1e999 0 0\n1 -inf 0\n1 1 1e-400\n");
    REQUIRE(file.ok());
    CHECK(file->cloud.positions.size() == 1);
    CHECK(file->report.points_dropped_non_finite == 3);
}

TEST_CASE("text points: what is refused, with its line") {
    const auto fails = [](const std::string& text, ErrorCode code, std::uint64_t line) {
        const auto file = parse(text);
        INFO(text);
        REQUIRE_FALSE(file.ok());
        CHECK(file.error().code == code);
        CHECK(file.error().line == line);
    };
    fails("1 2 3\n4 five 6\n", ErrorCode::kMalformed, 2);
    fails("1 2 3\n4 5\n", ErrorCode::kMalformed, 2);
    fails("1 2 3 4\n1 2 3\n", ErrorCode::kMalformed, 2);
    fails("# nothing\n\n", ErrorCode::kMalformed, 2);
    fails("9\n1 2 3\n", ErrorCode::kTruncated, 1);
    fails("words only\nmore words\n", ErrorCode::kMalformed, 2);
    CHECK(parse("").error().code == ErrorCode::kTruncated);
    CHECK(parse(std::string("1 2 3\n\0\0\0", 9)).error().code == ErrorCode::kMalformed);
    PointReadOptions few;
    few.max_points = 1;
    CHECK(parse("1 2 3\n4 5 6\n", ".xyz", few).error().code == ErrorCode::kLimit);
    CHECK(parse("LASF and so on").error().code == ErrorCode::kUnsupported);
}

TEST_CASE("PLY points: text and binary, with what else the file holds") {
    auto file = parse(
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
        "property float quality\nend_header\n1 2 3 9\n4 5 6 9\n",
        ".ply");
    REQUIRE(file.ok());
    CHECK(file->cloud.positions[1] == std::array<double, 3>{4, 5, 6});
    CHECK(file->report.columns_ignored == 1);
    file = parse(binary_ply(), ".ply");
    REQUIRE(file.ok());
    CHECK(file->cloud.positions[2] == std::array<double, 3>{20, 21, 22});
    CHECK(file->cloud.normals[2][2] == 1.0f);
    CHECK(file->cloud.colours[1][0] == 101);
    CHECK(parse("ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float "
                "y\nproperty float z\nend_header\n1 2 3\n")
              .error()
              .code == ErrorCode::kLimit);
    PointReadOptions many;
    many.max_points = ~0ull;
    CHECK(parse("ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float "
                "y\nproperty float z\nend_header\n1 2 3\n",
                ".ply", many)
              .error()
              .code == ErrorCode::kTruncated);
}

TEST_CASE("PCD points: ascii, binary, compressed") {
    const auto text = parse(pcd_header("ascii", 2) + "1 2 3 66051\n4 5 nan 0\n", ".pcd");
    REQUIRE(text.ok());
    CHECK(text->cloud.positions.size() == 1);
    CHECK(text->report.points_dropped_non_finite == 1);
    CHECK(text->cloud.colours[0] == std::array<std::uint8_t, 3>{1, 2, 3});
    for (const bool compressed : {false, true}) {
        const auto file = parse(binary_pcd(compressed), ".pcd");
        INFO(compressed << (file.ok() ? "" : file.error().describe()));
        REQUIRE(file.ok());
        REQUIRE(file->cloud.positions.size() == 40);
        CHECK(file->cloud.positions[39] == std::array<double, 3>{39, 78, 3});
        CHECK(file->cloud.colours[17] == std::array<std::uint8_t, 3>{1, 2, 3});
    }
}

TEST_CASE("hostile point files: cut anywhere and flipped anywhere, an answer and no crash") {
    const std::string text = "3\n1.5 2 3e2 0 0 1\n-4 5 6 0 1 0\n7 8 9 1 0 0\n";
    for (const std::string& good : {text, binary_ply(), pcd_header("ascii", 2) + "1 2 3 5\n4 5 6 7\n",
                                    binary_pcd(false), binary_pcd(true)}) {
        REQUIRE(parse(good).ok());
        for (std::size_t cut = 0; cut < good.size(); ++cut) {
            const auto file = parse(good.substr(0, cut));
            // A cut number is still a number; but nothing may be invented.
            if (file.ok())
                CHECK(file->cloud.positions.size() <= 40);
            else
                CHECK(!file.error().message.empty());
        }
        std::mt19937 random(1);
        for (int i = 0; i < 3000; ++i) {
            std::string bad = good;
            for (int k = 0; k < 1 + i % 4; ++k)
                bad[random() % bad.size()] ^= static_cast<char>(1 << random() % 8);
            const auto file = parse(bad);
            if (!file.ok()) continue;
            for (const auto& p : file->cloud.positions)
                REQUIRE((std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])));
            REQUIRE(
                (file->cloud.normals.empty() || file->cloud.normals.size() == file->cloud.positions.size()));
        }
    }
}
