// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Where poses put a wedge.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "vec.hpp"
#include "vsplit/bake/poses.hpp"
#include "vsplit/mesh.hpp"

namespace vsplit::bake {

/// Evaluates poses of vertices given by a place and a row of attribute values: offsets of morph targets, then
/// the joints by their weights (glTF 2.0, sections 3.7.2.2 and 3.7.3.3).
class Poser {
  public:
    /// Does nothing for a mesh without poses. `sets.set_of` is empty or one per vertex.
    Poser(const Mesh& mesh, const PoseSets& sets);

    /// The most that a set has.
    std::size_t count() const { return count_; }
    /// Of a vertex of the input.
    std::size_t count_of(std::uint32_t vertex) const {
        const std::uint32_t set = set_of(vertex);
        return set == PoseSets::kNone ? 0 : sets_[set].size();
    }
    std::uint32_t set_of(std::uint32_t vertex) const {
        return set_of_.empty() ? PoseSets::kNone : set_of_[vertex];
    }
    /// Three floats for each of count() poses into `out`. Poses that the vertex's set lacks: `place`.
    void pose(std::uint32_t vertex, const Float3& place, std::span<const float> row,
              std::span<float> out) const;

  private:
    struct Influences {
        std::uint32_t joints, weights;  // columns
    };
    std::vector<std::vector<Pose>> sets_;
    std::vector<std::uint32_t> set_of_;
    std::vector<Influences> influences_;
    std::vector<std::pair<std::size_t, std::uint32_t>> offsets_;  // target and column
    std::size_t count_ = 0;
};

}  // namespace vsplit::bake
