// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// The few vector operations that the reconstruction's stages share.
#pragma once

#include <cmath>

namespace vsplit::bake {

struct Vec3 {
    double x = 0, y = 0, z = 0;
    friend bool operator==(const Vec3&, const Vec3&) = default;
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
inline double squared_length(Vec3 a) {
    return dot(a, a);
}
inline double length(Vec3 a) {
    return std::sqrt(dot(a, a));
}
/// `a` scaled to length 1, or zero if it has none.
inline Vec3 unit(Vec3 a) {
    const double l = length(a);
    return l > 0 ? a * (1 / l) : Vec3{};
}

}  // namespace vsplit::bake
