// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "mesh_checks.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <span>

namespace vsplit::test {
namespace {

using Vec = std::array<double, 3>;

Vec vec(const Float3& p) {
    return {double(p.x), double(p.y), double(p.z)};
}
Vec minus(const Vec& a, const Vec& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vec along(const Vec& a, const Vec& b, double t) {
    return {a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]};
}
double dot(const Vec& a, const Vec& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vec cross(const Vec& a, const Vec& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Corners {
    Vec a, b, c;
    Vec normal() const { return cross(minus(b, a), minus(c, a)); }
    Vec at(double u, double v) const { return along(along(a, minus(b, a), u), minus(c, a), v); }
};
Corners corners(const Mesh& m, const Triangle& t) {
    return {vec(m.positions[t[0]]), vec(m.positions[t[1]]), vec(m.positions[t[2]])};
}

/// Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
double distance2(const Vec& p, const Corners& t) {
    const Vec ab = minus(t.b, t.a), ac = minus(t.c, t.a), ap = minus(p, t.a);
    const auto to = [&](const Vec& q) { return dot(minus(p, q), minus(p, q)); };
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return to(t.a);
    const Vec bp = minus(p, t.b);
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return to(t.b);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return to(along(t.a, ab, d1 - d3 > 0 ? d1 / (d1 - d3) : 0));
    const Vec cp = minus(p, t.c);
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return to(t.c);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return to(along(t.a, ac, d2 - d6 > 0 ? d2 / (d2 - d6) : 0));
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double w = (d4 - d3) + (d5 - d6);
        return to(along(t.b, minus(t.c, t.b), w > 0 ? (d4 - d3) / w : 0));
    }
    const double sum = va + vb + vc;
    if (!(sum > 0)) return to(t.a);
    return to(t.at(vb / sum, vc / sum));
}

struct UnionFind {
    std::vector<std::uint32_t> root;
    explicit UnionFind(std::size_t n) : root(n) { std::iota(root.begin(), root.end(), 0u); }
    std::uint32_t find(std::uint32_t i) {
        while (root[i] != i) i = root[i] = root[root[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) { root[find(a)] = find(b); }
};

struct EdgeUse {
    std::uint32_t low, high;
    std::uint32_t triangle;
    bool forward;  // runs from low to high
};

/// All edge uses, those of an edge together.
std::vector<EdgeUse> edge_uses(const Mesh& mesh) {
    std::vector<EdgeUse> uses;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
            uses.push_back({std::min(a, b), std::max(a, b), t, a < b});
        }
    std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
        return std::array{a.low, a.high, a.triangle} < std::array{b.low, b.high, b.triangle};
    });
    return uses;
}

template <class Visit>
void for_edges(const std::vector<EdgeUse>& uses, const Visit& visit) {
    for (std::size_t i = 0, j; i < uses.size(); i = j) {
        for (j = i; j < uses.size() && uses[j].low == uses[i].low && uses[j].high == uses[i].high;) ++j;
        visit(std::span(uses).subspan(i, j - i));
    }
}

}  // namespace

Topology topology(const Mesh& mesh) {
    Topology out;
    const std::size_t n = mesh.positions.size();
    UnionFind parts(n), loops(n);
    // Corners of a vertex are joined across its edges: a fan is one class of corners.
    UnionFind fans(3 * mesh.triangles.size());
    const auto corner = [&](std::uint32_t t, std::uint32_t v) {
        const Triangle& c = mesh.triangles[t];
        return 3 * t + (c[0] == v ? 0u : c[1] == v ? 1u : 2u);
    };
    std::vector<bool> on_boundary(n, false), used(n, false);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    for_edges(edge_uses(mesh), [&](std::span<const EdgeUse> uses) {
        const EdgeUse& e = uses[0];
        edges.emplace_back(e.low, e.high);
        parts.join(e.low, e.high);
        if (uses.size() == 1) {
            ++out.boundary_edges;
            loops.join(e.low, e.high);
            on_boundary[e.low] = on_boundary[e.high] = true;
        } else if (uses.size() > 2 || uses[0].forward == uses[1].forward) {
            ++out.non_manifold_edges;
        }
        for (const EdgeUse& other : uses)
            for (const std::uint32_t v : {e.low, e.high})
                fans.join(corner(e.triangle, v), corner(other.triangle, v));
    });
    out.edges = edges.size();
    out.triangles = mesh.triangles.size();
    std::vector<std::set<std::uint32_t>> fans_at(n);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (const std::uint32_t v : mesh.triangles[t]) {
            used[v] = true;
            fans_at[v].insert(fans.find(corner(t, v)));
        }
    std::map<std::uint32_t, PartTopology> by_part;
    std::set<std::uint32_t> counted;
    for (std::uint32_t v = 0; v < n; ++v) {
        if (!used[v]) continue;
        ++out.vertices;
        out.non_manifold_vertices += fans_at[v].size() > 1;
        PartTopology& part = by_part[parts.find(v)];
        ++part.euler;
        if (on_boundary[v] && counted.insert(loops.find(v)).second) ++part.boundary_loops;
    }
    for (const auto& [a, b] : edges) --by_part[parts.find(a)].euler;
    for (const Triangle& t : mesh.triangles) ++by_part[parts.find(t[0])].euler;
    for (const auto& [root, part] : by_part) out.parts.push_back(part);
    std::sort(out.parts.begin(), out.parts.end());
    return out;
}

bool parts_survive(const Topology& coarse, const Topology& fine) {
    return std::includes(fine.parts.begin(), fine.parts.end(), coarse.parts.begin(), coarse.parts.end());
}

std::vector<std::array<std::uint32_t, 12>> triangle_bits(const Mesh& mesh) {
    std::vector<std::array<std::uint32_t, 12>> all;
    for (const Triangle& t : mesh.triangles) {
        std::array<std::array<std::uint32_t, 4>, 3> c;
        for (std::size_t k = 0; k < 3; ++k) {
            const Float3& p = mesh.positions[t[k]];
            c[k] = {std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y),
                    std::bit_cast<std::uint32_t>(p.z),
                    mesh.weights.empty() ? 0 : std::bit_cast<std::uint32_t>(mesh.weights[t[k]])};
        }
        std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
        auto& out = all.emplace_back();
        for (std::size_t i = 0; i < 12; ++i) out[i] = c[i / 4][i % 4];
    }
    std::sort(all.begin(), all.end());
    return all;
}

std::size_t degenerate_triangles(const Mesh& mesh) {
    std::size_t count = 0;
    for (const Triangle& t : mesh.triangles) {
        const Corners c = corners(mesh, t);
        const Vec n = c.normal();
        const double longest =
            std::max({dot(minus(c.b, c.a), minus(c.b, c.a)), dot(minus(c.c, c.b), minus(c.c, c.b)),
                      dot(minus(c.a, c.c), minus(c.a, c.c))});
        count += !(std::sqrt(dot(n, n)) > 1e-7 * longest);
    }
    return count;
}

std::size_t flipped_triangles(const Mesh& mesh, const Mesh& input) {
    std::vector<Corners> originals;
    std::vector<Vec> normals;
    for (const Triangle& t : input.triangles) {
        originals.push_back(corners(input, t));
        normals.push_back(originals.back().normal());
    }
    std::size_t count = 0;
    for (const Triangle& t : mesh.triangles) {
        const Corners c = corners(mesh, t);
        const Vec n = c.normal();
        bool flipped = true;
        for (const auto& [u, v] : {std::pair{1 / 3.0, 1 / 3.0}, {0.6, 0.2}, {0.2, 0.6}, {0.2, 0.2}}) {
            const Vec p = c.at(u, v);
            double nearest = std::numeric_limits<double>::infinity();
            std::size_t face = 0;
            for (std::size_t i = 0; i < originals.size(); ++i)
                if (const double d = distance2(p, originals[i]); d < nearest) {
                    nearest = d;
                    face = i;
                }
            flipped &= !originals.empty() && dot(n, normals[face]) < 0;
            if (!flipped) break;
        }
        count += flipped;
    }
    return count;
}

std::size_t folded_edges(const Mesh& mesh) {
    std::size_t count = 0;
    for_edges(edge_uses(mesh), [&](std::span<const EdgeUse> uses) {
        if (uses.size() != 2) return;
        const Vec a = corners(mesh, mesh.triangles[uses[0].triangle]).normal(),
                  b = corners(mesh, mesh.triangles[uses[1].triangle]).normal();
        count += dot(a, b) < -0.95 * std::sqrt(dot(a, a) * dot(b, b));
    });
    return count;
}

double distance_to(const Mesh& mesh, const std::vector<Float3>& points) {
    std::vector<Corners> all;
    for (const Triangle& t : mesh.triangles) all.push_back(corners(mesh, t));
    double farthest = 0;
    for (const Float3& p : points) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Corners& c : all) nearest = std::min(nearest, distance2(vec(p), c));
        farthest = std::max(farthest, nearest);
    }
    return std::sqrt(farthest);
}

}  // namespace vsplit::test
