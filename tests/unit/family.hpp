// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The family of meshes that every property is checked on, and the way to the shared models.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vsplit/mesh.hpp"

namespace vsplit::test {

struct NamedMesh {
    std::string name;
    Mesh mesh;
};

/// Closed, bounded, of many components, non-manifold, degenerate, a single triangle, empty: small, made by
/// code.
const std::vector<NamedMesh>& mesh_family();

/// The path of a shared model ("meshes/spot.obj"), or nothing, after saying on stderr that the test runs
/// without it.
std::optional<std::string> corpus_file(const std::string& name);

/// A sphere of latitude and longitude: 2 * slices * (stacks - 1) triangles, radius 1.
Mesh make_sphere(int slices, int stacks);
/// A flat square grid in z = 0 of n * n cells, side 1.
Mesh make_grid(int n);
/// A torus of n * m cells, radii 1 and 0.35.
Mesh make_torus(int n, int m);
/// Both meshes as one, without sharing vertices.
Mesh join(const Mesh& a, const Mesh& b, Float3 shift = {});

}  // namespace vsplit::test
