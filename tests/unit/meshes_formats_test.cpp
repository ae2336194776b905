// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What each format can say, read from files written out by hand.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "family.hpp"
#include "mesh_files.hpp"

using namespace vsplit;
using namespace vsplit::bake;
using namespace vsplit::test;

TEST_CASE("OBJ: indices of every kind, continued lines, CRLF, and what is passed over") {
    const auto file = parse(
        "# a comment\r\nmtllib a.mtl\r\no thing\nv 0 0 0 1.0\nv 1 0 0 0.5 0.5 0.5\nv +1 1 \\\n 0\n\tv 0 1 0 "
        "# end\n"
        "vt 0 0\nvn 0 0 1\ng a b\nusemtl m\ns off\nf 1 2/1 3//1 # quad half\nf -4/1/1 \\\r\n -2 -1\nl 1 2\np "
        "1\n",
        ".OBJ");
    REQUIRE(file.ok());
    CHECK(file->report.format == "OBJ");
    CHECK(file->mesh.positions == std::vector<Float3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    CHECK(file->mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
    // A face may come before its vertices.
    CHECK(parse("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0", ".obj").ok());
    // Lines may end as on old Macintoshes.
    CHECK(parse("v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r", ".obj").ok());
}

TEST_CASE("OBJ: errors name their line") {
    const auto line_of = [](const std::string& text) {
        const auto file = parse(text, ".obj");
        REQUIRE(!file.ok());
        return file.error().line;
    };
    const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    CHECK(line_of(three + "f 1 2 4\n") == 4);
    CHECK(line_of(three + "f 1 2 3\nf 0 1 2\n") == 5);
    CHECK(line_of(three + "f 1 2 -4\n") == 4);
    CHECK(line_of(three + "f 1 2 3x\n") == 4);
    CHECK(line_of(three + "f 1 2 99999999999999999999\n") == 4);
    CHECK(line_of(three + "f\n") == 4);
    CHECK(line_of("v 0 0\nf 1 1 1\n") == 1);
    CHECK(line_of("v 0 0 \\\n\\\n zero\n") == 3);
    CHECK(line_of(three + "\n\nw 0 0 1\nf 1 2 3\n") == 6);
    CHECK(line_of("v 0,5 0 0\n") == 1);
}

TEST_CASE("Numbers: rounded once to the nearest float, and as all runtimes spell them") {
    const auto x_of = [](const std::string& number) {
        const auto file =
            parse("v " + number + " 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 2 3 4\n", ".obj");
        REQUIRE(file.ok());
        // Where x is not finite, the triangle that uses it goes and the other stays.
        return file->report.faces_dropped_non_finite == 1 ? std::numeric_limits<float>::infinity()
                                                          : file->mesh.positions[0].x;
    };
    CHECK(x_of("0.1") == 0.1f);
    CHECK(x_of("+2.5e-3") == 2.5e-3f);
    CHECK(x_of("-.5") == -0.5f);
    CHECK(x_of("5.") == 5.0f);
    CHECK(x_of("1E2") == 100.0f);
    CHECK(x_of("16777217.0000001") == 16777218.0f);  // Through a double it would round twice, to ...216.
    CHECK(x_of("1e-60") == 0.0f);
    CHECK(x_of("1e-400") == 0.0f);
    CHECK(std::signbit(x_of("-1e-400")));
    CHECK(x_of("1e-42") == 1e-42f);
    for (const char* odd : {"nan", "NaN", "-nan", "nan(ind)", "-nan(ind)", "inf", "-INF", "Infinity",
                            "1.#INF", "-1.#IND", "1.#QNAN", "1.#IND00", "1e60", "-1e400"}) {
        INFO(odd);
        CHECK(std::isinf(x_of(odd)));
    }
    for (const char* bad : {"+-1", "--1", "1.5.2", "0x10", "e5", ".", "1e", "1.#FOO"}) {
        INFO(bad);
        CHECK(!parse("v " + std::string(bad) + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ".obj").ok());
    }
}

TEST_CASE("PLY: text, with every other element and property around") {
    const auto file = parse(
        "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nobj_info x\r\nelement material 1\r\nproperty "
        "list uchar int ids\r\nproperty int "
        "n\r\nelement face 2\r\nproperty uchar flag\r\nproperty list uint8 int32 vertex_index\r\nproperty "
        "list uchar float uv\r\nelement "
        "vertex 4\r\nproperty uchar red\r\nproperty double z\r\nproperty float32 y\r\nproperty short "
        "x\r\nproperty list char char c\r\n"
        "property float quality\r\nelement edge 1\r\nproperty int a\r\nend_header\r\n2 7 8 9\r\n1 3 0 1 2 "
        "0\r\n0 4 0 1 2 3 2 0.5 nan\r\n"
        "255 0.5 0 0 0 1\r\n255 0.5 0 1 1 9 2\r\n255 0.5 1 1 0 3\r\n255 0.5 1 0 0 -4\r\n12\r\n",
        ".ply");
    REQUIRE(file.ok());
    CHECK(file->report.format == "PLY (ascii)");
    CHECK(file->mesh.positions ==
          std::vector<Float3>{{0, 0, 0.5f}, {1, 0, 0.5f}, {1, 1, 0.5f}, {0, 1, 0.5f}});
    CHECK(file->mesh.triangles.size() == 3);
    CHECK(file->report.polygons_triangulated == 1);
    CHECK(file->mesh.weights == std::vector<float>{1, 2, 3, 0});
    CHECK(file->report.weights_clamped == 1);
}

TEST_CASE("PLY: both binaries, every type") {
    for (const bool big : {false, true})
        for (const char* type : {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"})
            for (const char* index : {"char", "uchar", "short", "ushort", "int", "uint", "float"}) {
                INFO((big ? "big " : "little ") << type << " " << index);
                std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                                    "_endian 1.0\nelement vertex 4\nproperty " + type + " x\nproperty " +
                                    type + " y\nproperty list uchar " + type + " extra\nproperty " + type +
                                    " z\nelement face 2\nproperty list ushort " + index +
                                    " vertex_indices\nproperty uchar flag\nend_header\n";
                const int at[4][3] = {{1, 2, 3}, {4, 5, 6}, {7, 8, 8}, {100, 11, 12}};
                for (const auto& p : at) {
                    put(bytes, type, p[0], big);
                    put(bytes, type, p[1], big);
                    put(bytes, "uchar", p[0] % 3, big);
                    for (int i = 0; i < p[0] % 3; ++i) put(bytes, type, 1, big);
                    put(bytes, type, p[2], big);
                }
                for (const auto& corners : {std::vector<int>{0, 1, 2}, std::vector<int>{3, 2, 1, 0}}) {
                    put(bytes, "ushort", int(corners.size()), big);
                    for (const int c : corners) put(bytes, index, c, big);
                    put(bytes, "uchar", 9, big);
                }
                const auto file = parse(bytes, ".ply");
                REQUIRE(file.ok());
                CHECK(file->mesh.positions ==
                      std::vector<Float3>{{1, 2, 3}, {4, 5, 6}, {7, 8, 8}, {100, 11, 12}});
                CHECK(file->mesh.triangles.size() == 3);
                CHECK(!parse(bytes + "more", ".ply").ok());
            }
}

TEST_CASE("PLY: triangle strips with separators, as in Stanford's files") {
    for (const bool big : {false, true}) {
        std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                            "_endian 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty "
                            "float z\nelement tristrips "
                            "1\nproperty list int int vertex_indices\nend_header\n";
        for (int v = 0; v < 5; ++v)
            for (const int c : {v / 2, v % 2, 0}) put(bytes, "float", c, big);
        const std::vector<int> strip{0, 2, 1, 3, 3, -1, 4, 2, 3, -1, 0, 1};
        put(bytes, "int", int(strip.size()), big);
        for (const int i : strip) put(bytes, "int", i, big);
        const auto file = parse(bytes, ".ply");
        REQUIRE(file.ok());
        CHECK(file->mesh.triangles == std::vector<Triangle>{{0, 2, 1}, {1, 2, 3}, {4, 2, 3}});
        CHECK(file->report.faces_in == 4);
        CHECK(file->report.faces_dropped_degenerate == 1);
        bytes[bytes.size() - 8 + (big ? 3 : 0)] = 5;
        CHECK(!parse(bytes, ".ply").ok());
    }
}

TEST_CASE("PLY: weights come from where they are asked for") {
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
        "z\nproperty float "
        "weight\nproperty int age\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const std::string text = head + "0 0 0 1 10\n1 0 0 2 20\n0 1 0 3 30\n3 0 1 2\n";
    CHECK(parse(text, ".ply")->mesh.weights == std::vector<float>{1, 2, 3});
    ReadOptions options;
    options.weight_property = "age";
    CHECK(parse(text, ".ply", options)->mesh.weights == std::vector<float>{10, 20, 30});
    options.weight_property = "missing";
    CHECK(parse(text, ".ply", options).error().code == ErrorCode::kArgument);
    CHECK(parse("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ".obj", options).error().code ==
          ErrorCode::kArgument);
}

TEST_CASE("OFF: its kinds, comments, counts on the first line or glued to it") {
    const std::string face = "3 0 1 2\n", body = "0 0 0\n1 0 0\n0 1 0\n";
    for (const std::string& text : std::vector<std::string>{
             "OFF\n3 1 0\n" + body + face, "OFF 3 1 0\n" + body + face, "OFF3 1 0\n" + body + face,
             "# c\nOFF\n# d\n\n3 1\n# e\n0 0 0 # f\n1 0 0\n\n0 1 0\n3 0 1 2 255 0 0 # red",
             std::string("3 1 3\n") + body + face,
             std::string("COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 1 2 3 4\n0 1 0 1 2 3\n") + face,
             std::string("NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n") + face,
             std::string("STOFF\r\n3 1 0\r\n0 0 0 0 0\r\n1 0 0 0 1\r\n0 1 0 1 1\r\n") + face,
             std::string("OFF\n3 1 0\n0 0 0 10 20 30\n1 0 0 10 20 30\n0 1 0 1 1 1\n") + face}) {
        INFO(text);
        const auto file = parse(text, ".off");
        REQUIRE(file.ok());
        CHECK(file->mesh.positions == std::vector<Float3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
        CHECK(file->mesh.triangles == std::vector<Triangle>{{0, 1, 2}});
    }
    CHECK(parse("OFF BINARY\n", ".off").error().code == ErrorCode::kUnsupported);
    CHECK(parse("4OFF\n3 1 0\n", ".off").error().code == ErrorCode::kUnsupported);
    CHECK(parse("NOFF\n3 1 0\n" + body + face, ".off").error().line == 3);
    CHECK(parse("OFF\n3 1 0\n" + body + "3 0 1 3\n", ".off").error().line == 6);
    CHECK(parse("OFF\n3 1 0\n" + body + face + face, ".off").error().line == 7);
}

TEST_CASE("STL: text and binary, also a binary one that says solid, padded or blank at its end") {
    const std::string text =
        "solid x y z\n FACET normal 0 0 nan\n outer loop\n vertex 0 0 0\n vertex 1 0 0\n vertex 0 1 0\n "
        "endloop\n endfacet\n"
        "facet normal 0 0 0 outer loop vertex 1 0 0 vertex 1 1 0 vertex -0 1 0 endloop endfacet\nendsolid x "
        "y z\n"
        "solid second\nendsolid\n";
    const auto file = parse(text, ".stl");
    REQUIRE(file.ok());
    CHECK(file->report.format == "STL (ascii)");
    CHECK(file->mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}});
    CHECK(file->report.vertices_welded == 2);
    CHECK(
        parse("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 q\n", ".stl").error().line ==
        5);

    for (const char* head : {"", "solid like a text"}) {
        const Mesh sphere = make_sphere(8, 6);
        std::string bytes = stl_of(sphere, head);
        for (const char* padding : {"", "\n", "1234567890"}) {
            const auto binary = parse(bytes + padding, ".stl");
            REQUIRE(binary.ok());
            CHECK(binary->report.format == "STL (binary)");
            CHECK(binary->mesh.triangles.size() == sphere.triangles.size());
            CHECK(binary->mesh.positions.size() == sphere.positions.size());
            CHECK(survey_mesh(binary->mesh).closed());
        }
        CHECK(parse(bytes + std::string(100, '\0'), ".stl").ok());
        CHECK(!parse(bytes + std::string(50, 'x'), ".stl").ok());
        CHECK(parse(bytes, "").ok());  // By its length alone.
    }
}

TEST_CASE("Writing and reading again keeps every bit") {
    for (const auto& [name, mesh] : mesh_family()) {
        INFO(name);
        if (mesh.triangles.empty()) {
            CHECK(!parse_mesh(encode_ply(mesh), ".ply").ok());
            CHECK(!parse_mesh(encode_obj(mesh), ".obj").ok());
            continue;
        }
        Mesh odd = mesh;
        for (std::size_t v = 0; v < odd.positions.size(); ++v) {
            odd.positions[v].x *= 1.0f + 0x1p-20f * float(v % 7);
            if (v % 11 == 3) odd.positions[v].y = -0.0f;
            if (v % 13 == 5) odd.positions[v].z = 1e-41f;
            odd.weights.push_back(v % 5 == 0 ? std::numeric_limits<float>::infinity() : float(v) / 3);
        }
        ReadOptions options;
        options.weld = Weld::kNone;
        const auto ply = parse_mesh(encode_ply(odd), ".ply", options),
                   obj = parse_mesh(encode_obj(odd), ".obj", options);
        REQUIRE(ply.ok());
        REQUIRE(obj.ok());
        for (const Mesh* back : {&ply->mesh, &obj->mesh}) {
            REQUIRE(back->positions.size() == odd.positions.size());
            CHECK(std::memcmp(back->positions.data(), odd.positions.data(), 12 * odd.positions.size()) == 0);
            CHECK(back->triangles == odd.triangles);
        }
        CHECK(ply->mesh.weights == odd.weights);
    }
}

TEST_CASE("Weights as text: exactly one a vertex, in the file's order") {
    const auto weights = [](const std::string& text, std::size_t count) {
        return parse_weights(as_bytes(text), count);
    };
    CHECK(*weights("# marks\n1\n\n2.5 # nose\r\ninf\n0", 4) ==
          std::vector<float>{1, 2.5f, std::numeric_limits<float>::infinity(), 0});
    CHECK(weights("1\n2\n", 3).error().code == ErrorCode::kTruncated);
    CHECK(weights("1\n2\n3\n", 2).error().line == 3);
    CHECK(weights("1\n-2\n", 2).error().line == 2);
    CHECK(weights("1\nnan\n", 2).error().line == 2);
    CHECK(weights("1 2\n", 2).error().line == 1);
    CHECK(weights("1\ntwo\n", 2).error().line == 2);
    CHECK(weights("", 0)->empty());
    CHECK(!weights("1\n", std::size_t{1} << 40).ok());

    // A vertex unused, two welded: the largest of the welded counts.
    auto file =
        parse("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 2 3 4\nf 5 7 6\n", ".obj");
    REQUIRE(file.ok());
    CHECK(file->report.vertices_dropped_unused == 1);
    CHECK(file->report.vertices_welded == 2);
    REQUIRE(apply_weights(*file, std::vector<float>{100, 1, 2, 9, 8, 3, 4}).ok());
    CHECK(file->mesh.weights == std::vector<float>{1, 8, 9, 4});
    CHECK(apply_weights(*file, std::vector<float>{1, 2, 3, 4}).error().code == ErrorCode::kArgument);
}

TEST_CASE("Far from 0, the digits of text and doubles are kept by an origin") {
    // Map coordinates: metres, to the millimetre. Floats there are half a metre apart.
    const std::array<double, 3> corner{500000.125, 4500000.25, 100};
    std::string obj,
        ply =
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
            "property double z\nelement face 2\nproperty list uchar int vertex_indices\n"
            "end_header\n",
        off = "OFF\n4 2 0\n", stl = "solid a\n";
    const double step[4][3] = {{0, 0, 0}, {0.001, 0, 0}, {1, 2, 0.5}, {0, 0.002, 0.25}};
    std::array<std::string, 4> rows;
    for (int v = 0; v < 4; ++v) {
        char row[128];
        std::snprintf(row, sizeof(row), "%.3f %.3f %.3f\n", corner[0] + step[v][0], corner[1] + step[v][1],
                      corner[2] + step[v][2]);
        rows[std::size_t(v)] = row;
        obj += "v " + rows[std::size_t(v)];
        ply += row;
        off += row;
    }
    obj += "f 1 2 3\nf 1 3 4\n";
    ply += "3 0 1 2\n3 0 2 3\n";
    off += "3 0 1 2\n3 0 2 3\n";
    for (const auto& t : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
        stl += "facet normal 0 0 0\nouter loop\n";
        for (const int v : t) stl += "vertex " + rows[std::size_t(v)];
        stl += "endloop\nendfacet\n";
    }
    stl += "endsolid\n";
    const auto check = [&](const MeshFile& file) {
        CHECK(file.mesh.origin[1] != 0);
        REQUIRE(file.mesh.positions.size() == 4);
        for (std::size_t v = 0; v < 4; ++v) {
            const Float3& p = file.mesh.positions[v];
            const double got[3] = {p.x, p.y, p.z};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double said = std::round((corner[axis] + step[v][axis]) * 1000) / 1000;
                CHECK(std::fabs(file.mesh.origin[axis] + got[axis] - said) < 2e-7);
            }
        }
    };
    for (const auto& [text, extension] :
         {std::pair{obj, ".obj"}, {ply, ".ply"}, {off, ".off"}, {stl, ".stl"}}) {
        INFO(extension);
        const auto file = parse(text, extension);
        REQUIRE(file.ok());
        check(*file);
        // Doubles and text are written so that this comes back.
        for (const bool as_ply : {true, false}) {
            const auto bytes = as_ply ? encode_ply(file->mesh) : encode_obj(file->mesh);
            const auto again = parse_mesh(bytes, as_ply ? ".ply" : ".obj");
            REQUIRE(again.ok());
            check(*again);
            CHECK(again->mesh.positions == file->mesh.positions);
            CHECK(again->mesh.origin == file->mesh.origin);
        }
    }
    // Near enough, nothing is moved; a file of floats has no digits to lose.
    CHECK(parse("v 100 0 0\nv 101 0 0\nv 100 1 0\nf 1 2 3\n", ".obj")->mesh.origin ==
          std::array<double, 3>{});
    CHECK(local_origin({5, 5, 5}, {5, 5, 5}) == std::array<double, 3>{});
    CHECK(local_origin({-1e308, 0, 0}, {1e308, 0, 0}) == std::array<double, 3>{});
    CHECK(local_origin({1000, 0, 0}, {1001, 1, 1}) == std::array<double, 3>{1000, 0, 0});
}
