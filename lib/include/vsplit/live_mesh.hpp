// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A progressive mesh brought to life: buffers that are refined and coarsened in place.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "vsplit/progressive_mesh.hpp"

namespace vsplit {

/// Index and vertex buffers at one level of a progressive mesh. Refining, then coarsening by the same splits
/// restores every byte. Owns the progressive mesh; allocates only on construction. Contents must be sound
/// (progressive_mesh_fault() is null): not checked again.
class LiveMesh {
  public:
    explicit LiveMesh(ProgressiveMesh mesh);

    /// 0 is the base mesh, max_level() the full one.
    std::size_t level() const { return level_; }
    std::size_t max_level() const { return mesh_.splits.size(); }

    /// Applies or undoes splits one by one until `level` (clamped to max_level()) is reached; time is linear
    /// in their number.
    void go_to(std::size_t level);

    std::span<const Float3> positions() const;
    std::span<const Triangle> triangles() const;
    /// Empty if the mesh has none.
    std::span<const float> weights() const;
    double error() const { return error_at(mesh_, level_); }

    /// A copy of the mesh at this level.
    Mesh snapshot() const;

    /// Between calls its moves and positions are those of the current level: `moves` of splits already
    /// applied hold the coarser values (that is how they are undone), and `triangles` the current corners.
    const ProgressiveMesh& state() const { return mesh_; }

    /// Gives the progressive mesh back as it was given, at level 0; the live mesh is empty afterwards.
    ProgressiveMesh release();

  private:
    void refine();
    void coarsen();

    ProgressiveMesh mesh_;
    std::size_t level_ = 0;
};

/// The mesh at a level.
Mesh cut(const ProgressiveMesh& mesh, std::size_t level);

}  // namespace vsplit
