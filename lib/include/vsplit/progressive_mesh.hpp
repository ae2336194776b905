// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The hand-over between baking, the file and the live mesh: a base mesh and the vertex splits that refine it
// (Hoppe, Progressive Meshes, SIGGRAPH 1996), kept as patches to plain index and vertex buffers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "vsplit/mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit {

inline constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

/// One vertex split, as the ends of its ranges in ProgressiveMesh's arrays; they begin where the split before
/// ends (or the base mesh). Usually one vertex is born, one moves, two triangles open and about three corners
/// change; a seam gives birth to several vertices at once, and a component that had vanished comes back in
/// one split with no parents.
struct Split {
    std::uint32_t vertices_end = 0;   ///< Vertices alive after the split.
    std::uint32_t triangles_end = 0;  ///< Triangles alive after the split.
    std::uint32_t corners_end = 0;    ///< In corner_changes.
    std::uint32_t moves_end = 0;      ///< In moves.
    float error = 0;  ///< Geometric error, in the object's units, of the mesh *before* this split.
};

/// A corner that goes over to a vertex born in the same split; it held that vertex's parent before, and does
/// again after coarsening.
struct CornerChange {
    std::uint32_t corner = 0;  ///< 3 * triangle + 0, 1 or 2, of a triangle older than the split.
    std::uint32_t vertex = 0;  ///< Born in this split.
};

/// A vertex older than the split whose place, weight or attributes differ after it; usually the parent.
struct VertexMove {
    std::uint32_t vertex = 0;
    Float3 position;   ///< After the split (the finer one).
    float weight = 1;  ///< After the split.
};

/// A progressive mesh. Vertices and triangles are numbered in order of birth, so the mesh at level k (after k
/// splits) is a prefix of `positions` and a prefix of `triangles` whose later corner changes are undone.
/// Nothing in it depends on the mesh being manifold.
///
/// Rules, checked by progressive_mesh_fault(): levels only grow; a new triangle names three different
/// vertices alive after its split; a corner change names an older triangle and a vertex born in its split,
/// whose parent the corner holds; no triangle ever names a vertex twice; every number is finite; errors never
/// grow from one split to the next.
struct ProgressiveMesh {
    std::uint32_t base_vertices = 0;   ///< Level 0.
    std::uint32_t base_triangles = 0;  ///< Level 0.
    std::vector<Float3> positions;     ///< At birth. For a vertex of the base mesh: in the base mesh.
    std::vector<float> weights;        ///< At birth; empty (all 1), or one per vertex.
    std::vector<std::uint32_t>
        parents;  ///< One per vertex; kNoVertex for the base mesh and for returning components.
    std::vector<Triangle> triangles;  ///< Corners at birth.
    std::vector<Split> splits;
    std::vector<CornerChange> corner_changes;
    std::vector<VertexMove> moves;
    std::vector<Attribute> attributes;  ///< At birth, for all vertices.
    /// Parallel to `attributes`: the values of the vertices in `moves` after their move, components of each.
    std::vector<std::vector<float>> moved_values;
    std::vector<std::uint32_t> groups;  ///< Empty (all 0), or one per triangle: never changes.
    std::array<double, 3> origin{};     ///< As Mesh::origin, of all levels.

    std::size_t levels() const { return splits.size() + 1; }
};

/// Counts at a level, 0 <= level <= splits.size().
std::uint32_t vertices_at(const ProgressiveMesh& mesh, std::size_t level);
std::uint32_t triangles_at(const ProgressiveMesh& mesh, std::size_t level);
/// Largest distance between the level and the full mesh, both ways, in the object's units (as the baker
/// estimated it); 0 at the end.
double error_at(const ProgressiveMesh& mesh, std::size_t level);

/// The finest level with at most `count` triangles (vertices); level 0 if there is none.
std::size_t level_for_triangles(const ProgressiveMesh& mesh, std::uint64_t count);
std::size_t level_for_vertices(const ProgressiveMesh& mesh, std::uint64_t count);
/// The coarsest level whose geometric error is at most `error`.
std::size_t level_for_error(const ProgressiveMesh& mesh, double error);

/// What breaks the rules above, in words, or nullptr. Replays the whole mesh: linear in its size, allocates
/// one copy of the corners. Safe for hostile contents.
const char* progressive_mesh_fault(const ProgressiveMesh& mesh);

/// The paper's rule for weights that are set at a level rather than baked: on a split both children take the
/// parent's weight. `weights` are those of the vertices at `level`; the result has one for every vertex of
/// the full mesh. Vertices of a component that returns later get 1.
std::vector<float> inherit_weights(const ProgressiveMesh& mesh, std::size_t level,
                                   const std::vector<float>& weights);

}  // namespace vsplit
