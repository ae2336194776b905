// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Open scans: what no sample supports is trimmed off from the rim.
#pragma once

#include <cstddef>

#include "surface/crust.hpp"

namespace vsplit::bake {

/// Peels triangles with an edge longer than `reach` times the spacing at their corners, starting at the
/// boundary and as long as the rest stays a manifold of the same topology. So a gap inside, a lake, stays
/// bridged. Returns how many went.
std::size_t trim_rim(Crust& crust, double reach);

}  // namespace vsplit::bake
