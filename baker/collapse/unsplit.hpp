// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The collapses of a progressive mesh once more, one by one, with the stars around them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "star_mesh.hpp"
#include "vsplit/progressive_mesh.hpp"

namespace vsplit::bake {

/// Begins at the full mesh and undoes split after split. Refers to the progressive mesh, which must be sound
/// and stay as it is.
class Unsplitter {
  public:
    explicit Unsplitter(const ProgressiveMesh& mesh);

    /// The full mesh.
    static Mesh full(const ProgressiveMesh& mesh);

    /// Undoes the last split; there must be one. Returns its number.
    std::uint32_t step();
    std::uint32_t splits_left() const { return left_; }

    // Of the last step:
    /// The vertices that it acts on: parents of those that went, and what moved. Ascending.
    std::span<const std::uint32_t> acts() const { return acts_; }
    /// The vertices that went.
    std::uint32_t gone_begin() const { return positions_end(left_); }
    std::uint32_t gone_end() const { return positions_end(left_ + 1); }
    /// The triangles that went, with the corners they had then.
    std::uint32_t removed_begin() const { return triangles_end(left_); }
    std::uint32_t removed_end() const { return triangles_end(left_ + 1); }

    // As things are now:
    std::span<const Float3> positions() const { return {positions_.data(), positions_end(left_)}; }
    std::span<const Triangle> triangles() const { return {corners_.data(), triangles_end(left_)}; }
    /// A triangle that may be gone, as it was last.
    const Triangle& triangle(std::uint32_t t) const { return corners_[t]; }
    /// Visits the triangles around a vertex.
    template <class Visit>
    void star(std::uint32_t v, const Visit& visit) {
        std::uint32_t* at = &first_[v];
        while (*at != kNoVertex) {
            if (*at / 3 >= triangles_end(left_)) {
                *at = next_[*at];  // It went: leave it out from now on.
                continue;
            }
            visit(*at / 3);
            at = &next_[*at];
        }
    }

    /// Asks for the memory of a step that comes soon; visits triangles that it changes.
    template <class Visit>
    void look_ahead(const Visit& visit) const {
        if (left_ <= 2 * kAhead) return;
        for (std::uint32_t v = positions_end(left_ - 2 * kAhead); v < positions_end(left_ - 2 * kAhead + 1);
             ++v)
            if (mesh_.parents[v] != kNoVertex) {
                fetch_ahead(&first_[mesh_.parents[v]]);
                fetch_ahead(&positions_[mesh_.parents[v]]);
            }
        const std::uint32_t soon = left_ - kAhead, begin = mesh_.splits[soon - 1].corners_end;
        for (std::uint32_t i = begin; i < std::min(mesh_.splits[soon].corners_end, begin + kMostAhead); ++i) {
            const std::uint32_t t = mesh_.corner_changes[i].corner / 3;
            fetch_ahead(&corners_[t]);
            fetch_ahead(&next_[3 * t]);
            visit(t);
        }
    }

  private:
    static constexpr std::uint32_t kAhead = 6, kMostAhead = 8;

    std::uint32_t positions_end(std::uint32_t split) const {
        return split == 0 ? mesh_.base_vertices : mesh_.splits[split - 1].vertices_end;
    }
    std::uint32_t triangles_end(std::uint32_t split) const {
        return split == 0 ? mesh_.base_triangles : mesh_.splits[split - 1].triangles_end;
    }
    void link(std::uint32_t corner, std::uint32_t v) {
        next_[corner] = first_[v];
        first_[v] = corner;
    }

    const ProgressiveMesh& mesh_;
    std::uint32_t left_;
    std::vector<Float3> positions_;
    std::vector<Float3> before_;  // of each move: the place before it
    std::vector<Triangle> corners_;
    std::vector<std::uint32_t> first_, next_;  // chains of corners, one a vertex
    std::vector<std::uint32_t> acts_;
};

}  // namespace vsplit::bake
