// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// One level in Draco, positions and triangles only: what everything here is compared with.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "vsplit/mesh.hpp"

namespace vsplit::bench {

/// The encoder's settings: `-qp bits -cl level` of draco_encoder. Bits of 0 keep every float. Empty if Draco
/// refuses.
std::vector<char> encode_draco(const Mesh& mesh, int bits, int level);

/// Vertices after decoding; 0 if Draco refuses.
std::size_t decode_draco(const std::vector<char>& bytes);

std::string draco_version();

}  // namespace vsplit::bench
