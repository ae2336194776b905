// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "family.hpp"
#include "gltf_document.hpp"
#include "vsplit/bake/gltf.hpp"

using namespace vsplit;
using namespace vsplit::bake;
using namespace vsplit::test;

namespace {

std::vector<std::byte> glb_of(const Mesh& mesh) {
    const GltfLevel level{mesh, 0};
    auto bytes = encode_glb({&level, 1});
    REQUIRE(bytes.ok());
    return *bytes;
}

json json_of(const std::vector<std::byte>& glb) {
    std::uint32_t length = 0;
    std::memcpy(&length, glb.data() + 12, 4);
    return json::parse(std::string(reinterpret_cast<const char*>(glb.data()) + 20, length));
}

template <class T>
std::vector<T> values_of(const std::vector<std::byte>& glb, const json& document, std::size_t accessor,
                         std::size_t components) {
    const json& a = document["accessors"][accessor];
    const json& view = document["bufferViews"][a["bufferView"].get<std::size_t>()];
    std::uint32_t length = 0;
    std::memcpy(&length, glb.data() + 12, 4);
    std::vector<T> out(a["count"].get<std::size_t>() * components);
    REQUIRE(view["byteLength"] == out.size() * sizeof(T));
    REQUIRE(view["byteOffset"].get<std::size_t>() % 4 == 0);
    std::memcpy(out.data(), glb.data() + 28 + length + view["byteOffset"].get<std::size_t>(),
                out.size() * sizeof(T));
    return out;
}

bool same_bits(const Float3& a, const Float3& b) {
    return std::bit_cast<std::uint32_t>(a.x) == std::bit_cast<std::uint32_t>(b.x) &&
           std::bit_cast<std::uint32_t>(a.y) == std::bit_cast<std::uint32_t>(b.y) &&
           std::bit_cast<std::uint32_t>(a.z) == std::bit_cast<std::uint32_t>(b.z);
}

}  // namespace

TEST_CASE("what encode_glb writes, parse_gltf reads back bit for bit") {
    for (const auto& [name, mesh] : mesh_family()) {
        CAPTURE(name);
        if (mesh.triangles.empty()) continue;
        for (const bool weighted : {false, true}) {
            Mesh in = mesh;
            if (weighted)
                for (std::size_t v = 0; v < in.positions.size(); ++v)
                    in.weights.push_back(v % 7 == 0 ? std::numeric_limits<float>::infinity()
                                                    : 0.1f * float(v));
            const auto out = parse_gltf(glb_of(in), "", {Weld::kNone, "", 1u << 20});
            REQUIRE(out.ok());
            REQUIRE(mesh_fault(out->mesh) == nullptr);
            CHECK(out->report.format == "glTF (binary)");
            CHECK(out->report.faces_in == in.triangles.size());
            CHECK(out->report.vertices_in == in.positions.size());
            // Vertices that no triangle names go; the order of the others stays.
            std::vector<std::uint32_t> kept;
            std::vector<bool> used(in.positions.size(), false);
            for (const Triangle& t : in.triangles)
                for (const std::uint32_t v : t) used[v] = true;
            std::vector<std::uint32_t> number(in.positions.size(), 0);
            for (std::uint32_t v = 0; v < in.positions.size(); ++v)
                if (used[v]) {
                    number[v] = std::uint32_t(kept.size());
                    kept.push_back(v);
                }
            CHECK(out->report.vertices_dropped_unused == in.positions.size() - kept.size());
            REQUIRE(out->mesh.positions.size() == kept.size());
            REQUIRE(out->mesh.triangles.size() == in.triangles.size());
            for (std::size_t v = 0; v < kept.size(); ++v)
                REQUIRE(same_bits(out->mesh.positions[v], in.positions[kept[v]]));
            for (std::size_t t = 0; t < in.triangles.size(); ++t)
                for (std::size_t c = 0; c < 3; ++c)
                    REQUIRE(out->mesh.triangles[t][c] == number[in.triangles[t][c]]);
            REQUIRE(out->mesh.weights.size() == (weighted ? kept.size() : 0));
            for (std::size_t v = 0; v < out->mesh.weights.size(); ++v)
                REQUIRE(out->mesh.weights[v] == in.weights[kept[v]]);
        }
    }
}

TEST_CASE("minus zero, the smallest and the largest floats survive a GLB") {
    Mesh mesh;
    mesh.positions = {
        {-0.0f, 1e-45f, 3e38f}, {0.1f, -0.0f, -3e38f}, {1.17549435e-38f, 16777217.0f, 1.0f / 3}};
    mesh.triangles = {{0, 1, 2}};
    const auto glb = glb_of(mesh);
    const auto out = parse_gltf(glb, "");
    REQUIRE(out.ok());
    for (std::size_t v = 0; v < 3; ++v) CHECK(same_bits(out->mesh.positions[v], mesh.positions[v]));
    const json accessor = json_of(glb)["accessors"][0];
    CHECK(accessor["min"][0].get<float>() == 0.0f);
    CHECK(accessor["max"][0].get<float>() == 0.1f);
    CHECK(accessor["min"][2].get<float>() == -3e38f);
    CHECK(accessor["max"][2].get<float>() == 3e38f);
}

TEST_CASE("normals of a GLB are of unit length, point outwards and fall back") {
    for (const auto& [name, mesh] : mesh_family()) {
        CAPTURE(name);
        if (mesh.triangles.empty()) continue;
        const auto glb = glb_of(mesh);
        const auto normals = values_of<Float3>(glb, json_of(glb), 1, 1);
        REQUIRE(normals.size() == mesh.positions.size());
        for (const Float3& n : normals) REQUIRE(std::hypot(n.x, n.y, n.z) == Approx(1).margin(1e-6));
        if (name == "sphere")
            for (std::size_t v = 0; v < normals.size(); ++v) {
                const Float3 p = mesh.positions[v], n = normals[v];
                REQUIRE(p.x * n.x + p.y * n.y + p.z * n.z > 0.999);  // Max's weights are exact on a sphere
            }
        if (name == "grid")
            for (const Float3& n : normals) REQUIRE(n == Float3{0, 0, 1});
    }
    // Two triangles back to back cancel out; a vertex of zero-area triangles has no normal at all; nor has an
    // unused one.
    Mesh odd;
    odd.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {5, 5, 5}, {5, 5, 5}, {5, 5, 5}, {9, 9, 9}};
    odd.triangles = {{0, 1, 2}, {0, 2, 1}, {3, 4, 5}};
    const auto glb = glb_of(odd);
    const auto normals = values_of<Float3>(glb, json_of(glb), 1, 1);
    for (std::size_t v = 0; v < 3; ++v) CHECK(normals[v] == Float3{0, -1, 0});
    for (std::size_t v = 3; v < 7; ++v) CHECK(normals[v] == Float3{0, 0, 1});
}

TEST_CASE("indices are 16 bits wide up to 65535 vertices, and never the restart value") {
    for (const std::size_t count : {65535u, 65536u}) {
        Mesh mesh;
        for (std::size_t v = 0; v < count; ++v) mesh.positions.push_back({float(v), float(v % 3), 0});
        const auto last = std::uint32_t(count - 1);
        mesh.triangles = {{0, 1, last}};
        const auto glb = glb_of(mesh);
        const json document = json_of(glb);
        CHECK(document["accessors"][2]["componentType"] == (count == 65535 ? 5123 : 5125));
        CHECK(document["bufferViews"][2]["target"] == 34963);
        const auto out = parse_gltf(glb, "");
        REQUIRE(out.ok());
        CHECK(out->mesh.positions.back().x == float(last));
    }
}

TEST_CASE("the material is double sided where a mesh has an edge to look behind") {
    const auto sided = [](const Mesh& mesh) {
        return json_of(glb_of(mesh))["materials"][0].value("doubleSided", false);
    };
    CHECK_FALSE(sided(make_sphere(8, 6)));
    CHECK(sided(make_grid(3)));
    const GltfLevel levels[] = {{make_sphere(8, 6), 0}, {make_grid(3), 0.1}};
    CHECK(json_of(*encode_glb(levels))["materials"][0].value("doubleSided", false));
}

TEST_CASE("several levels hang on the finest one's node by MSFT_lod") {
    const GltfLevel levels[] = {
        {make_sphere(32, 24), 0}, {make_sphere(16, 12), 0.02}, {make_sphere(8, 6), 0.1}};
    const auto glb = encode_glb(levels);
    REQUIRE(glb.ok());
    const json document = json_of(*glb);
    CHECK(document["extensionsUsed"] == json::array({"MSFT_lod"}));
    CHECK(document["scenes"] == json::parse(R"([{"nodes":[0]}])"));
    CHECK(document["nodes"].size() == 3);
    CHECK(document["nodes"][0]["extensions"]["MSFT_lod"]["ids"] == json::array({1, 2}));
    const auto coverage = document["nodes"][0]["extras"]["MSFT_screencoverage"].get<std::vector<double>>();
    // Level 1 is off by one pixel where the radius spans R / 0.02 pixels: docs/lods.md.
    const double radius = 0.5 * std::sqrt(12.0);
    REQUIRE(coverage.size() == 3);
    CHECK(coverage[0] == Approx(std::numbers::pi * std::pow(radius / 0.02, 2) / (1920 * 1080)).epsilon(0.02));
    CHECK(coverage[1] == Approx(std::numbers::pi * std::pow(radius / 0.1, 2) / (1920 * 1080)).epsilon(0.02));
    CHECK(coverage[2] == 0);
    // A reader of the scene sees the finest level once.
    const auto out = parse_gltf(*glb, "");
    REQUIRE(out.ok());
    CHECK(out->mesh.triangles.size() == levels[0].mesh.triangles.size());
    // Without a scene the coarser levels are still no roots.
    json bare = document;
    bare.erase("scene");
    bare.erase("scenes");
    std::uint32_t length = 0;
    std::memcpy(&length, glb->data() + 12, 4);
    const std::vector<std::byte> bin(glb->begin() + 28 + length, glb->end());
    const auto again = parse_gltf(GltfDocument::glb(bare.dump(), bin), "");
    REQUIRE(again.ok());
    CHECK(again->mesh.triangles.size() == levels[0].mesh.triangles.size());
}

TEST_CASE("screen coverages descend strictly whatever the errors are") {
    const std::vector<std::vector<double>> cases = {
        {0, 0, 0, 0}, {0, 0.5, 0.1, 0.7}, {0, 1e-30, 1e-29, 1e30}, {0.3, 0.3, 0.3}, {0, 1e300, 1e300}};
    for (const auto& errors : cases)
        for (const bool point : {false, true}) {
            std::vector<GltfLevel> levels;
            for (const double e : errors) levels.push_back({make_grid(2), e});
            if (point)
                for (GltfLevel& level : levels)
                    for (Float3& p : level.mesh.positions) p = {1, 1, 1};
            const auto glb = encode_glb(levels);
            REQUIRE(glb.ok());
            const auto coverage =
                json_of(*glb)["nodes"][0]["extras"]["MSFT_screencoverage"].get<std::vector<double>>();
            REQUIRE(coverage.size() == errors.size());
            CHECK(coverage.back() == 0);
            for (std::size_t k = 0; k + 1 < coverage.size(); ++k) {
                CHECK(coverage[k] > coverage[k + 1]);
                CHECK(coverage[k] <= 1);
            }
        }
}

TEST_CASE("encode_glb refuses what glTF cannot say") {
    const auto code = [](std::vector<GltfLevel> levels) {
        const auto out = encode_glb(levels);
        REQUIRE_FALSE(out.ok());
        return out.error().code;
    };
    CHECK(code({}) == ErrorCode::kArgument);
    CHECK(code({{Mesh{}, 0}}) == ErrorCode::kArgument);
    CHECK(code({{make_grid(2), 0}, {Mesh{}, 1}}) == ErrorCode::kArgument);
    Mesh mesh = make_grid(2);
    CHECK(code({{mesh, -1}}) == ErrorCode::kArgument);
    CHECK(code({{mesh, std::nan("")}}) == ErrorCode::kArgument);
    mesh.positions[0].x = std::nanf("");
    CHECK(code({{mesh, 0}}) == ErrorCode::kArgument);
}

TEST_CASE("the same levels give the same bytes") {
    const GltfLevel levels[] = {{make_torus(20, 10), 0}, {make_torus(10, 5), 0.1}};
    CHECK(*encode_glb(levels) == *encode_glb(levels));
}
