// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Collapses that take the surface much farther from the input than others of their time wait until others do,
// too.
#pragma once

#include <cstdint>
#include <vector>

#include "vsplit/progressive_mesh.hpp"

namespace vsplit::bake {

/// Puts off those collapses that deviate more than all but a small share of the latest, to where the share
/// allows it, with what depends on them; others come earlier in their stead. Every collapse stays as it was,
/// star and all; only their order changes. `deviations` are those of the splits (measure_collapses()), and
/// change their order with them; recorded errors stay the largest so far of what was recorded.
/// With `batches`, those of a record made in batches stay together. Returns which split is now at each place.
std::vector<std::uint32_t> put_off_outliers(ProgressiveMesh& mesh, std::vector<float>& deviations,
                                            bool batches);

}  // namespace vsplit::bake
