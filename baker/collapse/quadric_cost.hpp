// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Cost `quadric`: memoryless quadrics (Lindstrom and Turk, Fast and memory efficient polygonal
// simplification, 1998) relative to their own vertex. Every plane and boundary line that counts for a vertex
// passes through it, so linear and constant parts vanish, and with them the cancellation that plagues
// quadrics in single precision.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "edge_star.hpp"
#include "star_mesh.hpp"
#include "vsplit/bake/collapse.hpp"

namespace vsplit::bake {

/// Symmetric 3x3 matrix: xx xy xz yy yz zz.
template <class Real>
struct SymmetricOf {
    alignas(sizeof(Real)) Real m[6]{};
    VSPLIT_INLINE Real& operator[](std::size_t i) { return m[i]; }
    VSPLIT_INLINE const Real& operator[](std::size_t i) const { return m[i]; }
};
using Symmetric = SymmetricOf<double>;

template <class Real>
VSPLIT_INLINE Vec3<Real> times(const SymmetricOf<Real>& m, Vec3<Real> v) {
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[1] * v.x + m[3] * v.y + m[4] * v.z,
            m[2] * v.x + m[4] * v.y + m[5] * v.z};
}
template <class Real>
VSPLIT_INLINE Real form(const SymmetricOf<Real>& m, Vec3<Real> v) {
    return dot(v, times(m, v));
}
template <class Real>
VSPLIT_INLINE Real trace(const SymmetricOf<Real>& m) {
    return m[0] + m[3] + m[5];
}

/// A placed collapse and its cost.
struct Candidate {
    Double3 place;
    double cost = 0;
};

/// Solves m x = b for a symmetric positive definite m by LDLT; false (where it is so) if a pivot is not
/// positive.
template <class Real>
VSPLIT_INLINE auto solve(const SymmetricOf<Real>& m, Vec3<Real> b, Vec3<Real>& x) {
    const Real r0 = 1.0 / m[0];
    const Real l10 = m[1] * r0, l20 = m[2] * r0;
    const Real d1 = m[3] - l10 * m[1], e = m[4] - l20 * m[1];
    const Real r1 = 1.0 / d1;
    const Real l21 = e * r1;
    const Real d2 = m[5] - l20 * m[2] - l21 * e;
    const Real y1 = b.y - l10 * b.x;
    const Real y2 = b.z - l20 * b.x - l21 * y1;
    x.z = y2 / d2;
    x.y = y1 * r1 - l21 * x.z;
    x.x = b.x * r0 - l10 * x.y - l20 * x.z;
    return (m[0] > 0.0) & (d1 > 0.0) & (d2 > 0.0);
}

/// What a vertex, or each of four, brings to the price of its edges; wider than in Vertex.
template <class Real>
struct Shape {
    Vec3<Real> position;
    Real weight;
    SymmetricOf<Real> quadric;
    Vec3<Real> area;
    Real size;
};

inline Shape<double> shape_of(const StarMesh& mesh, std::uint32_t v) {
    const Vertex& of = mesh.vertex(v);
    Shape<double> shape{mesh.position(v), of.weight, {}, {of.area[0], of.area[1], of.area[2]}, of.size};
    std::copy_n(of.quadric, 6, shape.quadric.m);
    return shape;
}

/// The quadrics of an edge's two ends together: cost and best place of folding it, of one edge or of four at
/// once. Costs are a length to the fifth power: area^1.5 times squared distance. (Area alone, as Garland and
/// Heckbert weigh, or squared, as Lindstrom and Turk do, both measured worse:
/// docs/decisions/0003-collapse-engine.md.)
template <class Real>
class EdgeQuadric {
  public:
    VSPLIT_INLINE EdgeQuadric(const Shape<Real>& u, const Shape<Real>& v, const CollapseOptions& options)
        : middle_((u.position + v.position) * 0.5), half_((v.position - u.position) * 0.5) {
        SymmetricOf<Real> difference;
        for (std::size_t i = 0; i < 6; ++i) {
            const Real a = u.weight * u.quadric[i], b = v.weight * v.quadric[i];
            sum_[i] = a + b;
            difference[i] = b - a;
        }
        trace_ = trace(sum_);
        extra_ = extra(u) + extra(v);
        pull_ = options.regularisation * trace_ + 1e-30;
        // Keeping the volume: (gu + gv) (x - middle) = (gv - gu) half, softly (Lindstrom and Turk 1998,
        // section 4.1).
        volume_ = u.area + v.area;
        const Real size = u.size + v.size;
        volume_scale_ = select(
            size > 0.0, options.volume_weight * 0.5 * (u.weight + v.weight) / square_root(size), size * 0.0);
        volume_rhs_ = dot(v.area - u.area, half_);
        // cost(x) = xT sum x - 2 rhs x + constant, about the middle
        rhs_ = times(difference, half_) + volume_ * (volume_scale_ * volume_rhs_);
        constant_ = form(sum_, half_) + volume_scale_ * volume_rhs_ * volume_rhs_;
    }

    /// A place relative to the middle of the edge, which runs from -half to half.
    struct Placed {
        Vec3<Real> place;
        Real cost;
    };

    /// Where the cost is least; if that is nowhere near, the best of the ends and the middle.
    VSPLIT_INLINE Placed best() const {
        SymmetricOf<Real> m = sum_;
        const Vec3<Real> scaled = volume_ * volume_scale_;
        m[0] += scaled.x * volume_.x + pull_;
        m[1] += scaled.x * volume_.y;
        m[2] += scaled.x * volume_.z;
        m[3] += scaled.y * volume_.y + pull_;
        m[4] += scaled.y * volume_.z;
        m[5] += scaled.z * volume_.z + pull_;
        Vec3<Real> x;
        const auto solved = solve(m, rhs_, x);
        const auto near = solved & (length2(x) <= 16.0 * length2(half_));
        Placed end = better_end();
        const auto between = constant_ <= end.cost;
        const Real zero = constant_ * 0.0;
        end = {select(between, Vec3<Real>{zero, zero, zero}, end.place),
               select(between, constant_, end.cost)};
        // At the minimum xT m x = rhs x; the pull is no part of the cost.
        return {select(near, x, end.place),
                select(near, constant_ - dot(rhs_, x) - pull_ * length2(x), end.cost)};
    }

    /// At the end of `side`, -1 or 1.
    VSPLIT_INLINE Placed end(double side) const {
        const Real moved = dot(volume_, half_);
        const Real even = form(sum_, half_) + volume_scale_ * moved * moved + constant_;
        return {half_ * (0.0 * even + side), even - side * 2.0 * dot(rhs_, half_)};
    }
    VSPLIT_INLINE Placed better_end() const {
        const Placed first = end(-1), second = end(1);
        const auto is_second = second.cost < first.cost;
        return {select(is_second, second.place, first.place), select(is_second, second.cost, first.cost)};
    }

    VSPLIT_INLINE Vec3<Real> middle() const { return middle_; }

    /// Of shapes stored in floats, a cost below this says little: the parts of large triangles cancel out.
    VSPLIT_INLINE Real noise() const { return 1e-7 * length2(half_) * trace_; }

    /// The cost in the queue: never negative, and among the free ones short edges come first. What weighs
    /// more than 1 is taken to bend a little at least, or weights would not keep what is flat.
    VSPLIT_INLINE Real price(Real cost) const {
        const Real edge2 = length2(half_);
        return select(cost > 0.0, cost, cost * 0.0) + edge2 * (4e-14 * trace_ + kLeastBend * extra_ + 1e-34);
    }

  private:
    /// Squared distance to the planes over that along the edge's half.
    static constexpr double kLeastBend = 1e-6;

    VSPLIT_INLINE static Real extra(const Shape<Real>& of) {
        return select(of.weight > 1.0, of.weight - 1.0, of.weight * 0.0) * trace(of.quadric);
    }

    SymmetricOf<Real> sum_;
    Vec3<Real> middle_, half_, volume_, rhs_;
    Real volume_rhs_, volume_scale_, constant_, trace_, extra_, pull_;
};

/// A price that stands for one lost in rounding.
inline constexpr float kUnsurePrice = -1;

/// Prices the edges from `u` to each of `others`, optimally placed: the same as EdgeQuadric<double>, four at
/// a time; kUnsurePrice where the cost is below noise().
void price_edges(const StarMesh& mesh, std::uint32_t u, std::span<const std::uint32_t> others,
                 const CollapseOptions& options, float* prices);

/// A triangle's part of the shapes of its corners, or that of each of four.
template <class Real>
struct TrianglePart {
    VSPLIT_INLINE explicit TrianglePart(Vec3<Real> n2) : area(n2 * 0.5) {
        size = square_root(length2(area));
        // area^1.5 n nT = area aT / sqrt(size)
        const Vec3<Real> scaled = area * select(size > 0.0, 1.0 / square_root(size), size * 0.0);
        quadric = {{scaled.x * area.x, scaled.x * area.y, scaled.x * area.z, scaled.y * area.y,
                    scaled.y * area.z, scaled.z * area.z}};
    }
    VSPLIT_INLINE TrianglePart() = default;
    VSPLIT_INLINE void add(const TrianglePart& other, Real sign) {
        for (std::size_t i = 0; i < 6; ++i) quadric[i] += sign * other.quadric[i];
        area = area + other.area * sign;
        size += sign * other.size;
    }
    SymmetricOf<Real> quadric;
    Vec3<Real> area;
    Real size{};
};

/// Adds a triangle's part, or the change of it.
inline void add_part(Vertex& vertex, const TrianglePart<double>& part) {
    for (std::size_t i = 0; i < 6; ++i) vertex.quadric[i] += float(part.quadric[i]);
    vertex.area[0] += float(part.area.x);
    vertex.area[1] += float(part.area.y);
    vertex.area[2] += float(part.area.z);
    vertex.size += float(part.size);
}

/// The parts of a vertex's triangles alone, from scratch.
inline void set_part(Vertex& vertex, const TrianglePart<double>& part) {
    for (float& q : vertex.quadric) q = 0;
    for (float& a : vertex.area) a = 0;
    vertex.size = 0;
    add_part(vertex, part);
}

/// After the star's edge collapsed to where it is placed: brings the shapes of the ring up to date, and says
/// the new vertex's.
TrianglePart<double> update_ring(StarMesh& mesh, const EdgeStar& star);

/// A vertex's shape from scratch, not rounded to floats. A boundary edge brings its length to the third power
/// times the squared distance to its line (after Lindstrom and Turk 1998, section 4.2, in the dimension of
/// the triangles' parts). `bends` says whether a triangle of the star, if that is not a large one, departs
/// much from their mean direction.
Shape<double> exact_shape(const StarMesh& mesh, std::uint32_t v, double boundary_weight,
                          std::vector<Neighbour>& scratch, bool* bends = nullptr);

/// The stored shape from scratch; the weight stays.
inline void rebuild_shape(StarMesh& mesh, std::uint32_t v, double boundary_weight,
                          std::vector<Neighbour>& scratch, bool* bends = nullptr) {
    const Shape<double> exact = exact_shape(mesh, v, boundary_weight, scratch, bends);
    TrianglePart<double> part;
    part.quadric = exact.quadric;
    part.area = exact.area;
    part.size = exact.size;
    set_part(mesh.vertex(v), part);
}

}  // namespace vsplit::bake
