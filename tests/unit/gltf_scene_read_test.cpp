// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>

#include "gltf_scene.hpp"

using namespace vsplit;
using namespace vsplit::bake;
using namespace vsplit::test;

namespace {

std::vector<std::string> names_of(const Mesh& mesh) {
    std::vector<std::string> out;
    for (const Attribute& attribute : mesh.attributes) out.push_back(attribute.name);
    return out;
}

const Attribute& attribute_of(const Mesh& mesh, const std::string& name) {
    for (const Attribute& attribute : mesh.attributes)
        if (attribute.name == name) return attribute;
    FAIL("no attribute " << name);
    return mesh.attributes.front();
}

Error refused(const GltfDocument& document, const GltfOptions& options = {}) {
    const auto scene = parse_scene(document.glb(), "", options);
    REQUIRE(!scene.ok());
    return scene.error();
}

}  // namespace

TEST_CASE("a scene has the union of its primitives' attributes, in order") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    REQUIRE(names_of(scene.mesh) == std::vector<std::string>{"NORMAL", "TANGENT", "TEXCOORD_0", "COLOR_0",
                                                             "JOINTS_0", "WEIGHTS_0", "_HEAT", "0/POSITION",
                                                             "1/NORMAL"});
    REQUIRE(scene.primitives.size() == 3);
    REQUIRE(scene.parts.size() == 2);
    REQUIRE(scene.primitives[0].targets == 2);
    REQUIRE(scene.primitives[2].targets == 0);
    REQUIRE(scene.primitives[2].mesh == rich.plain);
    REQUIRE(scene.primitives[2].primitive == 1);
    // Which primitive has what, and how it was stored.
    REQUIRE(scene.primitives[0].attributes.size() == 7);
    REQUIRE(scene.primitives[1].attributes.size() == 7);
    REQUIRE(scene.primitives[2].attributes.size() == 1);
    const StoredAttribute& colour = scene.primitives[1].attributes[1];
    REQUIRE(scene.mesh.attributes[colour.attribute].name == "COLOR_0");
    REQUIRE(colour.type == "VEC3");
    REQUIRE(colour.component_type == 5121);
    REQUIRE(colour.normalised);
    // Groups, parts.
    REQUIRE(scene.mesh.triangles.size() == 64);
    for (std::size_t t = 0; t < 64; ++t) {
        const std::uint32_t group = scene.mesh.groups[t];
        REQUIRE(group == (t < 16 ? 0u : t < 32 ? 1u : 2u));
        for (const std::uint32_t v : scene.mesh.triangles[t])
            REQUIRE(scene.part_of[v] == (group == 2 ? 1u : 0u));
    }
    REQUIRE(scene.part_of.size() == scene.mesh.positions.size());
    REQUIRE(scene.parts[0].end_vertex == scene.parts[1].first_vertex);
    REQUIRE(scene.parts[1].end_vertex == scene.mesh.positions.size());
    // A primitive that lacks an attribute has zeros.
    const Attribute& normal = attribute_of(scene.mesh, "NORMAL");
    for (std::uint32_t v = scene.parts[1].first_vertex; v < scene.parts[1].end_vertex; ++v)
        for (std::size_t c = 0; c < 3; ++c) REQUIRE(normal.values[3 * v + c] == 0);
}

TEST_CASE("each mesh is scaled to its largest place by a power of two") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    REQUIRE(scene.parts[0].exponent == 0);
    REQUIRE(scene.parts[1].exponent == 2);  // 4 <= 5 < 8
    REQUIRE(scene.unit == Approx(1.25));
    float most = 0;
    for (std::uint32_t v = scene.parts[1].first_vertex; v < scene.parts[1].end_vertex; ++v)
        most = std::max(most, scene.mesh.positions[v].x);
    REQUIRE(most == 4);
    // The large one spans (3, 0, 0) to (8, 5, 1.25), the small and the skinned one start at 0.
    REQUIRE(scene.radius == Approx(0.5 * std::sqrt(8 * 8 + 5 * 5 + 1.25 * 1.25)));
}

TEST_CASE("morph offsets are scaled as the positions are, other deltas are not") {
    GltfDocument d;
    const std::size_t p = d.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const std::size_t mesh = d.mesh({{"attributes", {{"POSITION", p}}},
                                     {"targets", {{{"POSITION", p}, {"NORMAL", p}}}},
                                     {"indices", d.shorts({0, 1, 2})}});
    d.scene({d.node({{"mesh", mesh}, {"scale", {9, 9, 9}}})});
    const Scene scene = scene_of(d.glb());
    REQUIRE(scene.parts[0].exponent == 3);
    REQUIRE(scene.mesh.positions[1].x == 8);
    REQUIRE(attribute_of(scene.mesh, "0/POSITION").values[3] == 8);
    REQUIRE(attribute_of(scene.mesh, "0/NORMAL").values[3] == 1);
    REQUIRE(attribute_of(scene.mesh, "0/POSITION").semantic == Semantic::kMorphOffset);
}

TEST_CASE("a scale that would round coordinates is not taken") {
    GltfDocument d;
    const float tiny = std::numeric_limits<float>::denorm_min() * 3;
    const std::size_t p = d.floats({tiny, 0, 0, 1, 0, 0, 0, 1, 0});
    const std::size_t mesh = d.mesh({{"attributes", {{"POSITION", p}}}, {"indices", d.shorts({0, 1, 2})}});
    d.scene({d.node({{"mesh", mesh}, {"scale", {0.25, 0.25, 0.25}}})});
    const Scene scene = scene_of(d.glb());
    REQUIRE(scene.parts[0].exponent == 0);
    REQUIRE(scene.mesh.positions[0].x == tiny);
}

TEST_CASE("vertices that agree in every bit merge within a primitive, others stay apart") {
    GltfDocument d;
    // Two triangles with six vertices: two pairs at the same places, of which one differs in its texture
    // coordinate.
    const std::size_t p = d.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    const std::size_t t = d.floats({0, 0, 1, 0, 0, 1, 1, 0, 1, 1, 0.5, 0.5}, "VEC2", 2);
    const json primitive = {{"attributes", {{"POSITION", p}, {"TEXCOORD_0", t}}}};
    d.add("meshes", {{"primitives", {primitive, primitive}}});
    d.scene({d.node({{"mesh", 0}})});
    const Scene scene = scene_of(d.glb());
    REQUIRE(scene.mesh.positions.size() == 10);
    REQUIRE(scene.report.vertices_welded == 2);
    REQUIRE(scene.mesh.triangles[0][1] == scene.mesh.triangles[1][0]);
    REQUIRE(scene.mesh.triangles[0][2] != scene.mesh.triangles[1][2]);
    REQUIRE(scene.parts.size() == 1);
}

TEST_CASE("colours of three and of four components share an attribute, alpha 1") {
    GltfDocument d;
    const std::size_t p = d.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const std::size_t three = d.floats({1, 0, 0, 0, 1, 0, 0, 0, 1}),
                      four = d.floats({1, 0, 0, 0.5, 0, 1, 0, 0.5, 0, 0, 1, 0.5}, "VEC4", 4);
    d.add("meshes", {{"primitives",
                      {{{"attributes", {{"POSITION", p}, {"COLOR_0", three}}}},
                       {{"attributes", {{"POSITION", p}, {"COLOR_0", four}}}}}}});
    d.scene({d.node({{"mesh", 0}})});
    const Scene scene = scene_of(d.glb());
    const Attribute& colour = attribute_of(scene.mesh, "COLOR_0");
    REQUIRE(colour.components == 4);
    REQUIRE(colour.values[3] == 1);
    REQUIRE(colour.values[4 * 3 + 3] == 0.5f);
    REQUIRE(scene.primitives[0].attributes[0].type == "VEC3");
}

TEST_CASE("matrices and any number of sets are read") {
    GltfDocument d;
    const std::size_t p = d.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
    json attributes = {{"POSITION", p}};
    // Columns of a 2x2 matrix of bytes begin at multiples of four.
    const std::vector<std::uint8_t> bytes = {1, 2, 0, 0, 3, 4,  0, 0, 5,  6,  0, 0,
                                             7, 8, 0, 0, 9, 10, 0, 0, 11, 12, 0, 0};
    attributes["_TWIST"] = d.accessor(bytes, 5121, "MAT2", 3);
    for (const int set : {0, 1, 2, 11})
        attributes["TEXCOORD_" + std::to_string(set)] =
            d.floats(std::vector<float>(6, float(set)), "VEC2", 2);
    d.scene_of({{"attributes", attributes}});
    const Scene scene = scene_of(d.glb());
    REQUIRE(names_of(scene.mesh) ==
            std::vector<std::string>{"TEXCOORD_0", "TEXCOORD_1", "TEXCOORD_2", "TEXCOORD_11", "_TWIST"});
    REQUIRE(attribute_of(scene.mesh, "_TWIST").values ==
            std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
    REQUIRE(attribute_of(scene.mesh, "TEXCOORD_11").semantic == Semantic::kTexcoord);
    // And they come out again.
    const auto back = scene_of(encoded(scene, levels_of(scene, 1)));
    REQUIRE(back.mesh.attributes == scene.mesh.attributes);
}

TEST_CASE("sparse accessors and morph targets without a view are read") {
    GltfDocument d;
    const std::size_t p = d.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const std::size_t indices = d.view(std::vector<std::uint16_t>{2}),
                      values = d.view(std::vector<float>{7, 8, 9});
    const std::size_t target =
        d.add("accessors", {{"componentType", 5126},
                            {"count", 3},
                            {"type", "VEC3"},
                            {"sparse",
                             {{"count", 1},
                              {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                              {"values", {{"bufferView", values}}}}}});
    d.scene_of({{"attributes", {{"POSITION", p}}}, {"targets", {{{"POSITION", target}}}}});
    const Scene scene = scene_of(d.glb());
    REQUIRE(attribute_of(scene.mesh, "0/POSITION").values == std::vector<float>{0, 0, 0, 0, 0, 0, 7, 8, 9});
}

TEST_CASE("joints without weights still make a pair, but are written alone") {
    GltfDocument d;
    const std::size_t p = d.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
    d.scene_of(
        {{"attributes",
          {{"POSITION", p}, {"JOINTS_0", d.accessor(std::vector<std::uint8_t>(12, 3), 5121, "VEC4", 3)}}}});
    const Scene scene = scene_of(d.glb());
    REQUIRE(names_of(scene.mesh) == std::vector<std::string>{"JOINTS_0", "WEIGHTS_0"});
    const json written = json_of_glb(encoded(scene, levels_of(scene, 1)));
    REQUIRE(!written["meshes"][0]["primitives"][0]["attributes"].contains("WEIGHTS_0"));
}

TEST_CASE("values that are no numbers become 0, triangles at such places go") {
    GltfDocument d;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::size_t p = d.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, nan, 0, 0});
    const std::size_t t = d.floats({0, nan, 1, 0, 0, 1, 0, 0}, "VEC2", 2);
    d.scene_of(
        {{"attributes", {{"POSITION", p}, {"TEXCOORD_0", t}}}, {"indices", d.shorts({0, 1, 2, 1, 3, 2})}});
    const Scene scene = scene_of(d.glb());
    REQUIRE(scene.mesh.triangles.size() == 1);
    REQUIRE(scene.report.faces_dropped_non_finite == 1);
    REQUIRE(scene.mesh.attributes[0].values[1] == 0);
    REQUIRE(scene.notes.size() == 1);
}

TEST_CASE("attributes of the wrong type or length, and too many of them, are refused") {
    GltfDocument d;
    const std::size_t p = d.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const std::size_t two = d.floats({0, 0, 0, 0, 0, 0}, "VEC2", 2),
                      four = d.floats(std::vector<float>(12), "VEC3", 3);
    const auto with = [&](json attributes, json targets = json::array()) {
        GltfDocument made = d;
        attributes["POSITION"] = p;
        made.scene_of({{"attributes", attributes}, {"targets", targets}});
        return made;
    };
    for (const char* name : {"NORMAL", "TANGENT", "COLOR_0", "JOINTS_0", "WEIGHTS_1"}) {
        const Error error = refused(with({{name, two}}));
        REQUIRE(error.code == ErrorCode::kMalformed);
        REQUIRE(error.message.find(name) != std::string::npos);
    }
    REQUIRE(refused(with({{"NORMAL", four}})).code == ErrorCode::kMalformed);
    REQUIRE(refused(with({}, {{{"POSITION", four}}})).message.find("targets[0].POSITION") !=
            std::string::npos);
    REQUIRE(refused(with({}, {{{"POSITION", 77}}})).code == ErrorCode::kMalformed);
    REQUIRE(refused(with({}, {{{"TANGENT", two}}})).code == ErrorCode::kMalformed);
    GltfOptions options;
    options.max_attribute_values = 5;
    REQUIRE(refused(with({{"TEXCOORD_0", two}}), options).code == ErrorCode::kLimit);
    options.max_attribute_values = 6;
    REQUIRE(parse_scene(with({{"TEXCOORD_0", two}}).glb(), "", options).ok());
}

TEST_CASE("the union of attributes is limited, not only what the file stores") {
    GltfDocument d;
    const std::size_t p = d.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
    json primitives = json::array();
    for (int i = 0; i < 20; ++i)
        primitives.push_back({{"attributes", {{"POSITION", p}, {"_A" + std::to_string(i), p}}}});
    d.add("meshes", {{"primitives", primitives}});
    d.scene({d.node({{"mesh", 0}})});
    GltfOptions options;
    options.max_attribute_values = 20 * 9;  // as stored; the union is twenty times as much
    REQUIRE(refused(d, options).code == ErrorCode::kLimit);
    options.max_attribute_values = 20 * 20 * 9;
    REQUIRE(parse_scene(d.glb(), "", options).ok());
}

TEST_CASE("levels of MSFT_lod in the input: the finest is the scene, the others are emptied") {
    const RichScene rich;
    const Scene scene = scene_of(rich.document.glb());
    const auto chain = encoded(scene, levels_of(scene, 3));
    REQUIRE(json_of_glb(chain)["extensionsUsed"].dump().find("MSFT_lod") != std::string::npos);
    const Scene back = scene_of(chain);
    REQUIRE(back.mesh.triangles.size() == scene.mesh.triangles.size());
    REQUIRE(back.mesh.attributes.size() == scene.mesh.attributes.size());
    // Written with one level, there are none of the old ones; with two, the new one's alone.
    const json single = json_of_glb(encoded(back, levels_of(back, 1)));
    REQUIRE(single["extensionsUsed"].dump().find("MSFT_lod") == std::string::npos);
    for (const json& node : single["nodes"])
        REQUIRE((!node.contains("extensions") || !node["extensions"].contains("MSFT_lod")));
    std::size_t shown = 0;
    for (const json& node : single["nodes"]) shown += node.contains("mesh");
    REQUIRE(shown == 3);
    const json twice = json_of_glb(encoded(back, levels_of(back, 2)));
    for (const json& node : twice["nodes"])
        if (node.contains("extensions") && node["extensions"].contains("MSFT_lod"))
            REQUIRE(node["extensions"]["MSFT_lod"]["ids"].size() == 1);
    // Of materials it is not ours.
    GltfDocument lods;
    const Sheet sheet;
    const std::size_t position = lods.floats(sheet.positions);
    lods.root["accessors"][position].update({{"min", {0, 0, 0}}, {"max", {1, 1, 0.25}}});
    lods.scene_of(
        {{"attributes", {{"POSITION", position}}}, {"indices", lods.shorts(sheet.corners)}, {"material", 0}});
    lods.root["materials"] = {{{"extensions", {{"MSFT_lod", {{"ids", {1}}}}}}}, {{"name", "far"}}};
    lods.root["extensionsUsed"] = {"MSFT_lod"};
    const Scene painted = scene_of(lods.glb());
    const json kept = json_of_glb(encoded(painted, levels_of(painted, 1)));
    REQUIRE(kept["materials"] == lods.root["materials"]);
    REQUIRE(kept["extensionsUsed"] == json({"MSFT_lod"}));
}

TEST_CASE("painted weights come from a channel") {
    const RichScene rich;
    GltfOptions options;
    options.weight_channel = "COLOR_0.g";
    auto scene = parse_scene(rich.document.glb(), "", options);
    REQUIRE(scene.ok());
    REQUIRE(scene->mesh.weights.size() == scene->mesh.positions.size());
    REQUIRE(scene->mesh.weights[scene->parts[1].first_vertex] == 1);
    options.weight_channel = "COLOR_7.g";
    scene = parse_scene(rich.document.glb(), "", options);
    REQUIRE(!scene.ok());
    REQUIRE(scene.error().code == ErrorCode::kArgument);
}

TEST_CASE("a scene without triangles, with cycles of nodes, is refused") {
    GltfDocument d;
    const std::size_t p = d.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
    d.add("meshes", {{"primitives", {{{"attributes", {{"POSITION", p}}}, {"mode", 0}}}}});
    d.scene({d.node({{"mesh", 0}})});
    REQUIRE(refused(d).code == ErrorCode::kMalformed);
    GltfDocument cycle = RichScene().document;
    cycle.root["nodes"][1]["children"] = {0};
    REQUIRE(refused(cycle).code == ErrorCode::kMalformed);
    GltfDocument twice = RichScene().document;
    twice.root["nodes"][3]["children"] = {5};
    REQUIRE(refused(twice).message.find("reached twice") != std::string::npos);
}
