// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Cost `paper`: E = Q/Re + F, Cost = w_u E(u) + w_v E(v) (Research on Optimization Technology of Three
// Dimensional Model, formulas 4 to 7 and section III.B). docs/collapse.md says how its units are brought
// together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "guards.hpp"
#include "quadric_cost.hpp"
#include "star_mesh.hpp"

namespace vsplit::bake {

/// Formula 6, with the edges sorted ascending: (l1 + l2 - l3) / l2, 1 for an equilateral triangle, 0 for a
/// sliver (and a point).
double regularity(Double3 a, Double3 b, Double3 c);

/// The curvature of an edge seen from one end: the largest, over that end's triangles, of the smallest (1 -
/// n1.n2)/2 to a triangle on the edge; normals are unit vectors. 0 where flat, 1 where a triangle turns back
/// on all of the edge's. 0 without edge triangles.
double edge_curvature(std::span<const Double3> normals_at_end, std::span<const Double3> normals_on_edge);

/// Area-weighted sum of squared distances to planes (Garland and Heckbert 1997, section 5), about an origin
/// near the planes.
struct PlaneQuadric {
    Symmetric a{};
    Double3 b;
    double c = 0;
    double area = 0;

    /// The plane through `p` with twice the area vector `n2`.
    void add_plane(Double3 p, Double3 n2);
    void add(const PlaneQuadric& other);
    double value(Double3 x) const { return form(a, x) + 2 * dot(b, x) + c; }
    /// sqrt(value / area): the root mean square distance to the planes, a length.
    double distance(Double3 x) const;
};

class PaperCost {
  public:
    explicit PaperCost(const StarMesh& mesh);

    /// Cost of the edge and where it folds to, working units. `star` belongs to the edge.
    Candidate evaluate(const StarMesh& mesh, const EdgeStar& star, Fold fold, Placement placement,
                       double weight_u, double weight_v) const;
    /// The cost of folding to a given place: w_u E(u) + w_v E(v).
    double cost_at(const EdgeStar& star, Double3 place, double weight_u, double weight_v) const;

    void merge(std::uint32_t parent, std::uint32_t child) { quadrics_[parent].add(quadrics_[child]); }

  private:
    std::vector<PlaneQuadric> quadrics_;
};

}  // namespace vsplit::bake
