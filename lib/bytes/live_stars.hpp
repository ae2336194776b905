// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The mesh at the level reached, as coding and decoding see it: places on the lattice, and which triangles
// are around each vertex. Nothing in it depends on the mesh being manifold.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "vsplit/progressive_mesh.hpp"

namespace vsplit {

using Lattice3 = std::array<std::int32_t, 3>;

/// Places lie within this distance of the lattice's origin, so that sums of them stay exact.
inline constexpr std::int32_t kLatticeReach = 1 << 22;

struct LiveVertex {
    Lattice3 at{};
    std::array<std::uint32_t, 3>
        ring{};  ///< Sum, over the star's triangles, of the two other corners' places; modulo 2^32.
    std::uint32_t star = 0;     ///< Triangles in it.
    std::uint32_t touched = 0;  ///< The last sweep that changed its star, from 1.
    std::uint32_t locked = 0;   ///< Of a batch: triangles of the star that it has changed, if touched in it.
    std::uint32_t acted = 0;    ///< The last in which it was born, split or moved.
    std::uint32_t twin = 0;     ///< The next in the ring of vertices born at the same place.
    std::uint32_t slots = 0;    ///< Where the list of its corners begins.
    std::uint32_t room = 0;     ///< How many the list has room for: 0 or a power of two.
};

/// The star of a vertex, and its ring in order if the triangles are a single fan.
struct Star {
    static constexpr std::size_t kLargestFan = 32;

    std::uint32_t centre = kNoVertex;
    std::vector<std::uint32_t> corners;  ///< Those that hold the centre, ascending if it is no fan.
    bool fan = false;                    ///< At most kLargestFan triangles, in one closed or open fan.
    bool closed = false;
    std::uint32_t size = 0;  ///< Triangles.
    std::array<std::uint32_t, kLargestFan + 1>
        ring{};  ///< Sector i lies between ring i and i + 1 (closed: modulo size).
    std::array<std::uint32_t, kLargestFan> sector{};  ///< Triangles.
    std::uint32_t ring_size() const { return closed ? size : size + 1; }
    std::uint32_t ring_at(std::uint32_t i) const { return ring[closed && i >= size ? i - size : i]; }
};

class LiveStars {
  public:
    /// Room for a mesh of these counts.
    void reserve(std::size_t vertices, std::size_t triangles);

    std::vector<LiveVertex> vertices;
    std::vector<Triangle> triangles;

    std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(vertices.size()); }
    void add_vertex(const Lattice3& at);
    /// Corners below vertex_count(), three different ones.
    void add_triangle(const Triangle& corners);
    /// The corners that hold a vertex, in no order; gone with the next change of any star.
    std::span<const std::uint32_t> corners(std::uint32_t vertex) const {
        return std::span(slots_).subspan(vertices[vertex].slots, vertices[vertex].star);
    }
    /// A corner goes over from the vertex that holds it to another. The lists of both are left to relink().
    void hand_over(std::uint32_t corner, std::uint32_t vertex) { triangles[corner / 3][corner % 3] = vertex; }
    /// Makes these corners, which are in no list of this class, the list of the vertex that all of them hold.
    void relink(std::uint32_t vertex, std::span<const std::uint32_t> corners);

    /// Adds (sign 1) or takes away (-1) a triangle's places from the ring sums of its corners.
    void weigh(std::uint32_t triangle, int sign);

    void gather(std::uint32_t vertex, Star& star) const;
    void gather_corners(std::uint32_t vertex, std::vector<std::uint32_t>& corners) const;

    /// Vertices of one place become twins of each other: among `first` and those after it.
    void link_twins(std::uint32_t first);

    /// How far a vertex is from the mean of its neighbours, in 1/16; zeros where the star is empty or vast.
    Lattice3 bump(std::uint32_t vertex) const;

    /// Has the memory read ahead that a split of this vertex needs: 0 its list, 1 its triangles, 2 its ring.
    void fetch(std::uint32_t vertex, int stage) const {
        const LiveVertex& v = vertices[vertex];
        if (v.star == 0 || v.star > 12) return;
        const std::uint32_t* slot = slots_.data() + v.slots;
        if (stage == 0) return __builtin_prefetch(slot);
        if (stage == 1) {
            for (std::uint32_t i = 0; i < v.star; ++i) __builtin_prefetch(&triangles[slot[i] / 3]);
            return;
        }
        for (std::uint32_t i = 0; i < v.star; ++i) {
            const std::uint32_t t = slot[i] / 3, k = slot[i] - 3 * t;
            __builtin_prefetch(&vertices[triangles[t][k == 2 ? 0 : k + 1]]);
        }
    }

  private:
    /// Room for so many corners; what is in the list stays.
    void make_room(LiveVertex& vertex, std::uint32_t corners);

    std::vector<std::uint32_t> slots_;                 // lists of corners, each as long as a power of two
    std::array<std::vector<std::uint32_t>, 33> free_;  // lists given back, by the power
    std::vector<std::uint32_t> order_;
};

}  // namespace vsplit
