// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Changes to the nodes of a document that leave what is seen as it was.
#pragma once

#include <array>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "level_geometry.hpp"
#include "scene_document.hpp"

namespace vsplit::bake {

/// Works on the nodes, animations and scenes of `root`, which were valid when it was made.
class NodeSurgery {
  public:
    explicit NodeSurgery(OrderedJson& root);

    /// By mesh, the numbers of the nodes that use it, ascending.
    std::vector<std::vector<std::size_t>> users() const;
    const OrderedJson& node(std::size_t n) const { return root_["nodes"][n]; }
    bool instanced(std::size_t n) const;  ///< By EXT_mesh_gpu_instancing.

    /// The mesh, its skin and its morph weights go; so do the channels that animate the weights.
    void take_mesh(std::size_t n);

    /// Gives the node further levels of detail, one for each mesh, finest first, by MSFT_lod. Where the node
    /// carries more than a mesh, or moves, a new one below it, at its place, gets mesh and levels.
    void add_levels(std::size_t n, const std::vector<std::size_t>& meshes,
                    const std::vector<double>& coverage);

    /// Undoes the grid of a quantised mesh: in the node, or in a new one below it. The node that has the mesh
    /// then.
    std::size_t apply_grid(std::size_t n, const Grid& grid);

    /// Takes out the meshes that are null, and renumbers.
    void drop_missing_meshes();

  private:
    std::size_t add_node(OrderedJson node);
    /// Moves the mesh to a new node at the same place; its number.
    std::size_t split_off(std::size_t n);
    bool simple(std::size_t n) const;
    template <class Each>
    void each_weights_channel(std::size_t n, Each each);

    OrderedJson& root_;
    std::set<std::size_t> moving_, joints_, morphing_;  // nodes, by what animates or holds them
};

}  // namespace vsplit::bake
