// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A scene with some of everything, for the tests of scenes.
#pragma once

#include <catch2/catch.hpp>
#include <cmath>

#include "gltf_document.hpp"
#include "vsplit/bake/scene.hpp"

namespace vsplit::test {

/// (n + 1)^2 vertices of a bumpy square, two triangles a cell.
struct Sheet {
    std::vector<float> positions, normals, tangents, uvs;
    std::vector<std::uint16_t> corners;
    std::size_t vertices = 0;

    explicit Sheet(std::uint16_t n = 4) {
        for (int i = 0; i <= n; ++i)
            for (int j = 0; j <= n; ++j) {
                const float u = float(j) / float(n), v = float(i) / float(n);
                positions.insert(positions.end(), {u, v, 0.25f * u * v});
                normals.insert(normals.end(), {0, 0, 1});
                tangents.insert(tangents.end(), {1, 0, 0, j % 2 == 0 ? 1.0f : -1.0f});
                uvs.insert(uvs.end(), {u, v});
                ++vertices;
            }
        for (std::uint16_t i = 0; i < n; ++i)
            for (std::uint16_t j = 0; j < n; ++j) {
                const auto a = std::uint16_t(i * (n + 1) + j), b = std::uint16_t(a + n + 1);
                for (const std::uint16_t c :
                     {a, std::uint16_t(a + 1), std::uint16_t(b + 1), a, std::uint16_t(b + 1), b})
                    corners.push_back(c);
            }
    }
};

/// Two meshes: a skinned, morphing one of two primitives, one of a single primitive used twice, with a line
/// beside it.
struct RichScene {
    GltfDocument document;
    std::size_t skinned = 0, plain = 0;

    RichScene() {
        GltfDocument& d = document;
        const Sheet sheet;
        const std::size_t n = sheet.vertices;
        std::vector<std::uint8_t> joints, weights, colours;
        std::vector<float> rise, heat;
        for (std::size_t v = 0; v < n; ++v) {
            const auto w = std::uint8_t(255 * v / (n - 1));
            for (const int j : {0, w > 0 ? 1 : 0, 0, 0}) joints.push_back(std::uint8_t(j));
            for (const int x : {255 - w, int(w), 0, 0}) weights.push_back(std::uint8_t(x));
            for (const int c : {int(w), 255 - w, 7, 0}) colours.push_back(std::uint8_t(c));
            for (const float x : {0.0f, 0.0f, 0.125f * float(v)}) rise.push_back(x);
            heat.push_back(float(v));
        }
        const std::size_t position = d.floats(sheet.positions), normal = d.floats(sheet.normals);
        const json bounded = {{"min", {0, 0, 0}}, {"max", {1, 1, 0.25}}};
        d.root["accessors"][position].update(bounded);
        const std::size_t uv = d.floats(sheet.uvs, "VEC2", 2);
        const std::size_t half = sheet.corners.size() / 2;
        const std::vector<std::uint16_t> first(sheet.corners.begin(), sheet.corners.begin() + long(half)),
            second(sheet.corners.begin() + long(half), sheet.corners.end());
        const std::size_t colour = d.accessor(colours, 5121, "VEC3", n, {{"normalized", true}});
        d.root["bufferViews"][d.root["accessors"][colour]["bufferView"].get<std::size_t>()]["byteStride"] = 4;
        const json skin_attributes = {
            {"JOINTS_0", d.accessor(joints, 5121, "VEC4", n)},
            {"WEIGHTS_0", d.accessor(weights, 5121, "VEC4", n, {{"normalized", true}})}};
        json a = {{"POSITION", position},
                  {"NORMAL", normal},
                  {"TANGENT", d.floats(sheet.tangents, "VEC4", 4)},
                  {"TEXCOORD_0", uv}};
        json b = {{"POSITION", position},
                  {"NORMAL", normal},
                  {"COLOR_0", colour},
                  {"_HEAT", d.floats(heat, "SCALAR", 1)}};
        a.update(skin_attributes);
        b.update(skin_attributes);
        const std::size_t offset = d.floats(rise);
        d.root["accessors"][offset].update({{"min", {0, 0, 0}}, {"max", {0, 0, 3}}});
        const json targets = json::array({{{"POSITION", offset}}, {{"NORMAL", normal}}});
        skinned = d.add("meshes", {{"name", "skinned"},
                                   {"weights", {0, 1}},
                                   {"extras", {{"targetNames", {"rise", "turn"}}}},
                                   {"primitives",
                                    {{{"attributes", a},
                                      {"indices", d.shorts(first)},
                                      {"targets", targets},
                                      {"material", 0},
                                      {"extensions", {{"ACME_stripes", {{"count", 3}}}}}},
                                     {{"attributes", b},
                                      {"indices", d.shorts(second)},
                                      {"targets", targets},
                                      {"extras", {{"side", "far"}}}}}}});
        const std::size_t line = d.floats({0, 0, 0, 1, 1, 1});
        d.root["accessors"][line].update({{"min", {0, 0, 0}}, {"max", {1, 1, 1}}});
        plain = d.add("meshes", {{"primitives",
                                  {{{"attributes", {{"POSITION", line}}}, {"mode", 1}},
                                   {{"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv}}},
                                    {"indices", d.shorts(sheet.corners)}}}}});
        d.root["materials"] = {
            {{"name", "cloth"}, {"extensions", {{"KHR_materials_sheen", json::object()}}}}};
        d.root["extensionsUsed"] = {"KHR_materials_sheen", "ACME_stripes"};
        d.root["nodes"] = {{{"name", "hip"}, {"children", {1}}},
                           {{"name", "knee"}, {"translation", {0, 1, 0}}},
                           {{"mesh", skinned}, {"skin", 0}, {"weights", {0.5, 0}}},
                           {{"mesh", plain}, {"name", "small"}, {"scale", {0.01, 0.01, 0.01}}},
                           {{"mesh", plain},
                            {"name", "large"},
                            {"translation", {3, 0, 0}},
                            {"scale", {5, 5, 5}},
                            {"children", {5}}},
                           {{"name", "lamp"}, {"extras", 7}}};
        const std::vector<float> inverse = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                                            1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1};
        d.root["skins"] = {{{"joints", {0, 1}}, {"inverseBindMatrices", d.floats(inverse, "MAT4", 16)}}};
        const std::size_t times = d.floats({0, 1}, "SCALAR", 1);
        d.root["accessors"][times].update({{"min", {0}}, {"max", {1}}});
        d.root["animations"] = {
            {{"samplers", {{{"input", times}, {"output", d.floats({0, 0, 1, 1}, "SCALAR", 1)}}}},
             {"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "weights"}}}}}}}};
        d.scene({0, 2, 3, 4});
    }
};

inline bake::Scene scene_of(std::span<const std::byte> bytes) {
    auto scene = bake::parse_scene(bytes, "");
    INFO((scene.ok() ? std::string() : scene.error().message));
    REQUIRE(scene.ok());
    REQUIRE(mesh_fault(scene->mesh) == nullptr);
    return std::move(*scene);
}

/// The finest level is the scene's mesh; of each coarser one a quarter of the triangles is left, and none of
/// the groups in `without` from its level on.
inline std::vector<bake::GltfLevel> levels_of(
    const bake::Scene& scene, std::size_t count,
    const std::vector<std::pair<std::uint32_t, std::size_t>>& without = {}) {
    std::vector<bake::GltfLevel> out;
    std::size_t step = 1;
    for (std::size_t k = 0; k < count; ++k, step *= 4) {
        Mesh mesh = scene.mesh;
        mesh.triangles.clear();
        mesh.groups.clear();
        std::vector<std::size_t> seen(scene.primitives.size(), 0);
        for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
            const std::uint32_t group = scene.mesh.groups[t];
            bool gone = seen[group]++ % step != 0;
            for (const auto& [g, level] : without) gone = gone || (g == group && k >= level);
            if (gone) continue;
            mesh.triangles.push_back(scene.mesh.triangles[t]);
            mesh.groups.push_back(group);
        }
        out.push_back({std::move(mesh), 0.001 * double(k)});
    }
    return out;
}

inline std::vector<std::byte> encoded(const bake::Scene& scene, const std::vector<bake::GltfLevel>& levels,
                                      const bake::SceneFormat& format = {}) {
    auto glb = bake::encode_scene(scene, levels, format);
    INFO((glb.ok() ? std::string() : glb.error().message));
    REQUIRE(glb.ok());
    return std::move(*glb);
}

inline json json_of_glb(const std::vector<std::byte>& glb) {
    std::uint32_t length = 0;
    std::memcpy(&length, glb.data() + 12, 4);
    return json::parse(std::string(reinterpret_cast<const char*>(glb.data()) + 20, length));
}

/// The bytes of an accessor without stride or sparse part.
inline std::vector<std::byte> accessor_bytes(const std::vector<std::byte>& glb, const json& document,
                                             std::size_t accessor, std::size_t element) {
    const json& a = document["accessors"][accessor];
    const json& view = document["bufferViews"][a["bufferView"].get<std::size_t>()];
    std::uint32_t length = 0;
    std::memcpy(&length, glb.data() + 12, 4);
    const std::size_t at =
        28 + length + view["byteOffset"].get<std::size_t>() + a.value("byteOffset", std::size_t{0});
    const std::size_t size = a["count"].get<std::size_t>() * element;
    REQUIRE(at + size <= glb.size());
    return {glb.begin() + long(at), glb.begin() + long(at + size)};
}

}  // namespace vsplit::test
