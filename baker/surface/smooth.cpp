// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/smooth.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "points/cholesky.hpp"
#include "surface/fit.hpp"

namespace vsplit::bake {
namespace {

/// Neighbours that a fit is given, and the most that a vertex of high valence may bring.
constexpr std::size_t kEnough = 60, kMost = 240;

/// Neighbours of each vertex, and normals that have seen two rings.
struct Rings {
    std::vector<std::uint32_t> starts, vertices;
    std::vector<Vec3> normals;
};

Rings make_rings(const Crust& crust) {
    const std::size_t count = crust.points.size();
    Rings rings;
    rings.starts.assign(count + 1, 0);
    // Every edge of a closed surface is met once from either end; at a boundary once from one end only, which
    // is enough.
    for (const Triangle& t : crust.triangles)
        for (const std::uint32_t v : t) ++rings.starts[v + 1];
    for (std::size_t v = 0; v < count; ++v) rings.starts[v + 1] += rings.starts[v];
    rings.vertices.resize(rings.starts[count]);
    std::vector<std::uint32_t> cursor(rings.starts.begin(), rings.starts.end() - 1);
    rings.normals.assign(count, {});
    for (const Triangle& t : crust.triangles) {
        const Vec3 n = area_normal(crust, t);
        for (std::size_t k = 0; k < 3; ++k) {
            rings.vertices[cursor[t[k]]++] = t[(k + 1) % 3];
            rings.normals[t[k]] = rings.normals[t[k]] + n;
        }
    }
    for (Vec3& n : rings.normals) n = unit(n);
    for (int pass = 0; pass < 2; ++pass) {
        std::vector<Vec3> sums = rings.normals;
        for (std::size_t v = 0; v < count; ++v) {
            for (std::uint32_t i = rings.starts[v]; i < rings.starts[v + 1]; ++i)
                sums[v] = sums[v] + rings.normals[rings.vertices[i]];
            sums[v] = unit(sums[v]);
        }
        rings.normals = std::move(sums);
    }
    return rings;
}

struct Near {
    double distance;
    std::uint32_t vertex;
    bool operator<(const Near& other) const {
        return distance != other.distance ? distance < other.distance : vertex < other.vertex;
    }
};

/// How far above the vertex its neighbours see the surface.
double lift(const Crust& crust, const Rings& rings, std::uint32_t v, std::vector<Near>& near) {
    const Vec3 origin = crust.points[v];
    near.assign(1, {0, v});
    // Whole rings are added until there is enough.
    for (std::size_t i = 0, ring_end = 1; i < near.size() && near.size() < kMost; ++i) {
        if (i == ring_end) {
            if (near.size() >= kEnough) break;
            ring_end = near.size();
        }
        for (std::uint32_t j = rings.starts[near[i].vertex]; j < rings.starts[near[i].vertex + 1]; ++j) {
            const std::uint32_t w = rings.vertices[j];
            if (std::none_of(near.begin(), near.end(), [w](const Near& n) { return n.vertex == w; }))
                near.push_back({length(crust.points[w] - origin), w});
        }
    }
    if (near.size() < 12) return 0;
    const std::size_t rank = std::min(kEnough, near.size()) - 1;
    std::nth_element(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(rank), near.end());
    const double reach = near[rank].distance;
    if (!(reach > 0)) return 0;
    Patch frame;
    frame.turn_to(rings.normals[v]);
    std::array<std::array<double, 6>, 6> a{};
    std::array<double, 6> b{};
    for (std::size_t i = 0; i <= rank; ++i) {
        constexpr double kLeastCosine = 0.3;
        const double agreement =
            (dot(rings.normals[near[i].vertex], frame.normal) - kLeastCosine) / (1 - kLeastCosine);
        if (agreement <= 0) continue;
        const Vec3 d = (crust.points[near[i].vertex] - origin) * (1 / reach);
        const double weight = agreement * std::exp(-2 * squared_length(d));
        const double x = dot(d, frame.x_axis), y = dot(d, frame.y_axis), z = dot(d, frame.normal);
        const std::array<double, 6> row{1, x, y, x * x, x * y, y * y};
        for (std::size_t r = 0; r < 6; ++r) {
            b[r] += weight * row[r] * z;
            for (std::size_t c = 0; c <= r; ++c) a[r][c] += weight * row[r] * row[c];
        }
    }
    const double total = a[0][0];
    for (std::size_t r = 1; r < 6; ++r) a[r][r] += (r < 3 ? 1e-6 : 1e-3) * total;
    if (!solve(a, b) || !(std::abs(b[0]) < 1)) return 0;
    return b[0] * reach;
}

}  // namespace

double roughness(const Crust& crust) {
    if (crust.points.size() < 100) return 0;
    const Rings rings = make_rings(crust);
    constexpr std::size_t kProbes = 1000;
    const std::size_t step = std::max<std::size_t>(1, crust.points.size() / kProbes);
    std::vector<double> missed;
    std::vector<Near> near;
    for (std::size_t v = 0; v < crust.points.size(); v += step) {
        const std::uint32_t first = rings.starts[v], last = rings.starts[v + 1];
        double edges = 0;
        for (std::uint32_t i = first; i < last; ++i)
            edges += length(crust.points[rings.vertices[i]] - crust.points[v]);
        if (edges > 0)
            missed.push_back(std::abs(lift(crust, rings, static_cast<std::uint32_t>(v), near)) *
                             (last - first) / edges);
    }
    if (missed.empty()) return 0;
    std::nth_element(missed.begin(), missed.begin() + static_cast<std::ptrdiff_t>(missed.size() / 2),
                     missed.end());
    return missed[missed.size() / 2];
}

void smooth(Crust& crust) {
    const Rings rings = make_rings(crust);
    std::vector<Vec3> moved(crust.points.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, moved.size(), 1024), [&](const auto& range) {
        std::vector<Near> near;
        for (std::size_t v = range.begin(); v < range.end(); ++v)
            moved[v] =
                crust.points[v] + rings.normals[v] * lift(crust, rings, static_cast<std::uint32_t>(v), near);
    });
    crust.points = std::move(moved);
}

}  // namespace vsplit::bake
