// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <numeric>
#include <tuple>

#include "points/frame.hpp"
#include "points/tetrahedra.hpp"
#include "vsplit/bake/points.hpp"

namespace vsplit::bake {
namespace {

Vec3 circumcentre(const Tetrahedra& t, const Corners& c) {
    const Vec3 a = t.points[c[0]], u = t.points[c[1]] - a, v = t.points[c[2]] - a, w = t.points[c[3]] - a;
    const Vec3 vw = cross(v, w);
    return a + (vw * squared_length(u) + cross(w, u) * squared_length(v) + cross(u, v) * squared_length(w)) *
                   (0.5 / dot(u, vw));
}

/// Six times the volume of the part of a's Voronoi cell that lies in one cell of the triangulation, signed:
/// the three tetrahedra pairs from a over edge, facet and cell centres. Signed parts add up also where a
/// centre lies outside.
struct Volumes {
    const Tetrahedra& t;
    std::vector<double> six;

    void add(const Corners& c) {
        const Vec3 centre = circumcentre(t, c);
        for (int i = 0; i < 4; ++i) {
            const Vec3 p = t.points[c[static_cast<std::size_t>(i)]];
            double sum = 0;
            for (int j = 0; j < 4; ++j) {
                if (j == i) continue;
                // Over the edge (i, j): the two facets that hold it, met in the order that keeps orientation.
                int others[2], n = 0;
                for (int k = 0; k < 4; ++k)
                    if (k != i && k != j) others[n++] = k;
                const Vec3 q = t.points[c[static_cast<std::size_t>(j)]];
                const Vec3 r = t.points[c[static_cast<std::size_t>(others[0])]],
                           s = t.points[c[static_cast<std::size_t>(others[1])]];
                const Vec3 middle = (q - p) * 0.5;
                const double sign = dot(q - p, cross(r - p, s - p)) > 0 ? 1 : -1;
                sum += sign * dot(middle, cross(facet_centre(p, q, r), centre - p));
                sum += sign * dot(middle, cross(centre - p, facet_centre(p, q, s)));
            }
            six[c[static_cast<std::size_t>(i)]] += sum;
        }
    }
    /// Centre of the circle through p, q, r, seen from p.
    static Vec3 facet_centre(Vec3 p, Vec3 q, Vec3 r) {
        const Vec3 u = q - p, v = r - p, n = cross(u, v);
        return (cross(n, u) * squared_length(v) + cross(v, n) * squared_length(u)) *
               (0.5 / squared_length(n));
    }
};

Result<VoronoiCells> tessellate(std::span<const std::array<double, 3>> positions, int threads,
                                const Progress& progress) {
    const auto stop = [&](double done) { return progress && !progress("voronoi", done); };
    const Error cancelled{ErrorCode::kCancelled, "stopped in the Voronoi tessellation", Error::kNowhere, 0};
    if (stop(0)) return cancelled;
    const Frame frame(positions);
    const std::vector<Vec3> given = frame.into(positions);
    const UniquePoints unique = unique_points(given);
    if (unique.points.size() < 4)
        return Error{ErrorCode::kArgument, "fewer than four different points", Error::kNowhere, 0};
    const Tetrahedra t = tetrahedralise(unique.points, unique.points.size(), threads);
    if (t.cells.empty())
        return Error{ErrorCode::kArgument, "all points lie in one plane", Error::kNowhere, 0};
    if (stop(0.7)) return cancelled;

    const std::size_t count = unique.points.size();
    Volumes volumes{t, std::vector<double>(count, 0)};
    std::vector<std::uint8_t> hull(count, 0);
    std::vector<std::uint32_t> starts(count + 1, 0);
    for (std::size_t i = 0; i < t.cells.size(); ++i) {
        volumes.add(t.cells[i]);
        for (int k = 0; k < 4; ++k) {
            starts[t.cells[i][static_cast<std::size_t>(k)] + 1] += 3;
            if (t.neighbours[i][static_cast<std::size_t>(k)] != kNoCell) continue;
            for (const int corner : kFacetCorner[k]) hull[t.cells[i][static_cast<std::size_t>(corner)]] = 1;
        }
    }
    for (std::size_t v = 0; v < count; ++v) starts[v + 1] += starts[v];
    std::vector<std::uint32_t> all(starts[count]), cursor(starts.begin(), starts.end() - 1);
    for (const Corners& c : t.cells)
        for (const std::uint32_t a : c)
            for (const std::uint32_t b : c)
                if (a != b) all[cursor[a]++] = b;

    // Lists in the caller's numbering; duplicates answer for the point that stands for them.
    const std::size_t asked = positions.size();
    std::vector<std::uint32_t> first(count, kNoCell), copies(count, 0);
    for (std::uint32_t i = 0; i < asked; ++i) {
        const std::uint32_t v = unique.place[i];
        if (first[v] == kNoCell) first[v] = i;
        ++copies[v];
    }
    VoronoiCells out;
    out.volumes.resize(asked);
    out.densities.resize(asked);
    out.neighbour_starts.resize(asked + 1, 0);
    const double unit_volume = 1 / frame.scale / frame.scale / frame.scale;
    std::vector<std::uint32_t> list;
    for (std::size_t i = 0; i < asked; ++i) {
        const std::uint32_t v = unique.place[i];
        const double volume = std::max(volumes.six[v] / 6, 0.0) * unit_volume;
        out.volumes[i] = hull[v] ? std::numeric_limits<double>::infinity() : volume;
        out.densities[i] = hull[v] || !(volume > 0) ? 0 : copies[v] / volume;
        list.assign(all.begin() + starts[v], all.begin() + starts[v + 1]);
        for (std::uint32_t& n : list) n = first[n];
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
        out.neighbours.insert(out.neighbours.end(), list.begin(), list.end());
        out.neighbour_starts[i + 1] = static_cast<std::uint32_t>(out.neighbours.size());
    }
    if (stop(1)) return cancelled;
    return out;
}

}  // namespace

Result<VoronoiCells> voronoi_cells(std::span<const std::array<double, 3>> positions, int threads,
                                   const Progress& progress) {
    constexpr std::size_t kMost = 100'000'000;
    if (positions.size() > kMost)
        return Error{ErrorCode::kLimit, "more than 100 million points", Error::kNowhere, 0};
    for (const auto& p : positions)
        if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
            return Error{ErrorCode::kArgument, "a position is not finite", Error::kNowhere, 0};
    try {
        return tessellate(positions, threads, progress);
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::kLimit, "not enough memory for the Voronoi tessellation", Error::kNowhere, 0};
    }
}

}  // namespace vsplit::bake
