// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What view-dependent refinement must know of each split before the first frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "vsplit/progressive_mesh.hpp"

namespace vsplit {

inline constexpr std::uint32_t kNoSplit = ~std::uint32_t{0};

/// A split as a camera judges it: what its vertex and all that comes of it may look like.
struct ViewNode {
    float error = 0;   ///< Distance to the coarser surface, this split's or a later one's below it.
    Float3 centre;     ///< Where its parent is born.
    float radius = 0;  ///< Around that: all triangles that come of the split.
    Float3 normal;     ///< Mean of the triangles'; all zero if they have none.
    float spread = 1;  ///< Sine of the largest angle to them; 1 from a right angle on.
};

/// Grows with the splits that are known: what is known of later ones counts for those above them.
struct ViewPlan {
    /// The splits that must be applied before split k: needs[needs_begin[k]] up to needs_begin[k + 1].
    std::vector<std::uint32_t> needs_begin{0}, needs;
    std::vector<ViewNode> nodes;
    std::vector<float> own_error;               ///< Of each split: its own distance to the coarser surface.
    std::vector<std::uint32_t> vertex;          ///< Of each split: the parent, or kNoVertex.
    std::vector<std::uint32_t> next, previous;  ///< Splits of the same parent, or kNoSplit.
    std::vector<std::uint32_t> first;           ///< Of each vertex: its first split, or kNoSplit.
    std::vector<std::uint32_t> born;            ///< Of each vertex: the split that makes it, or kNoSplit.
    std::vector<std::uint32_t> returning;       ///< Splits without a parent.

    /// The split that answers for this one: the one before of its vertex, or the one that makes that.
    std::uint32_t above(std::uint32_t split) const {
        if (previous[split] != kNoSplit || vertex[split] == kNoVertex) return previous[split];
        return born[vertex[split]];
    }
    /// Errors count as often as the splits' weights say, those of all splits.
    void weigh(std::span<const float> weights);
};

/// Replays the sequence once, as far as it is known, and goes on when more of it is.
class ViewPlanner {
  public:
    explicit ViewPlanner(ViewPlan& plan);
    ~ViewPlanner();

    /// `mesh` is what it was before and more, at level 0. `weight` of each new split multiplies its error (1
    /// if empty). Appends to `changed` the older splits whose nodes are not what they were; ascending within
    /// nothing, and possibly more than once. False if the stars around the splits are too large in all: the
    /// plan is then of no use.
    bool extend(const ProgressiveMesh& mesh, std::span<const float> weight,
                std::vector<std::uint32_t>& changed);

    /// Bytes allocated.
    std::size_t memory() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace vsplit
