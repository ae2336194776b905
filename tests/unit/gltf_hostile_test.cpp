// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <functional>
#include <random>

#include "family.hpp"
#include "gltf_document.hpp"
#include "vsplit/bake/gltf.hpp"

using namespace vsplit;
using namespace vsplit::bake;
using namespace vsplit::test;

namespace {

std::vector<std::byte> small_glb() {
    const GltfLevel levels[] = {{make_sphere(6, 4), 0}, {make_sphere(3, 2), 0.3}};
    return *encode_glb(levels);
}

/// Every property of the reader in one document.
GltfDocument rich() {
    GltfDocument document;
    const std::vector<float> square = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    const std::size_t positions = document.floats(square);
    const std::size_t sparse = document.floats(square);
    document.root["accessors"][sparse]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", document.view(std::vector<std::uint8_t>{2})}, {"componentType", 5121}}},
        {"values", {{"bufferView", document.view(std::vector<float>{0, 3, 0})}}}};
    const std::size_t color = document.floats(square);
    const std::size_t strip =
        document.mesh({{"attributes", {{"POSITION", sparse}, {"COLOR_0", color}}}, {"mode", 5}});
    const std::size_t list = document.mesh(
        {{"attributes", {{"POSITION", positions}}}, {"indices", document.shorts({0, 1, 2, 2, 1, 3})}});
    const std::size_t leaf = document.node(
        {{"mesh", list}, {"rotation", {0, 0, 0, 1}}, {"scale", {-1, 1, 1}}, {"translation", {0, 0, 1}}});
    const std::size_t root = document.node({{"mesh", strip},
                                            {"children", {leaf}},
                                            {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}});
    document.scene({root});
    return document;
}

/// An error with words, or a mesh that keeps its promises.
bool check(std::span<const std::byte> bytes) {
    const auto out = parse_gltf(bytes, "", {Weld::kAuto, "", 1u << 20});
    if (out.ok()) {
        REQUIRE(mesh_fault(out->mesh) == nullptr);
        REQUIRE_FALSE(out->mesh.triangles.empty());
    } else {
        REQUIRE_FALSE(out.error().message.empty());
        if (out.error().offset != Error::kNowhere) REQUIRE(out.error().offset <= bytes.size());
    }
    return out.ok();
}

}  // namespace

TEST_CASE("a GLB cut anywhere is an error with its offset") {
    const auto glb = small_glb();
    REQUIRE(check(glb));
    for (std::size_t length = 0; length < glb.size(); ++length) {
        const std::vector<std::byte> cut(glb.begin(), glb.begin() + std::ptrdiff_t(length));
        const auto out = parse_gltf(cut, "");
        REQUIRE_FALSE(out.ok());
        REQUIRE(out.error().code == ErrorCode::kTruncated);
        REQUIRE(out.error().offset == length);
    }
    // Cut with a header that says so.
    for (std::size_t length = 12; length < glb.size(); ++length) {
        std::vector<std::byte> cut(glb.begin(), glb.begin() + std::ptrdiff_t(length));
        for (std::size_t i = 0; i < 4; ++i) cut[8 + i] = std::byte(length >> 8 * i & 0xff);
        REQUIRE_FALSE(check(cut));
    }
}

TEST_CASE("a JSON scene cut anywhere is an error with its line") {
    const auto text = rich().gltf();
    REQUIRE(check(text));
    for (std::size_t length = 0; length < text.size(); ++length) {
        const std::vector<std::byte> cut(text.begin(), text.begin() + std::ptrdiff_t(length));
        const auto out = parse_gltf(cut, "");
        REQUIRE_FALSE(out.ok());
        REQUIRE(out.error().offset <= length);
        if (length > 0) REQUIRE(out.error().line > 0);
    }
}

TEST_CASE("flipped bits give an error or a sound mesh") {
    std::mt19937 random(20260101);
    for (const auto& source : {small_glb(), rich().glb(), rich().gltf()}) {
        int read = 0;
        for (int i = 0; i < 3000; ++i) {
            auto broken = source;
            for (unsigned n = 1 + random() % 4; n > 0; --n)
                broken[random() % broken.size()] ^= std::byte(1u << random() % 8);
            read += check(broken);
        }
        CHECK(read > 0);  // Or the flips never get past the first check.
        CHECK(read < 3000);
    }
}

TEST_CASE("garbage bytes in the JSON give an error or a sound mesh") {
    std::mt19937 random(42);
    const std::string source = rich().with_buffer().dump();
    const auto bin = rich().bin;
    static const std::string structural = "{}[]\",:0123456789-.eE truefalsn\\u\x80\xff";
    for (int i = 0; i < 3000; ++i) {
        std::string text = source;
        const std::size_t at = random() % text.size(), length = 1 + random() % 8;
        for (std::size_t k = at; k < std::min(at + length, text.size()); ++k)
            text[k] = i % 2 == 0 ? char(random()) : structural[random() % structural.size()];
        if (i % 5 == 0) text.erase(at, random() % 20);
        check(GltfDocument::glb(text, bin));
    }
}

TEST_CASE("every number and every value of a document replaced by something else") {
    const GltfDocument source = rich();
    const json document = source.with_buffer();
    const std::vector<json> others = {-1,
                                      0,
                                      1,
                                      2,
                                      3,
                                      7,
                                      255,
                                      65535,
                                      4294967295u,
                                      4294967296,
                                      9007199254740992,
                                      18446744073709551615u,
                                      0.5,
                                      1e300,
                                      -1e300,
                                      nullptr,
                                      true,
                                      "x",
                                      json::array(),
                                      json::object(),
                                      json::array({0}),
                                      "VEC2",
                                      "MAT4"};
    int read = 0, all = 0;
    const json flat = document.flatten();
    for (const auto& [pointer, value] : flat.items())
        for (const json& other : others) {
            json broken = document;
            broken[json::json_pointer(pointer)] = other;
            read += check(GltfDocument::glb(broken.dump(), source.bin));
            ++all;
        }
    CHECK(read > 0);
    CHECK(read < all / 2);
    // And every object or array, all of it, gone.
    const std::function<void(const json::json_pointer&)> walk = [&](const json::json_pointer& at) {
        const json& here = document[at];
        if (!here.is_structured()) return;
        for (const auto& [key, value] : here.items()) {
            const auto inner = here.is_array() ? at / std::size_t(std::stoul(key)) : at / key;
            for (const json& other : {json(nullptr), json::array(), json::object(), json("x")}) {
                json broken = document;
                broken[inner] = other;
                check(GltfDocument::glb(broken.dump(), source.bin));
            }
            json broken = document;
            if (here.is_array())
                broken[at].erase(std::stoul(key));
            else
                broken[at].erase(key);
            check(GltfDocument::glb(broken.dump(), source.bin));
            walk(inner);
        }
    };
    walk(json::json_pointer());
}

TEST_CASE("errors name the object") {
    const auto message = [](const std::function<void(json&)>& change) {
        const GltfDocument source = rich();
        json document = source.with_buffer();
        change(document);
        const auto out = parse_gltf(GltfDocument::glb(document.dump(), source.bin), "");
        REQUIRE_FALSE(out.ok());
        return out.error().message;
    };
    CHECK(message([](json& d) { d["meshes"][1]["primitives"][0]["indices"] = 99; }) ==
          "meshes[1].primitives[0].indices names accessors[99], which does not exist");
    CHECK(message([](json& d) { d["meshes"][1]["primitives"][0]["indices"] = "x"; }) ==
          "meshes[1].primitives[0].indices must be an index");
    CHECK(message([](json& d) { d["accessors"][0].erase("count"); }) == "accessors[0].count is missing");
    CHECK(message([](json& d) {
              d["nodes"][0]["scale"] = {1, 2};
          }) == "nodes[0].scale must be an array of 3 numbers");
    CHECK(message([](json& d) { d["accessors"][0]["count"] = 5; }) ==
          "meshes[1].primitives[0].attributes.POSITION (accessors[0]): 5 elements do not fit into the 48 "
          "bytes of bufferViews[0]");
    CHECK(message([](json& d) { d["accessors"][0]["componentType"] = 5130; }) ==
          "meshes[1].primitives[0].attributes.POSITION (accessors[0]): component type 5130 is not one of "
          "glTF's");
    CHECK(message([](json& d) {
              d["bufferViews"][0]["byteOffset"] = 9007199254740992;
          }).find("bufferViews[0] reaches beyond the") != std::string::npos);
    CHECK(message([](json& d) { d["accessors"][0]["count"] = 3; }) ==
          "meshes[1].primitives[0].indices: index 5 names vertex 3 of 3");
    CHECK(message([](json& d) { d["meshes"][0]["primitives"][0]["mode"] = 9; }) ==
          "meshes[0].primitives[0].mode 9 is not one of glTF's");
    CHECK(message([](json& d) { d["asset"]["version"] = "1.0"; }) == "glTF version '1.0', only 2 is read");
    CHECK(message([](json& d) { d["buffers"][0]["byteLength"] = 1000000; }).find("buffers[0] has") == 0);
    // Whole numbers may be written with a point.
    const GltfDocument source = rich();
    json document = source.with_buffer();
    document["accessors"][0]["count"] = 4.0;
    CHECK(check(GltfDocument::glb(document.dump(), source.bin)));
}

TEST_CASE("JSON that nests without end") {
    for (const std::string open : {"[", "{\"a\":"}) {
        std::string text = "{\"asset\":{\"version\":\"2.0\"},\"extras\":";
        const std::size_t start = text.size();
        for (int i = 0; i < 200000; ++i) text += open;
        const auto out = parse_gltf(GltfDocument::bytes(text), "");
        REQUIRE_FALSE(out.ok());
        CHECK(out.error().code == ErrorCode::kLimit);
        CHECK(out.error().offset > start);
    }
    // Brackets in strings are none.
    CHECK(check([] {
        GltfDocument document = rich();
        document.root["asset"]["generator"] = std::string(1000, '[') + "\\\"" + std::string(1000, '{');
        return document.glb();
    }()));
}

TEST_CASE("GLB containers with parts in the wrong place") {
    const GltfDocument document = rich();
    const auto good = document.glb();
    const auto with = [&](std::size_t at, std::uint32_t value) {
        auto out = good;
        for (std::size_t i = 0; i < 4; ++i) out[at + i] = std::byte(value >> 8 * i & 0xff);
        const auto result = parse_gltf(out, "");
        REQUIRE_FALSE(result.ok());
        return result.error();
    };
    CHECK(with(4, 1).code == ErrorCode::kUnsupported);
    CHECK(with(8, std::uint32_t(good.size()) - 4).code == ErrorCode::kMalformed);
    CHECK(with(8, std::uint32_t(good.size()) + 4).code == ErrorCode::kTruncated);
    CHECK(with(12, 0xffffffff).describe() == "GLB: a chunk of 4294967295 bytes does not fit (offset 12)");
    CHECK(with(12, 5).code == ErrorCode::kMalformed);
    CHECK(with(16, 0x004E4942).describe() == "GLB: the first chunk is not JSON (offset 16)");
    CHECK(with(20, 0x20202020).describe().find("JSON: ") == 0);
    const auto error = parse_gltf(GltfDocument::bytes("{\n \"asset\": {,}}"), "").error();
    CHECK(error.line == 2);
    CHECK(error.offset == 13);
}

TEST_CASE("other formats under a glTF name") {
    for (const std::string text : {"", "g", "glT", "ply\nformat ascii 1.0\n", "OFF\n0 0 0\n", "solid x\n",
                                   "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "{}", "[]", "{\"asset\":{}}",
                                   "null", "\xEF\xBB\xBF", "   ", "\x89PNG\r\n\x1a\n"}) {
        CAPTURE(text);
        const auto out = parse_gltf(GltfDocument::bytes(text), "");
        REQUIRE_FALSE(out.ok());
        CHECK_FALSE(out.error().message.empty());
    }
    std::mt19937 random(5);
    for (int i = 0; i < 500; ++i) {
        std::vector<std::byte> noise(random() % 300);
        for (std::byte& b : noise) b = std::byte(random() & 0xff);
        REQUIRE_FALSE(check(noise));
        if (noise.size() > 4) std::memcpy(noise.data(), "glTF", 4);
        REQUIRE_FALSE(check(noise));
    }
}

TEST_CASE("a scene without triangles is an error") {
    GltfDocument document;
    document.scene_of(
        {{"attributes", {{"POSITION", document.floats({0, 0, 0, 1, 0, 0, 0, 1, 0})}}}, {"mode", 1}});
    const auto out = parse_gltf(document.glb(), "");
    REQUIRE_FALSE(out.ok());
    CHECK(out.error().code == ErrorCode::kMalformed);
    CHECK_FALSE(check(GltfDocument::bytes(R"({"asset":{"version":"2.0"}})")));
}
