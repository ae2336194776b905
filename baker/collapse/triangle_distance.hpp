// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>

#include "vec.hpp"

namespace vsplit::bake {

/// Squared distance from p to the triangle abc, by the Voronoi regions of its parts (Ericson, Real-Time
/// Collision Detection, 2005, section 5.1.5). A degenerate triangle is its vertices and edges.
inline double distance2_to_triangle(Double3 p, Double3 a, Double3 b, Double3 c) {
    const Double3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return length2(ap);
    const Double3 bp = p - b;
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return length2(bp);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        const double along = d1 - d3;
        return length2(ap - ab * (along > 0 ? d1 / along : 0));
    }
    const Double3 cp = p - c;
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return length2(cp);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        const double along = d2 - d6;
        return length2(ap - ac * (along > 0 ? d2 / along : 0));
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double along = (d4 - d3) + (d5 - d6);
        return length2(bp - (c - b) * (along > 0 ? (d4 - d3) / along : 0));
    }
    const Double3 n = cross(ab, ac);
    const double nn = length2(n);
    if (!(nn > 0)) return std::min({length2(ap), length2(bp), length2(cp)});
    const double h = dot(n, ap);
    return h * h / nn;
}

/// Where the ray meets the triangle, in lengths of its direction, or infinity (Moeller and Trumbore, Fast,
/// Minimum Storage Ray/Triangle Intersection, 1997); from either side.
inline double distance_along(Double3 from, Double3 direction, Double3 a, Double3 b, Double3 c) {
    constexpr double kMiss = std::numeric_limits<double>::infinity();
    const Double3 e1 = b - a, e2 = c - a, p = cross(direction, e2);
    const double det = dot(e1, p);
    if (det == 0) return kMiss;
    const Double3 s = from - a;
    const double u = dot(s, p) / det;
    if (!(u >= 0 && u <= 1)) return kMiss;
    const Double3 q = cross(s, e1);
    const double v = dot(direction, q) / det;
    if (!(v >= 0 && u + v <= 1)) return kMiss;
    const double t = dot(e2, q) / det;
    return t > 0 ? t : kMiss;
}

}  // namespace vsplit::bake
