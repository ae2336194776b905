// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// One level's triangles as the primitives of a scene.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry_sink.hpp"
#include "pack.hpp"
#include "vsplit/bake/scene.hpp"

namespace vsplit::bake {

/// What one group has of a level: vertices of the level's mesh, ascending, and corners, which number those.
struct PrimitiveCut {
    std::vector<std::uint32_t> vertices, corners;
};

std::vector<PrimitiveCut> split_by_group(const Mesh& mesh, std::size_t groups);

/// Vertices in the order in which triangles that follow each other name them, which vertex caches and
/// meshopt's codec like.
void order_for_cache(PrimitiveCut& cut);

/// File coordinates are offset + scale * (what is stored, 0 to 1).
struct Grid {
    std::array<double, 3> offset{};
    double scale = 1;
};

/// Writes primitives of one scene in one format.
class PrimitiveWriter {
  public:
    PrimitiveWriter(const Scene& scene, const SceneFormat& format, GeometrySink& sink);

    /// A box around each mesh of the document that has triangles, over all levels, grown to hold the morph
    /// offsets' lengths too.
    void set_boxes(std::span<const GltfLevel> levels);
    const std::optional<Grid>& box(std::size_t mesh) const { return boxes_[mesh]; }
    /// Stores the mesh's positions as 16 bits within the grid.
    void quantise(std::size_t mesh, const Grid& grid) { grids_[mesh] = grid; }

    /// `attributes`, `indices`, `targets` and `extensions` into `primitive`.
    Status write(const Mesh& level, std::size_t group, const PrimitiveCut& cut, OrderedJson& primitive);

    /// Whether a type was written that only KHR_mesh_quantization allows.
    bool beyond_core() const { return beyond_core_; }

  private:
    std::vector<VertexValues> gather(const Mesh& level, std::size_t group, const PrimitiveCut& cut) const;
    void choose_types(std::vector<VertexValues>& attributes, const std::optional<Grid>& grid) const;
    void note_type(const VertexValues& values);
    Status write_draco(std::vector<VertexValues>& attributes, std::size_t mesh, const PrimitiveCut& cut,
                       OrderedJson& primitive);
    void name_accessor(OrderedJson& primitive, const VertexValues& values, std::size_t accessor) const;

    const Scene& scene_;
    const SceneFormat& format_;
    GeometrySink& sink_;
    std::vector<std::optional<Grid>> boxes_, grids_;
    std::vector<int> exponents_;  // by mesh
    bool beyond_core_ = false;
};

}  // namespace vsplit::bake
