// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Exact closest point of a triangle mesh: a binary box tree split by the surface area heuristic in bins (Wald
// 2007).
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "vec.hpp"
#include "vsplit/mesh.hpp"

namespace vsplit::bake {

/// Refers to the mesh, which must stay as it is; queries are const and may run at once.
class TriangleTree {
  public:
    static constexpr std::uint32_t kNoGuess = 0xFFFFFFFFu;

    struct Hit {
        double distance2 = 0;
        std::uint32_t triangle = 0;  ///< As the mesh numbers them.
        std::uint32_t slot = 0;      ///< A guess for the next query nearby.
    };

    /// `mesh` has a triangle, its corners exist and are finite.
    explicit TriangleTree(const Mesh& mesh);

    /// Puts the tree's own mesh in the order of its leaves, triangles and vertices: what is asked for
    /// together lies together, and slots are the triangles' numbers. Returns the new number of each vertex;
    /// one that no triangle has goes, and has kNoVertex.
    std::vector<std::uint32_t> arrange(Mesh& mesh);

    /// The closest triangle; of several at the same distance any, but always the same for the same guess. A
    /// guess (Hit::slot of a point nearby) only makes it faster. A triangle within `enough2` (squared) is
    /// good enough: the first found is returned. `bound2`, if the caller knows that something is that near,
    /// spares looking farther away: it is the distance if no triangle is nearer, and the triangle then any.
    /// After about `most` triangles the nearest of them is taken: near a hub's axis thousands are as near.
    Hit closest(Double3 point, std::uint32_t guess = kNoGuess, double enough2 = 0,
                double bound2 = std::numeric_limits<double>::infinity(),
                std::uint32_t most = std::numeric_limits<std::uint32_t>::max()) const;

    struct Meeting {
        double distance = std::numeric_limits<double>::infinity();  ///< In lengths of the direction.
        std::uint32_t triangle = 0;
    };
    /// The first triangle that a ray meets, from either side; of several at one distance that of the lowest
    /// number. An infinite distance if it meets none.
    Meeting first_met(Double3 from, Double3 direction) const;

    /// Appends the triangles in the leaves whose boxes meet the box from `low` to `high`; false if they are
    /// more than `most`, and not all are there.
    bool overlapping(Double3 low, Double3 high, std::size_t most, std::vector<std::uint32_t>& out) const;

  private:
    struct alignas(32) Node {
        std::array<float, 3> low, high;
        std::uint32_t first = 0, count = 0;  ///< count 0: an inner node, children at first and first + 1.
    };
    struct Box {
        std::array<float, 3> low, high, centre;
    };
    struct Range {
        std::uint32_t node, depth;
    };

    void grow(std::vector<Node>& nodes, Range root, const std::vector<Box>& boxes, std::uint32_t most,
              std::vector<Range>* parts);
    void fit(Node& node, const std::vector<Box>& boxes, std::array<float, 3>& low,
             std::array<float, 3>& high) const;
    std::uint32_t split(const Node& node, const std::vector<Box>& boxes, int axis, float low, float extent);
    double box_distance2(const Node& node, Double3 p) const;
    double distance2(std::uint32_t slot, Double3 p) const;
    std::uint32_t triangle_at(std::uint32_t slot) const { return order_.empty() ? slot : order_[slot]; }

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;  ///< Leaf order -> mesh order; none once they are the same.
    const Mesh& mesh_;
};

}  // namespace vsplit::bake
