// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Double-precision vectors of the ruler. Shares nothing with the baker on purpose: a ruler must not inherit
// the mistakes of what it measures.
#pragma once

#include <cmath>

#include "vsplit/mesh.hpp"

namespace vsplit::ruler {

struct Vec3 {
    double x = 0, y = 0, z = 0;
};

inline Vec3 operator+(Vec3 a, Vec3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3 operator-(Vec3 a, Vec3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3 operator*(Vec3 a, double s) {
    return {a.x * s, a.y * s, a.z * s};
}
inline double dot(Vec3 a, Vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec3 a) {
    return std::sqrt(dot(a, a));
}
inline Vec3 to_vec(Float3 p) {
    return {double(p.x), double(p.y), double(p.z)};
}

/// Twice the area long, along the outward normal.
inline Vec3 area_vector(const Mesh& mesh, const Triangle& t) {
    const Vec3 a = to_vec(mesh.positions[t[0]]);
    return cross(to_vec(mesh.positions[t[1]]) - a, to_vec(mesh.positions[t[2]]) - a);
}

}  // namespace vsplit::ruler
