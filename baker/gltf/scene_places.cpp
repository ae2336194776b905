// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "scene_document.hpp"
#include "transforms.hpp"
#include "vsplit/bake/scene.hpp"

namespace vsplit::bake {
namespace {

std::vector<double> numbers(const OrderedJson& object, const char* key, std::size_t count) {
    const OrderedJson* list = member(object, key);
    std::vector<double> values;
    if (list == nullptr || !list->is_array() || list->size() != count) return values;
    for (const OrderedJson& value : *list) {
        if (!value.is_number()) return {};
        values.push_back(value.get<double>());
    }
    return values;
}

std::optional<std::size_t> number(const OrderedJson* value, std::size_t end) {
    if (value == nullptr || !value->is_number_unsigned()) return std::nullopt;
    const auto n = value->get<std::uint64_t>();
    return n < end ? std::optional<std::size_t>(n) : std::nullopt;
}

Matrix matrix_of(const OrderedJson& json) {
    tinygltf::Node node;
    node.matrix = numbers(json, "matrix", 16);
    node.translation = numbers(json, "translation", 3);
    node.rotation = numbers(json, "rotation", 4);
    node.scale = numbers(json, "scale", 3);
    return local_matrix(node);
}

const OrderedJson& list_of(const OrderedJson& root, const char* key) {
    static const OrderedJson kNone = OrderedJson::array();
    const OrderedJson* list = member(root, key);
    return list != nullptr && list->is_array() ? *list : kNone;
}

/// The document's nodes from the roots of the scene that is shown, parents before children.
std::vector<std::pair<std::size_t, Matrix>> walk(const OrderedJson& root) {
    const OrderedJson &nodes = list_of(root, "nodes"), &scenes = list_of(root, "scenes");
    const auto each = [&](const OrderedJson& of, const char* key, auto&& use) {
        for (const OrderedJson& child : list_of(of, key))
            if (const auto n = number(&child, nodes.size())) use(*n);
    };
    std::vector<std::size_t> roots;
    if (!scenes.empty()) {
        const std::size_t chosen = number(member(root, "scene"), scenes.size()).value_or(0);
        each(scenes[chosen], "nodes", [&](std::size_t n) { roots.push_back(n); });
    } else {
        std::vector<char> child(nodes.size(), 0);
        for (const OrderedJson& node : nodes) each(node, "children", [&](std::size_t n) { child[n] = 1; });
        for (std::size_t n = 0; n < nodes.size(); ++n)
            if (!child[n]) roots.push_back(n);
    }
    std::vector<std::pair<std::size_t, Matrix>> found;
    std::vector<char> seen(nodes.size(), 0);
    const auto take = [&](std::size_t n, const Matrix& parent) {
        if (seen[n]) return;  // the nodes were found to be a forest when the scene was read
        seen[n] = 1;
        found.emplace_back(n, product(parent, matrix_of(nodes[n])));
    };
    for (const std::size_t n : roots) take(n, kIdentity);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const auto [n, matrix] = found[i];
        each(nodes[n], "children", [&, world = matrix](std::size_t child) { take(child, world); });
    }
    return found;
}

}  // namespace

std::vector<ScenePlace> scene_places(const Scene& scene) {
    std::vector<ScenePlace> places;
    if (!scene.document) return places;
    const OrderedJson& root = scene.document->root;
    const OrderedJson &nodes = list_of(root, "nodes"), &skins = list_of(root, "skins");
    const auto all = walk(root);
    std::map<std::size_t, Matrix> world(all.begin(), all.end());
    std::map<std::size_t, std::uint32_t> part_of_mesh;
    for (std::uint32_t p = 0; p < scene.parts.size(); ++p) part_of_mesh.emplace(scene.parts[p].mesh, p);
    for (const auto& [n, matrix] : all) {
        const auto mesh = number(member(nodes[n], "mesh"), list_of(root, "meshes").size());
        const auto part = mesh ? part_of_mesh.find(*mesh) : part_of_mesh.end();
        if (part == part_of_mesh.end()) continue;
        Matrix placed = matrix;
        // Skinned, it stands where its first joint puts it.
        if (const auto skin = number(member(nodes[n], "skin"), skins.size())) {
            const OrderedJson& joints = list_of(skins[*skin], "joints");
            const auto joint = joints.empty() ? std::nullopt : number(&joints[0], nodes.size());
            if (joint && world.count(*joint)) {
                Matrix bind = kIdentity;
                const auto& inverse = scene.document->inverse_bind;
                if (*skin < inverse.size() && inverse[*skin].size() >= 16)
                    std::copy_n(inverse[*skin].begin(), 16, bind.begin());
                placed = product(world[*joint], bind);
            }
        }
        const double scale = std::ldexp(1.0, -scene.parts[part->second].exponent);
        for (std::size_t i = 0; i < 12; ++i) placed[i] *= scale;
        if (std::all_of(placed.begin(), placed.end(), [](double x) { return std::isfinite(x); }))
            places.push_back({part->second, placed});
    }
    return places;
}

std::vector<SceneMaterial> scene_materials(const Scene& scene) {
    std::vector<SceneMaterial> materials(scene.primitives.size());
    if (!scene.document) return materials;
    const OrderedJson& root = scene.document->root;
    const OrderedJson &meshes = list_of(root, "meshes"), &all = list_of(root, "materials"),
                      &textures = list_of(root, "textures"), &images = list_of(root, "images");
    for (std::size_t p = 0; p < materials.size(); ++p) {
        const ScenePrimitive& from = scene.primitives[p];
        if (from.mesh >= meshes.size()) continue;
        const OrderedJson& primitives = list_of(meshes[from.mesh], "primitives");
        if (from.primitive >= primitives.size()) continue;
        const auto n = number(member(primitives[from.primitive], "material"), all.size());
        if (!n) continue;
        SceneMaterial& made = materials[p];
        made.number = std::uint32_t(*n);
        if (const OrderedJson* name = member(all[*n], "name"); name && name->is_string())
            made.name = name->get<std::string>();
        const OrderedJson* pbr = member(all[*n], "pbrMetallicRoughness");
        if (pbr == nullptr || !pbr->is_object()) continue;
        const std::vector<double> factor = numbers(*pbr, "baseColorFactor", 4);
        for (std::size_t c = 0; c < factor.size(); ++c) made.base_color[c] = float(factor[c]);
        const OrderedJson* texture = member(*pbr, "baseColorTexture");
        if (texture == nullptr || !texture->is_object()) continue;
        const auto t = number(member(*texture, "index"), textures.size());
        const auto image = t ? number(member(textures[*t], "source"), images.size()) : std::nullopt;
        const auto view =
            image ? number(member(images[*image], "bufferView"), list_of(root, "bufferViews").size())
                  : std::nullopt;
        if (!view) continue;
        const auto kept = scene.document->views.find(*view);
        if (kept == scene.document->views.end()) continue;
        made.image = kept->second.bytes;
        made.image_number = std::uint32_t(*image);
        if (const auto set = number(member(*texture, "texCoord"), 64)) made.texcoord = std::uint32_t(*set);
    }
    return materials;
}

}  // namespace vsplit::bake
