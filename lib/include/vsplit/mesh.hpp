// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The indexed triangle mesh that every stage reads and writes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vsplit {

/// A point or vector in the object's own units, right-handed.
struct Float3 {
    float x = 0, y = 0, z = 0;
    friend bool operator==(const Float3&, const Float3&) = default;
};

/// Three vertex indices, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// An indexed triangle mesh; owns its arrays. Nothing is promised of the topology: holes, several components,
/// non-manifold edges and vertices, duplicate and zero-area triangles may all be there.
/// Stages that take a Mesh require `mesh_fault(mesh)` to be null.
struct Mesh {
    std::vector<Float3> positions;    ///< One per vertex, finite.
    std::vector<Triangle> triangles;  ///< Indices below positions.size(), three different ones each.
    std::vector<float> weights;       ///< Painted weights: empty, or one per vertex, each >= 0 and not NaN.
};

/// What breaks the rules above, in words, or nullptr for a sound mesh. Linear in the mesh's size.
const char* mesh_fault(const Mesh& mesh);

}  // namespace vsplit
