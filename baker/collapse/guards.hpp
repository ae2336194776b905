// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Which collapses are allowed: those that keep the topology and turn no triangle over.
#pragma once

#include <cstdint>
#include <vector>

#include "quadric_cost.hpp"
#include "star_mesh.hpp"

namespace vsplit::bake {

/// How an edge may fold.
enum class Fold : std::uint8_t {
    kNever,
    kAnywhere,    ///< The remaining vertex may be put anywhere.
    kIntoFirst,   ///< Only onto the first vertex's place.
    kIntoSecond,  ///< Only onto the second's.
};

/// By the kinds of the ends, and whether the edge is special.
Fold fold_rule(const StarMesh& mesh, std::uint32_t u, std::uint32_t v);

/// The triangles that an edge's collapse changes, gathered once for all tests.
struct EdgeStar {
    struct Wing {
        std::uint32_t a, b;  ///< The triangle is (apex, a, b), counter-clockwise.
        Double3 pa, pb;
        Double3 normal;  ///< Twice the area vector.
        bool at_first;   ///< The apex is the edge's first vertex.
    };
    std::uint32_t u = 0, v = 0;
    Double3 pu, pv;
    std::vector<Wing> wings;              ///< Triangles that stay.
    std::vector<std::uint32_t> opposite;  ///< Third vertices of the triangles on the edge.
    std::vector<Double3> opposite_places;
    std::vector<bool> forward;  ///< The triangle on the edge runs along it from u to v.

    void gather(const StarMesh& mesh, std::uint32_t first, std::uint32_t second);
};

/// How strict the guards are; later passes get past what stops the first.
struct Strictness {
    double min_normal_cosine;
    double min_quality;
    std::size_t max_valence;
    bool keep_orientation;  ///< No triangle may oppose the input's normals around two of its corners.
};

class Guards {
  public:
    explicit Guards(const StarMesh& mesh) : mesh_(mesh), stamps_(mesh.vertex_count(), 0) {}

    /// The link condition, and what else collapsing the edge would do to the topology.
    bool keeps_topology(const EdgeStar& star);
    /// No triangle flips, folds over or becomes a sliver when the remaining vertex is put at `place`.
    bool keeps_shape(const EdgeStar& star, Double3 place, const std::vector<VertexHistory>& histories,
                     const Strictness& strictness) const;

  private:
    const StarMesh& mesh_;
    std::vector<std::uint32_t> stamps_;
    std::uint32_t stamp_ = 0;
};

}  // namespace vsplit::bake
