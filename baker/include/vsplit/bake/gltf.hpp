// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// glTF 2.0 scenes in, levels of detail out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "vsplit/bake/meshes.hpp"
#include "vsplit/mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit::bake {

/// How to read a scene.
struct GltfOptions {
    Weld weld = Weld::kAuto;  ///< kAuto means kAll.
    /// "COLOR_0.r" (.r .g .b .a): taken as weights, 1 where a primitive lacks it; missing everywhere:
    /// kArgument. Empty: the attribute _WEIGHT, as encode_glb writes it, if there.
    std::string weight_channel;
    /// Of all instances together; more: kLimit. A few nodes can repeat a mesh without end.
    std::uint64_t max_triangles = std::uint64_t{1} << 26;
    /// Floats in all attributes together; more: kLimit. Only parse_scene reads attributes.
    std::uint64_t max_attribute_values = std::uint64_t{1} << 30;
    /// Moments of the animations to sample as poses of skinned and morphing meshes, up to 1024; 0: none. Only
    /// parse_scene does.
    std::size_t poses = 0;
};

/// All triangle primitives (lists, strips, fans) of the default scene (the first one if none is called so,
/// all root nodes if there are no scenes), node transforms applied, as one mesh. `folder` is where external
/// buffers are looked for, "" refuses them. Skins and morph targets are read in their bind pose, where their
/// node stands; of MSFT_lod, the finest level. KHR_mesh_quantization, KHR_draco_mesh_compression and
/// EXT_meshopt_compression are read; any other *required* extension that may change geometry is kUnsupported.
/// Points and lines are counted in the report's format text and left out. Hostile bytes are safe. Errors
/// carry the byte, in JSON text the line, or name the object: "meshes[3].primitives[0].indices".
Result<MeshFile> parse_gltf(std::span<const std::byte> bytes, const std::string& folder,
                            const GltfOptions& options = {});

/// The screen (16:9) for which switching distances are computed, and how many of its pixels a level's error
/// may span while it is shown.
struct Screen {
    double lines = 1080;
    double pixels = 1;
};

/// One level of detail.
struct GltfLevel {
    Mesh mesh;
    double error = 0;  ///< Distance to the finest level, in the object's units.
};

/// A binary glTF: one node, or with several levels (finest first) MSFT_lod with MSFT_screencoverage
/// (docs/lods.md has the formula). Smooth vertex normals are computed; painted weights travel as the
/// attribute _WEIGHT. Passes the Khronos validator without errors or warnings. Errors: kArgument for no level
/// or an empty mesh.
Result<std::vector<std::byte>> encode_glb(std::span<const GltfLevel> levels, const Screen& screen = {});

}  // namespace vsplit::bake
