// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "points/tetrahedra.hpp"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <numeric>

#include "points/flatten.hpp"

namespace vsplit::bake {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using CellBase = CGAL::Triangulation_cell_base_with_info_3<std::uint32_t, Kernel,
                                                           CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Sequential =
    CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;
using Concurrent = CGAL::Delaunay_triangulation_3<
    Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase, CGAL::Parallel_tag>>;

/// Rounds of growing size, each along the curve: the biased randomised insertion order of Amenta, Choi and
/// Rote, "Incremental constructions con BRIO" (2003), with a hash of the index for a die.
std::vector<std::uint32_t> insertion_order(std::size_t count) {
    std::vector<std::vector<std::uint32_t>> rounds;
    for (std::uint32_t i = 0; i < count; ++i) {
        std::uint64_t die = (i + 1) * 0x9E3779B97F4A7C15ull;
        die ^= die >> 32;
        die *= 0xD6E8FEB86659FD93ull;
        die ^= die >> 32;
        std::size_t round = 0;
        for (; (die & 7) == 0 && round < 7; die >>= 3) ++round;
        if (rounds.size() <= round) rounds.resize(round + 1);
        rounds[round].push_back(i);
    }
    std::vector<std::uint32_t> order;
    order.reserve(count);
    for (std::size_t r = rounds.size(); r-- > 0;)
        order.insert(order.end(), rounds[r].begin(), rounds[r].end());
    return order;
}

}  // namespace

Tetrahedra tetrahedralise(std::vector<Vec3> points, std::size_t samples, int threads) {
    Tetrahedra out;
    out.samples = samples;
    if (threads > 1) {
        std::vector<Kernel::Point_3> copies;
        copies.reserve(points.size());
        for (const Vec3& p : points) copies.emplace_back(p.x, p.y, p.z);
        CGAL::Bbox_3 box;
        for (const auto& p : copies) box += p.bbox();
        Concurrent::Lock_data_structure locks(box, 50);
        Concurrent triangulation(copies.begin(), copies.end(), &locks);
        // The concurrent insertion of CGAL takes plain points; the index is found again by the coordinates.
        const auto less = [](const Vec3& a, const Vec3& b) {
            return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
        };
        std::vector<std::uint32_t> by_place(points.size());
        std::iota(by_place.begin(), by_place.end(), 0u);
        std::sort(by_place.begin(), by_place.end(),
                  [&](std::uint32_t a, std::uint32_t b) { return less(points[a], points[b]); });
        for (auto v = triangulation.finite_vertices_begin(); v != triangulation.finite_vertices_end(); ++v) {
            const Vec3 place{v->point().x(), v->point().y(), v->point().z()};
            v->info() = *std::lower_bound(by_place.begin(), by_place.end(), place,
                                          [&](std::uint32_t a, const Vec3& b) { return less(points[a], b); });
        }
        flatten(triangulation, points.size(), out.cells, out.neighbours);
        out.points = std::move(points);
        return out;
    }
    Sequential triangulation;
    Sequential::Vertex_handle hint;
    // The box first: later samples then meet no infinite cells.
    const auto insert = [&](std::size_t i) {
        const Vec3& p = points[i];
        hint = triangulation.insert({p.x, p.y, p.z}, hint);
        hint->info() = static_cast<std::uint32_t>(i);
    };
    for (std::size_t i = samples; i < points.size(); ++i) insert(i);
    for (const std::uint32_t i : insertion_order(samples)) insert(i);
    flatten(triangulation, points.size(), out.cells, out.neighbours);
    out.points = std::move(points);
    return out;
}

}  // namespace vsplit::bake
