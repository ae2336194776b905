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

/// The quadrics of an edge's two ends together: cost and best place of folding it. Costs are a length to the fifth power: area^1.5 times squared
/// distance. (Area alone, as Garland and Heckbert weigh, or squared, as Lindstrom and Turk do, both measured worse:
/// docs/decisions/0003-collapse-engine.md.)
class EdgeQuadric {
  public:
    EdgeQuadric(Double3 u, Double3 v, const VertexShape& su, const VertexShape& sv, const CollapseOptions& options)
        : middle_((u + v) * 0.5), half_((v - u) * 0.5), regularisation_(options.regularisation) {
        const double wu = su.weight, wv = sv.weight;
        Symmetric difference;
        for (std::size_t i = 0; i < 6; ++i) {
            const double a = wu * double(su.quadric[i]), b = wv * double(sv.quadric[i]);
            sum_[i] = a + b;
            difference[i] = b - a;
        }
        // Keeping the volume: (gu + gv) (x - middle) = (gv - gu) half, softly (Lindstrom and Turk 1998, section 4.1).
        const Double3 gu{su.area[0], su.area[1], su.area[2]}, gv{sv.area[0], sv.area[1], sv.area[2]};
        volume_ = gu + gv;
        const double size = double(su.size) + double(sv.size);
        volume_scale_ = size > 0 ? options.volume_weight * 0.5 * (wu + wv) / std::sqrt(size) : 0;
        volume_rhs_ = dot(gv - gu, half_);
        // cost(x) = xT sum x - 2 rhs x + constant, about the middle
        rhs_ = times(difference, half_) + volume_ * (volume_scale_ * volume_rhs_);
        constant_ = form(sum_, half_) + volume_scale_ * volume_rhs_ * volume_rhs_;
    }

    /// Of folding to x, relative to the middle of the edge, which runs from -half to half.
    double cost(Double3 x) const {
        const double moved = dot(volume_, x);
        return form(sum_, x) + volume_scale_ * moved * moved - 2 * dot(rhs_, x) + constant_;
    }

    Candidate best() const {
        Symmetric m = sum_;
        const Double3 scaled = volume_ * volume_scale_;
        m[0] += scaled.x * volume_.x;
        m[1] += scaled.x * volume_.y;
        m[2] += scaled.x * volume_.z;
        m[3] += scaled.y * volume_.y;
        m[4] += scaled.y * volume_.z;
        m[5] += scaled.z * volume_.z;
        const double pull = regularisation_ * trace(sum_) + 1e-30;
        m[0] += pull;
        m[3] += pull;
        m[5] += pull;
        Double3 x;
        if (!solve(m, rhs_, x) || !(length2(x) <= 16 * length2(half_))) return endpoint(true);
        // At the minimum xT m x = rhs x; the pull is no part of the cost.
        return {middle_ + x, constant_ - dot(rhs_, x) - pull * length2(x)};
    }

    Candidate first() const { return {middle_ - half_, cost(half_ * -1.0)}; }
    Candidate second() const { return {middle_ + half_, cost(half_)}; }
    Candidate endpoint(bool or_middle) const {
        Candidate best = first();
        if (const Candidate other = second(); other.cost < best.cost) best = other;
        if (or_middle && constant_ <= best.cost) best = {middle_, constant_};
        return best;
    }

    /// Prefers short edges where everything else is free.
    double tie_break() const {
        const double edge2 = 4 * length2(half_);
        return 1e-14 * edge2 * (std::sqrt(edge2) * edge2 + trace(sum_));
    }

  private:
    Symmetric sum_;
    Double3 middle_, half_, volume_, rhs_;
    double volume_rhs_ = 0, volume_scale_ = 0, constant_ = 0, regularisation_;
};

/// A triangle's part of the shapes of its corners.
struct TrianglePart {
    explicit TrianglePart(Double3 twice_area_vector) : n2(twice_area_vector) {
        const double len = length(n2);
        size = 0.5 * len;
        scale = len > 0 ? 0.25 * std::sqrt(size) / size : 0;  // area^1.5 n nT = scale n2 n2T
    }
    Double3 n2;
    double size = 0, scale = 0;
};

/// Adds (sign 1) or takes away (-1) a triangle's part.
inline void add_triangle(VertexShape& shape, const TrianglePart& part, double sign) {
    const double s = sign * part.scale;
    const Double3 n = part.n2;
    shape.quadric[0] += float(s * n.x * n.x);
    shape.quadric[1] += float(s * n.x * n.y);
    shape.quadric[2] += float(s * n.x * n.z);
    shape.quadric[3] += float(s * n.y * n.y);
    shape.quadric[4] += float(s * n.y * n.z);
    shape.quadric[5] += float(s * n.z * n.z);
    shape.area[0] += float(sign * 0.5 * n.x);
    shape.area[1] += float(sign * 0.5 * n.y);
    shape.area[2] += float(sign * 0.5 * n.z);
    shape.size += float(sign * part.size);
}

/// Adds a boundary edge's part: its length to the third power times the squared distance to its line (after Lindstrom and Turk 1998,
/// section 4.2, in the dimension of the triangles' parts).
inline void add_boundary(VertexShape& shape, Double3 edge, double boundary_weight) {
    const double e2 = length2(edge), weight = boundary_weight * std::sqrt(e2);
    shape.quadric[0] += float(weight * (e2 - edge.x * edge.x));
    shape.quadric[1] -= float(weight * edge.x * edge.y);
    shape.quadric[2] -= float(weight * edge.x * edge.z);
    shape.quadric[3] += float(weight * (e2 - edge.y * edge.y));
    shape.quadric[4] -= float(weight * edge.y * edge.z);
    shape.quadric[5] += float(weight * (e2 - edge.z * edge.z));
}

/// The shape from scratch; the weight stays.
inline void rebuild_shape(StarMesh& mesh, std::uint32_t v, double boundary_weight, std::vector<Neighbour>& scratch) {
    VertexShape& shape = mesh.shape(v);
    for (float& q : shape.quadric) q = 0;
    for (float& a : shape.area) a = 0;
    shape.size = 0;
    for (const std::uint32_t t : mesh.star(v)) add_triangle(shape, TrianglePart(mesh.normal(mesh.triangle(t))), 1);
    if (mesh.kind(v) == VertexKind::kInner) return;
    neighbours_of(mesh, v, scratch);
    const Double3 p = mesh.position(v);
    for (const Neighbour& n : scratch)
        if (n.special()) add_boundary(shape, mesh.position(n.vertex) - p, boundary_weight);
}

}  // namespace vsplit::bake
