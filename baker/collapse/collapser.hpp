// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The order of the work: rounds of one octave of costs, in each of them regions at once.
#pragma once

#include <utility>

#include "region.hpp"

namespace vsplit::bake {

/// Rounds are worked on by regions of neighbouring vertices, then come, one by one, the vertices whose
/// edges reach into several regions. Where regions begin depends on the mesh alone, so that the result does
/// not depend on the number of threads; and a region fits the cache.
class Collapser {
  public:
    Collapser(const Mesh& mesh, const CollapseOptions& options);
    Collapser(const PointMesh& points, const Mesh& input, const CollapseOptions& options);

    /// False if `progress` asked to stop.
    bool run(const Progress& progress);

    /// After run(): the record as a progressive mesh; errors in object units, not yet calibrated.
    /// Its groups are tags of copies(), if there are any. `extras` are for a mesh with wedges.
    ProgressiveMesh finish(CollapseReport& report, WedgeExtras& extras);
    TriangleCopies take_copies() { return state_.mesh.take_copies(); }

  private:
    void prepare(const Mesh& mesh);
    void lock();
    /// All vertices' shapes, and what is kept of the input; marks what lies back on each other.
    void shape_all();
    void price_all();
    /// Collapses those of `items` (ascending) that wait in the window by regions of `size` vertices, of which
    /// the first ends at `shift`; returns what they put off.
    std::vector<std::uint32_t> in_regions(const std::vector<std::uint32_t>& items, std::uint32_t size,
                                          std::uint32_t shift, Bucket begin, Bucket end);
    /// Collapses what waits in the window; false if `between` asked to stop.
    template <class Between>
    bool round(Bucket begin, Bucket end, std::uint64_t number, const Between& between);
    /// The window of the next round, below `limit`; empty at the end.
    std::pair<Bucket, Bucket> next_window(Bucket limit) const;
    /// The least bucket in which a component waits.
    Bucket next_component() const;
    /// Lines up all edges anew, for other guards.
    void retry_all();
    /// Rounds until nothing waits below `limit`; false if `between` asked to stop.
    template <class Between>
    bool rounds(Bucket limit, const Between& between);
    void take(const Region& region);

    CollapseState state_;
    const Mesh* input_ = nullptr;  // of a mesh with wedges
    Record record_;
    WedgeRecord wedge_record_;
    std::unique_ptr<Region> whole_;
    std::vector<std::unique_ptr<Region>> parts_;  // of the round; kept for their memory
    std::vector<std::uint32_t> alive_;            // vertices, ascending; up to as many dead ones among them
    std::uint64_t vanished_ = 0, rounds_ = 0;
    std::uint64_t unused_vertices_ = 0;
};

}  // namespace vsplit::bake
