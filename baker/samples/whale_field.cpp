// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A humpback: round cones along a spine, plates for flukes and fins, blended; pleats, mouth, eyes, knobs and
// barnacles on top. Fins are at least 0.14 thick, three times the spacing of 5,000 even samples: enough for a
// reconstruction to keep them.
#include <algorithm>
#include <array>

#include "surfaces.hpp"

namespace vsplit::bake {
namespace {

template <class T>
struct Vec {
    T x, y, z;
};
template <class T>
Vec<T> minus(const Vec<T>& a, const Double3& b) {
    return {a.x - T(b.x), a.y - T(b.y), a.z - T(b.z)};
}
template <class T>
T dot(const Vec<T>& a, const Double3& b) {
    return a.x * T(b.x) + a.y * T(b.y) + a.z * T(b.z);
}

struct Ball {
    Double3 at;
    double r;
};

/// Distance to the hull of two balls (Quilez, Round cone), exact.
template <class T>
T round_cone(const Vec<T>& p, const Ball& a, const Ball& b) {
    const Double3 axis{b.at.x - a.at.x, b.at.y - a.at.y, b.at.z - a.at.z};
    const double l2 = axis.x * axis.x + axis.y * axis.y + axis.z * axis.z, dr = a.r - b.r, a2 = l2 - dr * dr;
    const Vec<T> pa = minus(p, a.at);
    const T y = dot(pa, axis), z = y - T(l2);
    const T x2 = square(pa.x * T(l2) - y * T(axis.x)) + square(pa.y * T(l2) - y * T(axis.y)) +
                 square(pa.z * T(l2) - y * T(axis.z));
    const T y2 = y * y * T(l2), z2 = z * z * T(l2);
    const double k = (dr < 0 ? -1 : 1) * dr * dr * value_of(x2);
    if ((value_of(z) < 0 ? -1 : 1) * a2 * value_of(z2) > k) return root(x2 + z2) * T(1 / l2) - T(b.r);
    if ((value_of(y) < 0 ? -1 : 1) * a2 * value_of(y2) < k) return root(x2 + y2) * T(1 / l2) - T(a.r);
    return (root(x2 * T(a2 / l2)) + y * T(dr)) * T(1 / l2) - T(a.r);
}

template <class T, std::size_t N>
T chain(const Vec<T>& p, const std::array<Ball, N>& balls, double k) {
    T d = round_cone(p, balls[0], balls[1]);
    for (std::size_t i = 1; i + 1 < N; ++i) d = smooth_min(d, round_cone(p, balls[i], balls[i + 1]), k);
    return d;
}

/// A plate around a flat outline: `outline` is the distance to it within the plane, `off` that from the
/// plane. Its rim is round with radius `rim`; it swells by up to `swell` inwards.
template <class T>
T plate(const T& outline, const T& off, double rim, double swell, double inward) {
    const T half = T(rim) + T(swell) * ramp(0, inward, -outline);
    const T beyond = outline + T(rim);
    const T edge = value_of(beyond) > 0 ? beyond : T(0.0);
    return root(edge * edge + off * off) - half;
}

constexpr std::array<Ball, 9> kSpine = {{{{1.98, -0.03, 0}, 0.16},
                                         {{1.55, 0.00, 0}, 0.30},
                                         {{1.05, 0.00, 0}, 0.43},
                                         {{0.45, 0.00, 0}, 0.50},
                                         {{-0.15, 0.02, 0}, 0.46},
                                         {{-0.80, 0.07, 0}, 0.32},
                                         {{-1.40, 0.14, 0}, 0.20},
                                         {{-1.85, 0.22, 0}, 0.13},
                                         {{-2.10, 0.27, 0}, 0.11}}};
constexpr std::array<Ball, 3> kJaw = {
    {{{1.80, -0.22, 0}, 0.15}, {{1.25, -0.24, 0}, 0.34}, {{0.55, -0.16, 0}, 0.44}}};
// Outlines: x and z are the plane's own coordinates.
constexpr std::array<Ball, 4> kFluke = {
    {{{0.02, 0, 0}, 0.17}, {{-0.12, 0, 0.34}, 0.19}, {{-0.30, 0, 0.68}, 0.13}, {{-0.52, 0, 0.98}, 0.075}}};
constexpr std::array<Ball, 4> kFlipper = {
    {{{0.05, 0, 0}, 0.19}, {{-0.05, 0, 0.38}, 0.19}, {{-0.26, 0, 0.76}, 0.14}, {{-0.58, 0, 1.12}, 0.08}}};
constexpr std::array<Ball, 3> kDorsal = {
    {{{0.10, 0, -0.10}, 0.20}, {{-0.10, 0, 0.06}, 0.12}, {{-0.26, 0, 0.15}, 0.08}}};

/// Knobs and barnacles; none wider than kBumpReach.
constexpr double kBumpReach = 0.06;
struct Bump {
    Double3 at;
    double radius, height;
};

/// Where a ray from the spine leaves the smooth body, by bisection.
template <class Field>
Double3 skin_point(const Double3& from, const Double3& direction, Field&& field) {
    double inside = 0, outside = 1.2;
    for (int i = 0; i < 40; ++i) {
        const double t = (inside + outside) / 2;
        const Vec<double> p{from.x + t * direction.x, from.y + t * direction.y, from.z + t * direction.z};
        (field(p) < 0 ? inside : outside) = t;
    }
    return {from.x + inside * direction.x, from.y + inside * direction.y, from.z + inside * direction.z};
}

template <class T>
T body(const Vec<T>& p) {
    // A little wider than high.
    const Vec<T> q{p.x, p.y, p.z * T(0.95)};
    return smooth_min(chain(q, kSpine, 0.06), chain(q, kJaw, 0.06), 0.12);
}

template <class T>
T limbs_and_body(const Vec<T>& p, const T& trunk) {
    // Both sides at once; rounded, so that the slope has no jump at z = 0.
    const T side = root(p.z * p.z + T(0.0004));
    T d = trunk;

    const T fx = p.x + T(2.12);
    const Vec<T> fluke{fx, T(0.0), side};
    const T fluke_plane = p.y - T(0.28) + T(0.10) * fx - T(0.05) * side * side;
    d = smooth_min(d, plate(chain(fluke, kFluke, 0.06), fluke_plane, 0.07, 0.03, 0.12), 0.10);

    // Out and down, a little bent.
    constexpr double c = 0.82, s = 0.5723635208501674;  // Cosine and sine of the flipper's droop.
    const T out = side - T(0.34), down = p.y + T(0.26);
    const T along = out * T(c) - down * T(s), off = out * T(s) + down * T(c) + T(0.12) * along * along;
    const Vec<T> flipper{p.x - T(0.72), T(0.0), along};
    // Knobs along the leading edge, as a humpback has.
    const T outline = chain(flipper, kFlipper, 0.06) - T(0.022) * wave(along * T(6.5)) *
                                                           ramp(0.1, 0.3, along) *
                                                           ramp(0.05, 0.12, flipper.x + T(0.45) * along);
    d = smooth_min(d, plate(outline, off, 0.07, 0.03, 0.12), 0.10);

    const Vec<T> dorsal{p.x + T(0.80), T(0.0), p.y - T(0.42)};
    return smooth_min(d, plate(chain(dorsal, kDorsal, 0.06), p.z, 0.07, 0.02, 0.10), 0.10);
}

const std::vector<Bump>& bumps() {
    static const std::vector<Bump> all = [] {
        std::vector<Bump> made;
        const auto on_body = [](const Vec<double>& p) { return body(p); };
        const auto add = [&](double x, double y, double z, double radius, double height) {
            const double n = std::sqrt(y * y + z * z);
            made.push_back({skin_point({x, 0, 0}, {0, y / n, z / n}, on_body), radius, height});
        };
        // Knobs in three rows on the head, barnacles scattered on head, throat and back.
        for (int row = -1; row <= 1; ++row)
            for (int i = 0; i < 7; ++i) add(1.12 + 0.125 * i, 1, row * (0.75 - 0.03 * i), 0.055, 0.020);
        for (std::uint64_t i = 0; i < 70; ++i) {
            const double x = -0.6 + 2.4 * hash_unit(5 * i), side = hash_unit(5 * i + 1) < 0.5 ? -1 : 1;
            const double r = 0.028 + 0.028 * hash_unit(5 * i + 4);
            add(x, 2 * hash_unit(5 * i + 2) - 1, side * (0.15 + hash_unit(5 * i + 3)), r, 0.3 * r);
        }
        std::sort(made.begin(), made.end(), [](const Bump& a, const Bump& b) { return a.at.x < b.at.x; });
        return made;
    }();
    return all;
}

template <class T>
T whale(const Vec<T>& p) {
    const T trunk = body(p);
    T d = limbs_and_body(p, trunk);
    // What follows lives within a tenth of the skin.
    if (value_of(d) > 0.15 || value_of(d) < -0.15) return d;

    const T side = root(p.z * p.z + T(0.0004));
    const T near_trunk = bell(square(trunk * T(6.0)));

    // Throat pleats: grooves along the belly from the chin to the navel, fading at their ends.
    const T belly =
        ramp(-0.12, -0.30, p.y + T(0.04) * p.x) * ramp(-0.35, 0.05, p.x) * ramp(1.85, 1.6, p.x) * near_trunk;
    d = d - T(0.011) * belly * wave(p.z * T(11.0) + T(0.25));

    // The mouth: a groove from the snout back, turning down before the eye.
    const T bend = ramp(1.25, 0.85, p.x);
    const T lip = p.y + T(0.09) - T(0.05) * wave((p.x - T(0.8)) * T(0.4)) + T(0.17) * bend * bend;
    d = d + T(0.032) * bell(square(lip * T(1 / 0.045))) * ramp(0.80, 0.98, p.x) * near_trunk;

    // Eyes: a ball in a shallow socket.
    const T eye = root(square(p.x - T(0.80)) + square(p.y + T(0.10)) + square(side - T(0.495)));
    d = d + T(0.025) * bell(square(eye * T(1 / 0.11)));
    d = smooth_min(d, eye - T(0.048), 0.02);

    // Blowholes.
    const T hole = square((p.x - T(1.12)) * T(1 / 0.10)) + square((side - T(0.05)) * T(1 / 0.035));
    if (value_of(p.y) > 0.2) d = d + T(0.03) * bell(hole);

    const std::vector<Bump>& all = bumps();
    auto near = std::lower_bound(all.begin(), all.end(), value_of(p.x) - kBumpReach,
                                 [](const Bump& b, double x) { return b.at.x < x; });
    for (; near != all.end() && near->at.x < value_of(p.x) + kBumpReach; ++near) {
        const T s =
            (square(p.x - T(near->at.x)) + square(p.y - T(near->at.y)) + square(p.z - T(near->at.z))) *
            T(1 / (near->radius * near->radius));
        if (value_of(s) < 1) d = d - T(near->height) * bell(s);
    }

    // Skin, and wrinkles where the tail bends.
    d = d + T(0.0022) * wave(p.x * T(3.1) + T(0.7) * wave(p.y * T(2.3))) * wave(p.y * T(4.3) + p.z * T(2.9)) *
                wave(p.z * T(3.7) - p.x * T(1.3));
    return d + T(0.0025) * wave(p.x * T(9.0)) * ramp(-1.0, -1.4, p.x) * ramp(-2.0, -1.8, p.x);
}

}  // namespace

double whale_field(const Double3& p) {
    return whale(Vec<double>{p.x, p.y, p.z});
}

Dual whale_field_with_gradient(const Double3& p) {
    return whale(Vec<Dual>{Dual(p.x, 1, 0, 0), Dual(p.y, 0, 1, 0), Dual(p.z, 0, 0, 1)});
}

Double3 project_on_whale(const Double3& p, double reach) {
    Double3 q = p;
    for (int i = 0; i < 10; ++i) {
        const Dual f = whale_field_with_gradient(q);
        const double g2 = f.x * f.x + f.y * f.y + f.z * f.z;
        if (!(g2 > 1e-6)) return p;
        if (std::abs(f.v) < 1e-8) {
            const double dx = q.x - p.x, dy = q.y - p.y, dz = q.z - p.z;
            return dx * dx + dy * dy + dz * dz <= reach * reach ? q : p;
        }
        // Half a reach at most: the field bends.
        double step = f.v / g2;
        const double length = std::abs(step) * std::sqrt(g2);
        if (length > reach / 2) step *= reach / 2 / length;
        q = {q.x - step * f.x, q.y - step * f.y, q.z - step * f.z};
    }
    return p;
}

}  // namespace vsplit::bake
