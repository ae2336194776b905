// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/labels.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace vsplit::bake {
namespace {

constexpr std::uint16_t kLevels = 4096;
constexpr std::size_t kGrain = 8192;

/// Level 0 is the strongest. `agreement` is 1 for a link that leaves no doubt.
std::uint16_t link_level(double agreement) {
    if (!(agreement > -1)) return kLevels - 1;  // also NaN, from a ball without a radius
    return static_cast<std::uint16_t>((1 - std::min(agreement, 1.0)) * 0.5 * (kLevels - 1));
}

/// Cosine of the angle between two balls' surfaces where they meet: 1 for one inside the other's rim, -1 when
/// they touch.
double overlap(const Balls& balls, std::uint32_t a, std::uint32_t b) {
    const double ra = balls.squared_radii[a], rb = balls.squared_radii[b];
    return (ra + rb - squared_length(balls.centres[a] - balls.centres[b])) / (2 * std::sqrt(ra * rb));
}

/// Union-find that also knows whether two members carry the same or opposite labels.
class SignedSets {
  public:
    explicit SignedSets(std::size_t count) : parent_(count), rank_(count, 0), flip_(count, 0) {
        for (std::uint32_t i = 0; i < count; ++i) parent_[i] = i;
    }
    struct Place {
        std::uint32_t root;
        std::uint8_t flip;
    };
    Place find(std::uint32_t x) {
        std::uint8_t flip = 0;
        std::uint32_t root = x;
        for (; parent_[root] != root; root = parent_[root]) flip ^= flip_[root];
        for (std::uint8_t left = flip; parent_[x] != root && x != root;) {
            const std::uint32_t up = parent_[x];
            const std::uint8_t here = flip_[x];
            parent_[x] = root;
            flip_[x] = left;
            left ^= here;
            x = up;
        }
        return {root, flip};
    }
    void unite(std::uint32_t a, std::uint32_t b, std::uint8_t different) {
        Place x = find(a), y = find(b);
        if (x.root == y.root) return;
        if (rank_[x.root] < rank_[y.root]) std::swap(x, y);
        rank_[x.root] = static_cast<std::uint8_t>(rank_[x.root] + (rank_[x.root] == rank_[y.root]));
        parent_[y.root] = x.root;
        flip_[y.root] = x.flip ^ y.flip ^ different;
    }

  private:
    std::vector<std::uint32_t> parent_;
    std::vector<std::uint8_t> rank_, flip_;
};

}  // namespace

Balls circumscribe(const Tetrahedra& tetrahedra) {
    Balls balls;
    balls.centres.resize(tetrahedra.cells.size());
    balls.squared_radii.resize(tetrahedra.cells.size());
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, tetrahedra.cells.size(), kGrain), [&](const auto& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                const Corners& c = tetrahedra.cells[i];
                const Vec3 a = tetrahedra.points[c[0]], u = tetrahedra.points[c[1]] - a;
                const Vec3 v = tetrahedra.points[c[2]] - a, w = tetrahedra.points[c[3]] - a;
                const Vec3 vw = cross(v, w);
                const Vec3 to_centre = (vw * squared_length(u) + cross(w, u) * squared_length(v) +
                                        cross(u, v) * squared_length(w)) *
                                       (0.5 / dot(u, vw));
                // So flat that rounding decides where the centre is: samples of an exact sphere are full of
                // such cells.
                const double squared = squared_length(to_centre), six = std::abs(dot(u, vw));
                const bool known = squared < 1e24 && six * six > 1e-18 * squared_length(u) *
                                                                     squared_length(v) * squared_length(w);
                balls.centres[i] = known ? a + to_centre : a;
                balls.squared_radii[i] = known ? squared : 0;
            }
        });
    return balls;
}

Poles find_poles(const Tetrahedra& tetrahedra, const Balls& balls) {
    const std::size_t samples = tetrahedra.samples;
    Poles poles{std::vector<std::uint32_t>(samples, kNoCell), std::vector<std::uint32_t>(samples, kNoCell)};
    std::vector<double> farthest(samples, 0);
    const auto count = static_cast<std::uint32_t>(tetrahedra.cells.size());
    for (std::uint32_t i = 0; i < count; ++i)
        for (const std::uint32_t v : tetrahedra.cells[i]) {
            if (v >= samples || !(balls.squared_radii[i] > farthest[v])) continue;
            farthest[v] = balls.squared_radii[i];
            poles.first[v] = i;
        }
    std::fill(farthest.begin(), farthest.end(), 0);
    for (std::uint32_t i = 0; i < count; ++i)
        for (const std::uint32_t v : tetrahedra.cells[i]) {
            if (v >= samples || !(balls.squared_radii[i] > farthest[v])) continue;
            const Vec3 p = tetrahedra.points[v];
            if (!(dot(balls.centres[i] - p, balls.centres[poles.first[v]] - p) < 0)) continue;
            farthest[v] = balls.squared_radii[i];
            poles.second[v] = i;
        }
    return poles;
}

std::vector<std::uint8_t> label_cells(const Tetrahedra& tetrahedra, const Balls& balls, const Poles& poles,
                                      bool open) {
    const auto count = static_cast<std::uint32_t>(tetrahedra.cells.size());
    const std::uint32_t samples = static_cast<std::uint32_t>(tetrahedra.samples);
    // Links 4c+k join cell c with its neighbour k; links 4*count+s the poles of sample s.
    const std::size_t links = std::size_t{4} * count + samples;
    std::vector<std::uint16_t> levels(links, kLevels);
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, count, kGrain), [&](const auto& range) {
        for (std::uint32_t c = range.begin(); c < range.end(); ++c)
            for (std::uint32_t k = 0; k < 4; ++k) {
                const std::uint32_t other = tetrahedra.neighbours[c][k];
                if (other != kNoCell && other > c)
                    levels[std::size_t{4} * c + k] = link_level(overlap(balls, c, other));
            }
    });
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, samples, kGrain), [&](const auto& range) {
        for (std::uint32_t s = range.begin(); s < range.end(); ++s) {
            if (poles.first[s] == kNoCell || poles.second[s] == kNoCell) continue;
            const Vec3 u = balls.centres[poles.first[s]] - tetrahedra.points[s];
            const Vec3 v = balls.centres[poles.second[s]] - tetrahedra.points[s];
            levels[std::size_t{4} * count + s] =
                link_level(-dot(u, v) / std::sqrt(squared_length(u) * squared_length(v)));
        }
    });
    std::vector<std::size_t> starts(kLevels + 2, 0);
    for (const std::uint16_t level : levels) ++starts[level + 1u];
    for (std::size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
    std::vector<std::uint32_t> order(starts[kLevels]);
    for (std::size_t i = 0; i < links; ++i)
        if (levels[i] < kLevels) order[starts[levels[i]]++] = static_cast<std::uint32_t>(i);
    std::vector<std::uint16_t>().swap(levels);

    SignedSets sets(count);
    for (const std::uint32_t link : order) {
        if (link < std::size_t{4} * count) {
            const std::uint32_t c = link / 4;
            sets.unite(c, tetrahedra.neighbours[c][link % 4], 0);
        } else {
            const std::size_t s = link - std::size_t{4} * count;
            sets.unite(poles.first[s], poles.second[s], 1);
        }
    }
    std::vector<std::uint8_t> inside(count);
    for (std::uint32_t c = 0; c < count; ++c) inside[c] = sets.find(c).flip;
    // Every cell is joined to its neighbours by some link, so there is one set; only its sign is still to be
    // said.
    std::uint8_t outside = 0;
    if (open) {
        std::int64_t votes = 0;
        for (std::uint32_t s = 0; s < samples; ++s)
            if (poles.second[s] != kNoCell && inside[poles.first[s]] != inside[poles.second[s]])
                votes += inside[poles.first[s]] ? 1 : -1;
        outside = votes > 0;
    } else {
        std::int64_t votes = 0;
        for (std::uint32_t c = 0; c < count; ++c)
            for (const std::uint32_t v : tetrahedra.cells[c])
                if (v >= samples) votes += inside[c] ? 1 : -1;
        outside = votes > 0;
    }
    for (std::uint8_t& label : inside) label ^= outside;
    if (!open)
        for (std::uint32_t c = 0; c < count; ++c)
            for (const std::uint32_t v : tetrahedra.cells[c])
                if (v >= samples) inside[c] = 0;
    return inside;
}

}  // namespace vsplit::bake
