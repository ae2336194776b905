// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "weight_channel.hpp"

#include <map>
#include <string_view>

namespace vsplit::bake {
namespace {

Error fault(ErrorCode code, std::string message) {
    return {code, std::move(message), Error::kNowhere, 0};
}

}  // namespace

Result<WeightChannel> weight_channel(const std::string& text) {
    if (text.empty() || text == "_WEIGHT") return WeightChannel{"_WEIGHT", 0, true};
    const std::size_t dot = text.rfind('.');
    const std::size_t component =
        dot != text.npos && dot + 2 == text.size() ? std::string_view("rgba").find(text.back()) : text.npos;
    if (dot == 0 || component == text.npos)
        return fault(
            ErrorCode::kArgument,
            "a weight channel is an attribute and one of .r .g .b .a, as COLOR_0.r, not '" + text + "'");
    return WeightChannel{text.substr(0, dot), int(component), false};
}

std::string attributes_there(const tinygltf::Model& model) {
    std::map<std::string, int> names;
    for (const tinygltf::Mesh& mesh : model.meshes)
        for (const tinygltf::Primitive& primitive : mesh.primitives)
            names.insert(primitive.attributes.begin(), primitive.attributes.end());
    std::string text;
    for (const auto& [name, accessor] : names) {
        if (text.size() > 500) return text + ", ...";
        text += (text.empty() ? "" : ", ") + name.substr(0, 100);
    }
    return text.empty() ? "nothing" : text;
}

}  // namespace vsplit::bake
