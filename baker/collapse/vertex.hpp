// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What is kept for every vertex while its mesh collapses.
#pragma once

#include <cstddef>
#include <cstdint>

#include "vsplit/mesh.hpp"

namespace vsplit::bake {

/// All that pricing an edge needs of an end: one cache line, since what the loop waits for is memory. The
/// order lets four vertices be read at once, in four transpositions.
struct alignas(64) Vertex {
    Float3 position;        ///< Of the input, or rounded to what will be stored.
    float weight = 1;       ///< Painted; 1 for an infinite one, whose vertex is fixed anyway.
    float quadric[6] = {};  ///< Sum over triangles of area^1.5 n nT, plus boundary terms: xx xy xz yy yz zz.
                            ///< Relative to the vertex.
    float area[3] = {};     ///< Sum over triangles of the area vector.
    float size = 0;         ///< Sum over triangles of the area.
    std::uint32_t star_begin = 0;  ///< In the arena of triangle lists.
    std::uint32_t star_size = 0;
};
static_assert(sizeof(Vertex) == 64 && offsetof(Vertex, quadric) == 16 && offsetof(Vertex, star_begin) == 56);

/// What only a collapse itself needs to know of the input around a vertex.
struct alignas(32) VertexHistory {
    float normal[3] = {};  ///< Sum of the area vectors of all input triangles that ended up here.
    float deviation = 0;   ///< Estimated distance of the vertex to the input surface, working units.
    Float3 witness;        ///< The input vertex, of those that ended up here, found farthest away; working
                           ///< coordinates.
};

}  // namespace vsplit::bake
