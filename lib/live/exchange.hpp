// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

#include "vsplit/progressive_mesh.hpp"

namespace vsplit {

/// Exchanges a move's values with the buffers': refining stores the coarser values where the finer ones were,
/// and back.
inline void exchange_move(ProgressiveMesh& mesh, std::size_t index) {
    VertexMove& move = mesh.moves[index];
    std::swap(mesh.positions[move.vertex], move.position);
    if (!mesh.weights.empty()) std::swap(mesh.weights[move.vertex], move.weight);
    for (std::size_t i = 0; i < mesh.attributes.size(); ++i) {
        const std::size_t components = mesh.attributes[i].components;
        std::swap_ranges(mesh.moved_values[i].begin() + std::ptrdiff_t(components * index),
                         mesh.moved_values[i].begin() + std::ptrdiff_t(components * (index + 1)),
                         mesh.attributes[i].values.begin() + std::ptrdiff_t(components * move.vertex));
    }
}

}  // namespace vsplit
