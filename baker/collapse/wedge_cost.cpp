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

/// What distance along the surface counts against distance from it, squared, in poses.
constexpr double kAlong = 0.25;

/// Cosine of the angle by which a collapse may turn a triangle in a pose.
constexpr double kTurned = 0;

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

/// What poses show of a sample.
struct Posed {
    double more2 = 0;     ///< Mean over poses of the squared distance beyond that in the bind pose.
    double farthest = 0;  ///< The largest distance.
};

/// The sample where the input has it in each pose, against the place on the new triangles that is nearest to
/// it in the bind pose. What lies along them counts half, as texture that slides.
Posed posed_apart(const StarMesh& mesh, const WedgeValues& values, std::uint32_t sample,
                  const WedgeValues::Blend& blend, double bind2) {
    Posed out;
    const auto row = values.sample_values(sample);
    const double unit2 = mesh.scale() * mesh.scale();
    const std::size_t poses = values.poses_of(sample);
    for (std::size_t p = 0; p < poses; ++p) {
        const std::size_t at = values.plain() + 3 * p;
        const Double3 a = WedgeValues::posed(blend.of[0], at), b = WedgeValues::posed(blend.of[1], at),
                      c = WedgeValues::posed(blend.of[2], at);
        const Double3 apart =
            WedgeValues::posed(row, at) - (a * blend.shares[0] + b * blend.shares[1] + c * blend.shares[2]);
        const Double3 normal = cross(b - a, c - a);
        const double n2 = length2(normal), along = dot(apart, normal), whole = length2(apart);
        const double across2 = n2 > 0 ? std::min(along * along / n2, whole) : whole;
        const double apart2 = unit2 * (across2 + kAlong * (whole - across2));
        out.more2 += std::max(0.0, apart2 - bind2);
        out.farthest = std::max(out.farthest, apart2);
    }
    out.more2 /= double(poses);
    out.farthest = std::sqrt(out.farthest);
    return out;
}

/// Whether a triangle that keeps one of two wedges at its tip is turned over in a pose, where it was not.
bool turns_over(const StarMesh& mesh, const EdgeStar& star, const WedgeValues& values, std::uint32_t a,
                std::uint32_t b, std::span<const float> tip) {
    for (std::size_t i = 0; i < star.size; ++i) {
        const Triangle corners = corners_from(mesh, star.triangles[i], i < star.first_size ? star.u : star.v);
        if (corners[0] != a && corners[0] != b) continue;
        const auto before = values.of(corners[0]), left = values.of(corners[1]),
                   right = values.of(corners[2]);
        const std::size_t poses = values.poses_of(corners[0]);
        for (std::size_t p = 0; p < poses; ++p) {
            const std::size_t at = values.plain() + 3 * p;
            const Double3 l = WedgeValues::posed(left, at), r = WedgeValues::posed(right, at),
                          old = WedgeValues::posed(before, at), now = WedgeValues::posed(tip, at);
            const Double3 n = cross(l - old, r - old), m = cross(l - now, r - now);
            if (dot(n, m) < kTurned * length(n) * length(m)) return true;
        }
    }
    return false;
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
    if (std::isinf(nearest.distance2)) {
        copy(pair.parent);
        return values.repose(pair.parent, mesh.round(place), out);
    }
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
    const std::size_t plain = values.plain();
    fits.assign(plain, {});
    const auto widen = [&](std::span<const float> by) {
        for (std::size_t i = 0; i < plain; ++i) {
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
            for (std::size_t i = 0; i < plain; ++i)
                fits[i].wanted += tip * (double(goal[i]) - b * double(at_b[i]) - c * double(at_c[i]) -
                                         tip * double(out[i]));
        }
    }
    thread_local std::vector<float> fitted;
    fitted.resize(plain);
    for (std::size_t i = 0; i < plain; ++i)
        fitted[i] = std::clamp(float(double(out[i]) + fits[i].wanted / weight), fits[i].low, fits[i].high);
    values.take_linear(fitted, out);
    values.repose(pair.parent, mesh.round(place), out);
}

AttributeCost attribute_cost(const StarMesh& mesh, const EdgeStar& star, const WedgeStar& wedges,
                             const WedgeValues& values, Double3 place) {
    const double area = double(mesh.vertex(star.u).size) + double(mesh.vertex(star.v).size);
    const double extent = std::sqrt(area / 6);
    double sum = 0;
    std::size_t count = 0;
    AttributeCost out;
    // The samples of `own` against the new triangles that keep one of two wedges at their tip, whose values
    // become `tip`.
    const auto compare = [&](std::uint32_t own, std::uint32_t a, std::uint32_t b,
                             std::span<const float> tip) {
        for (const std::uint32_t sample : values.samples(own)) {
            const Double3 p = mesh.work(values.sample_place(sample));
            const Nearest nearest = nearest_new(mesh, star, place, p, a, b);
            if (std::isinf(nearest.distance2)) return;  // This side of the seam goes.
            const WedgeValues::Blend blend{
                {tip, values.of(nearest.corners[1]), values.of(nearest.corners[2])}, nearest.shares};
            sum += values.apart2(values.sample_values(sample), blend, extent, mesh.scale());
            if (values.poses_of(sample) > 0) {
                const Posed posed = posed_apart(mesh, values, sample, blend, nearest.distance2);
                sum += posed.more2;
                out.posed = std::max(out.posed, posed.farthest);
            }
            ++count;
        }
    };
    thread_local std::vector<float> mixed;
    mixed.resize(values.stride());
    const auto look_at_poses = [&](std::uint32_t a, std::uint32_t b, std::span<const float> tip) {
        if (values.poses_of(a) > 0 && !out.turns_over)
            out.turns_over = turns_over(mesh, star, values, a, b, tip);
    };
    for (const WedgePair& pair : wedges.pairs) {
        mix_at(mesh, star, wedges, pair, values, place, mixed);
        compare(pair.child, pair.child, pair.parent, mixed);
        compare(pair.parent, pair.child, pair.parent, mixed);
        look_at_poses(pair.child, pair.parent, mixed);
    }
    for (const std::uint32_t wedge : wedges.transferred) {
        const auto own = values.of(wedge);
        std::copy(own.begin(), own.end(), mixed.begin());
        values.repose(wedge, mesh.round(place), mixed);
        compare(wedge, wedge, wedge, mixed);
        look_at_poses(wedge, wedge, mixed);
    }
    if (count > 0) out.cost = std::pow(area, 1.5) / std::sqrt(6.0) * sum / double(count);
    return out;
}

void alike_in_motion(const WedgeStar& star, const WedgeValues& values, std::vector<std::uint32_t>& out) {
    out.clear();
    if (star.pairs.empty()) return;
    const WedgePair& first = star.pairs[0];
    const auto is_pair = [&](std::uint32_t wedge) {
        return std::any_of(star.pairs.begin(), star.pairs.end(),
                           [&](const WedgePair& pair) { return pair.parent == wedge; });
    };
    for (std::size_t i = 1; i < star.pairs.size(); ++i) {
        const WedgePair& pair = star.pairs[i];
        if (values.moves_alike(values.of(pair.child), values.of(first.child)) &&
            values.moves_alike(values.of(pair.parent), values.of(first.parent)))
            out.push_back(pair.parent);
    }
    for (const std::uint32_t wedge : star.moved)
        if (!is_pair(wedge) && values.moves_alike(values.of(wedge), values.of(first.parent)))
            out.push_back(wedge);
    for (const std::uint32_t wedge : star.transferred)
        if (values.moves_alike(values.of(wedge), values.of(first.child))) out.push_back(wedge);
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
