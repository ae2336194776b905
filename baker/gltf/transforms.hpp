// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Where a glTF node puts its mesh.
#pragma once

#include <tiny_gltf.h>

#include <array>

namespace vsplit::bake {

/// Column-major, the last row being 0 0 0 1.
using Matrix = std::array<double, 16>;
constexpr Matrix kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Matrix product(const Matrix& a, const Matrix& b);
double determinant(const Matrix& m);
/// The node's own transform, from its matrix or its translation, rotation and scale.
Matrix local_matrix(const tinygltf::Node& node);
/// The longest column: what a unit vector is at most stretched to where no shear is in the matrix.
double largest_scale(const Matrix& m);

}  // namespace vsplit::bake
