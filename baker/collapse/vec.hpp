// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace vsplit::bake {

/// A point or vector in working coordinates: the mesh recentred and scaled to about unit size.
struct Double3 {
    double x = 0, y = 0, z = 0;
};

inline Double3 operator+(Double3 a, Double3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Double3 operator-(Double3 a, Double3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Double3 operator*(Double3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double dot(Double3 a, Double3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Double3 cross(Double3 a, Double3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length2(Double3 a) { return dot(a, a); }
inline double length(Double3 a) { return std::sqrt(length2(a)); }

}  // namespace vsplit::bake
