// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Compressed geometry of glTF: EXT_meshopt_compression and KHR_draco_mesh_compression.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "document.hpp"
#include "vsplit/mesh.hpp"

namespace vsplit::bake {

/// Meshopt's vertex codec spends at least two bits on sixteen bytes, its index codecs a byte on a triangle or
/// an index: no view grows by more than this.
constexpr std::uint64_t kMeshoptExpansion = 64;

/// The decompressed bytes of a buffer view, count * stride of them; more than `max_bytes` are refused
/// (kLimit).
Result<std::vector<std::byte>> decode_meshopt(const MeshoptView& view, Bytes source, std::uint64_t max_bytes);

/// A decoded Draco mesh. Values are read as floats, normalised where Draco's own attribute says so.
class DracoMesh {
  public:
    struct Attribute {
        std::vector<std::array<float, 4>> values;  ///< One per vertex; components beyond `components` are 0.
        int components = 0;
        bool normalised = false;  ///< By Draco already.
    };
    std::uint32_t vertices = 0;
    std::vector<std::uint32_t> corners;  ///< Three a triangle, each below `vertices`.

    /// More than `max_triangles` are refused before anything is allocated (kLimit).
    static Result<DracoMesh> decode(Bytes source, std::uint64_t max_triangles);
    Result<Attribute> attribute(std::uint32_t id) const;

  private:
    std::shared_ptr<void> mesh_;  // draco::Mesh; its headers stay in one source
};

}  // namespace vsplit::bake
