// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// What noise is left once the surface is known: neighbours along the surface, unlike those in space, never
// mix two sheets.
#pragma once

#include "surface/crust.hpp"

namespace vsplit::bake {

/// How far, in mean edge lengths, a quadric fitted to the neighbours along the surface misses the median
/// vertex.
double roughness(const Crust& crust);

/// Moves every vertex onto the quadric fitted to its neighbours along the surface.
void smooth(Crust& crust);

}  // namespace vsplit::bake
