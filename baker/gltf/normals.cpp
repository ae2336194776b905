// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "normals.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace vsplit::bake {
namespace {

using Vector = std::array<double, 3>;

Vector edge(const Float3& from, const Float3& to) {
    return {double(to.x) - from.x, double(to.y) - from.y, double(to.z) - from.z};
}

double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// False for a vector without a direction.
bool unit(const Vector& v, Float3& out) {
    // By its largest component first: the squares of the sums below may leave a double's range.
    const double most = std::fmax(std::fabs(v[0]), std::fmax(std::fabs(v[1]), std::fabs(v[2])));
    if (!(most > 0) || !std::isfinite(most)) return false;
    const Vector s = {v[0] / most, v[1] / most, v[2] / most};
    const double length = std::sqrt(dot(s, s));
    out = {float(s[0] / length), float(s[1] / length), float(s[2] / length)};
    return true;
}

}  // namespace

std::vector<Float3> smooth_normals(const Mesh& mesh) {
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    const std::size_t count = mesh.positions.size();
    std::vector<Vector> sums(count, Vector{});
    std::vector<double> sizes(count, 0);  // what the sum would be if all faces agreed
    std::vector<std::uint32_t> first(count, kNone);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::size_t c = 0; c < 3; ++c) {
            const std::uint32_t v = mesh.triangles[t][c];
            const Float3& p = mesh.positions[v];
            const Vector a = edge(p, mesh.positions[mesh.triangles[t][(c + 1) % 3]]);
            const Vector b = edge(p, mesh.positions[mesh.triangles[t][(c + 2) % 3]]);
            const Vector normal = cross(a, b);
            const double scale = dot(a, a) * dot(b, b), length = std::sqrt(dot(normal, normal));
            if (!(scale > 0) || !(length > 0)) continue;
            if (first[v] == kNone) first[v] = t;
            for (std::size_t i = 0; i < 3; ++i) sums[v][i] += normal[i] / scale;
            sizes[v] += length / scale;
        }
    std::vector<Float3> normals(count, Float3{0, 0, 1});
    for (std::size_t v = 0; v < count; ++v) {
        if (first[v] == kNone) continue;
        // Below this a sum is what rounding left of faces that cancel out, and no direction.
        if (std::sqrt(dot(sums[v], sums[v])) > 1e-9 * sizes[v] && unit(sums[v], normals[v])) continue;
        const Triangle& t = mesh.triangles[first[v]];
        unit(cross(edge(mesh.positions[t[0]], mesh.positions[t[1]]),
                   edge(mesh.positions[t[0]], mesh.positions[t[2]])),
             normals[v]);
    }
    return normals;
}

}  // namespace vsplit::bake
