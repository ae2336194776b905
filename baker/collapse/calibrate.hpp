// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// From local estimates to errors that mean what they say.
#pragma once

#include <vector>

#include "vsplit/bake/progress.hpp"
#include "vsplit/progressive_mesh.hpp"

namespace vsplit::bake {

/// Measures the two-sided distance to the full mesh at levels of ever fewer triangles, and rescales the
/// recorded errors between them, so that the error of every level is at least what was measured, never grows
/// with the level, and is 0 at the full one. False if `progress` asked to stop.
bool calibrate_errors(ProgressiveMesh& mesh, const Progress& progress);

/// Errors that bound the distance of each level to the full mesh, from the deviations of the splits'
/// collapses (measure_collapses()). Where components vanish, no triangle is left that could tell how far
/// their places are from the surface: then levels are measured, as above. False if `progress` asked to stop.
bool bound_errors(ProgressiveMesh& mesh, const std::vector<float>& deviations, const Progress& progress);

}  // namespace vsplit::bake
