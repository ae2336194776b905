// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "vsplit/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace vsplit {

const char* attributes_fault(const std::vector<Attribute>& attributes, std::size_t vertices) {
    for (std::size_t i = 0; i < attributes.size(); ++i) {
        const Attribute& attribute = attributes[i];
        if (attribute.components < 1 || attribute.components > 16)
            return "an attribute has no components, or more than 16";
        std::uint32_t least = 1, most = 16;
        switch (attribute.semantic) {
            case Semantic::kNormal:
            case Semantic::kMorphOffset:
            case Semantic::kMorphNormal:
            case Semantic::kMorphTangent:
                least = most = 3;
                break;
            case Semantic::kTangent:
            case Semantic::kJointWeights:
            case Semantic::kJoints:
                least = most = 4;
                break;
            case Semantic::kTexcoord:
                least = most = 2;
                break;
            case Semantic::kColor:
                least = 3, most = 4;
                break;
            case Semantic::kOther:
                break;
            default:
                return "an attribute's semantic is unknown";
        }
        if (attribute.components < least || attribute.components > most)
            return "an attribute's semantic asks for another number of components";
        if (attribute.values.size() / attribute.components != vertices ||
            attribute.values.size() % attribute.components != 0)
            return "there are not as many values of an attribute as vertices";
        for (const float value : attribute.values)
            if (!std::isfinite(value)) return "an attribute is not finite";
        const bool follows_joints = i > 0 && attributes[i - 1].semantic == Semantic::kJoints;
        if ((attribute.semantic == Semantic::kJointWeights) != follows_joints)
            return "joints and their weights do not follow each other";
    }
    if (!attributes.empty() && attributes.back().semantic == Semantic::kJoints)
        return "joints and their weights do not follow each other";
    // Files may announce thousands.
    std::vector<std::string_view> names;
    for (const Attribute& attribute : attributes) names.push_back(attribute.name);
    std::sort(names.begin(), names.end());
    if (std::adjacent_find(names.begin(), names.end()) != names.end()) return "two attributes have one name";
    return nullptr;
}

const char* mesh_fault(const Mesh& mesh) {
    for (const Float3& p : mesh.positions)
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            return "a position is not finite";
    for (const Triangle& t : mesh.triangles) {
        for (const std::uint32_t v : t)
            if (v >= mesh.positions.size()) return "a triangle names a vertex that does not exist";
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return "a triangle names a vertex twice";
    }
    if (!mesh.weights.empty() && mesh.weights.size() != mesh.positions.size())
        return "there are not as many weights as vertices";
    for (const float w : mesh.weights)
        if (!(w >= 0)) return "a weight is negative or not a number";
    if (!mesh.groups.empty() && mesh.groups.size() != mesh.triangles.size())
        return "there are not as many groups as triangles";
    for (const double x : mesh.origin)
        if (!std::isfinite(x)) return "the origin is not finite";
    return attributes_fault(mesh.attributes, mesh.positions.size());
}

}  // namespace vsplit
