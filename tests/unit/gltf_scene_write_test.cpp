// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <set>

#include "gltf_scene.hpp"

using namespace vsplit;
using namespace vsplit::bake;
using namespace vsplit::test;

namespace {

bool same_mesh(const Mesh& a, const Mesh& b) {
    return a.triangles == b.triangles && a.groups == b.groups && a.attributes == b.attributes &&
           a.positions.size() == b.positions.size() &&
           std::memcmp(a.positions.data(), b.positions.data(), a.positions.size() * sizeof(Float3)) == 0;
}

/// Triangles by the bits of their corners' positions, whatever the order of vertices and triangles.
std::multiset<std::vector<float>> corner_set(const Mesh& mesh) {
    std::multiset<std::vector<float>> out;
    for (const Triangle& t : mesh.triangles) {
        std::vector<std::vector<float>> corners;
        for (const std::uint32_t v : t) {
            std::vector<float> row = {mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z};
            for (const Attribute& a : mesh.attributes)
                row.insert(row.end(), a.values.begin() + long(a.components * v),
                           a.values.begin() + long(a.components * (v + 1)));
            corners.push_back(row);
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        std::vector<float> all;
        for (const auto& row : corners) all.insert(all.end(), row.begin(), row.end());
        out.insert(all);
    }
    return out;
}

std::vector<float> floats_of(const std::vector<std::byte>& glb, std::size_t accessor,
                             std::size_t components) {
    const json document = json_of_glb(glb);
    const auto bytes = accessor_bytes(glb, document, accessor, 4 * components);
    std::vector<float> out(bytes.size() / 4);
    std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
}

}  // namespace

TEST_CASE("a scene at its finest level is written as it was read, bit for bit") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    REQUIRE(same_mesh(scene_of(encoded(scene, levels_of(scene, 1))).mesh, scene.mesh));
    SceneFormat meshopt;
    meshopt.meshopt = true;
    const Scene back = scene_of(encoded(scene, levels_of(scene, 1), meshopt));
    REQUIRE(corner_set(back.mesh) == corner_set(scene.mesh));
    REQUIRE(encoded(scene, levels_of(scene, 1)) == encoded(scene, levels_of(scene, 1)));
}

TEST_CASE("what is not triangles passes through") {
    const RichScene rich;
    const std::vector<std::byte> in = rich.document.glb();
    const Scene scene = scene_of(in);
    for (const bool several : {false, true}) {
        const std::vector<std::byte> out = encoded(scene, levels_of(scene, several ? 3 : 1));
        const json before = json_of_glb(in), after = json_of_glb(out);
        for (const char* key : {"asset", "scene", "materials"}) REQUIRE(after[key] == before[key]);
        REQUIRE(after["meshes"][0]["extras"] == before["meshes"][0]["extras"]);
        REQUIRE(after["meshes"][0]["weights"] == before["meshes"][0]["weights"]);
        const json& first = after["meshes"][0]["primitives"][0];
        REQUIRE(first["extensions"]["ACME_stripes"]["count"] == 3);
        REQUIRE(first["material"] == 0);
        REQUIRE(after["meshes"][0]["primitives"][1]["extras"]["side"] == "far");
        for (const std::size_t n : {0, 1, 5}) REQUIRE(after["nodes"][n] == before["nodes"][n]);
        // The line, the skin's matrices and the animation have the same bytes, wherever they are.
        const auto same = [&](const json& a, const json& b, std::size_t size) {
            REQUIRE(accessor_bytes(in, before, a.get<std::size_t>(), size) ==
                    accessor_bytes(out, after, b.get<std::size_t>(), size));
        };
        same(before["meshes"][1]["primitives"][0]["attributes"]["POSITION"],
             after["meshes"][1]["primitives"][0]["attributes"]["POSITION"], 12);
        REQUIRE(after["meshes"][1]["primitives"][0]["mode"] == 1);
        same(before["skins"][0]["inverseBindMatrices"], after["skins"][0]["inverseBindMatrices"], 64);
        REQUIRE(after["skins"][0]["joints"] == before["skins"][0]["joints"]);
        for (const char* key : {"input", "output"})
            same(before["animations"][0]["samplers"][0][key], after["animations"][0]["samplers"][0][key], 4);
        REQUIRE(after["animations"][0]["channels"][0] == before["animations"][0]["channels"][0]);
    }
}

TEST_CASE("each primitive keeps its own attributes and their types") {
    const RichScene rich;
    const std::vector<std::byte> in = rich.document.glb();
    const Scene scene = scene_of(in);
    const json before = json_of_glb(in), after = json_of_glb(encoded(scene, levels_of(scene, 2)));
    for (const auto& [m, p] : {std::pair<std::size_t, std::size_t>{0, 0}, {0, 1}, {1, 1}}) {
        const json& a = before["meshes"][m]["primitives"][p];
        const json& b = after["meshes"][m]["primitives"][p];
        REQUIRE(b["attributes"].size() == a["attributes"].size());
        for (const auto& [name, number] : a["attributes"].items()) {
            const json& x = before["accessors"][number.get<std::size_t>()];
            const json& y = after["accessors"][b["attributes"][name].get<std::size_t>()];
            for (const char* key : {"componentType", "type"}) REQUIRE(x[key] == y[key]);
            REQUIRE(x.value("normalized", false) == y.value("normalized", false));
        }
        REQUIRE(b.contains("targets") == a.contains("targets"));
        if (a.contains("targets")) {
            REQUIRE(b["targets"].size() == 2);
            REQUIRE(b["targets"][0].contains("POSITION"));
            REQUIRE(b["targets"][1].contains("NORMAL"));
            REQUIRE(!b["targets"][1].contains("POSITION"));
        }
    }
}

TEST_CASE("levels hang on the nodes that show the meshes") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    const std::vector<std::byte> glb = encoded(scene, levels_of(scene, 3));
    const json d = json_of_glb(glb);
    REQUIRE(d["scenes"][0]["nodes"] == json({0, 2, 3, 4}));
    // Node 2 is skinned and node 3 plain: they carry their levels. Node 4 has a child: a new one carries
    // them.
    for (const std::size_t n : {2, 3}) REQUIRE(d["nodes"][n].contains("mesh"));
    REQUIRE(!d["nodes"][4].contains("mesh"));
    const std::size_t child = d["nodes"][4]["children"][1];
    REQUIRE(child >= 6);
    REQUIRE(d["nodes"][4]["children"][0] == 5);
    std::set<std::size_t> levels;
    for (const std::size_t n : {std::size_t(2), std::size_t(3), child}) {
        const json& node = d["nodes"][n];
        const json& ids = node["extensions"]["MSFT_lod"]["ids"];
        REQUIRE(ids.size() == 2);
        const std::vector<double> coverage = node["extras"]["MSFT_screencoverage"];
        REQUIRE(coverage.size() == 3);
        REQUIRE(coverage[0] > coverage[1]);
        REQUIRE(coverage[1] > coverage[2]);
        REQUIRE(coverage[2] == 0);
        std::size_t triangles = SIZE_MAX;
        for (const json& id : ids) {
            const json& level = d["nodes"][id.get<std::size_t>()];
            REQUIRE(levels.insert(id.get<std::size_t>()).second);
            for (const char* key : {"scale", "translation", "rotation", "matrix", "skin", "weights"})
                REQUIRE(level.value(key, json()) == node.value(key, json()));
            REQUIRE(!level.contains("children"));
            std::size_t here = 0;
            for (const json& primitive : d["meshes"][level["mesh"].get<std::size_t>()]["primitives"])
                if (primitive.contains("indices"))
                    here +=
                        d["accessors"][primitive["indices"].get<std::size_t>()]["count"].get<std::size_t>() /
                        3;
            REQUIRE(here > 0);
            REQUIRE(here < triangles);
            triangles = here;
        }
    }
    // Both places of the mesh share its levels.
    REQUIRE(d["meshes"].size() == 2 + 4);
    // No level is in a scene, and weights are animated at each.
    for (const json& node : d["nodes"])
        for (const json& c : node.value("children", json::array()))
            REQUIRE(levels.count(c.get<std::size_t>()) == 0);
    std::multiset<std::size_t> animated;
    for (const json& channel : d["animations"][0]["channels"])
        animated.insert(channel["target"]["node"].get<std::size_t>());
    REQUIRE(animated.size() == 3);
    REQUIRE(animated.count(2) == 1);
    for (const json& id : d["nodes"][2]["extensions"]["MSFT_lod"]["ids"])
        REQUIRE(animated.count(id.get<std::size_t>()) == 1);
    // Our reader takes the finest level.
    REQUIRE(same_mesh(scene_of(glb).mesh, scene.mesh));
}

TEST_CASE("a node that moves gets a child to carry the levels") {
    RichScene rich;
    json& animation = rich.document.root["animations"][0];
    animation["channels"].push_back({{"sampler", 0}, {"target", {{"node", 3}, {"path", "scale"}}}});
    const Scene scene = scene_of(rich.document.glb());
    const json d = json_of_glb(encoded(scene, levels_of(scene, 2)));
    REQUIRE(!d["nodes"][3].contains("mesh"));
    const json& child = d["nodes"][d["nodes"][3]["children"][0].get<std::size_t>()];
    REQUIRE(child.contains("mesh"));
    REQUIRE(!child.contains("scale"));
    REQUIRE(child["extensions"]["MSFT_lod"]["ids"].size() == 1);
    REQUIRE(d["nodes"][3]["scale"] == json({0.01, 0.01, 0.01}));
}

TEST_CASE("a primitive that has vanished is left out, a mesh that has vanished ends its levels") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    // Group 1 goes at level 1, group 0, the same mesh's last, at level 2.
    const json d = json_of_glb(encoded(scene, levels_of(scene, 3, {{1, 1}, {0, 2}})));
    const json& skinned = d["nodes"][2];
    REQUIRE(skinned["extensions"]["MSFT_lod"]["ids"].size() == 1);
    const std::vector<double> coverage = skinned["extras"]["MSFT_screencoverage"];
    REQUIRE(coverage.size() == 2);
    REQUIRE(coverage[1] > 0);  // below this it need not be seen
    const json& level = d["nodes"][skinned["extensions"]["MSFT_lod"]["ids"][0].get<std::size_t>()];
    const json& mesh = d["meshes"][level["mesh"].get<std::size_t>()];
    REQUIRE(mesh["primitives"].size() == 1);
    REQUIRE(mesh["primitives"][0]["material"] == 0);
    for (const json& m : d["meshes"]) REQUIRE(!m["primitives"].empty());
}

TEST_CASE("a mesh that is not there at all takes its skin, weights and their animation along") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    const std::vector<std::byte> glb = encoded(scene, levels_of(scene, 1, {{0, 0}, {1, 0}}));
    const json d = json_of_glb(glb);
    REQUIRE(d["meshes"].size() == 1);
    REQUIRE(d["nodes"].size() == 6);
    REQUIRE(d["nodes"][2].empty());
    REQUIRE(d["nodes"][3]["mesh"] == 0);
    REQUIRE(!d.contains("animations"));
    REQUIRE(scene_of(glb).mesh.triangles.size() == 32);
    // Where nothing at all is left, neither is a mesh or a buffer that is empty.
    GltfDocument bare;
    bare.scene_of({{"attributes", {{"POSITION", bare.floats({0, 0, 0, 1, 0, 0, 0, 1, 0})}}}});
    const Scene one = scene_of(bare.glb());
    const json nothing = json_of_glb(encoded(one, levels_of(one, 1, {{0, 0}})));
    for (const char* key : {"meshes", "buffers", "bufferViews", "accessors"}) REQUIRE(!nothing.contains(key));
}

TEST_CASE("levels can share vertices, if these stay as they are") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    SceneFormat format;
    format.shared_vertices = true;
    auto levels = levels_of(scene, 3);
    const std::vector<std::byte> glb = encoded(scene, levels, format);
    const json d = json_of_glb(glb);
    for (const auto& [finest, coarser] : {std::pair<std::size_t, std::size_t>{0, 2}, {1, 3}, {0, 4}, {1, 5}})
        for (std::size_t p = 0; p < d["meshes"][finest]["primitives"].size(); ++p) {
            const json& a = d["meshes"][finest]["primitives"][p];
            const json& b = d["meshes"][coarser]["primitives"][p];
            REQUIRE(a["attributes"] == b["attributes"]);
            if (a.contains("indices")) REQUIRE(a["indices"] != b["indices"]);
        }
    REQUIRE(same_mesh(scene_of(glb).mesh, scene.mesh));
    // Vertices go by what they are, not by their numbers; one that is new is added.
    const std::size_t before =
        d["accessors"][d["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<std::size_t>()]["count"];
    Mesh& coarse = levels[2].mesh;
    const std::uint32_t v = coarse.triangles[0][0], other = coarse.triangles[0][1];
    std::swap(coarse.positions[v], coarse.positions[other]);
    for (Attribute& a : coarse.attributes)
        for (std::size_t c = 0; c < a.components; ++c)
            std::swap(a.values[a.components * v + c], a.values[a.components * other + c]);
    const auto count = [&] {
        const json made = json_of_glb(encoded(scene, levels, format));
        return made["accessors"]
                   [made["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<std::size_t>()]["count"]
                       .get<std::size_t>();
    };
    REQUIRE(count() == before);
    coarse.positions[v].x += 1;
    REQUIRE(count() == before + 1);
}

TEST_CASE("mixed values are lawful again when they are written") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    auto levels = levels_of(scene, 1);
    for (Attribute& a : levels[0].mesh.attributes)
        for (std::size_t i = 0; i < a.values.size(); ++i) {
            if (a.semantic == Semantic::kNormal) a.values[i] *= i % 7 == 0 ? 0.0f : 0.5f;
            if (a.semantic == Semantic::kTangent) a.values[i] *= 0.3f;
            if (a.semantic == Semantic::kColor) a.values[i] = a.values[i] * 3 - 1;
            if (a.semantic == Semantic::kJointWeights) a.values[i] = a.values[i] * 0.7f - 0.01f;
            if (a.semantic == Semantic::kJoints && i % 4 == 2) a.values[i] = 1;  // twice
        }
    const Scene back = scene_of(encoded(scene, levels));
    for (std::size_t g = 0; g < 2; ++g)
        for (const StoredAttribute& stored : back.primitives[g].attributes) {
            const Attribute& a = back.mesh.attributes[stored.attribute];
            for (std::size_t t = 0; t < back.mesh.triangles.size(); ++t) {
                if (back.mesh.groups[t] != g) continue;
                for (const std::uint32_t v : back.mesh.triangles[t]) {
                    const float* x = a.values.data() + a.components * v;
                    if (a.semantic == Semantic::kNormal || a.semantic == Semantic::kTangent)
                        REQUIRE(double(x[0]) * x[0] + double(x[1]) * x[1] + double(x[2]) * x[2] ==
                                Approx(1).margin(1e-5));
                    if (a.semantic == Semantic::kTangent) REQUIRE(std::fabs(x[3]) == 1);
                    if (a.semantic == Semantic::kColor)
                        for (std::size_t c = 0; c < 3; ++c) REQUIRE((x[c] >= 0 && x[c] <= 1));
                    if (a.semantic == Semantic::kJointWeights) {
                        // Bytes: their sum is exactly 255.
                        int sum = 0;
                        for (std::size_t c = 0; c < 4; ++c) sum += int(std::lround(double(x[c]) * 255));
                        REQUIRE(sum == 255);
                        const float* joints =
                            back.mesh.attributes[stored.attribute - 1].values.data() + 4 * v;
                        std::set<float> used;
                        for (std::size_t c = 0; c < 4; ++c)
                            if (x[c] > 0)
                                REQUIRE(used.insert(joints[c]).second);
                            else
                                REQUIRE(joints[c] == 0);
                    }
                }
            }
        }
}

TEST_CASE("a mesh with a line keeps its positions when quantised") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    SceneFormat format;
    format.quantised = true;
    const json d = json_of_glb(encoded(scene, levels_of(scene, 1), format));
    REQUIRE(d["nodes"][4]["scale"] == json({5, 5, 5}));
    REQUIRE(d["nodes"][4]["mesh"] == 1);
    for (const json& primitive : d["meshes"][1]["primitives"])
        REQUIRE(d["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()]["componentType"] ==
                5126);
}

TEST_CASE("quantised scenes stand where they stood, within half a step") {
    RichScene rich;
    rich.document.root["meshes"][rich.plain]["primitives"].erase(0);
    const Scene scene = scene_of(rich.document.glb());
    SceneFormat format;
    format.quantised = true;
    const std::vector<std::byte> plain = encoded(scene, levels_of(scene, 2)),
                                 packed = encoded(scene, levels_of(scene, 2), format);
    const json d = json_of_glb(packed);
    REQUIRE(d["extensionsRequired"] == json({"KHR_mesh_quantization"}));
    // The unskinned meshes, in the world.
    const auto world = [](std::vector<std::byte> glb) {
        json document = json_of_glb(glb);
        std::uint32_t length = 0;
        std::memcpy(&length, glb.data() + 12, 4);
        document["nodes"][2].erase("mesh");
        document["nodes"][2].erase("skin");
        document["nodes"][2].erase("extensions");
        auto mesh =
            parse_gltf(GltfDocument::glb(document.dump(), {glb.begin() + 28 + length, glb.end()}), "");
        REQUIRE(mesh.ok());
        return std::move(mesh->mesh);
    };
    const Mesh a = world(plain), b = world(packed);
    REQUIRE(a.positions.size() == b.positions.size());
    for (std::size_t v = 0; v < a.positions.size(); ++v) {
        REQUIRE(a.positions[v].x == Approx(b.positions[v].x).margin(5.0 / 65535 / 2 + 1e-5));
        REQUIRE(a.positions[v].y == Approx(b.positions[v].y).margin(5.0 / 65535 / 2 + 1e-5));
        REQUIRE(a.positions[v].z == Approx(b.positions[v].z).margin(5.0 / 65535 / 2 + 1e-5));
    }
    // The skinned one, as its joints move it: inverse bind matrix times position, plus morph.
    const std::size_t accessor = d["meshes"][0]["primitives"][0]["attributes"]["POSITION"];
    REQUIRE(d["accessors"][accessor]["componentType"] == 5123);
    const std::vector<float> matrices = floats_of(packed, d["skins"][0]["inverseBindMatrices"], 16);
    REQUIRE(matrices.size() == 32);
    const Scene back = scene_of(packed);
    for (std::uint32_t v = scene.parts[0].first_vertex; v < scene.parts[0].end_vertex; ++v)
        for (std::size_t joint = 0; joint < 2; ++joint) {
            const Float3 &p = scene.mesh.positions[v], &q = back.mesh.positions[v];
            const float* m = matrices.data() + 16 * joint;
            const int down = -back.parts[0].exponent;
            const float x[3] = {std::ldexp(q.x, down), std::ldexp(q.y, down), std::ldexp(q.z, down)};
            const float want[3] = {p.x, p.y - float(joint), p.z};
            for (std::size_t row = 0; row < 3; ++row)
                REQUIRE(m[row] * x[0] + m[4 + row] * x[1] + m[8 + row] * x[2] + m[12 + row] ==
                        Approx(want[row]).margin(3.1 / 65535 / 2 + 1e-5));
        }
    // Morph offsets have the same step; 3 is the longest.
    const std::size_t target = d["meshes"][0]["primitives"][0]["targets"][0]["POSITION"];
    REQUIRE(d["accessors"][target]["componentType"] == 5122);
    REQUIRE(d["accessors"][target]["max"][2].get<int>() > 16000);
}

TEST_CASE("Draco scenes read back within its rounding, sequence kept where targets need it") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    SceneFormat format;
    format.draco = true;
    const std::vector<std::byte> glb = encoded(scene, levels_of(scene, 2), format);
    const json d = json_of_glb(glb);
    REQUIRE(d["extensionsRequired"] == json({"KHR_draco_mesh_compression"}));
    for (const json& mesh : d["meshes"])
        for (const json& primitive : mesh["primitives"]) {
            if (!primitive.contains("indices")) continue;
            const json& draco = primitive["extensions"]["KHR_draco_mesh_compression"];
            for (const auto& [name, id] : draco["attributes"].items()) {
                const json& accessor = d["accessors"][primitive["attributes"][name].get<std::size_t>()];
                REQUIRE(!accessor.contains("bufferView"));
                REQUIRE(accessor.contains("min") == (name == "POSITION"));
            }
            REQUIRE(!d["accessors"][primitive["indices"].get<std::size_t>()].contains("bufferView"));
        }
    const Scene back = scene_of(glb);
    REQUIRE(back.mesh.triangles.size() == scene.mesh.triangles.size());
    // Group 0 has morph targets: vertex by vertex the same.
    for (std::size_t t = 0; t < 16; ++t)
        for (std::size_t c = 0; c < 3; ++c) {
            const std::uint32_t v = scene.mesh.triangles[t][c], w = back.mesh.triangles[t][c];
            REQUIRE(back.mesh.positions[w].x == Approx(scene.mesh.positions[v].x).margin(1e-4));
            for (std::size_t a = 0; a < scene.mesh.attributes.size(); ++a) {
                const Attribute &x = scene.mesh.attributes[a], &y = back.mesh.attributes[a];
                REQUIRE(x.name == y.name);
                for (std::size_t i = 0; i < x.components; ++i)
                    REQUIRE(y.values[w * y.components + i] ==
                            Approx(x.values[v * x.components + i]).margin(4e-3));
            }
        }
}

TEST_CASE("formats that do not go together, and levels of another scene, are refused") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    SceneFormat format;
    format.draco = format.meshopt = true;
    REQUIRE(encode_scene(scene, levels_of(scene, 1), format).error().code == ErrorCode::kArgument);
    REQUIRE(encode_scene(scene, {}).error().code == ErrorCode::kArgument);
    auto levels = levels_of(scene, 1);
    levels[0].mesh.attributes.pop_back();
    REQUIRE(encode_scene(scene, levels).error().code == ErrorCode::kArgument);
    levels = levels_of(scene, 1);
    levels[0].mesh.groups[0] = 99;
    REQUIRE(encode_scene(scene, levels).error().code == ErrorCode::kArgument);
    levels = levels_of(scene, 1);
    levels[0].mesh.triangles[0] = {0, 1, 1u << 30};
    REQUIRE(encode_scene(scene, levels).error().code == ErrorCode::kArgument);
}

TEST_CASE("a mesh wider than a float keeps its positions when quantised") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    auto levels = levels_of(scene, 1);
    levels[0].mesh.attributes.clear();
    levels[0].mesh.groups.clear();
    SceneFormat format;
    format.quantised = true;
    const auto type_of_positions = [&] {
        const auto glb = encode_levels(levels, format);
        REQUIRE(glb.ok());
        const json d = json_of_glb(*glb);
        for (const json& node : d["nodes"])
            if (node.contains("scale"))
                for (const json& x : node["scale"]) REQUIRE(x.is_number());
        return d["accessors"][d["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<std::size_t>()]
                ["componentType"]
                    .get<int>();
    };
    CHECK(type_of_positions() == 5123);
    levels[0].mesh.positions.front().x = -3e38f;
    levels[0].mesh.positions.back().x = 3e38f;
    CHECK(type_of_positions() == 5126);
}

TEST_CASE("levels without a scene get one") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    const auto levels = levels_of(scene, 2);
    const auto glb = encode_levels(levels);
    REQUIRE(glb.ok());
    const json d = json_of_glb(*glb);
    REQUIRE(d["meshes"][0]["primitives"].size() == 3);
    REQUIRE(d["nodes"][0]["extensions"]["MSFT_lod"]["ids"].size() == 1);
    REQUIRE(scene_of(*glb).mesh.triangles == scene.mesh.triangles);
    // Bare ones in a packed format have normals all the same.
    std::vector<GltfLevel> bare = levels;
    for (GltfLevel& level : bare) level.mesh.attributes.clear(), level.mesh.groups.clear();
    SceneFormat draco;
    draco.draco = true;
    const auto packed = encode_levels(bare, draco);
    REQUIRE(packed.ok());
    REQUIRE(json_of_glb(*packed)["meshes"][0]["primitives"][0]["attributes"].contains("NORMAL"));
}
