// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "attribute_set.hpp"
#include "pack.hpp"
#include "scene_document.hpp"
#include "vsplit/bake/scene.hpp"

namespace vsplit::bake {

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
    root["meshes"] = OrderedJson::array({{{"primitives", std::move(primitives)}}});
    root["materials"] = OrderedJson::array_t(groups, material);
    scene.document = std::move(document);
    return scene;
}

}  // namespace vsplit::bake
