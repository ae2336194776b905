// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Slivers and edges without length, removed without changing what the surface is.
#pragma once

#include <cstddef>

#include "surface/crust.hpp"

namespace vsplit::bake {

struct TidyReport {
    std::size_t edges_collapsed = 0, edges_flipped = 0, slivers_left = 0;
    std::size_t components_dropped = 0, triangles_dropped = 0;
};

/// Repairs triangles whose quality (4 sqrt 3 area over the sum of squared edges, 1 if equilateral) is below
/// `worst`: needles lose their short edge, caps have their long edge flipped. An edge collapses only under
/// the link condition and only if no triangle turns; so a manifold stays one, with its genus.
void repair_slivers(Crust& crust, double worst, TidyReport& report);

/// Drops connected parts of fewer triangles than `least`, but never the largest.
void drop_small_components(Crust& crust, std::size_t least, TidyReport& report);

}  // namespace vsplit::bake
