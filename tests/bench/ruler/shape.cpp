// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Topology and quality, counted.
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <numbers>
#include <numeric>

#include "ruler.hpp"

namespace vsplit::ruler {
namespace {

constexpr double kFoldCosine = -0.95;  ///< Bent back by more than about 162 degrees.
constexpr double kFlipCosine = -0.1;   ///< Against the closest triangle of the reference.
constexpr double kLeastQuality = 1e-6, kLeastArea = 1e-14;

struct EdgeUse {
    std::uint64_t edge;  ///< The lesser vertex above, the greater below.
    std::uint32_t triangle;
};

/// Sets of vertices joined so far.
class Components {
  public:
    explicit Components(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
    std::uint32_t root(std::uint32_t v) {
        while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
        return v;
    }
    void join(std::uint32_t a, std::uint32_t b) { parent_[root(a)] = root(b); }

  private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace

Shape Ruler::shape_of(const Mesh& mesh) const {
    const std::size_t count = mesh.triangles.size();
    Shape shape;
    shape.triangles = count;
    shape.quality_min = 1;
    Components components(mesh.positions.size());
    std::vector<char> used(mesh.positions.size(), 0);
    std::vector<EdgeUse> edges;
    edges.reserve(3 * count);
    std::vector<Vec3> normals(count);  // Zero for degenerate triangles.
    for (std::size_t i = 0; i < count; ++i) {
        const Triangle& t = mesh.triangles[i];
        double squared_edges = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            used[a] = 1;
            components.join(a, b);
            if (a != b)
                edges.push_back({std::uint64_t(std::min(a, b)) << 32 | std::max(a, b), std::uint32_t(i)});
            const Vec3 side = to_vec(mesh.positions[b]) - to_vec(mesh.positions[a]);
            squared_edges += dot(side, side);
        }
        const Vec3 normal = area_vector(mesh, t);
        const double area = 0.5 * length(normal);
        const double quality = squared_edges > 0 ? 4 * std::numbers::sqrt3 * area / squared_edges : 0;
        shape.quality_min = std::min(shape.quality_min, quality);
        shape.quality_mean += quality / double(count);
        if (t[0] == t[1] || t[1] == t[2] || t[0] == t[2] || quality < kLeastQuality ||
            area < kLeastArea * diagonal_ * diagonal_) {
            ++shape.degenerate;
            shape.new_degenerate += !in_reference(mesh, t);
        } else {
            normals[i] = normal * (0.5 / area);
        }
    }

    std::sort(edges.begin(), edges.end(), [](const EdgeUse& a, const EdgeUse& b) { return a.edge < b.edge; });
    for (std::size_t i = 0, next = 0; i < edges.size(); i = next) {
        while (next < edges.size() && edges[next].edge == edges[i].edge) ++next;
        if (next - i == 1) ++shape.boundary_edges;
        if (next - i > 2) ++shape.non_manifold_edges;
        const std::uint32_t a = edges[i].triangle, b = edges[next - 1].triangle;
        if (next - i == 2 && dot(normals[a], normals[b]) < kFoldCosine) {
            ++shape.folded;
            shape.new_folded +=
                !in_reference(mesh, mesh.triangles[a]) || !in_reference(mesh, mesh.triangles[b]);
        }
    }
    for (std::uint32_t v = 0; v < used.size(); ++v) {
        shape.vertices += used[v] != 0;
        shape.components += used[v] && components.root(v) == v;
    }

    std::vector<char> flipped(count, 0);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        if (dot(normals[i], normals[i]) == 0) return;
        const Triangle& t = mesh.triangles[i];
        static constexpr double kInside[4][3] = {
            {1. / 3, 1. / 3, 1. / 3}, {.6, .2, .2}, {.2, .6, .2}, {.2, .2, .6}};
        std::uint32_t guess = TriangleTree::kNoGuess;
        for (const auto& w : kInside) {
            const TriangleTree::Hit hit =
                tree_.closest(to_vec(mesh.positions[t[0]]) * w[0] + to_vec(mesh.positions[t[1]]) * w[1] +
                                  to_vec(mesh.positions[t[2]]) * w[2],
                              guess);
            guess = hit.slot;
            const Vec3 there = area_vector(reference_, reference_.triangles[hit.triangle]);
            const double size = length(there);
            if (!(size > 0) || dot(there, normals[i]) > kFlipCosine * size) return;
        }
        flipped[i] = 1;
    });
    for (std::size_t i = 0; i < count; ++i) {
        shape.flipped += flipped[i] != 0;
        shape.new_flipped += flipped[i] && !in_reference(mesh, mesh.triangles[i]);
    }
    return shape;
}

}  // namespace vsplit::ruler
