// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The indexed triangle mesh that every stage reads and writes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vsplit {

/// A point or vector in the object's own units, right-handed.
struct Float3 {
    float x = 0, y = 0, z = 0;
    friend bool operator==(const Float3&, const Float3&) = default;
};

/// Three vertex indices, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// What the values of an attribute are, and so how two of them are mixed and what they must obey.
enum class Semantic : std::uint8_t {
    kNormal,        ///< 3: a unit vector.
    kTangent,       ///< 4: a unit vector, and a handedness of 1 or -1, which is never mixed.
    kTexcoord,      ///< 2.
    kColor,         ///< 3 or 4, linear.
    kJoints,        ///< 4: whole numbers, never mixed; belongs to the kJointWeights that follows it.
    kJointWeights,  ///< 4: how much each of the joints before it counts.
    kMorphOffset,   ///< 3: what a morph target adds to the position.
    kMorphNormal,   ///< 3: what it adds to the normal.
    kMorphTangent,  ///< 3: what it adds to the tangent's direction.
    kOther,         ///< Anything, mixed linearly.
};

/// One value of `components` finite floats per vertex.
struct Attribute {
    std::string name;  ///< "NORMAL", "TEXCOORD_0", ...; of morph target 2 "2/POSITION". Different for each.
    Semantic semantic = Semantic::kOther;
    std::uint32_t components = 1;  ///< 1 to 16.
    std::vector<float> values;     ///< components per vertex.
    friend bool operator==(const Attribute&, const Attribute&) = default;
};

/// An indexed triangle mesh; owns its arrays. Nothing is promised of the topology: holes, several components,
/// non-manifold edges and vertices, duplicate and zero-area triangles may all be there.
/// Vertices are those of a renderer: where attributes differ across an edge (a seam), several vertices have
/// the same position, bit by bit (0 and -0 being the same).
/// Stages that take a Mesh require `mesh_fault(mesh)` to be null.
struct Mesh {
    std::vector<Float3> positions;    ///< One per vertex, finite.
    std::vector<Triangle> triangles;  ///< Indices below positions.size(), three different ones each.
    std::vector<float> weights;       ///< Painted weights: empty, or one per vertex, each >= 0 and not NaN.
    std::vector<Attribute> attributes{};
    /// Which material or part a triangle belongs to: empty (all 0), or one per triangle.
    std::vector<std::uint32_t> groups{};
    /// What was taken off the source's coordinates, finite; add it for the place there. Zeros but for sources
    /// so far from 0 for their size (map projections) that floats would lose what tells their vertices apart.
    std::array<double, 3> origin{};
};

/// What breaks the rules of attributes of `vertices` vertices, in words, or nullptr.
const char* attributes_fault(const std::vector<Attribute>& attributes, std::size_t vertices);

/// What breaks the rules above, in words, or nullptr for a sound mesh. Linear in the mesh's size.
const char* mesh_fault(const Mesh& mesh);

}  // namespace vsplit
