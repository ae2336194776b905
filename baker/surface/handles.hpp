// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Handles that no sample asked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "points/tetrahedra.hpp"
#include "surface/labels.hpp"

namespace vsplit::bake {

/// Grows each part of the cells labelled `label` anew from its largest ball, larger balls first, and leaves
/// out what would close a loop with a ball of less than `smallest` radius; what is left out changes its
/// label. So a narrow tunnel (label 0) is plugged, a thin strand (label 1) is cut, and a hole that large
/// empty balls fit through stays. Returns the cells changed.
std::size_t remove_handles(const Tetrahedra& tetrahedra, const Balls& balls,
                           std::vector<std::uint8_t>& inside, std::uint8_t label, double smallest);

}  // namespace vsplit::bake
