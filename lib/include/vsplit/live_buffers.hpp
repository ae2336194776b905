// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What a renderer draws of a progressive mesh that is still arriving: plain vertex and index buffers, refined
// and coarsened in place, with the ranges to send to the GPU. Holds its own compact copy of the splits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vsplit/dirty_runs.hpp"
#include "vsplit/progressive_mesh.hpp"

namespace vsplit {

/// What changed since the last take_dirty(): half-open ranges of elements, within what is alive; empty if
/// begin >= end. They are hulls: what lies within need not have changed.
struct DirtyRanges {
    std::uint32_t vertices_begin = 0, vertices_end = 0;    ///< Position, attributes or weight; or born.
    std::uint32_t triangles_begin = 0, triangles_end = 0;  ///< Corners; or born.
};

/// Where places are origin + step * n for whole numbers n along each axis: FileInfo::lattice_origin and
/// lattice_step, unless the file is lossless. It saves memory; places that are not on it cost no more than
/// that.
struct PlaceGrid {
    std::array<double, 3> origin{};
    double step = 0;  ///< 0: none.
};

/// A vertex or triangle that dies keeps its number and comes back with the same values, so that buffers on
/// the GPU hold a prefix that is drawn and a tail that is not. Refining, then coarsening by the same splits
/// restores every byte. Contents must be sound (progressive_mesh_fault() is null): not checked again.
/// Spans stay valid until begin(); their data never moves. Not synchronised; objects are independent.
class LiveBuffers {
  public:
    LiveBuffers() = default;

    /// Starts anew with the base mesh at level 0, and appends the splits that `mesh` has. The totals are
    /// those of the whole mesh: memory for them is allocated here, and never again but for unusual splits.
    void begin(const ProgressiveMesh& mesh, std::uint32_t vertices, std::uint32_t triangles,
               std::uint32_t splits, std::uint32_t corner_changes, std::uint32_t moves,
               const PlaceGrid& grid = {});

    /// Appends mesh.splits from available() on; the level stays. `mesh` is what it was before and more, and
    /// is at level 0 as BlockDecoder::mesh() is. Splits that go beyond the totals are not taken.
    void append(const ProgressiveMesh& mesh);

    /// Splits applied; 0 is the base mesh.
    std::size_t level() const { return level_; }
    /// Splits known: the finest level there is by now.
    std::size_t available() const { return codes_.size(); }

    /// By at most so many splits, as far as there are any; time is linear in their number.
    void refine(std::size_t splits);
    void coarsen(std::size_t splits);
    /// To a level, clamped to available().
    void jump(std::size_t level);

    /// Alive now.
    std::uint32_t vertex_count() const { return now_.vertices; }
    std::uint32_t triangle_count() const { return now_.triangles; }

    /// Of any level up to available(), whatever level() is; constant time.
    std::uint32_t vertices_at(std::size_t level) const { return at(level).vertices; }
    std::uint32_t triangles_at(std::size_t level) const { return at(level).triangles; }
    /// 0 for the whole mesh. At available() of a mesh that goes on, the error of the level before: an upper
    /// bound, infinite if no split is known.
    float error_at(std::size_t level) const;

    /// The finest level known with at most `count`; 0 if there is none.
    std::size_t level_for_triangles(std::uint64_t count) const;
    std::size_t level_for_vertices(std::uint64_t count) const;
    /// The coarsest level known whose error is at most `error`; available() if there is none.
    std::size_t level_for_error(double error) const;

    /// Those alive.
    std::span<const Float3> positions() const { return std::span(positions_).first(now_.vertices); }
    std::span<const Triangle> triangles() const { return std::span(triangles_).first(now_.triangles); }
    /// Empty if the mesh has none.
    std::span<const float> weights() const;
    std::size_t attribute_count() const { return attributes_.size(); }
    /// Components of each vertex alive.
    std::span<const float> attribute(std::size_t index) const;
    /// One per triangle alive; empty if the mesh has none.
    std::span<const std::uint32_t> groups() const;
    /// As ProgressiveMesh::parents, of the vertices alive.
    std::span<const std::uint32_t> parents() const { return std::span(parents_).first(now_.vertices); }

    /// The same of all vertices of the levels known, alive or not.
    std::span<const std::uint32_t> all_parents() const { return std::span(parents_).first(known_.vertices); }

    /// As groups(), of all triangles of the levels known, alive or not.
    std::span<const std::uint32_t> all_groups() const { return groups_; }

    DirtyRanges take_dirty();

    /// Keeps from the next begin() on, beside the hulls, which runs of vertices and triangles changed:
    /// refining changes a few corners here and there, and a hull of them is nearly everything. Costs a look
    /// at each corner changed, and a bit for every 16 elements.
    void track_runs(bool on) { tracks_ = on; }
    /// Those since the last call: appended, in order, apart from each other, within what is alive. Nothing
    /// unless they are tracked.
    void take_dirty_runs(std::vector<ElementRange>& vertices, std::vector<ElementRange>& triangles);

    /// The splits known as they were appended, but without the attributes' names and meanings. Walks to level
    /// 0 and back: all ends as it was.
    ProgressiveMesh record();

    /// Bytes allocated.
    std::size_t memory() const;

  private:
    /// Where a level ends in the arrays.
    struct Ends {
        std::uint32_t vertices = 0, triangles = 0, corners = 0, moves = 0;
        std::uint32_t specials = 0, special_corners = 0, special_moves = 0;
    };
    struct Checkpoint {
        Ends ends;                                        ///< At its level.
        std::uint32_t first_corner = 0, last_corner = 0;  ///< Changed in the splits up to the next one.
    };
    /// A split that does not fit into a code: how much it has of each.
    struct Special {
        std::uint32_t vertices = 0, triangles = 0, corners = 0, moves = 0;
    };
    struct ErrorRun {
        std::uint32_t split = 0;  ///< The first one.
        float error = 0;          ///< Before each of its splits.
    };
    struct Values {
        std::uint32_t components = 1;
        std::vector<float> alive;          ///< Of the vertices.
        std::vector<std::uint32_t> moved;  ///< The bits in which they differ before and after each move.
    };

    void pass(Ends& ends, std::size_t split) const;
    Ends at(std::size_t level) const;
    template <class Count>
    std::size_t last_level(std::uint64_t limit, Count count) const;
    void encode(const ProgressiveMesh& mesh, std::size_t split);
    void store_corner(std::uint32_t corner);
    void append_moves(const ProgressiveMesh& mesh);
    template <bool kForward, unsigned kBytes>
    void patch(std::size_t level, const Ends& to);
    template <bool kForward>
    void move(std::size_t from_level, const Ends& from, std::size_t to_level, const Ends& to);
    template <bool kForward>
    void exchange(std::span<const std::uint32_t> vertices, std::size_t first_move);
    void mark_triangles(std::size_t from_level, const Ends& from, std::size_t to_level, const Ends& to);

    std::size_t level_ = 0;
    Ends now_, known_, totals_;
    std::size_t total_splits_ = 0;
    unsigned corner_bytes_ = 4;
    DirtyRanges dirty_{~0u, 0, ~0u, 0};
    bool tracks_ = false;
    DirtyRuns vertex_runs_, triangle_runs_;  ///< No room for any if they are not tracked.
    bool tracking_ = false;                  ///< Since begin().

    std::vector<Float3> positions_;
    std::vector<Triangle> triangles_;
    std::vector<float> weights_;
    std::vector<Values> attributes_;
    std::vector<std::uint32_t> groups_;
    std::vector<std::uint32_t> parents_;

    std::vector<std::uint8_t> codes_;    ///< One per split.
    std::vector<std::uint8_t> corners_;  ///< Changed ones, corner_bytes_ each, and a byte that may be read.
    PlaceGrid grid_;
    bool packed_ = false;  ///< All places are on the grid, and no step is long: steps_, not moved_positions_.
    std::vector<std::array<std::int16_t, 3>> steps_;
    std::vector<std::array<std::uint32_t, 3>> moved_positions_;  ///< As Values::moved.
    std::vector<std::uint32_t> moved_weights_;                   ///< Likewise.
    std::size_t moves_stored_ = 0;
    std::vector<std::uint32_t> last_moves_;  ///< Of each vertex, while there are splits to come.
    std::vector<std::uint32_t> moving_;      ///< Room to list vertices that move.
    std::vector<Special> specials_;
    std::vector<std::uint32_t> special_corners_;  ///< The vertex of each of their corner changes.
    std::vector<std::uint32_t> special_moves_;    ///< The vertex of each of their moves.
    std::vector<Checkpoint> checkpoints_;
    std::vector<ErrorRun> errors_;
};

}  // namespace vsplit
