// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The base mesh's triangles and places as Draco bytes. Only base_mesh_draco.cpp names Draco; a library built
// without it has reads_only.cpp in its place.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "live_stars.hpp"
#include "vsplit/read.hpp"
#include "vsplit/result.hpp"

namespace vsplit {

struct BaseMesh {
    std::vector<Lattice3> places;
    std::vector<Triangle> triangles;
};

/// Draco's sequential coding of whole numbers: order and places come back exactly. No bytes for what Draco
/// does not read again: a mesh without triangles, or with many vertices for its few.
Result<std::vector<std::byte>> encode_base(const BaseMesh& base);

/// `vertices` and `triangles` are what the header announces; anything else is kMalformed. Without bytes,
/// places and triangles come elsewhere: the places are zeros, and there are no triangles. `decoder`, if it is
/// not empty, takes Draco's place.
Result<BaseMesh> decode_base(std::span<const std::byte> bytes, std::uint32_t vertices,
                             std::uint32_t triangles, const BaseMeshDecoder& decoder);

/// Draco itself: what BaseMeshDecoder is asked for. kUnsupported if the library was built without it.
Status decode_draco(std::span<const std::byte> bytes, std::span<std::int32_t> places,
                    std::span<std::uint32_t> corners);

}  // namespace vsplit
