// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What is written down at each collapse, and how it becomes a progressive mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "star_mesh.hpp"
#include "vsplit/progressive_mesh.hpp"

namespace vsplit::bake {

/// The collapses in the order in which they happened, in the numbers of a StarMesh.
class Record {
  public:
    explicit Record(bool has_weights) : has_weights_(has_weights) {}

    /// For a mesh of so many.
    void reserve(std::size_t vertices, std::size_t triangles);

    /// `child` folded into `parent`, which was at `parent_position` with `parent_weight`, and has another
    /// position or weight now if `moved`; ranges of the two lists that StarMesh::fold() appended to end here.
    /// The child keeps position and weight in the mesh.
    void add(std::uint32_t child, std::uint32_t parent, const Float3& parent_position, float parent_weight,
             bool moved, float error);
    /// A component went: `vertices` and (in `removed`) its triangles.
    void add_vanished(const std::vector<std::uint32_t>& vertices, float error);
    /// Appends steps `begin` to `end` - 1 of another record.
    void append(const Record& other, std::size_t begin, std::size_t end);

    std::vector<std::uint32_t> corners_changed;  ///< 3 * triangle + corner.
    std::vector<std::uint32_t> removed;          ///< Triangles.

    std::size_t size() const { return steps_.size(); }

    struct Step {
        std::uint32_t child =
            0;  ///< Or kNoVertex: a component vanished; the parent is its number among those.
        std::uint32_t parent : 31 = 0;
        std::uint32_t moved : 1 = 0;
        std::uint32_t corners_end = 0;
        std::uint32_t removed_end = 0;
        Float3 parent_position;
        float error = 0;
    };
    const std::vector<Step>& steps() const { return steps_; }
    /// 1 without weights.
    float parent_weight(std::size_t step) const { return has_weights_ ? parent_weights_[step] : 1.0f; }

    /// Reverses the record: births in the order of the splits. `weights` are the current ones of all vertices
    /// (empty: none), the dead ones' as they were when they went. `births`, if given, receives the StarMesh
    /// vertex of each vertex. Consumes the record.
    ProgressiveMesh finish(const StarMesh& mesh, const std::vector<float>& weights,
                           std::vector<std::uint32_t>* births);

  private:
    std::uint32_t vanished_end(std::uint32_t number) const {
        return number + 1 < vanished_begins_.size() ? vanished_begins_[number + 1]
                                                    : std::uint32_t(vanished_.size());
    }

    std::vector<Step> steps_;
    std::vector<float> parent_weights_;
    std::vector<std::uint32_t> vanished_;         // vertices of vanished components
    std::vector<std::uint32_t> vanished_begins_;  // where each of them begins
    float error_ = 0;                             // the largest so far
    bool has_weights_;
};

}  // namespace vsplit::bake
