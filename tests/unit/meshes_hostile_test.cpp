// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Files cut at every byte, with flipped bits, with lying counts, under a wrong name: an error, or a sound
// mesh. Never a crash.
#include <catch2/catch.hpp>
#include <chrono>

#include "family.hpp"
#include "mesh_files.hpp"

using namespace vsplit;
using namespace vsplit::bake;
using namespace vsplit::test;

namespace {

struct Sample {
    std::string name, extension, bytes;
    bool counted;  ///< The format announces or closes what it holds, so that any cut shows.
};

const std::vector<Sample>& samples() {
    static const std::vector<Sample> all = [] {
        const Mesh mesh = make_sphere(7, 5);
        return std::vector<Sample>{{"PLY text", ".ply", ply_of(mesh, "ascii"), true},
                                   {"PLY little", ".ply", ply_of(mesh, "binary_little_endian"), true},
                                   {"PLY big", ".ply", ply_of(mesh, "binary_big_endian"), true},
                                   {"OFF", ".off", off_of(mesh), true},
                                   {"STL binary", ".stl", stl_of(mesh, "test"), true},
                                   {"STL text", ".stl", stl_text_of(make_sphere(3, 2)), true},
                                   {"OBJ", ".obj", obj_of(mesh), false}};
    }();
    return all;
}

/// An error that says something and where, or a mesh that keeps the rules.
void check_answer(const Result<MeshFile>& file) {
    if (file.ok()) {
        REQUIRE(mesh_fault(file->mesh) == nullptr);
        REQUIRE(!file->mesh.triangles.empty());
    } else
        REQUIRE(!file.error().message.empty());
}

}  // namespace

TEST_CASE("Every cut of a file is an error, or for OBJ at least a sound mesh") {
    for (const Sample& s : samples()) {
        const std::uint64_t whole = parse(s.bytes, s.extension)->report.faces_in;
        for (std::size_t n = 0; n < s.bytes.size(); ++n) {
            INFO(s.name << " cut at " << n << " of " << s.bytes.size());
            const auto file = parse(std::string_view(s.bytes).substr(0, n), s.extension);
            check_answer(file);
            // The last line of a text may lose its end, and an STL's last words their name; a number its last
            // digits.
            const std::string_view lost = std::string_view(s.bytes).substr(n);
            if (s.counted && lost.size() > 4) REQUIRE(!file.ok());
            if (s.counted && file.ok()) REQUIRE(file->report.faces_in == whole);
        }
    }
}

TEST_CASE("A cut file's error says where") {
    const std::string bytes = ply_of(make_sphere(7, 5), "binary_little_endian");
    const auto file = parse(std::string_view(bytes).substr(0, bytes.size() - 20), ".ply");
    REQUIRE(!file.ok());
    CHECK(file.error().code == ErrorCode::kTruncated);
    CHECK(file.error().offset != Error::kNowhere);
    const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
    const auto cut = parse(obj, ".obj");
    REQUIRE(!cut.ok());
    CHECK(cut.error().line == 5);
}

TEST_CASE("Flipped bits give an error or a sound mesh") {
    for (const Sample& s : samples()) {
        std::uint64_t state = 12345;
        const auto random = [&state](std::size_t below) {
            state = state * 6364136223846793005ull + 1442695040888963407ull;
            return static_cast<std::size_t>((state >> 33) % below);
        };
        for (int round = 0; round < 3000; ++round) {
            std::string bytes = s.bytes;
            const int flips = 1 + round % 3;
            std::string where;
            for (int f = 0; f < flips; ++f) {
                // Half of them near the front, where the counts are.
                const std::size_t at =
                    random(round % 2 ? bytes.size() : std::min<std::size_t>(bytes.size(), 260));
                bytes[at] = static_cast<char>(bytes[at] ^ (1 << random(8)));
                where += std::to_string(at) + " ";
            }
            INFO(s.name << " flipped at " << where);
            check_answer(parse(bytes, s.extension));
        }
    }
}

TEST_CASE("Counts that lie are found out at once, before any memory is taken for them") {
    const auto start = std::chrono::steady_clock::now();
    for (const char* count :
         {"4000000000", "4294967296", "18446744073709551615", "99999999999999999999999", "-1", "1e9"}) {
        INFO(count);
        for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
            const std::string head = std::string("ply\nformat ") + format + " 1.0\nelement vertex ";
            const std::string xyz = "\nproperty float x\nproperty float y\nproperty float z\nelement face ";
            const std::string list =
                "\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0 0 0 0 0 0 0";
            CHECK(!parse(head + count + xyz + "1" + list, ".ply").ok());
            CHECK(!parse(head + "3" + xyz + count + list, ".ply").ok());
        }
        CHECK(!parse(std::string("OFF\n") + count + " 1 0\n0 0 0\n", ".off").ok());
        CHECK(!parse(std::string("OFF\n1 ") + count + " 0\n0 0 0\n", ".off").ok());
        CHECK(!parse(std::string("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n") + count + " 0 1 2\n", ".off").ok());
        CHECK(!parse(std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 ") + "1" + count + "\n", ".obj").ok());
    }
    std::string stl = stl_of(make_sphere(4, 3), "x");
    for (std::size_t i = 80; i < 84; ++i) stl[i] = '\xEE';
    const auto file = parse(stl, ".stl");
    REQUIRE(!file.ok());
    CHECK(file.error().code == ErrorCode::kTruncated);
    // A list longer than the file.
    std::string ply =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float "
        "y\nproperty float "
        "z\nelement face 1\nproperty list uint int vertex_indices\nend_header\n" +
        std::string(36, '\0');
    for (int i = 0; i < 4; ++i) ply += '\xEE';
    CHECK(parse(ply + std::string(12, '\0'), ".ply").error().code == ErrorCode::kTruncated);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(5));
}

TEST_CASE("Other formats under a mesh's name are named") {
    const std::string png("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\1\0", 20);
    std::string noise;
    for (int i = 0; i < 5000; ++i) noise += static_cast<char>(i * i * 2654435761u >> 13);
    for (const char* extension : {".obj", ".ply", ".off", ".stl", ".xyz", ""}) {
        INFO(extension);
        for (const std::string& bytes :
             {png, noise, std::string(), std::string("\0", 1), std::string(500, '\0'),
              std::string("glTF\2\0\0\0", 8), std::string("{\"asset\":{}}"), std::string("<html></html>"),
              std::string("1 2 3\n4 5 6\n"), std::string("hello\n"), std::string("ply"), std::string("ply\n"),
              std::string("solid\n"), std::string("OFF"), std::string("#\n"), std::string("v")}) {
            const auto file = parse(bytes, extension);
            REQUIRE(!file.ok());
            CHECK(!file.error().message.empty());
        }
        CHECK(parse(png, extension).error().message.find("PNG") != std::string::npos);
        CHECK(parse("glTF\2", extension).error().code == ErrorCode::kUnsupported);
        // And a mesh is read by what it is.
        for (const Sample& s : samples()) {
            INFO(s.name);
            CHECK(parse(s.bytes, extension).ok());
        }
    }
}
