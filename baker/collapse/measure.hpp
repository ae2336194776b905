// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// How far each collapse of a record took the surface from the input.
#pragma once

#include <vector>

#include "vsplit/bake/progress.hpp"
#include "vsplit/progressive_mesh.hpp"

namespace vsplit::bake {

/// For each split the distance, in the object's units, between the input and the triangles that its collapse
/// left, both ways: from the input's vertices that are nearest to them (after Klein, Liebich and Strasser,
/// Mesh reduction with error control, 1996, each follows the triangle that it is nearest to from collapse to
/// collapse), and from samples on them, by an exact search. Such samples are looked at only as closely as it
/// takes to tell what lies well below the largest 1.5 % of their time. 0 for a component that vanishes. The
/// same for any number of threads. Empty if `progress` asked to stop. The mesh must be sound.
std::vector<float> measure_collapses(const ProgressiveMesh& mesh, const Progress& progress);

}  // namespace vsplit::bake
