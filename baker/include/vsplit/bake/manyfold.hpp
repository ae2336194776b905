// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The proposed glTF extension MANYFOLD_mesh_progressive (glTF pull request 2464), by our reading of its
// draft: formats/gltf/MANYFOLD_mesh_progressive.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vsplit/progressive_mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit::bake {

/// A GLB with a base mesh and vertex splits.
struct ManyfoldGlb {
    std::vector<std::byte> bytes;
    std::uint32_t base_vertices = 0, base_triangles = 0;
    std::uint64_t records = 0;
    /// Splits of the mesh before its base: the last of them is one that the extension cannot say.
    std::uint64_t left_out = 0;
};

/// Writes the shape of a sound progressive mesh. The base is the coarsest level from which each split bears
/// one vertex in a fan of triangles; at full refinement places are the mesh's within rounding, and at coarser
/// levels those that the extension implies: halfway between the two vertices of a split. Errors: kArgument if
/// not even the last split can be said.
Result<ManyfoldGlb> encode_manyfold(const ProgressiveMesh& mesh);

/// What a file with the extension holds.
struct ManyfoldFile {
    /// The base mesh and the records that are sound. Errors are bounds that follow from displacements alone:
    /// the largest sum of them that a vertex of the full mesh may have been moved by.
    ProgressiveMesh mesh;
    std::uint64_t records = 0;  ///< As announced.
    std::uint64_t read = 0;     ///< The sound ones before the first that is not, which are in `mesh`.
    std::string fault;          ///< Of record `read`, in words; empty if all are sound.
};

/// Nothing for a document without the extension. Every record is checked; reading ends at the first that does
/// not fit the mesh so far. Places are the mesh's own, whatever its node does.
/// `folder` as in parse_gltf. Errors: as there for the base mesh and the document; kUnsupported if several
/// primitives have the extension. Hostile bytes are safe.
Result<std::optional<ManyfoldFile>> parse_manyfold(std::span<const std::byte> bytes,
                                                   const std::string& folder);

}  // namespace vsplit::bake
