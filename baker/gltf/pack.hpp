// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Attribute values made lawful again after mixing, and put into a glTF accessor's numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "vsplit/bake/scene.hpp"
#include "vsplit/mesh.hpp"

namespace vsplit::bake {

constexpr std::uint32_t kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                        kUnsignedInt = 5125, kFloat = 5126;

/// An attribute of one primitive's vertices, and how it is to be stored.
struct VertexValues {
    std::string name;  ///< "2/POSITION" of a morph target.
    Semantic semantic = Semantic::kOther;
    StoredAttribute stored;
    std::uint32_t components = 1;  ///< Of stored.type.
    std::vector<float> values;
};

/// Components of glTF's type by name: "VEC3" has 3; 0 if there is none of that name.
std::uint32_t components_of_name(const std::string& type);
/// Bytes of a component.
std::uint32_t component_bytes(std::uint32_t component_type);

/// Unit normals and tangents, handedness of 1 or -1, colours in [0, 1], joints whole, joint weights positive
/// and 1 together over all sets, no joint twice, and joint 0 where the weight is 0. What is lawful keeps its
/// bits. `fallback` has a normal for each vertex that has none.
void make_lawful(std::vector<VertexValues>& attributes, std::span<const Float3> fallback);

/// An accessor's bytes, each element starting at a multiple of four, with its smallest and largest numbers.
struct PackedValues {
    std::vector<std::byte> bytes;
    std::uint32_t stride = 0;
    std::size_t count = 0;
    StoredAttribute stored;
    std::vector<double> min, max;  ///< As stored, per component.
};

/// Rounds to what the stored type has; joint weights must be lawful.
PackedValues pack(const VertexValues& values);

/// Makes the joint weights of all sets, which are fractions of `whole`, whole numbers of that sum.
void round_joint_weights(std::vector<VertexValues>& attributes);

}  // namespace vsplit::bake
