// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// glTF 2.0 scenes in, levels of detail out.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "vsplit/bake/meshes.hpp"
#include "vsplit/mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit::bake {

/// How to read a scene.
struct GltfOptions {
    Weld weld = Weld::kAuto;     ///< kAuto means kAll.
    std::string weight_channel;  ///< "COLOR_0.r" (.r .g .b .a): taken as weights; empty: none. Missing everywhere: kArgument.
};

/// All triangle primitives (lists, strips, fans) of the default scene (or of all root nodes, if there is none), node
/// transforms applied, as one mesh. `folder` is where external buffers are looked for, "" refuses them.
/// Skins and morph targets are read in their bind pose. Points and lines are counted in the report's format text and left out.
Result<MeshFile> parse_gltf(std::span<const std::byte> bytes, const std::string& folder, const GltfOptions& options = {});

/// One level of detail.
struct GltfLevel {
    Mesh mesh;
    double error = 0;  ///< Distance to the finest level, in the object's units.
};

/// A binary glTF: one node, or with several levels (finest first) MSFT_lod with MSFT_screencoverage (docs/lods.md has the
/// formula). Smooth vertex normals are computed; painted weights travel as the attribute _WEIGHT.
/// Passes the Khronos validator without errors or warnings. Errors: kArgument for no level or an empty mesh.
Result<std::vector<std::byte>> encode_glb(std::span<const GltfLevel> levels);

}  // namespace vsplit::bake
