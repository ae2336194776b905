// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "attribute_set.hpp"

#include <algorithm>
#include <tuple>

namespace vsplit::bake {
namespace {

struct Name {
    int target = -1;  // of a morph target
    std::string_view base;
    int set = -1;  // TEXCOORD_3: 3
    std::string_view stem;
};

/// Digits without leading zeros, below a million; -1 for anything else.
int small_number(std::string_view text) {
    if (text.empty() || text.size() > 6 || (text.size() > 1 && text[0] == '0')) return -1;
    int value = 0;
    for (const char c : text) {
        if (c < '0' || c > '9') return -1;
        value = value * 10 + (c - '0');
    }
    return value;
}

Name parse(std::string_view name) {
    Name out;
    if (const auto slash = name.find('/'); slash != name.npos)
        if (out.target = small_number(name.substr(0, slash)); out.target >= 0) name.remove_prefix(slash + 1);
    out.base = out.stem = name;
    if (const auto line = name.rfind('_'); line != name.npos && line > 0)
        if (out.set = small_number(name.substr(line + 1)); out.set >= 0) out.stem = name.substr(0, line);
    return out;
}

}  // namespace

Semantic semantic_of(std::string_view full) {
    const Name name = parse(full);
    if (name.target >= 0) {
        if (name.base == "POSITION") return Semantic::kMorphOffset;
        if (name.base == "NORMAL") return Semantic::kMorphNormal;
        if (name.base == "TANGENT") return Semantic::kMorphTangent;
        return Semantic::kOther;
    }
    if (name.base == "NORMAL") return Semantic::kNormal;
    if (name.base == "TANGENT") return Semantic::kTangent;
    if (name.set >= 0 && name.stem == "TEXCOORD") return Semantic::kTexcoord;
    if (name.set >= 0 && name.stem == "COLOR") return Semantic::kColor;
    if (name.set >= 0 && name.stem == "JOINTS") return Semantic::kJoints;
    if (name.set >= 0 && name.stem == "WEIGHTS") return Semantic::kJointWeights;
    return Semantic::kOther;
}

Status AttributeSet::add(const std::string& name, int type, const std::string& place) {
    bool fits = true;
    switch (semantic_of(name)) {
        case Semantic::kNormal:
        case Semantic::kMorphOffset:
        case Semantic::kMorphNormal:
        case Semantic::kMorphTangent:
            fits = type == TINYGLTF_TYPE_VEC3;
            break;
        case Semantic::kTangent:
        case Semantic::kJointWeights:
        case Semantic::kJoints:
            fits = type == TINYGLTF_TYPE_VEC4;
            break;
        case Semantic::kTexcoord:
            fits = type == TINYGLTF_TYPE_VEC2;
            break;
        case Semantic::kColor:
            fits = type == TINYGLTF_TYPE_VEC3 || type == TINYGLTF_TYPE_VEC4;
            break;
        case Semantic::kOther:
            fits = components_of(type) > 0;
            break;
    }
    if (!fits)
        return Error{ErrorCode::kMalformed, place + ": " + name.substr(0, 100) + " is a " + type_name(type),
                     Error::kNowhere, 0};
    std::uint32_t& components = components_[name];
    components = std::max(components, static_cast<std::uint32_t>(components_of(type)));
    return Ok{};
}

const std::vector<Attribute>& AttributeSet::order() {
    // Joints and weights come in pairs, for whoever mixes them; a primitive that has only one keeps one.
    std::map<std::string, std::uint32_t> all = components_;
    for (const auto& [name, components] : components_)
        if (const Semantic semantic = semantic_of(name); semantic == Semantic::kJoints)
            all["WEIGHTS" + name.substr(name.rfind('_'))] = 4;
        else if (semantic == Semantic::kJointWeights)
            all["JOINTS" + name.substr(name.rfind('_'))] = 4;
    const auto key = [](const std::string& full) {
        const Name name = parse(full);
        int rank = 0;
        switch (semantic_of(full)) {
            case Semantic::kNormal:
            case Semantic::kMorphOffset:
                rank = 0;
                break;
            case Semantic::kTangent:
            case Semantic::kMorphNormal:
                rank = 1;
                break;
            case Semantic::kTexcoord:
            case Semantic::kMorphTangent:
                rank = 2;
                break;
            case Semantic::kColor:
                rank = 3;
                break;
            case Semantic::kJoints:
            case Semantic::kJointWeights:
                rank = 4;
                break;
            case Semantic::kOther:
                rank = 5;
                break;
        }
        return std::tuple(name.target, rank, rank == 5 ? 0 : name.set, full);
    };
    ordered_.clear();
    for (const auto& [name, components] : all) ordered_.push_back({name, semantic_of(name), components, {}});
    std::sort(ordered_.begin(), ordered_.end(),
              [&](const Attribute& a, const Attribute& b) { return key(a.name) < key(b.name); });
    for (std::size_t i = 0; i < ordered_.size(); ++i)
        numbers_[ordered_[i].name] = static_cast<std::uint32_t>(i);
    return ordered_;
}

std::uint64_t AttributeSet::components() const {
    std::uint64_t sum = 0;
    for (const Attribute& attribute : ordered_) sum += attribute.components;
    return sum;
}

const char* type_name(int type) {
    switch (type) {
        case TINYGLTF_TYPE_SCALAR:
            return "SCALAR";
        case TINYGLTF_TYPE_VEC2:
            return "VEC2";
        case TINYGLTF_TYPE_VEC3:
            return "VEC3";
        case TINYGLTF_TYPE_VEC4:
            return "VEC4";
        case TINYGLTF_TYPE_MAT2:
            return "MAT2";
        case TINYGLTF_TYPE_MAT3:
            return "MAT3";
        case TINYGLTF_TYPE_MAT4:
            return "MAT4";
        default:
            return "type that glTF does not have";
    }
}

}  // namespace vsplit::bake
