// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// All splits in another order than the file's, of which every beginning can be applied, too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "view_plan.hpp"
#include "vsplit/progressive_mesh.hpp"

namespace vsplit {

/// By error times weight, the largest first; a split goes with the most important of those that need it.
struct SplitOrder {
    std::vector<std::uint32_t> splits;         ///< By rank.
    std::vector<std::uint32_t> vertices_end;   ///< Alive once the split of a rank and those before are done.
    std::vector<std::uint32_t> triangles_end;  ///< Likewise.
    std::vector<float> error;                  ///< Of each rank, weighed; never grows.

    /// `weights` are one for each split, or empty: all 1, and the order is the file's. O(n log n).
    void build(const ProgressiveMesh& mesh, const ViewPlan& plan, std::span<const float> weights);
    std::size_t memory() const;
};

}  // namespace vsplit
