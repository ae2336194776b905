// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <random>

#include "gltf_scene.hpp"

using namespace vsplit;
using namespace vsplit::bake;
using namespace vsplit::test;

namespace {

const std::vector<std::byte> kStream =
    GltfDocument::bytes("these bytes stand for a .pmesh, nobody here reads them");

std::vector<std::byte> progressive(const Scene& scene, const GltfLevel& shown,
                                   const SceneFormat& format = {}) {
    auto glb = encode_progressive_scene(scene, shown, kStream, format);
    INFO((glb.ok() ? std::string() : glb.error().message));
    REQUIRE(glb.ok());
    return std::move(*glb);
}

}  // namespace

TEST_CASE("a progressive GLB shows a level, carries the stream, and gives the scene back") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    const auto levels = levels_of(scene, 3);
    for (const int packing : {0, 1, 2}) {
        SceneFormat format;
        format.meshopt = packing == 1;
        format.draco = packing == 2;
        const std::vector<std::byte> glb = progressive(scene, levels[2], format);
        const auto found = find_progressive(glb);
        REQUIRE(found.ok());
        REQUIRE(found->has_value());
        const CarriedStream at = **found;
        REQUIRE(at.bytes == kStream.size());
        REQUIRE(std::equal(kStream.begin(), kStream.end(), glb.begin() + long(at.offset)));
        // What any viewer sees, and what comes before the stream.
        REQUIRE(scene_of(glb).mesh.triangles.size() == levels[2].mesh.triangles.size());
        const json d = json_of_glb(glb);
        const std::size_t own = d["extensions"]["VSPLIT_progressive_mesh"]["bufferView"];
        for (std::size_t v = 0; v < d["bufferViews"].size(); ++v)
            if (v != own && d["bufferViews"][v]["buffer"] == 0)
                REQUIRE(d["bufferViews"][v].value("byteOffset", 0u) <
                        d["bufferViews"][own]["byteOffset"].get<unsigned>());
        // The scene behind it writes what the first one writes.
        const auto back = parse_progressive_scene(glb);
        INFO((back.ok() ? std::string() : back.error().message));
        REQUIRE(back.ok());
        REQUIRE(back->unit == scene.unit);
        REQUIRE(back->radius == scene.radius);
        for (const std::size_t count : {1, 3}) {
            const auto a = encoded(scene, levels_of(scene, count)),
                       b = encoded(*back, levels_of(scene, count));
            json x = json_of_glb(a), y = json_of_glb(b);
            // Numbers of accessors and views may differ; nothing else does.
            const Scene p = scene_of(a), q = scene_of(b);
            REQUIRE(p.mesh.triangles == q.mesh.triangles);
            REQUIRE(p.mesh.attributes == q.mesh.attributes);
            for (const char* key : {"nodes", "materials", "scenes"}) REQUIRE(x[key] == y[key]);
            REQUIRE(x.value("extensionsUsed", json()) == y.value("extensionsUsed", json()));
            REQUIRE(!y.contains("extensions"));
            REQUIRE(x["meshes"].size() == y["meshes"].size());
            for (json* j : {&x, &y})
                for (json& mesh : (*j)["meshes"])
                    for (json& primitive : mesh["primitives"])
                        for (const char* key : {"attributes", "targets", "indices"}) primitive.erase(key);
            REQUIRE(x["meshes"] == y["meshes"]);
            REQUIRE(b.size() < a.size() + kStream.size() + 400);
        }
    }
}

TEST_CASE("a mesh that the level shown lacks is there with one triangle, and whole again afterwards") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    const auto shown = levels_of(scene, 1, {{0, 0}, {1, 0}});
    const std::vector<std::byte> glb = progressive(scene, shown[0]);
    const json d = json_of_glb(glb);
    REQUIRE(d["nodes"][2]["skin"] == 0);
    REQUIRE(d["meshes"][0]["primitives"].size() == 1);
    REQUIRE(scene_of(glb).mesh.triangles.size() == 33);
    const auto back = parse_progressive_scene(glb);
    REQUIRE(back.ok());
    REQUIRE(scene_of(encoded(*back, levels_of(scene, 1))).mesh.attributes == scene.mesh.attributes);
}

TEST_CASE("a beginning that holds the JSON says where the stream is") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    const std::vector<std::byte> glb = progressive(scene, levels_of(scene, 1)[0]);
    std::uint32_t length = 0;
    std::memcpy(&length, glb.data() + 12, 4);
    const auto whole = find_progressive(glb);
    const auto part = find_progressive(std::span(glb).first(20 + length));
    REQUIRE(part.ok());
    REQUIRE((*part)->offset == (*whole)->offset);
    REQUIRE(find_progressive(std::span(glb).first(19 + length)).error().code == ErrorCode::kTruncated);
    // Other files have none.
    for (const std::vector<std::byte>& other :
         {rich.document.glb(), rich.document.gltf(), std::vector<std::byte>(), GltfDocument::bytes("glTF"),
          GltfDocument::bytes("ply\nformat")}) {
        const auto none = find_progressive(other);
        REQUIRE(none.ok());
        REQUIRE(!none->has_value());
    }
}

TEST_CASE("a progressive GLB is not quantised, and needs all meshes") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    SceneFormat format;
    format.quantised = true;
    REQUIRE(encode_progressive_scene(scene, levels_of(scene, 1)[0], kStream, format).error().code ==
            ErrorCode::kArgument);
}

TEST_CASE("a stream's description that lies is refused") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    const std::vector<std::byte> glb = progressive(scene, levels_of(scene, 2)[1]);
    std::uint32_t length = 0;
    std::memcpy(&length, glb.data() + 12, 4);
    const std::vector<std::byte> bin(glb.begin() + 28 + length, glb.end());
    const auto with = [&](const std::string& pointer, const json& value) {
        json d = json_of_glb(glb);
        d[json::json_pointer("/extensions/VSPLIT_progressive_mesh" + pointer)] = value;
        return GltfDocument::glb(d.dump(), bin);
    };
    const auto code = [&](const std::string& pointer, const json& value) {
        const auto read = parse_progressive_scene(with(pointer, value));
        CAPTURE(pointer, value);
        REQUIRE(!read.ok());
        return read.error().code;
    };
    for (const json& bad : {json(-1), json("x"), json(1e9), json(nullptr), json::array({1}), json::object()})
        for (const char* where :
             {"/meshes/0/mesh", "/meshes/0/exponent", "/meshes/0/primitives", "/meshes/0/primitives/0/group",
              "/meshes/0/primitives/0/index", "/meshes/0/primitives/0/shown",
              "/meshes/0/primitives/0/position", "/meshes/0/primitives/0/attributes",
              "/meshes/0/primitives/0/attributes/0/attribute", "/meshes/0/primitives/0/attributes/0/type",
              "/meshes/0/primitives/0/attributes/0/componentType", "/attributes/0/components", "/meshes"}) {
            if (bad == json(-1) && std::string(where) == "/meshes/0/exponent") continue;  // a fair one
            REQUIRE(code(where, bad) == ErrorCode::kMalformed);
        }
    REQUIRE(code("/meshes/1/mesh", 0) == ErrorCode::kMalformed);
    REQUIRE(code("/meshes/0/primitives/0/index", 1) == ErrorCode::kMalformed);
    REQUIRE(code("/meshes/0/primitives/1/group", 0) == ErrorCode::kMalformed);
    REQUIRE(code("/meshes/0/primitives/1/shown", 0) == ErrorCode::kMalformed);
    REQUIRE(code("/attributes/0/name", "TANGENT") == ErrorCode::kMalformed);
    REQUIRE(code("/attributes/7/name", "999999/POSITION") == ErrorCode::kMalformed);
    REQUIRE(code("/attributes/0/components", 2) == ErrorCode::kMalformed);
    REQUIRE(code("/unit", 0) == ErrorCode::kMalformed);
    for (const json& bad : {json(99999), json(-1), json("x")})
        REQUIRE(find_progressive(with("/bufferView", bad)).error().code == ErrorCode::kMalformed);
}

TEST_CASE("bits flipped in scenes end in an answer") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    SceneFormat draco, meshopt;
    draco.draco = true;
    meshopt.meshopt = true;
    std::mt19937 random(5);
    for (const std::vector<std::byte>& good :
         {rich.document.glb(), progressive(scene, levels_of(scene, 2)[1]),
          encoded(scene, levels_of(scene, 2), draco), encoded(scene, levels_of(scene, 2), meshopt)}) {
        for (int round = 0; round < 150; ++round) {
            std::vector<std::byte> bad = good;
            for (int flips = 1 + round % 3; flips > 0; --flips)
                bad[random() % bad.size()] ^= std::byte(1u << random() % 8);
            if (round % 5 == 4) bad.resize(random() % bad.size());
            const auto found = find_progressive(bad);
            const auto around = parse_progressive_scene(bad);
            const auto read = parse_scene(bad, "");
            for (const Scene* made : {around.ok() ? &*around : nullptr, read.ok() ? &*read : nullptr}) {
                if (made == nullptr) continue;
                const GltfLevel level{made->mesh, 0};
                const auto written = encode_scene(*made, {&level, 1});
                REQUIRE((written.ok() || !written.error().message.empty()));
            }
        }
    }
}
