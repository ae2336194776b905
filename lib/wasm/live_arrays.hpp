// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A mesh that is refined while its splits still arrive, as the arrays that a page draws: vertex attributes
// for all, and an index for each group of triangles (material). All arrays grow at their ends only; what
// changes before is marked.
#pragma once

#include <cstdint>
#include <vector>

#include "changes.hpp"
#include "vsplit/progressive_mesh.hpp"
#include "vsplit/read.hpp"

namespace vsplit::web {

struct VertexArray {
    std::uint32_t components = 1;
    std::vector<float> values;
    Changes changes;
};

struct GroupIndex {
    std::vector<std::uint32_t>
        corners;  ///< Of all triangles that were ever shown; the first `triangles` count.
    std::uint32_t triangles = 0;
    Changes changes;
};

/// Follows a ProgressiveMesh that a BlockDecoder appends to and checks: it is not checked again.
class LiveArrays {
  public:
    /// Allocates for the full mesh; `normals` for smooth ones made here.
    LiveArrays(const FileInfo& info, const ProgressiveMesh& mesh, bool normals);

    std::size_t level() const { return level_; }
    /// Nearer to `level`, by at most `most` splits. Levels up to the splits that have been decoded.
    void go_towards(std::size_t level, std::size_t most);
    /// Positions of this group's vertices are given times `scale`. Before the first take of positions.
    void set_scale(std::uint32_t group, float scale);
    /// Makes the normals of the level, weighted by area.
    void update_normals();

    VertexArray positions, weights;
    std::vector<VertexArray> attributes;
    std::vector<std::int16_t> normals;  ///< Four a vertex, the last 0.
    std::vector<GroupIndex> groups;
    std::vector<float> scale_of_vertex;  ///< Empty: all 1.

  private:
    void refine();
    void coarsen();
    void add_triangle(std::size_t triangle);
    void set_corner(std::uint32_t corner, std::uint32_t vertex);
    void set_vertex(std::uint32_t vertex, const Float3& position);
    void exchange(std::size_t move);

    const ProgressiveMesh& mesh_;
    std::size_t level_ = 0;
    std::uint32_t shown_vertices_ = 0, shown_triangles_ = 0;
    std::vector<float> scale_of_group_;
    std::vector<std::uint32_t> place_;  ///< Of a triangle in its group; empty if there is one group.
    /// What a move overwrote, to undo it: for each move position, weight, attributes in a row.
    std::vector<float> before_;
    std::size_t stride_ = 0;
    std::vector<float> sums_;
};

}  // namespace vsplit::web
