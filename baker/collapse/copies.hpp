// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Triangles that occur more than once (twice the same, or both ways round as double-sided models have them)
// collapse as one; sheets whose triangles run one way here and the other there collapse as if they agreed. In
// the progressive mesh all are there again, as they were.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "vsplit/mesh.hpp"
#include "vsplit/progressive_mesh.hpp"

namespace vsplit::bake {

class TriangleCopies {
  public:
    /// Leaves one triangle of each three vertices in `triangles`, in order of the first ones. They come
    /// sorted by their least vertex; those of vertex v end before ends[v].
    void merge(std::vector<Triangle>& triangles, std::span<const std::uint32_t> ends);

    /// Turns triangles over so that those on two sides of an edge agree, in sheets that have two sides; false
    /// if none has to. Edges of more than two triangles bound a sheet.
    bool orient(std::vector<Triangle>& triangles);

    /// There is something for expand() to do.
    bool any() const { return !tags_.empty(); }
    /// How many triangles merge() left out.
    std::uint64_t count() const { return count_; }
    /// Which copies there are of a triangle that stayed; for expand().
    std::uint32_t tag(std::uint32_t triangle) const { return tags_[triangle]; }

    /// `mesh` has tags as groups: turns back what was turned over, adds the copies, born with their originals
    /// and changing corners as they do, and takes the groups away.
    void expand(ProgressiveMesh& mesh) const;

  private:
    /// How often a triangle occurs in each order of its corners.
    using Counts = std::array<std::uint32_t, 6>;

    std::uint32_t tag_of(const Counts& counts);

    std::vector<std::uint32_t> tags_;  // empty if all are single, as they were
    std::vector<Counts> counts_;       // of each tag
    std::map<Counts, std::uint32_t> known_;
    std::uint64_t count_ = 0;
};

}  // namespace vsplit::bake
