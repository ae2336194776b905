// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Smooth vertex normals for shading.
#pragma once

#include <vector>

#include "vsplit/mesh.hpp"

namespace vsplit::bake {

/// One unit normal a vertex, by N. Max, "Weights for Computing Vertex Normals from Facet Normals", Journal of
/// Graphics Tools 4(2), 1999: exact on a sphere, and in need of nothing but the four operations and a root,
/// so that the bytes are the same on every machine, which angles are not. Where the faces cancel out: the
/// normal of the first one that has any; of none: +Z.
std::vector<Float3> smooth_normals(const Mesh& mesh);

}  // namespace vsplit::bake
