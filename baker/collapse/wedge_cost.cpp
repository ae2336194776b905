// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "wedge_cost.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vsplit::bake {
namespace {

/// What pulls fitted values toward those found in place, where the samples say little; a sample in the middle
/// of the new triangles weighs 1.
constexpr double kPull = 0.2;

/// The nearest point of triangles, as shares of its corners. Inside a triangle exact, beside it near enough.
struct Nearest {
    double distance2 = std::numeric_limits<double>::infinity();
    std::array<double, 3> shares{1, 0, 0};
    Triangle corners{};

    void offer(Double3 p, Double3 a, Double3 b, Double3 c, const Triangle& triangle) {
        const Double3 ab = b - a, ac = c - a, ap = p - a;
        const double bb = length2(ab), bc = dot(ab, ac), cc = length2(ac), pb = dot(ap, ab), pc = dot(ap, ac),
                     determinant = bb * cc - bc * bc;
        double x = 0, y = 0;
        if (determinant > 1e-12 * bb * cc) {
            x = std::max(0.0, (cc * pb - bc * pc) / determinant);
            y = std::max(0.0, (bb * pc - bc * pb) / determinant);
            if (const double sum = x + y; sum > 1) {
                x /= sum;
                y = 1 - x;
            }
        }
        const double d = length2(ap - ab * x - ac * y);
        if (d >= distance2) return;
        distance2 = d;
        shares = {1 - x - y, x, y};
        corners = triangle;
    }
};

/// The wedges at a triangle's corners, from one of its vertices on.
Triangle corners_from(const StarMesh& mesh, std::uint32_t t, std::uint32_t vertex) {
    const Triangle &c = mesh.triangle(t), &wedges = mesh.corners(t);
    const std::size_t k = c[0] == vertex ? 0 : c[1] == vertex ? 1 : 2;
    return {wedges[k], wedges[(k + 1) % 3], wedges[(k + 2) % 3]};
}

/// The point nearest to `p` of the new triangles, their tips at `place`, that have one of two wedges there.
Nearest nearest_new(const StarMesh& mesh, const EdgeStar& star, Double3 place, Double3 p, std::uint32_t a,
                    std::uint32_t b) {
    Nearest nearest;
    for (std::size_t i = 0; i < star.size; ++i) {
        const Triangle corners = corners_from(mesh, star.triangles[i], i < star.first_size ? star.u : star.v);
        if (corners[0] != a && corners[0] != b) continue;
        const EdgeStar::Wing wing = star.wing(i);
        nearest.offer(p, place, wing.pa, wing.pb, corners);
    }
    return nearest;
}

}  // namespace

void mix_at(const StarMesh& mesh, const EdgeStar& star, const WedgeStar& wedges, const WedgePair& pair,
            const WedgeValues& values, Double3 place, std::span<float> out) {
    const auto copy = [&](std::uint32_t wedge) {
        const auto from = values.of(wedge);
        std::copy(from.begin(), from.end(), out.begin());
    };
    const bool first_stays = wedges.parent == star.u;
    const auto is_at = [&](Double3 p) { return p.x == place.x && p.y == place.y && p.z == place.z; };
    if (is_at(first_stays ? star.pu : star.pv)) return copy(pair.parent);
    if (is_at(first_stays ? star.pv : star.pu)) return copy(pair.child);
    const std::uint32_t at_first = first_stays ? pair.parent : pair.child,
                        at_second = first_stays ? pair.child : pair.parent;
    Nearest nearest;
    for (std::size_t i = 0; i < star.size; ++i) {
        const bool first = i < star.first_size;
        const Triangle corners = corners_from(mesh, star.triangles[i], first ? star.u : star.v);
        if (corners[0] != (first ? at_first : at_second)) continue;
        const EdgeStar::Wing wing = star.wing(i);
        nearest.offer(place, first ? star.pu : star.pv, wing.pa, wing.pb, corners);
    }
    for (std::size_t i = 0; i < star.opposite.size(); ++i) {
        const Triangle corners = corners_from(mesh, star.opposite_triangles[i], star.u);
        if (corners[0] != at_first) continue;
        const bool forward = star.forward[i] != 0;
        nearest.offer(place, star.pu, forward ? star.pv : star.opposite_places[i],
                      forward ? star.opposite_places[i] : star.pv, corners);
    }
    if (std::isinf(nearest.distance2)) return copy(pair.parent);
    values.mix({{values.of(nearest.corners[0]), values.of(nearest.corners[1]), values.of(nearest.corners[2])},
                nearest.shares},
               out);
    // Least squares of what is linear: the samples say what the new triangles should have in their places.
    // Nothing leaves the range of what is around: a chart's border stays within the chart.
    struct Fit {
        double wanted = 0;
        float low = std::numeric_limits<float>::infinity(), high = -low;
    };
    thread_local std::vector<Fit> fits;
    fits.assign(out.size(), {});
    const auto widen = [&](std::span<const float> by) {
        for (std::size_t i = 0; i < out.size(); ++i) {
            fits[i].low = std::min(fits[i].low, by[i]);
            fits[i].high = std::max(fits[i].high, by[i]);
        }
    };
    widen(out);
    double weight = kPull;
    for (const std::uint32_t wedge : {pair.child, pair.parent}) {
        widen(values.of(wedge));
        for (const std::uint32_t sample : values.samples(wedge)) {
            const Nearest at = nearest_new(mesh, star, place, mesh.work(values.sample_place(sample)),
                                           pair.child, pair.parent);
            if (std::isinf(at.distance2)) continue;
            const auto [tip, b, c] = at.shares;
            const auto goal = values.sample_values(sample), at_b = values.of(at.corners[1]),
                       at_c = values.of(at.corners[2]);
            widen(goal);
            weight += tip * tip;
            for (std::size_t i = 0; i < out.size(); ++i)
                fits[i].wanted += tip * (double(goal[i]) - b * double(at_b[i]) - c * double(at_c[i]) -
                                         tip * double(out[i]));
        }
    }
    thread_local std::vector<float> fitted;
    fitted.resize(out.size());
    for (std::size_t i = 0; i < out.size(); ++i)
        fitted[i] = std::clamp(float(double(out[i]) + fits[i].wanted / weight), fits[i].low, fits[i].high);
    values.take_linear(fitted, out);
}

double attribute_cost(const StarMesh& mesh, const EdgeStar& star, const WedgeStar& wedges,
                      const WedgeValues& values, Double3 place) {
    const double area = double(mesh.vertex(star.u).size) + double(mesh.vertex(star.v).size);
    const double extent = std::sqrt(area / 6);
    double sum = 0;
    std::size_t count = 0;
    // The samples of `own` against the new triangles that keep one of two wedges at their tip, whose values
    // become `tip`.
    const auto compare = [&](std::uint32_t own, std::uint32_t a, std::uint32_t b,
                             std::span<const float> tip) {
        for (const std::uint32_t sample : values.samples(own)) {
            const Nearest nearest =
                nearest_new(mesh, star, place, mesh.work(values.sample_place(sample)), a, b);
            if (std::isinf(nearest.distance2)) return;  // This side of the seam goes.
            sum += values.apart2(
                values.sample_values(sample),
                {{tip, values.of(nearest.corners[1]), values.of(nearest.corners[2])}, nearest.shares}, extent,
                mesh.scale());
            ++count;
        }
    };
    thread_local std::vector<float> mixed;
    mixed.resize(values.stride());
    for (const WedgePair& pair : wedges.pairs) {
        mix_at(mesh, star, wedges, pair, values, place, mixed);
        compare(pair.child, pair.child, pair.parent, mixed);
        compare(pair.parent, pair.child, pair.parent, mixed);
    }
    for (const std::uint32_t wedge : wedges.transferred) compare(wedge, wedge, wedge, values.of(wedge));
    return count == 0 ? 0 : std::pow(area, 1.5) / std::sqrt(6.0) * sum / double(count);
}

void join_samples(const StarMesh& mesh, const EdgeStar& star, const WedgePair& pair, WedgeValues& values,
                  Double3 place, std::span<const float> mixed) {
    struct Shown {
        double apart;
        std::uint32_t sample;
    };
    std::array<Shown, 2 * WedgeValues::kSamples> all;
    std::size_t count = 0;
    for (const std::uint32_t wedge : {pair.parent, pair.child})
        for (const std::uint32_t sample : values.samples(wedge)) {
            const Nearest at = nearest_new(mesh, star, place, mesh.work(values.sample_place(sample)),
                                           pair.child, pair.parent);
            double apart = 0;
            if (!std::isinf(at.distance2))
                apart =
                    values.apart2(values.sample_values(sample),
                                  {{mixed, values.of(at.corners[1]), values.of(at.corners[2])}, at.shares}, 1,
                                  mesh.scale());
            all[count++] = {apart, sample};
        }
    if (count > WedgeValues::kSamples)
        std::stable_sort(all.begin(), all.begin() + std::ptrdiff_t(count),
                         [](const Shown& x, const Shown& y) { return x.apart > y.apart; });
    std::array<std::uint32_t, WedgeValues::kSamples> kept;
    count = std::min(count, WedgeValues::kSamples);
    for (std::size_t i = 0; i < count; ++i) kept[i] = all[i].sample;
    values.set_samples(pair.parent, std::span(kept).first(count));
}

}  // namespace vsplit::bake
