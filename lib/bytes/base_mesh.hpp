// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The base mesh as Draco bytes: the only file of lib/bytes that names Draco.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "vsplit/mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit {

/// Draco's sequential coding without quantisation: order and floats come back exactly. A mesh without
/// triangles is its plain floats.
Result<std::vector<std::byte>> encode_base(const Mesh& base);

/// `vertices`, `triangles` and `has_weights` are what the header announces; anything else is kMalformed.
Result<Mesh> decode_base(std::span<const std::byte> bytes, std::uint32_t vertices, std::uint32_t triangles,
                         bool has_weights);

}  // namespace vsplit
