// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What is kept for every vertex while its mesh collapses.
#pragma once

#include <cstddef>
#include <cstdint>

#include "vsplit/mesh.hpp"

namespace vsplit::bake {

/// How a vertex may collapse, after Dey, Edelsbrunner, Guha and Nekhayev, Topology preserving edge
/// contraction (1999), section 3.
enum class VertexKind : std::uint8_t {
    kInner,  ///< One closed fan of triangles: may fold into any neighbour.
    kCurve,  ///< On exactly two special edges of one kind (a boundary, a non-manifold crease): folds along
             ///< them only.
    kFixed,  ///< Anything else, or locked: stays where it is; others may fold into it.
    kDead,   ///< Collapsed.
};

/// All that pricing an edge needs of an end: one cache line, since what the loop waits for is memory. The
/// order lets four vertices be read at once, in four transpositions.
struct alignas(64) Vertex {
    Float3 position;   ///< Of the input, or rounded to what will be stored.
    float weight = 1;  ///< Of costs, by the painted one; 1 for an infinite one, whose vertex is fixed anyway.
    float quadric[6] = {};  ///< Sum over triangles of area^1.5 n nT, plus boundary terms: xx xy xz yy yz zz.
                            ///< Relative to the vertex.
    float area[3] = {};     ///< Sum over triangles of the area vector.
    float size = 0;         ///< Sum over triangles of the area.
    std::uint32_t star_begin = 0;  ///< In the arena of triangle lists.
    std::uint32_t star_size : 26 = 0;
    std::uint32_t seam : 1 = 0;      ///< Of a curve: where wedges or groups of triangles meet.
    std::uint32_t junction : 1 = 0;  ///< Of a curve: where seams end, meet, or reach a boundary. Stays where
                                     ///< it is, but for another junction.
    std::uint32_t open : 1 = 0;      ///< On a boundary.
    std::uint32_t folded : 1 = 0;    ///< Near an edge whose triangles lay back on each other in the input.
    VertexKind kind : 2 = VertexKind::kFixed;
};
static_assert(sizeof(Vertex) == 64 && offsetof(Vertex, quadric) == 16);

/// What only a collapse itself needs to know of the input around a vertex.
struct alignas(32) VertexHistory {
    float normal[3] = {};  ///< Sum of the area vectors of all input triangles that ended up here.
    float deviation = 0;   ///< Estimated distance of the vertex to the input surface, working units.
    Float3 witness;        ///< The input vertex, of those that ended up here, found farthest away; working
                           ///< coordinates.
};

}  // namespace vsplit::bake
