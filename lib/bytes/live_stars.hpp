// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The mesh at the level reached, as coding and decoding see it: places on the lattice, and which triangles
// are around each vertex. Nothing in it depends on the mesh being manifold; but where the triangles around a
// vertex are a fan, they are kept in its order, and a split of a fan hands the order on.
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

/// A line of memory: vertices are met in no order of theirs.
struct alignas(64) LiveVertex {
    /// What is known of the star: nothing, that it is no fan, that it is one.
    enum class Shape : std::uint8_t { kUnknown, kOther, kOpen, kClosed };

    Lattice3 at{};
    std::array<std::uint32_t, 3>
        ring{};  ///< Sum, over the star's triangles, of the two other corners' places; modulo 2^32.
    std::uint32_t star = 0;     ///< Triangles in it.
    std::uint32_t touched = 0;  ///< The last sweep that changed its star, from 1.
    std::uint32_t locked = 0;   ///< Of a batch: triangles of the star that it has changed, if touched in it.
    std::uint32_t row = 0;      ///< Of rounds: its place among those asked, if it is older than the sweep.
    std::uint32_t acted = 0;    ///< The last in which it was born, split or moved.
    std::uint32_t twin = 0;     ///< The next in the ring of vertices born at the same place.
    std::uint32_t more = 0;     ///< Where its list goes on if it is long.
    std::uint8_t power = 0;     ///< The list has room for 8 << power slots.
    Shape shape = Shape::kUnknown;

    bool is_fan() const { return shape >= Shape::kOpen; }
    /// The star changes in this sweep.
    void touch(std::uint32_t sweep) {
        if (touched != sweep) locked = 0;
        touched = sweep;
    }
    std::uint32_t slots() const { return star + (shape == Shape::kOpen); }
};

/// The star of a vertex, and its ring in order if the triangles are a single fan.
struct Star {
    static constexpr std::size_t kLargestFan = 32;

    std::uint32_t centre = kNoVertex;
    bool fan = false;  ///< At most kLargestFan triangles, in one closed or open fan.
    bool closed = false;
    std::uint32_t size = 0;              ///< Triangles.
    std::vector<std::uint32_t> corners;  ///< Those that hold the centre, ascending; if it is no fan.
    /// Sector i lies between ring i and i + 1; closed ones go round twice.
    std::array<std::uint32_t, 2 * kLargestFan + 8> ring;
    std::array<std::uint32_t, 2 * kLargestFan + 8> corner;  ///< The centre's in each sector.
    std::uint32_t ring_size() const { return closed ? size : size + 1; }
};

/// A run of sectors begin .. begin + length of a fan, and the new triangles at its ends.
struct Cut {
    std::uint32_t begin = 0, length = 0;
    bool first_wing = true;  ///< There is a new triangle (child, parent, ring[begin]).
    bool last_wing = true;   ///< There is a new triangle (child, ring[begin + length], parent), before it.
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
    /// A corner goes over from the vertex that holds it to another. The lists of both are left to relink().
    void hand_over(std::uint32_t corner, std::uint32_t vertex) { triangles[corner / 3][corner % 3] = vertex; }
    /// The corners that hold the vertex, in any order: its list.
    void relink(std::uint32_t vertex, std::span<const std::uint32_t> corners);
    /// Forgets the order of a star, one of whose triangles has got another corner.
    void forget(std::uint32_t vertex);

    /// Splits a fan, as gathered: moves its centre, adds the child and the new triangles. What changes is
    /// touched in this sweep, parent and child act, and the triangles of the child are locked.
    void split(const Star& star, const Cut& cut, const Lattice3& parent_at, const Lattice3& child_at,
               std::uint32_t sweep);

    /// Adds (sign 1) or takes away (-1) a triangle's places from the ring sums of its corners.
    void weigh(std::uint32_t triangle, int sign);

    void gather(std::uint32_t vertex, Star& star);
    /// The corners that hold a vertex, in no order.
    void gather_corners(std::uint32_t vertex, std::vector<std::uint32_t>& corners) const;

    /// Vertices of one place become twins of each other: among `first` and those after it.
    void link_twins(std::uint32_t first);

    /// How far a vertex is from the mean of its neighbours, in 1/16; zeros where the star is empty or vast.
    Lattice3 bump(std::uint32_t vertex) const;

    void fetch(std::uint32_t vertex) const { __builtin_prefetch(&vertices[vertex]); }
    /// Has the memory read ahead that asking for a split of this vertex needs: 0 its list, 1 its ring.
    void fetch(std::uint32_t vertex, int stage) const {
        const LiveVertex& v = vertices[vertex];
        const Slot* const slot = list(vertex);
        if (stage == 0) {
            __builtin_prefetch(slot);
            if (v.power > 0) __builtin_prefetch(slot + kLine);
        } else if (stage == 1 && v.is_fan()) {
            for (std::uint32_t i = 0; i < v.slots(); ++i) {
                __builtin_prefetch(&vertices[slot[i].vertex], 1);
                __builtin_prefetch(&lines_[slot[i].vertex], 1);
            }
        }
    }
    /// And what the split itself changes.
    void fetch(const Star& star) const {
        for (std::uint32_t i = 0; i < star.ring_size(); ++i) __builtin_prefetch(list(star.ring[i]), 1);
        for (std::uint32_t i = 0; i < star.size; ++i)
            __builtin_prefetch(triangles.data()->data() + star.corner[i], 1);
    }

  private:
    /// A corner that holds the vertex, and, in a fan, the ring's vertex where its sector begins. An open fan
    /// has a last slot of the ring's last vertex and no corner.
    struct Slot {
        std::uint32_t vertex, corner;
    };
    static constexpr std::uint32_t kLine = 8;
    /// Where in a fan's list a vertex is that it has.
    static std::uint32_t find(const Slot* slot, const LiveVertex& v, std::uint32_t vertex);
    /// Makes way for a slot at this place of a list.
    static void shift(Slot* slot, const LiveVertex& v, std::uint32_t at);
    struct alignas(64) Line {
        std::array<Slot, kLine> slot;
    };

    Slot* list(std::uint32_t vertex) {
        const LiveVertex& v = vertices[vertex];
        return (v.power == 0 ? lines_[vertex] : more_[v.more]).slot.data();
    }
    const Slot* list(std::uint32_t vertex) const { return const_cast<LiveStars*>(this)->list(vertex); }
    /// Room for so many slots; what is in the list stays.
    Slot* make_room(std::uint32_t vertex, std::uint32_t slots) {
        return slots <= kLine << vertices[vertex].power ? list(vertex) : grow(vertex, slots);
    }
    Slot* grow(std::uint32_t vertex, std::uint32_t slots);
    /// Finds out whether the star of a vertex is a fan, and puts its list in order if so.
    void order(std::uint32_t vertex);
    static void set_fan(LiveVertex& vertex, std::uint32_t triangles, bool closed);
    /// In the list of a neighbour of a split vertex.
    void replace(std::uint32_t vertex, std::uint32_t parent, std::uint32_t child);
    void insert(std::uint32_t vertex, std::uint32_t parent, std::uint32_t child, std::uint32_t corner,
                bool after);

    std::vector<Line> lines_;                          // the first of each vertex
    std::vector<Line> more_;                           // longer lists, whole
    std::array<std::vector<std::uint32_t>, 33> free_;  // of them, lists given back, by their power
    std::vector<std::uint32_t> order_;
};

}  // namespace vsplit
