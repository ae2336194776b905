// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <array>
#include <numeric>

#include "edge_table.hpp"
#include "vsplit/bake/meshes.hpp"

namespace vsplit::bake {
namespace {

/// Union-find with path halving; the smaller index is the root.
struct Groups {
    std::vector<std::uint32_t> parent;
    explicit Groups(std::size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), 0u); }
    std::uint32_t root(std::uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = root(a);
        b = root(b);
        if (a < b)
            parent[b] = a;
        else
            parent[a] = b;
    }
};

std::uint64_t count_duplicates(std::span<const Triangle> triangles) {
    std::vector<Triangle> sorted(triangles.begin(), triangles.end());
    for (Triangle& t : sorted) std::sort(t.begin(), t.end());
    std::sort(sorted.begin(), sorted.end());
    std::uint64_t count = 0;
    for (std::size_t i = 1; i < sorted.size(); ++i) count += sorted[i] == sorted[i - 1];
    return count;
}

std::uint64_t count_zero_area(const Mesh& mesh) {
    if (mesh.positions.empty()) return 0;
    Float3 low = mesh.positions[0], high = low;
    for (const Float3& p : mesh.positions) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const double dx = double(high.x) - low.x, dy = double(high.y) - low.y, dz = double(high.z) - low.z;
    const double least = 1e-14 * (dx * dx + dy * dy + dz * dz);
    std::uint64_t count = 0;
    for (const Triangle& t : mesh.triangles) {
        const Float3 p = mesh.positions[t[0]], q = mesh.positions[t[1]], r = mesh.positions[t[2]];
        const double ux = double(q.x) - p.x, uy = double(q.y) - p.y, uz = double(q.z) - p.z;
        const double vx = double(r.x) - p.x, vy = double(r.y) - p.y, vz = double(r.z) - p.z;
        const double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
        const double area2 = (x * x + y * y + z * z) / 4;
        count += area2 <= 0 || area2 < least * least;
    }
    return count;
}

}  // namespace

MeshSurvey survey_mesh(const Mesh& mesh) {
    MeshSurvey survey;
    survey.vertices = mesh.positions.size();
    survey.triangles = mesh.triangles.size();

    // Corners at a vertex are one fan if a walk across shared edges joins them; an edge of three triangles
    // joins all.
    Groups fans(3 * mesh.triangles.size()), parts(mesh.positions.size());
    const auto corner_at = [&](const EdgeUse& use, std::uint32_t vertex) {
        const Triangle& t = mesh.triangles[use.half_edge / 3];
        const std::uint32_t base = use.half_edge / 3 * 3;
        return t[0] == vertex ? base : t[1] == vertex ? base + 1 : base + 2;
    };
    for_each_edge(mesh.positions.size(), mesh.triangles,
                  [&](std::uint32_t a, std::uint32_t b, std::span<const EdgeUse> uses) {
                      parts.join(a, b);
                      for (std::size_t i = 1; i < uses.size(); ++i) {
                          fans.join(corner_at(uses[0], a), corner_at(uses[i], a));
                          fans.join(corner_at(uses[0], b), corner_at(uses[i], b));
                      }
                      const auto leaves_a = [&](const EdgeUse& use) {
                          return mesh.triangles[use.half_edge / 3][use.half_edge % 3] == a;
                      };
                      survey.boundary_edges += uses.size() == 1;
                      survey.non_manifold_edges += uses.size() > 2;
                      survey.misoriented_edges += uses.size() == 2 && leaves_a(uses[0]) == leaves_a(uses[1]);
                  });

    std::vector<std::uint8_t> fans_at(mesh.positions.size(), 0);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t corner = 3 * t + k, v = mesh.triangles[t][k];
            if (fans.root(corner) == corner && fans_at[v] < 2) ++fans_at[v];
        }
    for (std::uint32_t v = 0; v < fans_at.size(); ++v) {
        survey.non_manifold_vertices += fans_at[v] > 1;
        survey.components += fans_at[v] > 0 && parts.root(v) == v;
    }
    survey.duplicate_triangles = count_duplicates(mesh.triangles);
    survey.zero_area_triangles = count_zero_area(mesh);
    return survey;
}

}  // namespace vsplit::bake
