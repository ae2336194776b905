// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "node_surgery.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace vsplit::bake {
namespace {

constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

std::size_t number_of(const OrderedJson* value, std::size_t none) {
    if (value == nullptr || !value->is_number()) return none;
    const double number = value->get<double>();  // "3.0" is a whole number, too
    return number >= 0 && number <= 4294967295.0 ? static_cast<std::size_t>(number) : none;
}

/// "/nodes/12/rotation" of KHR_animation_pointer: 12 and "rotation".
std::pair<std::size_t, std::string> pointed(const OrderedJson& target, std::string_view array) {
    constexpr std::size_t kNone = std::size_t(-1);
    const OrderedJson* pointer = extension_of(target, "KHR_animation_pointer");
    if (pointer != nullptr) pointer = member(*pointer, "pointer");
    if (pointer == nullptr || !pointer->is_string()) return {kNone, {}};
    std::string_view text = pointer->get_ref<const std::string&>();
    const std::string head = "/" + std::string(array) + "/";
    if (!text.starts_with(head)) return {kNone, {}};
    text.remove_prefix(head.size());
    const std::size_t slash = text.find('/');
    if (slash == text.npos || slash == 0 || slash > 9) return {kNone, {}};
    std::size_t number = 0;
    for (const char c : text.substr(0, slash)) {
        if (c < '0' || c > '9') return {kNone, {}};
        number = number * 10 + std::size_t(c - '0');
    }
    return {number, std::string(text.substr(slash + 1))};
}

template <class Each>
void each_channel(OrderedJson& root, Each each) {
    OrderedJson* animations = member(root, "animations");
    if (animations == nullptr || !animations->is_array()) return;
    for (OrderedJson& animation : *animations)
        if (OrderedJson* channels = member(animation, "channels"))
            for (std::size_t c = 0; c < channels->size(); ++c)
                if (member((*channels)[c], "target") != nullptr) each(*channels, c);
}

}  // namespace

NodeSurgery::NodeSurgery(OrderedJson& root) : root_(root) {
    if (!root_.contains("nodes")) root_["nodes"] = OrderedJson::array();
    each_channel(root_, [&](OrderedJson& channels, std::size_t c) {
        const OrderedJson& target = channels[c]["target"];
        const OrderedJson* path = member(target, "path");
        const bool weights = path != nullptr && *path == "weights";
        if (const std::size_t n = number_of(member(target, "node"), root_["nodes"].size());
            n < root_["nodes"].size())
            (weights ? morphing_ : moving_).insert(n);
        if (const auto [n, rest] = pointed(target, "nodes"); !rest.empty() && n < root_["nodes"].size())
            (rest.starts_with("weights") ? morphing_ : moving_).insert(n);
    });
    if (const OrderedJson* skins = member(root_, "skins"))
        for (const OrderedJson& skin : *skins) {
            if (const OrderedJson* joints = member(skin, "joints"))
                for (const OrderedJson& joint : *joints) joints_.insert(number_of(&joint, 0));
            if (const OrderedJson* skeleton = member(skin, "skeleton"))
                joints_.insert(number_of(skeleton, 0));
        }
}

std::vector<std::vector<std::size_t>> NodeSurgery::users() const {
    const OrderedJson* meshes = member(root_, "meshes");
    std::vector<std::vector<std::size_t>> out(meshes != nullptr ? meshes->size() : 0);
    const OrderedJson& nodes = root_["nodes"];
    for (std::size_t n = 0; n < nodes.size(); ++n)
        if (const std::size_t m = number_of(member(nodes[n], "mesh"), out.size()); m < out.size())
            out[m].push_back(n);
    return out;
}

bool NodeSurgery::instanced(std::size_t n) const {
    return extension_of(node(n), kInstancing) != nullptr;
}

std::size_t NodeSurgery::add_node(OrderedJson node) {
    root_["nodes"].push_back(std::move(node));
    return root_["nodes"].size() - 1;
}

template <class Each>
void NodeSurgery::each_weights_channel(std::size_t n, Each each) {
    if (!morphing_.contains(n)) return;
    each_channel(root_, [&](OrderedJson& channels, std::size_t c) {
        const OrderedJson& target = channels[c]["target"];
        const OrderedJson* path = member(target, "path");
        const auto [to, rest] = pointed(target, "nodes");
        const bool plain =
            path != nullptr && *path == "weights" && number_of(member(target, "node"), std::size_t(-1)) == n;
        if (plain || (to == n && rest.starts_with("weights"))) each(channels, c, plain, rest);
    });
}

void NodeSurgery::take_mesh(std::size_t n) {
    OrderedJson& node = root_["nodes"][n];
    for (const char* key : {"mesh", "skin", "weights"}) node.erase(key);
    erase_extension(node, kInstancing);
    if (!morphing_.contains(n)) return;
    // Channels are emptied first, so that their numbers hold while they are looked at.
    each_weights_channel(
        n, [](OrderedJson& channels, std::size_t c, bool, const std::string&) { channels[c] = nullptr; });
    OrderedJson* animations = member(root_, "animations");
    if (animations == nullptr || !animations->is_array()) return;
    OrderedJson kept = OrderedJson::array();
    for (OrderedJson& animation : *animations) {
        if (OrderedJson* channels = member(animation, "channels")) {
            OrderedJson left = OrderedJson::array();
            for (OrderedJson& channel : *channels)
                if (!channel.is_null()) left.push_back(std::move(channel));
            *channels = std::move(left);
            if (channels->empty()) continue;
        }
        kept.push_back(std::move(animation));
    }
    *animations = std::move(kept);
    if (animations->empty()) root_.erase("animations");
}

/// A node that holds a mesh and stays where it is.
bool NodeSurgery::simple(std::size_t n) const {
    const OrderedJson& node = this->node(n);
    const OrderedJson* children = member(node, "children");
    if (children != nullptr && !children->empty()) return false;
    if (node.contains("camera") || joints_.contains(n)) return false;
    const OrderedJson* extras = member(node, "extras");
    if (extras != nullptr && !extras->is_object()) return false;
    if (const OrderedJson* extensions = member(node, "extensions"))
        for (const auto& [name, value] : extensions->items())
            if (name != kInstancing) return false;
    return node.contains("skin") || !moving_.contains(n);
}

std::size_t NodeSurgery::split_off(std::size_t n) {
    OrderedJson made = OrderedJson::object();
    OrderedJson& source = root_["nodes"][n];
    for (const char* key : {"name", "mesh", "skin", "weights"})
        if (source.contains(key)) made[key] = source[key];
    for (const char* key : {"mesh", "skin", "weights"}) source.erase(key);
    if (const OrderedJson* instancing = extension_of(source, kInstancing)) {
        made["extensions"][kInstancing] = *instancing;
        erase_extension(source, kInstancing);
    }
    const bool skinned = made.contains("skin");
    const std::size_t number = add_node(std::move(made));
    each_weights_channel(n, [&](OrderedJson& channels, std::size_t c, bool plain, const std::string& rest) {
        OrderedJson& target = channels[c]["target"];
        if (plain)
            target["node"] = number;
        else
            target["extensions"]["KHR_animation_pointer"]["pointer"] =
                "/nodes/" + std::to_string(number) + "/" + rest;
    });
    if (morphing_.erase(n) > 0) morphing_.insert(number);
    if (!skinned) {
        OrderedJson& children = root_["nodes"][n]["children"];
        if (!children.is_array()) children = OrderedJson::array();
        children.push_back(number);
        return number;
    }
    // A skinned mesh stands where its joints are, so that it belongs to the top of each scene that it is in.
    std::vector<std::size_t> parent(root_["nodes"].size(), std::size_t(-1));
    for (std::size_t p = 0; p < parent.size(); ++p)
        if (const OrderedJson* children = member(root_["nodes"][p], "children"))
            for (const OrderedJson& child : *children)
                if (const std::size_t c = number_of(&child, parent.size()); c < parent.size()) parent[c] = p;
    std::size_t top = n;
    while (parent[top] < parent.size()) top = parent[top];
    if (OrderedJson* scenes = member(root_, "scenes"))
        for (OrderedJson& scene : *scenes)
            if (OrderedJson* nodes = member(scene, "nodes"))
                if (std::find(nodes->begin(), nodes->end(), top) != nodes->end()) nodes->push_back(number);
    return number;
}

void NodeSurgery::add_levels(std::size_t n, const std::vector<std::size_t>& meshes,
                             const std::vector<double>& coverage) {
    if (meshes.empty()) return;  // there is nothing to switch to
    if (!simple(n)) n = split_off(n);
    OrderedJson ids = OrderedJson::array();
    for (std::size_t k = 0; k < meshes.size(); ++k) {
        const OrderedJson& source = root_["nodes"][n];
        OrderedJson copy = OrderedJson::object();
        const OrderedJson* name = member(source, "name");
        if (name != nullptr && name->is_string())
            copy["name"] = name->get_ref<const std::string&>() + "_LOD" + std::to_string(k + 1);
        copy["mesh"] = meshes[k];
        for (const char* key : {"skin", "weights", "matrix", "translation", "rotation", "scale"})
            if (source.contains(key)) copy[key] = source[key];
        if (const OrderedJson* instancing = extension_of(source, kInstancing))
            copy["extensions"][kInstancing] = *instancing;
        const std::size_t number = add_node(std::move(copy));
        ids.push_back(number);
        // Morphing goes on at every level.
        std::vector<std::pair<OrderedJson*, OrderedJson>> more;
        each_weights_channel(n,
                             [&](OrderedJson& channels, std::size_t c, bool plain, const std::string& rest) {
                                 OrderedJson channel = channels[c];
                                 if (plain)
                                     channel["target"]["node"] = number;
                                 else
                                     channel["target"]["extensions"]["KHR_animation_pointer"]["pointer"] =
                                         "/nodes/" + std::to_string(number) + "/" + rest;
                                 more.emplace_back(&channels, std::move(channel));
                             });
        for (auto& [channels, channel] : more) channels->push_back(std::move(channel));
    }
    OrderedJson& host = root_["nodes"][n];
    host["extensions"]["MSFT_lod"] = {{"ids", std::move(ids)}};
    host["extras"]["MSFT_screencoverage"] = coverage;
    use_extension(root_, "MSFT_lod", false);
}

std::size_t NodeSurgery::apply_grid(std::size_t n, const Grid& grid) {
    OrderedJson& node = root_["nodes"][n];
    if (node.contains("skin")) return n;  // its inverse bind matrices take it
    const auto scale = OrderedJson::array({grid.scale, grid.scale, grid.scale});
    const auto offset = OrderedJson::array({grid.offset[0], grid.offset[1], grid.offset[2]});
    if (!simple(n) || node.contains("matrix")) {
        const std::size_t child = split_off(n);
        root_["nodes"][child]["translation"] = offset;
        root_["nodes"][child]["scale"] = scale;
        return child;
    }
    const auto numbers = [&](const char* key, std::vector<double> otherwise) {
        const OrderedJson* given = member(node, key);
        return given != nullptr ? given->get<std::vector<double>>() : otherwise;
    };
    auto t = numbers("translation", {0, 0, 0}), r = numbers("rotation", {0, 0, 0, 1}),
         s = numbers("scale", {1, 1, 1});
    // t' = t + R (s o): v + 2 w (u x v) + 2 u x (u x v), the quaternion being (u, w).
    const std::array<double, 3> v = {s[0] * grid.offset[0], s[1] * grid.offset[1], s[2] * grid.offset[2]};
    const auto cross = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
        return std::array<double, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                     a[0] * b[1] - a[1] * b[0]};
    };
    const double length = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3]);
    if (length > 0)
        for (double& x : r) x /= length;
    const std::array<double, 3> u = {r[0], r[1], r[2]};
    const auto uv = cross(u, v), uuv = cross(u, uv);
    for (std::size_t c = 0; c < 3; ++c) {
        t[c] += v[c] + 2 * r[3] * uv[c] + 2 * uuv[c];
        s[c] *= grid.scale;
    }
    node["translation"] = t;
    node["scale"] = s;
    return n;
}

void NodeSurgery::drop_missing_meshes() {
    OrderedJson* meshes = member(root_, "meshes");
    if (meshes == nullptr) return;
    std::vector<std::size_t> number(meshes->size(), 0);
    OrderedJson kept = OrderedJson::array();
    for (std::size_t m = 0; m < meshes->size(); ++m) {
        number[m] = kept.size();
        if (!(*meshes)[m].is_null()) kept.push_back(std::move((*meshes)[m]));
    }
    if (kept.size() == number.size()) {
        *meshes = std::move(kept);
        return;
    }
    *meshes = std::move(kept);
    for (OrderedJson& node : root_["nodes"])
        if (OrderedJson* mesh = member(node, "mesh")) *mesh = number[mesh->get<std::size_t>()];
    each_channel(root_, [&](OrderedJson& channels, std::size_t c) {
        OrderedJson& target = channels[c]["target"];
        if (const auto [m, rest] = pointed(target, "meshes"); !rest.empty() && m < number.size())
            target["extensions"]["KHR_animation_pointer"]["pointer"] =
                "/meshes/" + std::to_string(number[m]) + "/" + rest;
    });
    if (meshes->empty()) root_.erase("meshes");
}

}  // namespace vsplit::bake
