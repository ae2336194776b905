// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The ruler: how far a mesh is from a reference, both ways, and what is wrong with it (after Cignoni,
// Rocchini and Scopigno, Metro: Measuring Error on Simplified Surfaces, 1998).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "triangle_tree.hpp"
#include "vsplit/mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit::ruler {

struct RulerOptions {
    std::size_t samples = 200'000;  ///< On each of the two meshes, stratified by area; at least 1.
    std::uint64_t seed = 1;
};

/// Distances in the object's units, from samples of one surface to the closest points of the other.
struct OneWay {
    double mean = 0, rms = 0;
    double max = 0;  ///< Over the samples and every vertex.
    double normal_degrees =
        0;  ///< Mean angle between the normal at the sample and that of the closest triangle.
};

/// Counts of a mesh, and of what the reference did not have: a triangle whose three corners are where a
/// triangle of the reference has them is the reference's own.
struct Shape {
    std::uint64_t vertices = 0;  ///< Used ones.
    std::uint64_t triangles = 0, components = 0, boundary_edges = 0, non_manifold_edges = 0;
    std::uint64_t degenerate =
        0;  ///< A corner twice, quality below 1e-6, or area below 1e-14 of the squared diagonal.
    std::uint64_t flipped =
        0;  ///< Opposes the closest triangle of the reference at its centre and three points around it.
    std::uint64_t folded =
        0;  ///< Edges whose two triangles lie back on each other: cosine of the normals below -0.95.
    std::uint64_t new_degenerate = 0, new_flipped = 0, new_folded = 0;
    double quality_min = 0,
           quality_mean = 0;  ///< 4 sqrt(3) area / (sum of squared edges): 1 equilateral, 0 a sliver.
};

struct Measurement {
    OneWay from_reference, to_reference;
    double mean = 0, rms = 0, max = 0,
           normal_degrees = 0;  ///< Both ways: the mean of the means, the greater maximum.
    Shape shape;
};

/// Measures meshes against one reference. The same numbers for any number of threads (oneTBB). Building one
/// runs on the calling thread alone, so that a process may build a ruler and then fork.
class Ruler {
  public:
    /// Errors: kArgument if the mesh has no triangle, an index out of range or a corner that is not finite.
    static Result<Ruler> over(const Mesh& reference, const RulerOptions& options = {});

    /// The same errors for `mesh`. A triangle may name a vertex twice: it is counted as degenerate.
    Result<Measurement> measure(const Mesh& mesh) const;
    /// Measurement::max alone.
    Result<double> max_distance(const Mesh& mesh) const;
    /// Of the reference's bounding box.
    double diagonal() const { return diagonal_; }

  private:
    Ruler(const Mesh& reference, const RulerOptions& options);

    OneWay one_way(const Mesh& from, const Mesh& to, const TriangleTree& tree, std::uint64_t seed) const;
    Shape shape_of(const Mesh& mesh) const;
    std::uint32_t reference_vertex(Float3 position) const;
    bool in_reference(const Mesh& mesh, const Triangle& triangle) const;

    Mesh reference_;
    RulerOptions options_;
    TriangleTree tree_;
    double diagonal_ = 0;
    std::vector<std::uint32_t>
        by_position_;  ///< Vertices sorted by position: tells the reference's own triangles.
    std::vector<Triangle>
        sorted_triangles_;  ///< In vertices that are the first at their position, least corner first.
};

}  // namespace vsplit::ruler
