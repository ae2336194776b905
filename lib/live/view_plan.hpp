// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What view-dependent refinement must know of each split before the first frame.
#pragma once

#include <cstddef>
#include <cstdint>
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

struct ViewPlan {
    /// The splits that must be applied before split k: needs[needs_begin[k]] up to needs_begin[k + 1].
    std::vector<std::uint32_t> needs_begin, needs;
    std::vector<ViewNode> nodes;
    std::vector<std::uint32_t> vertex;          ///< Of each split: the parent, or kNoVertex.
    std::vector<std::uint32_t> next, previous;  ///< Splits of the same parent, or kNoSplit.
    std::vector<std::uint32_t> first;           ///< Of each vertex: its first split, or kNoSplit.
    std::vector<std::uint32_t> born;       ///< Of each vertex: the split that makes it; empty afterwards.
    std::vector<std::uint32_t> returning;  ///< Splits without a parent.
};

/// False if the stars around the splits are too large in all. `mesh` is at level 0, and is left so.
bool plan_view(ProgressiveMesh& mesh, ViewPlan& plan);

}  // namespace vsplit
