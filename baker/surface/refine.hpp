// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where the samples' tangent planes say that the surface leaves the chord of an edge, the edge gets a vertex:
// on the crease where the two planes meet, or on the curve between two samples of a smooth part.
#pragma once

#include <cstddef>
#include <span>

#include "surface/crust.hpp"

namespace vsplit::bake {

struct RefineOptions {
    double crease_cosine = 0.8;  ///< Planes at the ends of an edge that turn by more meet in a crease.
    double smallest_bow = 0.02;  ///< An edge bends when the surface leaves it by this share of its length.
};

struct RefineReport {
    std::size_t crease_points = 0, corner_points = 0, curve_points = 0;
};

RefineReport refine(Crust& crust, const RefineOptions& options = {});

}  // namespace vsplit::bake
