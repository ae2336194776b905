// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Nearest neighbours among the points of a cloud.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "points/vec3.hpp"

namespace vsplit::bake {

/// A k-d tree. Ties in distance are broken by index, so that the answer depends on the points alone.
class Neighbours {
  public:
    explicit Neighbours(std::span<const Vec3> points);

    struct Found {
        double squared_distance;
        std::uint32_t index;
        bool operator<(const Found& other) const {
            return squared_distance != other.squared_distance ? squared_distance < other.squared_distance
                                                              : index < other.index;
        }
    };
    /// The `k` points nearest to `place`, nearest first, fewer if there are fewer. `skip` is left out.
    void nearest(Vec3 place, std::size_t k, std::vector<Found>& found,
                 std::uint32_t skip = 0xFFFFFFFFu) const;

  private:
    struct Node {
        double split;
        std::uint32_t first,
            count;  ///< Points of a leaf; an inner node has count 0 and its second child at `first`.
        std::uint8_t axis;
    };
    std::uint32_t build(std::span<const Vec3> points, std::uint32_t first, std::uint32_t last);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
    std::vector<Vec3> sorted_;
};

}  // namespace vsplit::bake
