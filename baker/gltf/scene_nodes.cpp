// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "scene_nodes.hpp"

#include <algorithm>
#include <cmath>

#include "accessor.hpp"
#include "transforms.hpp"

namespace vsplit::bake {
namespace {

/// World matrices of all nodes, whichever scene they are in.
Result<std::vector<Matrix>> world_matrices(const tinygltf::Model& model) {
    const std::size_t count = model.nodes.size();
    std::vector<std::uint8_t> is_child(count, 0), seen(count, 0);
    for (const tinygltf::Node& node : model.nodes)
        for (const int child : node.children) is_child[std::size_t(child)] = 1;
    std::vector<Matrix> world(count, kIdentity);
    std::vector<std::size_t> stack;
    for (std::size_t n = 0; n < count; ++n)
        if (is_child[n] == 0) stack.push_back(n), world[n] = local_matrix(model.nodes[n]);
    std::size_t reached = 0;
    while (!stack.empty()) {
        const std::size_t n = stack.back();
        stack.pop_back();
        if (seen[n]++ != 0)
            return Error{ErrorCode::kMalformed,
                         object_name("nodes", n) + " is reached twice: the nodes are no tree",
                         Error::kNowhere, 0};
        ++reached;
        for (const int child : model.nodes[n].children) {
            world[std::size_t(child)] = product(world[n], local_matrix(model.nodes[std::size_t(child)]));
            stack.push_back(std::size_t(child));
        }
    }
    if (reached != count)
        return Error{ErrorCode::kMalformed, "some nodes are their own ancestors: the nodes are no tree",
                     Error::kNowhere, 0};
    return world;
}

std::vector<std::uint8_t> below(const tinygltf::Model& model, std::vector<std::size_t> stack) {
    std::vector<std::uint8_t> reached(model.nodes.size(), 0);
    while (!stack.empty()) {
        const std::size_t n = stack.back();
        stack.pop_back();
        if (reached[n]++ != 0) continue;
        for (const int child : model.nodes[n].children) stack.push_back(std::size_t(child));
    }
    return reached;
}

struct BindPose {
    bool known = false;
    double scale = 0;  // of the largest joint
    Matrix first = kIdentity;
};

/// How a skin's joints transform a vertex in its bind pose.
BindPose bind_pose(Document& document, const tinygltf::Skin& skin, const std::vector<Matrix>& world) {
    BindPose pose;
    pose.known = true;
    const int number = skin.inverseBindMatrices;
    Result<AccessorReader> inverse = Error{};
    if (number >= 0) inverse = AccessorReader::open(document, number, "inverseBindMatrices");
    const bool given = inverse.ok() && inverse->type() == TINYGLTF_TYPE_MAT4;
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
        Matrix bind = kIdentity;
        if (given && j < inverse->count()) {
            float values[16];
            inverse->read(j, values);
            std::copy(std::begin(values), std::end(values), bind.begin());
        }
        const Matrix matrix = product(world[std::size_t(skin.joints[j])], bind);
        if (j == 0) pose.first = matrix;
        const double scale = largest_scale(matrix);
        if (std::isfinite(scale)) pose.scale = std::max(pose.scale, scale);
    }
    return pose;
}

}  // namespace

Result<std::vector<Instance>> place_meshes(const Document& document) {
    const tinygltf::Model& model = document.model;
    const std::size_t count = model.nodes.size();
    std::vector<int> roots;
    if (!model.scenes.empty()) {
        roots = model.scenes[std::size_t(std::max(model.defaultScene, 0))].nodes;
    } else {
        std::vector<std::uint8_t> is_child(document.is_lod);
        for (const tinygltf::Node& node : model.nodes)
            for (const int child : node.children) is_child[std::size_t(child)] = 1;
        for (std::size_t n = 0; n < count; ++n)
            if (is_child[n] == 0) roots.push_back(int(n));
        // Where nobody is a root everybody is on a cycle, which the walk below must get to see.
        if (roots.empty() && count > 0) roots.push_back(0);
    }
    struct Step {
        std::size_t node;
        Matrix parent;
    };
    std::vector<Step> stack;
    for (auto root = roots.rbegin(); root != roots.rend(); ++root)
        stack.push_back({std::size_t(*root), kIdentity});
    std::vector<std::uint8_t> seen(count, 0);
    std::vector<Instance> out;
    while (!stack.empty()) {
        const Step step = stack.back();
        stack.pop_back();
        if (seen[step.node]++ != 0)
            return Error{ErrorCode::kMalformed,
                         object_name("nodes", step.node) + " is reached twice: the nodes are no tree",
                         Error::kNowhere, 0};
        const tinygltf::Node& node = model.nodes[step.node];
        const Matrix matrix = product(step.parent, local_matrix(node));
        if (node.mesh >= 0) out.push_back({std::size_t(node.mesh), step.node, matrix});
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
            stack.push_back({std::size_t(*child), matrix});
    }
    return out;
}

Result<SceneUse> survey_nodes(Document& document) {
    const tinygltf::Model& model = document.model;
    const auto world = world_matrices(model);
    if (!world.ok()) return world.error();
    const std::size_t count = model.nodes.size();
    std::vector<std::size_t> levels, shown;
    std::vector<std::uint8_t> is_child(count, 0);
    for (const tinygltf::Node& node : model.nodes)
        for (const int child : node.children) is_child[std::size_t(child)] = 1;
    for (std::size_t n = 0; n < count; ++n)
        if (document.is_lod[n] != 0)
            levels.push_back(n);
        else if (is_child[n] == 0)
            shown.push_back(n);
    for (const tinygltf::Scene& scene : model.scenes)
        for (const int root : scene.nodes) shown.push_back(std::size_t(root));
    SceneUse use;
    use.only_lod = below(model, levels);
    const auto reached = below(model, shown);
    for (std::size_t n = 0; n < count; ++n)
        if (reached[n] != 0) use.only_lod[n] = 0;

    use.mesh_used.assign(model.meshes.size(), 0);
    use.mesh_scale.assign(model.meshes.size(), 0);
    std::vector<BindPose> skins(model.skins.size());
    for (std::size_t n = 0; n < count; ++n) {
        const tinygltf::Node& node = model.nodes[n];
        if (node.mesh < 0 || use.only_lod[n] != 0) continue;
        const auto mesh = std::size_t(node.mesh);
        use.mesh_used[mesh] = 1;
        double scale = 0;
        if (node.skin >= 0) {
            BindPose& pose = skins[std::size_t(node.skin)];
            if (!pose.known) pose = bind_pose(document, model.skins[std::size_t(node.skin)], *world);
            scale = pose.scale;
            use.places.push_back({mesh, pose.first});
        } else {
            scale = largest_scale((*world)[n]);
            use.places.push_back({mesh, (*world)[n]});
        }
        if (std::isfinite(scale)) use.mesh_scale[mesh] = std::max(use.mesh_scale[mesh], scale);
    }
    return use;
}

}  // namespace vsplit::bake
