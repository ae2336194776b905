// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Numbers that carry their gradient, so that one formula yields a field and its exact slope; and the few
// functions the samples need, made of IEEE arithmetic alone: libm's differ between machines, these do not.
#pragma once

#include <cmath>
#include <cstdint>

namespace vsplit::bake {

/// A value and its derivatives by x, y, z (forward mode).
struct Dual {
    double v = 0, x = 0, y = 0, z = 0;
    Dual() = default;
    Dual(double value) : v(value) {}
    Dual(double value, double dx, double dy, double dz) : v(value), x(dx), y(dy), z(dz) {}
};

inline Dual operator+(const Dual& a, const Dual& b) {
    return {a.v + b.v, a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Dual operator-(const Dual& a, const Dual& b) {
    return {a.v - b.v, a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Dual operator-(const Dual& a) {
    return {-a.v, -a.x, -a.y, -a.z};
}
inline Dual operator*(const Dual& a, const Dual& b) {
    return {a.v * b.v, a.x * b.v + b.x * a.v, a.y * b.v + b.y * a.v, a.z * b.v + b.z * a.v};
}

inline double value_of(double a) {
    return a;
}
inline double value_of(const Dual& a) {
    return a.v;
}

inline double root(double a) {
    return std::sqrt(a);
}
inline Dual root(const Dual& a) {
    const double r = std::sqrt(a.v), slope = r > 1e-150 ? 0.5 / r : 0;
    return {r, a.x * slope, a.y * slope, a.z * slope};
}

/// sin(2 pi t) by its Taylor polynomial on a quarter turn, exact to 1e-12.
inline double sine_of_turns(double t) {
    t -= std::floor(t + 0.5);
    if (t > 0.25)
        t = 0.5 - t;
    else if (t < -0.25)
        t = -0.5 - t;
    const double a = t * 6.283185307179586, s = a * a;
    return a *
           (1 -
            s / 6 *
                (1 - s / 20 * (1 - s / 42 * (1 - s / 72 * (1 - s / 110 * (1 - s / 156 * (1 - s / 210)))))));
}
inline double wave(double t) {
    return sine_of_turns(t);
}
inline Dual wave(const Dual& t) {
    const double slope = 6.283185307179586 * sine_of_turns(t.v + 0.25);
    return {sine_of_turns(t.v), t.x * slope, t.y * slope, t.z * slope};
}

template <class T>
T absolute(const T& a) {
    return value_of(a) < 0 ? -a : a;
}
template <class T>
T square(const T& a) {
    return a * a;
}
/// (1 - s)^3 for 0 <= s < 1, else 0: a bell without an exponential.
template <class T>
T bell(const T& s) {
    if (value_of(s) >= 1) return T(0.0);
    const T r = T(1.0) - s;
    return r * r * r;
}
/// 0 below a, 1 above b, smooth between; a > b falls.
template <class T>
T ramp(double a, double b, const T& x) {
    const T t = (x - T(a)) * T(1 / (b - a));
    if (value_of(t) <= 0) return T(0.0);
    if (value_of(t) >= 1) return T(1.0);
    return t * t * (T(3.0) - T(2.0) * t);
}
/// The smaller of two, rounded where they differ by less than k (Quilez, Smooth minimum). Slopes stay below
/// the steeper one's.
template <class T>
T smooth_min(const T& a, const T& b, double k) {
    const T& low = value_of(a) < value_of(b) ? a : b;
    const T h = T(k) - absolute(a - b);
    return value_of(h) <= 0 ? low : low - h * h * T(0.25 / k);
}

/// A well-mixed number in [0, 1) for a counter (SplitMix64).
inline double hash_unit(std::uint64_t i) {
    i += 0x9E3779B97F4A7C15ull;
    i *= 0x9E3779B97F4A7C15ull;
    i = (i ^ (i >> 30)) * 0xBF58476D1CE4E5B9ull;
    i = (i ^ (i >> 27)) * 0x94D049BB133111EBull;
    return static_cast<double>((i ^ (i >> 31)) >> 11) * 0x1p-53;
}

}  // namespace vsplit::bake
