// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>

#include "attribute_set.hpp"
#include "pack.hpp"
#include "scene_document.hpp"
#include "vsplit/bake/scene.hpp"

namespace vsplit::bake {

namespace {

/// One more than the largest joint; 0 without, or for numbers that no skin has.
std::size_t joints_of(const Mesh& mesh) {
    float most = -1;
    for (const Attribute& attribute : mesh.attributes)
        if (attribute.semantic == Semantic::kJoints)
            for (const float joint : attribute.values) most = std::max(most, joint);
    return most >= 0 && most <= 65535 ? std::size_t(most) + 1 : 0;
}

/// Joints that stand still, in the place of those that moved the mesh.
void add_skin(SceneDocument& document, std::size_t joints) {
    OrderedJson numbers = OrderedJson::array(), others = OrderedJson::array();
    OrderedJson& nodes = document.root["nodes"];
    for (std::size_t j = 0; j < joints; ++j) {
        numbers.push_back(j + 1);
        if (j > 0) others.push_back(j + 1);
        nodes.push_back({{"name", "joint " + std::to_string(j)}});
    }
    if (!others.empty()) nodes[1]["children"] = std::move(others);
    nodes[0]["skin"] = 0;
    document.root["scenes"][0]["nodes"].push_back(1);
    document.root["skins"] = OrderedJson::array({{{"joints", std::move(numbers)}}});
    std::vector<float> matrices(16 * joints, 0.0f);
    for (std::size_t j = 0; j < joints; ++j)
        for (std::size_t k = 0; k < 4; ++k) matrices[16 * j + 5 * k] = 1;
    document.inverse_bind.push_back(std::move(matrices));
}

}  // namespace

Scene plain_scene(const Mesh& mesh) {
    Scene scene;
    for (const Attribute& attribute : mesh.attributes)
        scene.mesh.attributes.push_back({attribute.name, attribute.semantic, attribute.components, {}});
    std::uint32_t groups = 1;
    // Above this the groups are no materials, and writing the levels says so.
    constexpr std::uint32_t kMost = 1u << 16;
    for (const std::uint32_t group : mesh.groups)
        if (group < kMost) groups = std::max(groups, group + 1);
    ScenePrimitive primitive;
    for (std::size_t a = 0; a < mesh.attributes.size(); ++a) {
        const Attribute& attribute = mesh.attributes[a];
        constexpr const char* kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
        const std::uint32_t n = attribute.components;
        if (n > 4 && n != 9 && n != 16) continue;  // glTF has no such type
        StoredAttribute stored;
        stored.attribute = std::uint32_t(a);
        stored.type = n == 16 ? "MAT4" : n == 9 ? "MAT3" : kTypes[n - 1];
        stored.component_type = attribute.semantic == Semantic::kJoints ? kUnsignedShort : kFloat;
        primitive.attributes.push_back(stored);
        if (const auto slash = attribute.name.find('/'); slash != attribute.name.npos) {
            const std::string digits = attribute.name.substr(0, slash);
            const bool number = !digits.empty() && digits.size() <= 6 &&
                                digits.find_first_not_of("0123456789") == digits.npos;
            if (!number || std::stoul(digits) >= mesh.attributes.size()) {
                primitive.attributes.pop_back();
                continue;
            }
            primitive.targets = std::max(primitive.targets, std::uint32_t(std::stoul(digits)) + 1);
        }
    }
    const std::size_t joints = joints_of(mesh);
    if (joints == 0)
        std::erase_if(primitive.attributes, [&](const StoredAttribute& stored) {
            const Semantic semantic = mesh.attributes[stored.attribute].semantic;
            return semantic == Semantic::kJoints || semantic == Semantic::kJointWeights;
        });
    scene.primitives.assign(groups, primitive);
    OrderedJson primitives = OrderedJson::array();
    for (std::uint32_t g = 0; g < groups; ++g) {
        scene.primitives[g].primitive = g;
        primitives.push_back({{"material", g}});
    }
    scene.parts.push_back({0, 0, 0, 0});
    auto document = std::make_shared<SceneDocument>();
    OrderedJson material = {{"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.8}}},
                            {"doubleSided", true}};
    OrderedJson& root = document->root;
    root["asset"] = {{"version", "2.0"}, {"generator", "vsplit"}};
    root["scene"] = 0;
    root["scenes"] = OrderedJson::array({{{"nodes", OrderedJson::array({0})}}});
    root["nodes"] = OrderedJson::array({{{"mesh", 0}}});
    if (joints > 0) add_skin(*document, joints);
    root["meshes"] = OrderedJson::array({{{"primitives", std::move(primitives)}}});
    root["materials"] = OrderedJson::array_t(groups, material);
    scene.document = std::move(document);
    return scene;
}

}  // namespace vsplit::bake
