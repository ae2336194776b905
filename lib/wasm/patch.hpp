// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What a page needs besides LiveBuffers: patches of each array since the last ones, an index for each group
// of triangles (material), a scale for each group's positions, and smooth normals.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vsplit/live_buffers.hpp"

namespace vsplit::web {

/// New contents of stretches of an array: pairs of first element and number of elements, and their values in
/// a row.
template <class Value>
struct Stretches {
    std::vector<std::uint32_t> ranges;
    std::vector<Value> values;

    void clear() { ranges.clear(), values.clear(); }
    /// Room for `count` values that go to `first` on.
    Value* add(std::size_t first, std::size_t count);
};

/// Follows buffers that track their runs. All that take() and the rest return lives until the next take().
class Patcher {
  public:
    /// `groups` of triangles, numbered from 0; `normals` for smooth ones made here.
    Patcher(std::uint32_t groups, bool normals);

    /// Positions of this group's vertices are given times `scale`. Before the first take().
    void set_scale(std::uint32_t group, float scale);

    /// What changed since the last call.
    void take(LiveBuffers& buffers);

    const Stretches<float>& positions(const LiveBuffers& buffers);
    const Stretches<float>& vertex_values(std::span<const float> values, std::uint32_t components);
    /// Weighted by area; four numbers a vertex, the last 0.
    const Stretches<std::int16_t>& normals(const LiveBuffers& buffers);
    const Stretches<std::uint32_t>& group(std::uint32_t group) const { return indices_[group]; }
    std::uint32_t group_triangles(std::uint32_t group) const { return counts_[group]; }

  private:
    void learn(const LiveBuffers& buffers);

    std::vector<ElementRange> vertices_, triangles_;  ///< That changed.
    std::vector<Stretches<std::uint32_t>> indices_;
    std::vector<std::uint32_t> counts_;  ///< Triangles alive per group.
    std::vector<std::uint32_t> place_;   ///< Of each triangle in its group; empty if there is one group.
    std::vector<std::uint32_t> placed_;  ///< Triangles per group that have a place.
    std::uint32_t alive_ = 0;            ///< Triangles counted in counts_.
    std::vector<float> scale_of_group_, scale_of_vertex_;  ///< Empty: all 1.
    Stretches<float> values_;
    bool makes_normals_;
    std::vector<std::int16_t> normal_;  ///< As given last.
    std::vector<float> sums_;
    Stretches<std::int16_t> normals_;
};

}  // namespace vsplit::web
