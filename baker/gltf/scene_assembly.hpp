// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A scene's document put together again around levels of its triangles.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "geometry_sink.hpp"
#include "level_geometry.hpp"
#include "node_surgery.hpp"
#include "scene_document.hpp"
#include "vsplit/bake/scene.hpp"

namespace vsplit::bake {

/// kArgument unless the levels are cuts of the scene.
Status check_scene_levels(const Scene& scene, std::span<const GltfLevel> levels);

class SceneAssembly {
  public:
    SceneAssembly(const Scene& scene, const SceneFormat& format);

    /// Meshes, nodes and their levels.
    Status add_levels(std::span<const GltfLevel> levels);
    /// What stays: first what is not a picture, then the pictures.
    void add_kept();
    /// Number in the written document's primitives of each group at the finest level; -1 if it has none.
    const std::vector<int>& shown_at() const { return shown_at_; }

    GeometrySink& sink() { return sink_; }
    OrderedJson& root() { return root_; }
    Result<std::vector<std::byte>> finish();

  private:
    void choose_grids(std::span<const GltfLevel> levels);
    void quantise_skins(const std::map<std::size_t, Grid>& grids);
    void drop_accessor(std::size_t accessor);
    Status write_meshes(std::span<const GltfLevel> levels);
    Mesh share_vertices(std::span<const GltfLevel> levels);
    void place_levels(std::span<const GltfLevel> levels);
    /// By mesh of the document, of a ball around the level's triangles.
    std::vector<double> radii(const Mesh& mesh) const;

    const Scene& scene_;
    const SceneFormat& format_;
    OrderedJson root_;
    GeometrySink sink_;
    NodeSurgery nodes_;
    std::vector<std::vector<std::size_t>> users_;  // nodes, by mesh of the document
    PrimitiveWriter writer_;
    std::vector<std::vector<PrimitiveCut>> cuts_;  // by level, by group
    /// By part, by level: the mesh in the written document, or none.
    std::vector<std::vector<std::size_t>> mesh_at_;
    std::vector<int> shown_at_;
    std::set<std::size_t> dropped_views_;  // that stayed, but for what is replaced here
};

}  // namespace vsplit::bake
