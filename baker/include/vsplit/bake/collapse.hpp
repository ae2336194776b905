// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// MESH -> COLLAPSE SEQUENCE: the full weighted edge-collapse record of a mesh, as a progressive mesh.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vsplit/bake/poses.hpp"
#include "vsplit/bake/progress.hpp"
#include "vsplit/mesh.hpp"
#include "vsplit/progressive_mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit::bake {

/// What a collapse costs.
enum class Cost : std::uint8_t {
    kQuadric,  ///< Memoryless area-weighted quadrics with volume and boundary terms; docs/collapse.md. The
               ///< default.
    kPaper,    ///< E = Q/Re + F of the paper (DESIGN.md, docs/collapse.md): quadric, regularity, curvature.
};

/// Where the vertex that remains is put.
enum class Placement : std::uint8_t {
    kOptimal,   ///< Where the cost is least.
    kEndpoint,  ///< On the better of the two ends: every position is one of the input's.
};

/// What a difference of attributes counts against a distance. A difference between what a removed vertex had
/// and what the triangles that remain have there costs as much as if the surface were this much away from it.
struct AttributeWeights {
    double texcoord = 0.5;  ///< Times how far the texture slides on the surface.
    double morph = 0.5;     ///< Times how far a morph target's vertex is moved elsewhere.
    // The others times the size of the triangles around, and:
    double normal = 1.0;   ///< the difference of unit vectors;
    double tangent = 0.0;  ///< the same;
    double color = 0.1;    ///< the difference of colours;
    double joints = 1.0;   ///< the difference of the joints' weights;
    double other = 0.1;    ///< the difference over the attribute's range.
};

struct CollapseOptions {
    Cost cost = Cost::kQuadric;
    Placement placement = Placement::kOptimal;

    bool lock_boundary = false;  ///< Vertices on boundary and non-manifold edges never move nor go.
    bool lock_seams = false;     ///< Nor those where attributes or groups differ across an edge.
    double lock_features_degrees =
        0;  ///< If > 0: nor do those on edges whose dihedral angle departs from flat by more.

    /// Weight of a boundary edge's squared length times squared distance, against a triangle's area times
    /// squared distance.
    double boundary_weight = 10;
    /// Weight of the change of volume (soft form of Lindstrom and Turk 1998, section 4.1).
    double volume_weight = 3;
    /// Pull toward the edge's middle, relative to the quadric's trace: what decides where the quadric does
    /// not.
    double regularisation = 1e-8;
    /// A collapse waits until its cost reaches this times the third power of the deviation it makes, times
    /// the mean area around an edge; 0 turns it off. Larger trades the mean error for the maximum.
    double deviation_limit = 0.5;
    AttributeWeights attribute_weights;
    /// Vertices of different parts never share a point, even if their positions are the same: empty, or one
    /// number per vertex. Only meshes with attributes or groups are asked for shared points at all.
    std::vector<std::uint32_t> part_of{};
    /// Boundary edges whose ends are at most so many diagonals of the mesh (of its part) from another's
    /// collapse as if they were one, and come apart in the last splits: 0 turns it off. Only in meshes with
    /// attributes or groups.
    double stitch = 2e-4;
    /// Poses besides the bind pose: what the surface departs from the posed input is counted where it is more
    /// than in the bind pose, and recorded errors are the largest of all poses. For meshes with attributes;
    /// cost `paper` is priced without. `set_of` must be empty or have one number per vertex.
    PoseSets poses{};
    /// Guard: a triangle's normal may turn by at most the angle of this cosine in one collapse.
    double min_normal_cosine = 0.4;
    /// Guard: least quality 4 sqrt(3) area / (sum of squared edges) of a changed triangle, unless it was
    /// worse before.
    double min_quality = 0.02;
    /// After the record, measures how far each collapse took the surface from the input, and puts off those
    /// few that take it much farther than others of their time, so that no level has a far point for which
    /// most of it is too fine. Their order is all that changes. Never with cost `paper`.
    bool put_off_outliers = true;
    /// Makes the recorded errors bounds of the measured distance to the input; without, they are estimates.
    bool calibrate = true;
};

/// What happened, for people and --json.
struct CollapseReport {
    std::uint64_t collapses = 0;
    std::uint64_t components = 0;       ///< Of the input.
    std::uint64_t unused_vertices = 0;  ///< That no triangle uses: left out of the record.
    /// With two corners at one point: only the full mesh has them, by a last split.
    std::uint64_t degenerate_triangles = 0;
    std::uint64_t duplicate_triangles = 0;  ///< Same three vertices as another, either way round: follow it.
    std::uint64_t stitched_vertices = 0;    ///< On boundaries that collapse as one; see `stitch`.
    std::uint64_t components_vanished = 0;  ///< Left out of the base mesh; one split brings each back.
    std::uint64_t fixed_vertices =
        0;  ///< Non-manifold corners, locked, or of infinite weight: never removed.
    std::string
        stopped_by;  ///< Why there is no coarser base: "every edge is guarded or would change the topology".
    double collapse_cpu_seconds = 0;   ///< The record alone, all threads.
    double calibrate_cpu_seconds = 0;  ///< What comes after it: measuring, and putting off.
};

struct CollapseResult {
    ProgressiveMesh mesh;
    CollapseReport report;
};

/// Of a mesh with attributes or groups, vertices at the same position are one point that collapses as a
/// whole; where attributes or groups differ across an edge, there is a seam, which collapses along itself
/// only. Attributes of the vertex that remains lie between those of both ends.
///
/// Collapses edges by ascending cost until none is left that keeps the topology, recording each. `mesh` must
/// be sound (mesh_fault() null): anything else is kArgument. Weights of the mesh (painted; 1 if none)
/// multiply the cost of their vertices (kPaper; kQuadric: their third power does, so that a weight tells
/// about how many times as dense a place stays), average on a collapse, and a vertex of infinite weight never
/// moves nor goes. Vertices that no triangle uses are left out and counted. The result is the same for any
/// number of threads. Works on up to 2^30 triangles; memory about 180 bytes a triangle.
Result<CollapseResult> collapse(const Mesh& mesh, const CollapseOptions& options = {},
                                const Progress& progress = {});

}  // namespace vsplit::bake
