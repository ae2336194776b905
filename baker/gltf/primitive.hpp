// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// One primitive of a glTF mesh as triangles, in the space of its mesh.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "document.hpp"
#include "vsplit/mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit::bake {

/// One attribute of the vertices that are used, as floats; of morph target 2 "2/POSITION".
struct PrimitiveAttribute {
    std::string name;
    int type = 0;            ///< tinygltf's: TINYGLTF_TYPE_VEC3, ...
    int component_type = 0;  ///< As stored.
    bool normalised = false;
    std::vector<float> values;  ///< components_of(type) of each vertex; not checked for being finite.
};

/// 1 to 16; 0 if there is no such type.
int components_of(int type);

/// The vertices that its triangles name, in the file's order.
struct PrimitiveMesh {
    std::vector<Float3> positions;
    std::vector<float> weights;          ///< One per position if `has_weights`, else empty.
    std::vector<std::uint32_t> corners;  ///< Three a triangle.
    std::vector<std::uint32_t> used;     ///< Per position, its number in the primitive's vertex array,
    std::uint64_t listed = 0;            ///< which has this many.
    std::uint64_t leftover = 0;          ///< Indices too few for a last triangle.
    bool has_weights = false;
    int position_type = 0;  ///< Component type, as stored.
    bool position_normalised = false;
    std::vector<PrimitiveAttribute> attributes;  ///< If they were asked for.
};

/// Where weights come from: an attribute and a component of it.
struct WeightChannel {
    std::string attribute;  ///< "COLOR_0"; empty: none.
    int component = 0;
    bool own = false;  ///< Our own _WEIGHT, where the largest float stands for infinity.
};

/// Whether the mode is one of the three that make triangles.
bool is_triangles(const tinygltf::Primitive& primitive);

/// More than `max_triangles` are refused (kLimit). Attributes other than POSITION are read if
/// `max_attribute_values` is not 0, which limits their floats (kLimit).
Result<PrimitiveMesh> read_primitive(Document& document, std::size_t mesh, std::size_t primitive,
                                     const WeightChannel& weights, std::uint64_t max_triangles,
                                     std::uint64_t max_attribute_values = 0);

}  // namespace vsplit::bake
