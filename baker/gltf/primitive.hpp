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

/// The vertices that its triangles name, in the file's order.
struct PrimitiveMesh {
    std::vector<Float3> positions;
    std::vector<float> weights;          ///< One per position if `has_weights`, else empty.
    std::vector<std::uint32_t> corners;  ///< Three a triangle.
    std::vector<std::uint32_t> used;     ///< Per position, its number in the primitive's vertex array,
    std::uint64_t listed = 0;            ///< which has this many.
    std::uint64_t leftover = 0;          ///< Indices too few for a last triangle.
    bool has_weights = false;
};

/// Where weights come from: an attribute and a component of it.
struct WeightChannel {
    std::string attribute;  ///< "COLOR_0"; empty: none.
    int component = 0;
    bool own = false;  ///< Our own _WEIGHT, where the largest float stands for infinity.
};

/// Whether the mode is one of the three that make triangles.
bool is_triangles(const tinygltf::Primitive& primitive);

/// More than `max_triangles` are refused (kLimit).
Result<PrimitiveMesh> read_primitive(Document& document, std::size_t mesh, std::size_t primitive,
                                     const WeightChannel& weights, std::uint64_t max_triangles);

}  // namespace vsplit::bake
