// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// The facets between inside and outside cells as an oriented 2-manifold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "points/tetrahedra.hpp"
#include "surface/crust.hpp"

namespace vsplit::bake {

struct BoundaryReport {
    std::size_t cells_flipped = 0;   ///< Relabelled where the surface touched itself.
    std::size_t vertices_split = 0;  ///< Samples that became two vertices or more.
    std::size_t edges_split = 0;     ///< Edges that got a vertex because two sheets ran along them.
};

/// Flips groups of at most a few cells that make the surface touch itself along an edge or in a vertex.
void untangle(const Tetrahedra& tetrahedra, std::vector<std::uint8_t>& inside, BoundaryReport& report);

/// Facets with a box corner are left out: they are what makes a boundary (none if no inside cell has a box
/// corner). Where sheets still touch each gets vertices of its own, drawn a little into its own inside, so
/// that the result is a manifold for every labelling. Points 0.. are in the order of the samples that are
/// used.
Crust extract_boundary(const Tetrahedra& tetrahedra, const std::vector<std::uint8_t>& inside,
                       BoundaryReport& report);

}  // namespace vsplit::bake
