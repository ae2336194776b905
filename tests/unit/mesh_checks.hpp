// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What tests ask of a mesh's shape and topology. Written apart from the baker's own survey and guards, so
// that one checks the other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "vsplit/mesh.hpp"

namespace vsplit::test {

/// One connected part (through shared vertices).
struct PartTopology {
    long euler = 0;  ///< vertices - edges + triangles
    std::size_t boundary_loops = 0;
    auto operator<=>(const PartTopology&) const = default;
};

struct Topology {
    std::size_t vertices = 0;  ///< Those that a triangle names.
    std::size_t triangles = 0, edges = 0, boundary_edges = 0;
    std::size_t non_manifold_edges = 0;     ///< Three triangles or more, or two in the same direction.
    std::size_t non_manifold_vertices = 0;  ///< Not one fan.
    std::vector<PartTopology> parts;        ///< Sorted.
    bool manifold() const { return non_manifold_edges + non_manifold_vertices == 0; }
    bool operator==(const Topology&) const = default;
};

Topology topology(const Mesh& mesh);

/// Every part of `coarse` is like one of `fine`, no two like the same: holes and handles came through, parts
/// may have vanished.
bool parts_survive(const Topology& coarse, const Topology& fine);

/// Triangles as the bits of their corners (and weights), least corner first, orientation kept, sorted: equal
/// for the same surface however it is numbered.
std::vector<std::array<std::uint32_t, 12>> triangle_bits(const Mesh& mesh);

/// Triangles without area (below 1e-7 of the longest edge squared: what float coordinates can still tell).
std::size_t degenerate_triangles(const Mesh& mesh);
/// Triangles that oppose the nearest triangle of `input` at the centroid and at three points around it.
/// Quadratic time.
std::size_t flipped_triangles(const Mesh& mesh, const Mesh& input);
/// Edges whose two triangles lie face to face, folded by more than 162 degrees.
std::size_t folded_edges(const Mesh& mesh);

/// The largest distance of a vertex of `points` to the surface of `mesh`. Quadratic time.
double distance_to(const Mesh& mesh, const std::vector<Float3>& points);

}  // namespace vsplit::test
