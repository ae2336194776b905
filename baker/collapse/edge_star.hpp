// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// An edge with the triangles around it.
#pragma once

#include <cstdint>
#include <vector>

#include "star_mesh.hpp"

namespace vsplit::bake {

/// The triangles that an edge's collapse changes, gathered once for all tests.
struct EdgeStar {
    struct Wing {
        std::uint32_t a, b;  ///< The triangle is (apex, a, b), counter-clockwise.
        Double3 pa, pb;
        bool at_first;  ///< The apex is the edge's first vertex.
    };
    /// Four triangles that stay.
    struct Wings {
        Lanes3 apex, a, b;
        Lanes3 before, after;  ///< Twice the area vectors, set by place_at().
    };
    std::uint32_t u = 0, v = 0;
    Double3 pu, pv;
    std::size_t size = 0;        ///< Triangles that stay.
    std::size_t first_size = 0;  ///< Those at u, which come first.
    /// Their other corners, and the places; the last of them fills up four.
    std::vector<std::uint32_t> a, b;
    std::vector<std::uint32_t> triangles;  ///< Only of meshes with wedges; so are opposite_triangles.
    std::vector<Wings> wings;
    std::vector<std::uint32_t> opposite;  ///< Third vertices of the triangles on the edge.
    std::vector<Double3> opposite_places;
    std::vector<std::uint32_t> opposite_triangles;
    std::vector<char> forward;  ///< The triangle on the edge runs along it from u to v.

    void gather(const StarMesh& mesh, std::uint32_t first, std::uint32_t second);
    /// The normals, if the remaining vertex goes to `place`.
    void place_at(Double3 place);

    Wing wing(std::size_t i) const {
        const Wings& w = wings[i / 4];
        const auto lane = [&](const Lanes3& p) { return Double3{p.x[i % 4], p.y[i % 4], p.z[i % 4]}; };
        return {a[i], b[i], lane(w.a), lane(w.b), i < first_size};
    }
};

/// The end that is nearer to a place; the first, if they are the same.
inline std::uint32_t nearer_end(const EdgeStar& star, Double3 place) {
    return length2(place - star.pv) < length2(place - star.pu) ? star.v : star.u;
}

}  // namespace vsplit::bake
