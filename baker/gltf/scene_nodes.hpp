// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Which meshes the nodes of a document use, and how large they appear in the world.
#pragma once

#include <cstdint>
#include <vector>

#include "document.hpp"
#include "transforms.hpp"
#include "vsplit/result.hpp"

namespace vsplit::bake {

struct SceneUse {
    std::vector<std::uint8_t> mesh_used;  ///< Per mesh: by a node that is no mere coarser level.
    std::vector<double> mesh_scale;       ///< Per mesh, of its largest place; 0 if it has none.
    struct Place {
        std::size_t mesh;
        Matrix matrix;
    };
    std::vector<Place> places;  ///< Of the meshes used; of a skinned one, where its first joint puts it.
    /// Per node: reached only as, or below, a coarser level of another one (MSFT_lod).
    std::vector<std::uint8_t> only_lod;
};

/// A node of the default scene that shows a mesh.
struct Instance {
    std::size_t mesh, node;
    Matrix matrix;  ///< Of the node, skinned or not.
};

/// Those of the default scene (the first one if none is called so, all root nodes if there are no scenes), in
/// depth-first order, which is the file's. Errors: kMalformed if the nodes are no forest.
Result<std::vector<Instance>> place_meshes(const Document& document);

/// A skinned mesh stands where its joints put it, whatever its node's transform is (glTF 2.0,
/// section 3.7.3.3): the largest of its joints counts. Errors: kMalformed if the nodes are no forest.
Result<SceneUse> survey_nodes(Document& document);

}  // namespace vsplit::bake
