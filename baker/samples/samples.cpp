// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "vsplit/bake/samples.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>

#include "surfaces.hpp"

namespace vsplit::bake {
namespace {

constexpr std::size_t kCandidatesPerPoint = 5;

/// Points evenly by area over a mesh of the surface, one in each of `count` equal shares of the area, moved
/// onto the surface itself. `on_surface(t, weights)` yields the point of the surface at barycentric `weights`
/// of triangle t.
template <class OnSurface>
std::vector<Double3> scatter(const Mesh& mesh, std::size_t count, double& area, OnSurface&& on_surface) {
    std::vector<double> sums;
    sums.reserve(mesh.triangles.size());
    area = 0;
    for (const Triangle& t : mesh.triangles) {
        const Float3 p = mesh.positions[t[0]], q = mesh.positions[t[1]], r = mesh.positions[t[2]];
        const double ux = double(q.x) - p.x, uy = double(q.y) - p.y, uz = double(q.z) - p.z;
        const double vx = double(r.x) - p.x, vy = double(r.y) - p.y, vz = double(r.z) - p.z;
        const double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
        area += std::sqrt(x * x + y * y + z * z) / 2;
        sums.push_back(area);
    }
    std::vector<Double3> points(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        const double at = area * ((static_cast<double>(i) + hash_unit(3 * i)) / static_cast<double>(count));
        const auto found = std::lower_bound(sums.begin(), sums.end(), at);
        const Triangle t =
            mesh.triangles[static_cast<std::size_t>(std::min(found, sums.end() - 1) - sums.begin())];
        const double s = std::sqrt(hash_unit(3 * i + 1)), b = s * hash_unit(3 * i + 2),
                     weights[3] = {1 - s, s - b, b};
        points[i] = on_surface(t, weights);
    });
    return points;
}

}  // namespace

Mesh make_sample_mesh(Sample sample, std::size_t triangles) {
    assert(triangles >= 100 && triangles <= 20'000'000);
    return sample == Sample::kWhale ? mesh_whale(triangles) : mesh_ocean(ocean_grid(triangles));
}

std::vector<Float3> make_sample_points(Sample sample, std::size_t count) {
    if (count == 0) return {};
    const std::size_t triangles = std::clamp<std::size_t>(count, 20'000, 2'000'000),
                      scattered = count * kCandidatesPerPoint;
    double area = 0;
    std::vector<Double3> candidates;
    if (sample == Sample::kWhale) {
        const Mesh mesh = mesh_whale(triangles);
        candidates = scatter(mesh, scattered, area, [&](const Triangle& t, const double(&weights)[3]) {
            Double3 p;
            for (std::size_t c = 0; c < 3; ++c) {
                const Float3 q = mesh.positions[t[c]];
                p = {p.x + weights[c] * q.x, p.y + weights[c] * q.y, p.z + weights[c] * q.z};
            }
            return project_on_whale(p, 0.05);
        });
    } else {
        const OceanGrid grid = ocean_grid(triangles);
        candidates =
            scatter(mesh_ocean(grid), scattered, area, [&](const Triangle& t, const double(&weights)[3]) {
                double u = 0, v = 0;
                for (std::size_t c = 0; c < 3; ++c) {
                    u += weights[c] * static_cast<double>(t[c] % (grid.columns + 1));
                    v += weights[c] * static_cast<double>(t[c] / (grid.columns + 1));
                }
                return ocean_point(u / static_cast<double>(grid.columns), v / static_cast<double>(grid.rows));
            });
    }
    std::vector<Float3> points;
    points.reserve(count);
    for (const Double3& p : eliminate_samples(candidates, count, area))
        points.push_back({float(p.x), float(p.y), float(p.z)});
    return points;
}

}  // namespace vsplit::bake
