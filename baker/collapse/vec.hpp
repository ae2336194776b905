// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Points and vectors of the collapse engine, one at a time or four.
#pragma once

// Vectors never cross a library's edge, so their calling convention is nobody's concern.
#pragma GCC diagnostic ignored "-Wpsabi"

#include <algorithm>
#include <cmath>

namespace vsplit::bake {

/// Functions over Lanes must be inlined into one of VSPLIT_CLONES: only there is the width of the machine's
/// registers known.
#define VSPLIT_INLINE inline __attribute__((always_inline))
#define VSPLIT_INLINE_LAMBDA __attribute__((always_inline))
/// Compiles a function twice, the wider one is taken where it runs. Nothing is contracted or reordered: both
/// give the same bits.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__gnu_linux__)
#define VSPLIT_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define VSPLIT_CLONES
#endif

/// Four doubles that go through the same arithmetic.
using Lanes = double __attribute__((vector_size(32)));
/// A comparison's result: all bits or none.
using LaneMask = decltype(Lanes{} < Lanes{});
using FourFloats = float __attribute__((vector_size(16)));

VSPLIT_INLINE Lanes lanes(double x) {
    return Lanes{x, x, x, x};
}
VSPLIT_INLINE Lanes select(LaneMask mask, Lanes a, Lanes b) {
    return mask ? a : b;
}
VSPLIT_INLINE double select(bool mask, double a, double b) {
    return mask ? a : b;
}
VSPLIT_INLINE bool any(LaneMask mask) {
    return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
}
template <class Real>
VSPLIT_INLINE Real lesser(Real a, Real b) {
    return select(a < b, a, b);
}
template <class Real>
VSPLIT_INLINE Real larger(Real a, Real b) {
    return select(a > b, a, b);
}
VSPLIT_INLINE double square_root(double x) {
    return std::sqrt(x);
}
VSPLIT_INLINE Lanes square_root(Lanes x) {
    return Lanes{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3])};
}

template <class Real>
struct Vec3 {
    // The wide clones expect the full alignment, which a base machine's ABI does not give.
    alignas(sizeof(Real)) Real x{};
    Real y{}, z{};
};

/// A point or vector in working coordinates: the mesh recentred and scaled to about unit size.
using Double3 = Vec3<double>;
/// Four of them.
using Lanes3 = Vec3<Lanes>;

template <class Real>
VSPLIT_INLINE Vec3<Real> operator+(Vec3<Real> a, Vec3<Real> b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
VSPLIT_INLINE Vec3<Real> operator-(Vec3<Real> a, Vec3<Real> b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real, class Scale>
VSPLIT_INLINE Vec3<Real> operator*(Vec3<Real> a, Scale s) {
    return {a.x * s, a.y * s, a.z * s};
}
template <class Real>
VSPLIT_INLINE Real dot(Vec3<Real> a, Vec3<Real> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
VSPLIT_INLINE Vec3<Real> cross(Vec3<Real> a, Vec3<Real> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Real>
VSPLIT_INLINE Real length2(Vec3<Real> a) {
    return dot(a, a);
}
inline double length(Double3 a) {
    return std::sqrt(length2(a));
}

VSPLIT_INLINE double sum(Lanes x) {
    return (x[0] + x[1]) + (x[2] + x[3]);
}
VSPLIT_INLINE double least(Lanes x) {
    return std::min(std::min(x[0], x[1]), std::min(x[2], x[3]));
}

VSPLIT_INLINE Lanes3 lanes(Double3 a) {
    return {lanes(a.x), lanes(a.y), lanes(a.z)};
}
template <class Mask, class Real>
VSPLIT_INLINE Vec3<Real> select(Mask mask, Vec3<Real> a, Vec3<Real> b) {
    return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

/// The first, second, third and fourth of each of four times four.
VSPLIT_INLINE void transpose(const FourFloats (&in)[4], FourFloats (&out)[4]) {
    using Order = int __attribute__((vector_size(16)));
    const FourFloats ab_low = __builtin_shuffle(in[0], in[1], Order{0, 4, 1, 5}),
                     ab_high = __builtin_shuffle(in[0], in[1], Order{2, 6, 3, 7});
    const FourFloats cd_low = __builtin_shuffle(in[2], in[3], Order{0, 4, 1, 5}),
                     cd_high = __builtin_shuffle(in[2], in[3], Order{2, 6, 3, 7});
    out[0] = __builtin_shuffle(ab_low, cd_low, Order{0, 1, 4, 5});
    out[1] = __builtin_shuffle(ab_low, cd_low, Order{2, 3, 6, 7});
    out[2] = __builtin_shuffle(ab_high, cd_high, Order{0, 1, 4, 5});
    out[3] = __builtin_shuffle(ab_high, cd_high, Order{2, 3, 6, 7});
}
/// Four floats from each address.
VSPLIT_INLINE void transpose(const float* a, const float* b, const float* c, const float* d,
                             Lanes (&out)[4]) {
    FourFloats in[4], turned[4];
    __builtin_memcpy(&in[0], a, 16);
    __builtin_memcpy(&in[1], b, 16);
    __builtin_memcpy(&in[2], c, 16);
    __builtin_memcpy(&in[3], d, 16);
    transpose(in, turned);
    for (int i = 0; i < 4; ++i) out[i] = __builtin_convertvector(turned[i], Lanes);
}
VSPLIT_INLINE void transpose(Lanes a, Lanes b, Lanes c, Lanes d, FourFloats (&out)[4]) {
    const FourFloats in[4] = {__builtin_convertvector(a, FourFloats), __builtin_convertvector(b, FourFloats),
                              __builtin_convertvector(c, FourFloats), __builtin_convertvector(d, FourFloats)};
    transpose(in, out);
}

}  // namespace vsplit::bake
