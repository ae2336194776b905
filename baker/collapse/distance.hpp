// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#pragma once

#include "vec.hpp"

namespace vsplit::bake {

/// A triangle, or four of them, asked for the squared distances to points. A degenerate triangle is its
/// edges. Distances below 1e-8 of the distance to the first corner are lost in rounding.
template <class Real>
class TriangleDistance {
  public:
    VSPLIT_INLINE TriangleDistance(Vec3<Real> a, Vec3<Real> b, Vec3<Real> c)
        : a_(a),
          ab_(b - a),
          ac_(c - a),
          normal_(cross(ab_, ac_)),
          bb_(length2(ab_)),
          bc_(dot(ab_, ac_)),
          cc_(length2(ac_)) {
        opposite_ = bb_ - 2.0 * bc_ + cc_;
        area_ = length2(normal_);
        inverse_ab_ = inverse(bb_);
        inverse_ac_ = inverse(cc_);
        inverse_opposite_ = inverse(opposite_);
        inverse_area_ = inverse(area_);
    }

    VSPLIT_INLINE Real squared(Vec3<Real> p) const {
        const Vec3<Real> ap = p - a_;
        const Real pp = length2(ap), b = dot(ap, ab_), c = dot(ap, ac_), h = dot(ap, normal_);
        const Real nearest_edge =
            lesser(lesser(to_segment(pp, b, bb_, inverse_ab_), to_segment(pp, c, cc_, inverse_ac_)),
                   to_segment(pp - 2.0 * b + bb_, c - b - bc_ + bb_, opposite_, inverse_opposite_));
        // Barycentric coordinates, times the squared normal.
        const Real at_b = cc_ * b - bc_ * c, at_c = bb_ * c - bc_ * b;
        const auto above = (at_b >= 0.0) & (at_c >= 0.0) & (at_b + at_c <= area_) & (area_ > 0.0);
        return select(above, h * h * inverse_area_, larger(nearest_edge, nearest_edge * 0.0));
    }

  private:
    static VSPLIT_INLINE Real inverse(Real x) { return select(x > 0.0, 1.0 / x, x * 0.0); }
    /// From a point at squared distance `pp` of the segment's begin, with `along` the product of both.
    static VSPLIT_INLINE Real to_segment(Real pp, Real along, Real segment, Real inverse_segment) {
        const Real t = along * inverse_segment, zero = t * 0.0, one = zero + 1.0;
        const Real s = larger(lesser(t, one), zero);
        return pp + s * (s * segment - 2.0 * along);
    }

    Vec3<Real> a_, ab_, ac_, normal_;
    Real bb_, bc_, cc_, opposite_, area_, inverse_ab_, inverse_ac_, inverse_opposite_, inverse_area_;
};

}  // namespace vsplit::bake
