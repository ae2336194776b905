// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A progressive mesh without a collapser: edges folded as a random number says, whatever becomes of the
// surface. So the library's tests need no baker, and meet stars that a careful collapser would never make.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vsplit/progressive_mesh.hpp"

namespace vsplit::test {

/// Folds up to `collapses` edges of `mesh`; sound for any sound mesh. Weights of the mesh average, errors
/// fall evenly to 0.
ProgressiveMesh naive_record(const Mesh& mesh, std::uint32_t seed, std::size_t collapses = ~std::size_t{0});

/// Every array equal, byte for byte.
bool same_bytes(const ProgressiveMesh& a, const ProgressiveMesh& b);

/// Weights between 0 and 10 that repeat only seldom, the same on every machine.
std::vector<float> some_weights(std::size_t count);

}  // namespace vsplit::test
