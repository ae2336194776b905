// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Geomorphs (Hoppe, Progressive Meshes, SIGGRAPH 1996, section 3.2): from one level to another without a
// jump.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vsplit/live_buffers.hpp"
#include "vsplit/read.hpp"

namespace vsplit {

/// Remembers the places of one level, and blends those of another from them. The finer of the two meshes is
/// what is drawn while t goes from 0 to 1: each of its vertices has a place in both levels, its own in the
/// finer, and in the coarser that of the ancestor which was alive there.
///
///     Geomorph morph(buffers);       // at the level that is shown
///     stream.set_target(...);  stream.update(...);
///     morph.turn(stream.buffers());  // at the level to come
///     morph.blend(t);                // or: upload from() and to() once, and mix them in a vertex shader
///
/// Going coarser, the mesh drawn during the morph is the level left behind: its triangles are kept here.
/// Owns copies: three floats for each vertex of the finer level, twice, and when coarsening its triangles.
class Geomorph {
  public:
    explicit Geomorph(const LiveBuffers& from);

    /// The level it is going to. Same mesh, whichever level. Again before it is over: from where the places
    /// are at `t` of the way before, so that a target that changes is no jump either.
    void turn(const LiveBuffers& to, double t = 0);

    /// What to draw while it lasts.
    std::span<const Triangle> triangles() const { return triangles_; }
    /// One for each vertex of the finer level: where it starts and where it ends.
    std::span<const Float3> from() const { return from_; }
    std::span<const Float3> to() const { return to_; }
    /// from() at t = 0, to() at t = 1; t is clamped. The span lives until the next call.
    std::span<const Float3> blend(double t);

  private:
    std::size_t level_;  ///< Of the triangles drawn.
    std::vector<Float3> from_, to_, mixed_;
    std::vector<Triangle> triangles_;
};

/// One of the meshes that share a budget.
struct BudgetItem {
    const FileInfo* info = nullptr;  ///< The counts and errors of its table. Not null.
    double pixels_a_unit = 0;  ///< Pixels that an error of 1 spans: pixels_of_error(..., 1); 0: not seen.
};

/// Shares `triangles` among meshes so that the largest error on the screen is as small as their tables allow:
/// the error, in each object's units, to hand to Target::error(). No mesh gets less than spans `pixels` on
/// the screen, however much of the budget that leaves. A mesh that is not seen gets its base mesh. Where even
/// all base meshes are too many, each gets that. Linear in the tables' length, times about 60.
std::vector<double> share_triangles(std::span<const BudgetItem> items, std::uint64_t triangles,
                                    double pixels = 0);

/// The same for bytes that are fetched: of each file's front and the blocks that its error needs.
std::vector<double> share_bytes(std::span<const BudgetItem> items, std::uint64_t bytes, double pixels = 0);

}  // namespace vsplit
