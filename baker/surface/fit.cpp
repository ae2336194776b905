// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/fit.hpp"

#include <algorithm>
#include <cmath>

#include "points/cholesky.hpp"

namespace vsplit::bake {
namespace {

/// The normal that most of the surface around the vertex agrees with: beside a crease, that of the vertex's
/// own side.
Vec3 agreed_normal(std::span<const Vec3> normals, std::span<const double> areas) {
    double best = -1;
    Vec3 result;
    for (std::size_t i = 0; i < normals.size(); ++i) {
        double votes = 0;
        Vec3 sum;
        for (std::size_t j = 0; j < normals.size(); ++j) {
            const double agreement = dot(normals[i], normals[j]) - 0.9;
            if (agreement <= 0) continue;
            votes += areas[j] * agreement;
            sum = sum + normals[j] * (areas[j] * agreement);
        }
        if (votes > best) {
            best = votes;
            result = unit(sum);
        }
    }
    return result;
}

}  // namespace

void Patch::turn_to(Vec3 n) {
    normal = n;
    const Vec3 least = std::abs(n.x) <= std::abs(n.y) && std::abs(n.x) <= std::abs(n.z) ? Vec3{1, 0, 0}
                       : std::abs(n.y) <= std::abs(n.z)                                 ? Vec3{0, 1, 0}
                                                                                        : Vec3{0, 0, 1};
    x_axis = unit(cross(n, least));
    y_axis = cross(n, x_axis);
}

namespace {

/// Least squares over neighbours that agree with the patch's present normal; turns the patch into the fitted
/// one.
void fit(Patch& patch, std::uint32_t v, std::span<const std::uint32_t> around, const Crust& crust,
         std::span<const Vec3> normals) {
    const Vec3 origin = crust.points[v];
    double reach = 0;
    for (const std::uint32_t q : around) reach = std::max(reach, squared_length(crust.points[q] - origin));
    if (!(reach > 0)) return;
    const double scale = 1 / std::sqrt(reach);
    std::array<std::array<double, 5>, 5> a{};
    std::array<double, 5> b{};
    int agreeing = 0;
    for (const std::uint32_t q : around) {
        const Vec3 d = (crust.points[q] - origin) * scale;
        const double squared = squared_length(d), turn = dot(normals[q], patch.normal);
        const double h = dot(d, patch.normal);
        if (turn < 0.8 || h * h > 0.1 * squared || squared <= 0) continue;
        const double agreement = (turn - 0.8) * 5;
        const double weight = agreement * agreement / (squared + 0.02);
        const double x = dot(d, patch.x_axis), y = dot(d, patch.y_axis);
        const std::array<double, 5> row{x, y, x * x, x * y, y * y};
        for (std::size_t i = 0; i < 5; ++i) {
            b[i] += weight * row[i] * h;
            for (std::size_t j = 0; j <= i; ++j) a[i][j] += weight * row[i] * row[j];
        }
        ++agreeing;
    }
    if (agreeing < 3) return;
    const double trace = a[0][0] + a[1][1];
    for (std::size_t i = 0; i < 2; ++i) a[i][i] += 1e-6 * trace;
    for (std::size_t i = 2; i < 5; ++i) a[i][i] += (agreeing < 6 ? 1e-1 : 1e-3) * trace;
    if (!solve(a, b)) return;
    // The height over the old plane, seen from the new one: the second-order part is kept as it is.
    patch.normal = unit(patch.normal - patch.x_axis * b[0] - patch.y_axis * b[1]);
    patch.bend = {b[2] * scale, b[3] * scale, b[4] * scale};
    const Vec3 y = unit(cross(patch.normal, patch.x_axis));
    patch.x_axis = cross(y, patch.normal);
    patch.y_axis = y;
}

}  // namespace

std::vector<Patch> fit_patches(const Crust& crust, std::span<const std::uint32_t> opposite) {
    const std::size_t count = crust.points.size();
    const std::vector<std::uint32_t> leaving = leaving_edges(crust, opposite);
    std::vector<Patch> patches(count);
    std::vector<Vec3> normals(count);
    std::vector<Vec3> facet(crust.triangles.size());
    std::vector<double> area(crust.triangles.size());
    for (std::size_t t = 0; t < facet.size(); ++t) {
        const Vec3 n = area_normal(crust, crust.triangles[t]);
        area[t] = length(n);
        facet[t] = unit(n);
    }
    std::vector<std::uint32_t> ring_starts(count + 1, 0), ring;
    ring.reserve(opposite.size() + 16);
    std::vector<Vec3> near_normals;
    std::vector<double> near_areas;
    for (std::uint32_t v = 0; v < count; ++v) {
        near_normals.clear();
        near_areas.clear();
        for (std::uint32_t h = leaving[v]; h != kNoEdge;) {
            near_normals.push_back(facet[h / 3]);
            near_areas.push_back(area[h / 3]);
            ring.push_back(edge_to(crust, h));
            const std::uint32_t back = previous_edge(h);
            h = opposite[back];
            if (h == kNoEdge) ring.push_back(edge_from(crust, back));
            if (h == leaving[v]) break;
        }
        ring_starts[v + 1] = static_cast<std::uint32_t>(ring.size());
        normals[v] = agreed_normal(near_normals, near_areas);
    }
    std::vector<std::uint32_t> around, seen(count, kNoEdge);
    for (int pass = 0; pass < 2; ++pass) {
        for (std::uint32_t v = 0; v < count; ++v) {
            around.clear();
            seen[v] = v;
            for (std::uint32_t i = ring_starts[v]; i < ring_starts[v + 1]; ++i) {
                if (seen[ring[i]] == v) continue;
                seen[ring[i]] = v;
                around.push_back(ring[i]);
            }
            for (std::size_t i = 0, first = around.size(); i < first; ++i)
                for (std::uint32_t j = ring_starts[around[i]]; j < ring_starts[around[i] + 1]; ++j) {
                    if (seen[ring[j]] == v) continue;
                    seen[ring[j]] = v;
                    around.push_back(ring[j]);
                }
            Patch& patch = patches[v];
            patch.turn_to(normals[v]);
            fit(patch, v, around, crust, normals);
        }
        for (std::uint32_t v = 0; v < count; ++v) {
            normals[v] = patches[v].normal;
            seen[v] = kNoEdge;
        }
    }
    return patches;
}

}  // namespace vsplit::bake
