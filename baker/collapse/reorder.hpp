// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The splits of a progressive mesh in another order.
#pragma once

#include <cstdint>
#include <vector>

#include "vsplit/progressive_mesh.hpp"

namespace vsplit::bake {

/// Renumbers a progressive mesh so that its splits come in the order `splits`, coarsest first, each once. Two
/// splits must keep their order if one acts on a vertex (splits or moves it) in the star of a vertex that the
/// other acts on. Each split takes its error along: they may grow from one to the next until they are made
/// monotone again.
void reorder_splits(ProgressiveMesh& mesh, const std::vector<std::uint32_t>& splits);

}  // namespace vsplit::bake
