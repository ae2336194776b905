// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What a collapse makes of attributes, and what that costs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "edge_star.hpp"
#include "wedges.hpp"

namespace vsplit::bake {

/// The values that a pair's wedge has at `place` once it is all that is left of the two, into `out`: its own
/// if it stays where it is. Else what the nearest of the old triangles on its side of seams has there,
/// fitted to the samples of both.
void mix_at(const StarMesh& mesh, const EdgeStar& star, const WedgeStar& wedges, const WedgePair& pair,
            const WedgeValues& values, Double3 place, std::span<float> out);

/// What a collapse does to attributes and in poses.
struct AttributeCost {
    /// The triangles' area^1.5 around the edge times the mean squared length that WedgeValues::apart2 says,
    /// of the samples of all wedges against the new triangles, plus the mean over all poses of how much
    /// farther (squared) a sample is from them there than in the bind pose.
    double cost = 0;
    double posed = 0;         ///< The largest of those distances in any pose, working units.
    bool turns_over = false;  ///< A triangle is turned over in a pose.
};
AttributeCost attribute_cost(const StarMesh& mesh, const EdgeStar& star, const WedgeStar& wedges,
                             const WedgeValues& values, Double3 place);

/// The wedges of an edge that joints and morph targets move as they do the first pair's, at each end; not
/// those of that pair itself.
void alike_in_motion(const WedgeStar& star, const WedgeValues& values, std::vector<std::uint32_t>& out);

/// The samples of the wedge that remains of a pair, of which those stay that it shows worst. `mixed`: what it
/// will have; the mesh is still as it was.
void join_samples(const StarMesh& mesh, const EdgeStar& star, const WedgePair& pair, WedgeValues& values,
                  Double3 place, std::span<const float> mixed);

}  // namespace vsplit::bake
