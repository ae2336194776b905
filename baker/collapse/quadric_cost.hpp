// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Cost `quadric`: memoryless quadrics (Lindstrom and Turk, Fast and memory efficient polygonal simplification, 1998) relative to
// their own vertex. Every plane and boundary line that counts for a vertex passes through it, so linear and constant parts
// vanish, and with them the cancellation that plagues quadrics in single precision.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "star_mesh.hpp"
#include "vsplit/bake/collapse.hpp"

namespace vsplit::bake {

/// Symmetric 3x3 matrix: xx xy xz yy yz zz.
using Symmetric = std::array<double, 6>;

/// What a vertex knows of its star, one cache line.
struct alignas(64) VertexShape {
    float quadric[6] = {};  ///< Sum over triangles of area n nT, plus boundary terms.
    float area[3] = {};     ///< Sum over triangles of the area vector.
    float normal[3] = {};   ///< Area vectors of all input triangles that ended up here.
    float weight = 1;       ///< Painted.
    float deviation = 0;    ///< Estimated distance of the vertex to the input surface.
    float pad[2] = {};
};

inline Double3 times(const Symmetric& m, Double3 v) {
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[1] * v.x + m[3] * v.y + m[4] * v.z, m[2] * v.x + m[4] * v.y + m[5] * v.z};
}
inline double form(const Symmetric& m, Double3 v) { return dot(v, times(m, v)); }
inline double trace(const Symmetric& m) { return m[0] + m[3] + m[5]; }

/// A placed collapse and its cost.
struct Candidate {
    Double3 place;
    double cost = 0;
};

/// Solves m x = b for a symmetric positive definite m by LDLT; false if a pivot is not positive.
inline bool solve(const Symmetric& m, Double3 b, Double3& x) {
    const double d0 = m[0];
    if (!(d0 > 0)) return false;
    const double l10 = m[1] / d0, l20 = m[2] / d0;
    const double d1 = m[3] - l10 * m[1];
    if (!(d1 > 0)) return false;
    const double e = m[4] - l20 * m[1];
    const double l21 = e / d1;
    const double d2 = m[5] - l20 * m[2] - l21 * e;
    if (!(d2 > 0)) return false;
    const double y1 = b.y - l10 * b.x;
    const double y2 = b.z - l20 * b.x - l21 * y1;
    x.z = y2 / d2;
    x.y = y1 / d1 - l21 * x.z;
    x.x = b.x / d0 - l10 * x.y - l20 * x.z;
    return true;
}

inline Symmetric widen(const float (&q)[6], double weight) {
    return {q[0] * weight, q[1] * weight, q[2] * weight, q[3] * weight, q[4] * weight, q[5] * weight};
}

/// The quadrics of an edge's two ends together: cost and best place of folding it.
struct EdgeQuadric {
    EdgeQuadric(Double3 u, Double3 v, const VertexShape& su, const VertexShape& sv, const CollapseOptions& options)
        : qu(widen(su.quadric, su.weight)), qv(widen(sv.quadric, sv.weight)), middle((u + v) * 0.5), half((v - u) * 0.5),
          edge2(4 * length2(half)), options_(options) {
        for (std::size_t i = 0; i < 6; ++i) sum[i] = qu[i] + qv[i];
        const Double3 gu{su.area[0], su.area[1], su.area[2]}, gv{sv.area[0], sv.area[1], sv.area[2]};
        volume = gu + gv;
        volume_rhs = dot(gv - gu, half);  // volume . (x - middle) = volume_rhs keeps the volume
        const double t = trace(sum);
        const double w = 0.5 * (double(su.weight) + double(sv.weight));
        volume_scale = t > 0 ? options.volume_weight * w * w / t : 0;
    }

    /// x relative to the middle of the edge, which runs from -half to half.
    double cost(Double3 x) const {
        const double miss = dot(volume, x) - volume_rhs;
        return form(qu, x + half) + form(qv, x - half) + volume_scale * miss * miss;
    }

    Candidate best() const {
        Candidate best;
        Symmetric m = sum;
        m[0] += volume_scale * volume.x * volume.x;
        m[1] += volume_scale * volume.x * volume.y;
        m[2] += volume_scale * volume.x * volume.z;
        m[3] += volume_scale * volume.y * volume.y;
        m[4] += volume_scale * volume.y * volume.z;
        m[5] += volume_scale * volume.z * volume.z;
        const double pull = options_.regularisation * trace(sum) + 1e-30;
        m[0] += pull;
        m[3] += pull;
        m[5] += pull;
        // qu (x + half) + qv (x - half) + ... = 0
        const Double3 rhs = times(qv, half) - times(qu, half) + volume * (volume_scale * volume_rhs);
        Double3 x;
        if (!solve(m, rhs, x) || !(length2(x) <= 4 * edge2)) return endpoint(true);
        best.place = x;
        best.cost = cost(x);
        return best;
    }

    Candidate endpoint(bool with_middle) const {
        Candidate best{half * -1.0, cost(half * -1.0)};
        const Candidate other{half, cost(half)};
        if (other.cost < best.cost) best = other;
        if (with_middle) {
            const Candidate centre{{}, cost({})};
            if (centre.cost <= best.cost) best = centre;
        }
        return best;
    }

    Symmetric qu, qv, sum;
    Double3 middle, half, volume;
    double edge2, volume_rhs = 0, volume_scale = 0;

  private:
    const CollapseOptions& options_;
};

/// Adds (sign 1) or takes away (-1) a triangle's part of a vertex's quadric; `n2` is twice the area vector.
inline void add_triangle(VertexShape& shape, Double3 n2, double sign) {
    const double len = length(n2);
    if (!(len > 0)) return;
    const double s = sign * 0.5 / len;
    shape.quadric[0] += float(s * n2.x * n2.x);
    shape.quadric[1] += float(s * n2.x * n2.y);
    shape.quadric[2] += float(s * n2.x * n2.z);
    shape.quadric[3] += float(s * n2.y * n2.y);
    shape.quadric[4] += float(s * n2.y * n2.z);
    shape.quadric[5] += float(s * n2.z * n2.z);
    shape.area[0] += float(sign * 0.5 * n2.x);
    shape.area[1] += float(sign * 0.5 * n2.y);
    shape.area[2] += float(sign * 0.5 * n2.z);
}

/// Adds a boundary edge's part: squared length times squared distance to its line (Lindstrom and Turk 1998, section 4.2).
inline void add_boundary(VertexShape& shape, Double3 edge, double weight) {
    const double e2 = length2(edge) * weight;
    shape.quadric[0] += float(e2 - weight * edge.x * edge.x);
    shape.quadric[1] += float(-weight * edge.x * edge.y);
    shape.quadric[2] += float(-weight * edge.x * edge.z);
    shape.quadric[3] += float(e2 - weight * edge.y * edge.y);
    shape.quadric[4] += float(-weight * edge.y * edge.z);
    shape.quadric[5] += float(e2 - weight * edge.z * edge.z);
}

/// Quadric and area vector from scratch; normal, weight and deviation stay.
inline void rebuild_shape(const StarMesh& mesh, std::uint32_t v, double boundary_weight, std::vector<Neighbour>& scratch, VertexShape& shape) {
    for (float& q : shape.quadric) q = 0;
    for (float& a : shape.area) a = 0;
    for (const std::uint32_t t : mesh.star(v)) add_triangle(shape, mesh.normal(mesh.triangle(t)), 1);
    if (mesh.kind(v) == VertexKind::kInner) return;
    neighbours_of(mesh, v, scratch);
    const Double3 p = mesh.position(v);
    for (const Neighbour& n : scratch)
        if (n.special()) add_boundary(shape, mesh.position(n.vertex) - p, boundary_weight);
}

}  // namespace vsplit::bake
