// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "calibrate.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "triangle_distance.hpp"
#include "triangle_tree.hpp"
#include "vsplit/live_mesh.hpp"

namespace vsplit::bake {
namespace {

/// What samples miss between them.
constexpr double kSafety = 1.2;
/// From one measured level to the next coarser.
constexpr double kLevelRatio = 0.7;
/// Between two measured levels, the error is at least this share of the coarser one's, so that a jump between
/// them is not missed by much.
constexpr double kShareOfCoarser = 0.8;
/// Where the error grows by more from one measured level to the next, one between is measured too; at most so
/// many of them.
constexpr double kJump = 2;
constexpr std::size_t kMoreLevels = 16;
/// A jump is not looked for more closely than this share of a level's splits: to find the one split that
/// makes it takes ten measurements of a large mesh more, and the levels beside it have its error at worst.
constexpr std::size_t kJumpShare = 64;
/// Bounds of the triangles' centres are known down to this share of what is known to be as far: they say
/// where samples go, and those farthest get them.
constexpr double kCentresShare = 0.5;
/// Coarse levels look at the input's vertices in steps: the distance varies as slowly as their triangles are
/// large.
constexpr std::size_t kDensePass = 50000;
/// A tree over a level is built where the level is small; above, the stars around a vertex's ancestor are
/// near enough to exact.
constexpr std::size_t kTreeTriangles = 120000;
/// Of a star, so many triangles bound a distance well enough; a hub has thousands.
constexpr std::uint32_t kLookedAt = 32;
/// Samples on a level's triangles, at most about.
constexpr std::size_t kSamples = 40000;

Double3 to_double(const Float3& p) {
    return {double(p.x), double(p.y), double(p.z)};
}

/// A point and an upper bound of its squared distance to the other surface.
struct Probe {
    double bound2;
    std::uint32_t index;
};

/// The largest distance among probes whose bounds are known, if it is above `enough2` (squared), asking
/// `exact2` for as few as it takes: by falling bound, until none that is left could be farther.
template <class Exact>
double farthest(std::vector<Probe>& probes, double enough2, const Exact& exact2) {
    const auto end =
        std::partition(probes.begin(), probes.end(), [&](const Probe& p) { return p.bound2 > enough2; });
    std::sort(probes.begin(), end, [](const Probe& a, const Probe& b) {
        return a.bound2 != b.bound2 ? a.bound2 > b.bound2 : a.index < b.index;
    });
    double most = enough2;
    for (auto probe = probes.begin(); probe != end && probe->bound2 > most; ++probe)
        most = std::max(most, exact2(*probe, most));
    return std::sqrt(most);
}

/// Triangles around each vertex of a level.
struct Stars {
    explicit Stars(const Mesh& mesh)
        : begin(mesh.positions.size() + 1, 0), triangles(3 * mesh.triangles.size()) {
        for (const Triangle& t : mesh.triangles)
            for (const std::uint32_t v : t) ++begin[v + 1];
        std::partial_sum(begin.begin(), begin.end(), begin.begin());
        auto next = begin;
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
            for (const std::uint32_t v : mesh.triangles[t]) triangles[next[v]++] = t;
    }
    std::vector<std::uint32_t> begin, triangles;
};

/// Squared distance from p to the triangles around a vertex (of a hub, some of them); below `enough2` any
/// value that low will do.
double star_distance2(const Mesh& mesh, const Stars& stars, std::uint32_t v, Double3 p, double enough2) {
    double least = length2(p - to_double(mesh.positions[v]));
    const std::uint32_t end = std::min(stars.begin[v + 1], stars.begin[v] + kLookedAt);
    for (std::uint32_t s = stars.begin[v]; s < end && least > enough2; ++s) {
        const Triangle& t = mesh.triangles[stars.triangles[s]];
        least = std::min(
            least, distance2_to_triangle(p, to_double(mesh.positions[t[0]]), to_double(mesh.positions[t[1]]),
                                         to_double(mesh.positions[t[2]])));
    }
    return least;
}

/// The same around the vertex that is nearest to p among those reached by going from star to star, always
/// nearer: where a surface is flat, vertices fold far away, and their ancestor's star does not cover them.
double walked_distance2(const Mesh& mesh, const Stars& stars, std::uint32_t v, Double3 p, double enough2) {
    double least = star_distance2(mesh, stars, v, p, enough2);
    double here = length2(p - to_double(mesh.positions[v]));
    for (int steps = 0; steps < 1000 && least > enough2; ++steps) {
        std::uint32_t nearest = v;
        const std::uint32_t end = std::min(stars.begin[v + 1], stars.begin[v] + kLookedAt);
        for (std::uint32_t s = stars.begin[v]; s < end; ++s)
            for (const std::uint32_t w : mesh.triangles[stars.triangles[s]])
                if (const double there = length2(p - to_double(mesh.positions[w])); there < here) {
                    here = there;
                    nearest = w;
                }
        if (nearest == v) break;
        v = nearest;
        least = std::min(least, star_distance2(mesh, stars, v, p, enough2));
    }
    return least;
}

/// The same, and around all neighbours of the vertex where that ends, and on from the best of them: the
/// nearest triangle is rarely farther from the nearest vertex. Slower.
double searched_distance2(const Mesh& mesh, const Stars& stars, std::uint32_t v, Double3 p, double enough2) {
    double least = std::numeric_limits<double>::infinity();
    for (int steps = 0; steps < 100; ++steps) {
        // To the vertex nearest to p.
        double here = length2(p - to_double(mesh.positions[v]));
        for (bool nearer = true; nearer;) {
            nearer = false;
            const std::uint32_t from = v;
            for (std::uint32_t s = stars.begin[from]; s < stars.begin[from + 1]; ++s)
                for (const std::uint32_t w : mesh.triangles[stars.triangles[s]])
                    if (const double there = length2(p - to_double(mesh.positions[w])); there < here) {
                        here = there;
                        v = w;
                        nearer = true;
                    }
        }
        // The best star around it.
        const double before = least;
        std::uint32_t best = v;
        least = std::min(least, star_distance2(mesh, stars, v, p, enough2));
        for (std::uint32_t s = stars.begin[v]; s < stars.begin[v + 1] && least > enough2; ++s)
            for (const std::uint32_t w : mesh.triangles[stars.triangles[s]])
                if (const double there = star_distance2(mesh, stars, w, p, enough2); there < least) {
                    least = there;
                    best = w;
                }
        if (best == v || !(least < before) || least <= enough2) break;
        v = best;
    }
    return least;
}

/// Whether a triangle's edge u -> v has no other triangle.
bool single(const Mesh& mesh, const Stars& stars, std::uint32_t u, std::uint32_t v) {
    int triangles = 0;
    for (std::uint32_t s = stars.begin[u]; s < stars.begin[u + 1]; ++s) {
        const Triangle& t = mesh.triangles[stars.triangles[s]];
        triangles += t[0] == v || t[1] == v || t[2] == v;
    }
    return triangles == 1;
}

/// Spreads 10 bits, two zeros between each.
std::uint32_t spread(std::uint32_t x) {
    x = (x | x << 16) & 0x030000FFu;
    x = (x | x << 8) & 0x0300F00Fu;
    x = (x | x << 4) & 0x030C30C3u;
    return (x | x << 2) & 0x09249249u;
}

/// Each position's place among all along a Morton curve of 1024 steps a side.
std::vector<std::uint32_t> ranks_along_curve(std::span<const Float3> positions) {
    Double3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    for (const Float3& f : positions) {
        const Double3 p = to_double(f);
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const double extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    const double scale = extent > 0 ? 1023 / extent : 0;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order(positions.size());
    for (std::uint32_t v = 0; v < order.size(); ++v) {
        const Double3 p = (to_double(positions[v]) - low) * scale;
        order[v] = {
            spread(std::uint32_t(p.x)) | spread(std::uint32_t(p.y)) << 1 | spread(std::uint32_t(p.z)) << 2,
            v};
    }
    tbb::parallel_sort(order.begin(), order.end());
    std::vector<std::uint32_t> ranks(positions.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) ranks[order[i].second] = i;
    return ranks;
}

class Calibrator {
  public:
    explicit Calibrator(ProgressiveMesh&& mesh) : live_(std::move(mesh)) {
        live_.go_to(live_.max_level());
        ranks_ = ranks_along_curve(live_.positions());
        full_ = arranged();
        full_stars_ = Stars(full_);
        tree_.emplace(full_);
    }

    ProgressiveMesh release() { return live_.release(); }

    /// The two-sided distance between a level and the full mesh, if it is more than about `enough`, and at
    /// most that otherwise.
    double measure(std::size_t level, double enough) {
        enough2_ = enough * enough;
        live_.go_to(level);
        const Mesh coarse = arranged();
        const Stars stars(coarse);
        // How far, squared, the two surfaces are around each of the level's vertices: where the samples on
        // triangles should go.
        std::vector<float> apart(coarse.positions.size(), 0);
        const double forth = from_full(coarse, stars, apart);
        const double back = from_vertices(coarse, stars, apart);
        std::vector<float> apart_triangles(coarse.triangles.size(), 0);
        const double centres =
            coarse.triangles.size() > kSamples / 6
                ? from_centres(coarse, kCentresShare * std::max(forth, back), apart_triangles)
                : 0;
        const double known = std::max({enough, forth, back, centres});
        return std::max(known, from_triangles(coarse, stars, apart, apart_triangles, known));
    }

  private:
    /// The current level with its vertices numbered along a Morton curve, as the full mesh's, and its
    /// triangles in their order: numbers in order of birth are scattered in space, and every look around
    /// would miss the cache.
    Mesh arranged() const {
        Mesh mesh;
        mesh.positions.resize(ranks_.size());
        const auto positions = live_.positions();
        for (std::size_t v = 0; v < positions.size(); ++v) mesh.positions[ranks_[v]] = positions[v];
        std::vector<std::uint32_t> place(ranks_.size() + 1, 0);
        const auto ranked = [&](const Triangle& t) {
            return Triangle{ranks_[t[0]], ranks_[t[1]], ranks_[t[2]]};
        };
        const auto first = [](const Triangle& t) { return std::min({t[0], t[1], t[2]}); };
        for (const Triangle& t : live_.triangles()) ++place[first(ranked(t)) + 1];
        std::partial_sum(place.begin(), place.end(), place.begin());
        mesh.triangles.resize(live_.triangles().size());
        for (const Triangle& t : live_.triangles()) {
            const Triangle r = ranked(t);
            mesh.triangles[place[first(r)]++] = r;
        }
        return mesh;
    }

    /// For each input vertex, the level's one that it folded into; kNoVertex where its component is gone.
    std::vector<std::uint32_t> ancestors(bool& orphans) const {
        const std::vector<std::uint32_t>& parents = live_.state().parents;
        const std::size_t alive = live_.positions().size();
        std::vector<std::uint32_t> births(parents.size()), ranked(parents.size());
        orphans = false;
        for (std::uint32_t v = 0; v < births.size(); ++v) {
            births[v] = v < alive ? v : parents[v] == kNoVertex ? kNoVertex : births[parents[v]];
            orphans |= births[v] == kNoVertex;
            ranked[ranks_[v]] = births[v] == kNoVertex ? kNoVertex : ranks_[births[v]];
        }
        return ranked;
    }

    /// Input vertices to the level. Their ancestors' stars bound the distance.
    double from_full(const Mesh& coarse, const Stars& stars, std::vector<float>& apart) const {
        bool orphans = false;
        const std::vector<std::uint32_t> ancestors = this->ancestors(orphans);
        const std::size_t vertices = live_.positions().size();
        const std::size_t step = std::clamp<std::size_t>(
            full_.positions.size() / std::max<std::size_t>(8 * vertices, kDensePass), 1, 8);
        std::vector<Probe> probes((full_.positions.size() + step - 1) / step);
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, probes.size(), 4096),
                          [&](const tbb::blocked_range<std::size_t>& range) {
                              for (std::size_t i = range.begin(); i < range.end(); ++i) {
                                  const auto v = std::uint32_t(i * step);
                                  const std::uint32_t ancestor = ancestors[v];
                                  double bound2 = std::numeric_limits<double>::infinity();
                                  if (ancestor != kNoVertex)
                                      bound2 = walked_distance2(coarse, stars, ancestor,
                                                                to_double(full_.positions[v]), enough2_);
                                  probes[i] = {bound2, v};
                              }
                          });
        for (const Probe& probe : probes)
            if (const std::uint32_t a = ancestors[probe.index]; a != kNoVertex)
                apart[a] = std::max(apart[a], float(probe.bound2));
        std::optional<TriangleTree> tree;
        if (orphans || coarse.triangles.size() <= kTreeTriangles) tree.emplace(coarse);
        return farthest(probes, enough2_, [&](Probe& probe, double most) {
            return tree ? tree->closest(to_double(full_.positions[probe.index]), TriangleTree::kNoGuess, most,
                                        probe.bound2)
                              .distance2
                        : searched_distance2(coarse, stars, ancestors[probe.index],
                                             to_double(full_.positions[probe.index]), most);
        });
    }

    /// The level's vertices to the input. Each is still one of the input's, elsewhere: a walk from there
    /// bounds the distance.
    double from_vertices(const Mesh& coarse, const Stars& stars, std::vector<float>& apart) const {
        std::vector<Probe> probes(coarse.positions.size(), Probe{0, 0});
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, probes.size(), 4096),
                          [&](const tbb::blocked_range<std::size_t>& range) {
                              for (std::size_t v = range.begin(); v < range.end(); ++v)
                                  if (stars.begin[v] < stars.begin[v + 1])
                                      probes[v] = {walked_distance2(full_, full_stars_, std::uint32_t(v),
                                                                    to_double(coarse.positions[v]), enough2_),
                                                   std::uint32_t(v)};
                          });
        const double most = farthest(probes, enough2_, [&](Probe& probe, double least) {
            return probe.bound2 = tree_
                                      ->closest(to_double(coarse.positions[probe.index]),
                                                TriangleTree::kNoGuess, least, probe.bound2)
                                      .distance2;
        });
        for (const Probe& probe : probes)
            apart[probe.index] = std::max(apart[probe.index], float(probe.bound2));
        return most;
    }

    /// The centres of a level's many triangles to the input; a walk from a corner bounds the distance.
    /// What is not farther than `known` need not be known.
    double from_centres(const Mesh& coarse, double known, std::vector<float>& apart_triangles) const {
        const double enough2 = std::max(enough2_, known * known);
        std::vector<Probe> probes(coarse.triangles.size());
        const auto centre = [&](std::uint32_t t) {
            const Triangle& c = coarse.triangles[t];
            return (to_double(coarse.positions[c[0]]) + to_double(coarse.positions[c[1]]) +
                    to_double(coarse.positions[c[2]])) *
                   (1.0 / 3);
        };
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, probes.size(), 4096),
            [&](const tbb::blocked_range<std::size_t>& range) {
                for (std::size_t i = range.begin(); i < range.end(); ++i) {
                    const auto t = std::uint32_t(i);
                    const Double3 p = centre(t);
                    probes[i] = {walked_distance2(full_, full_stars_, coarse.triangles[t][0], p, enough2), t};
                }
            });
        const double most = farthest(probes, enough2, [&](Probe& probe, double least) {
            return probe.bound2 =
                       tree_->closest(centre(probe.index), TriangleTree::kNoGuess, least, probe.bound2)
                           .distance2;
        });
        for (const Probe& probe : probes) apart_triangles[probe.index] = float(probe.bound2);
        return most;
    }

    /// Samples on the level's triangles to the input; of many triangles those where the surfaces are farthest
    /// apart, and those at boundaries, which may reach beyond the input without any vertex being far. What is
    /// not farther than `known` is of no interest: the largest that all threads have found grows with them,
    /// and at the end is the same in whatever order they find it.
    double from_triangles(const Mesh& coarse, const Stars& stars, const std::vector<float>& apart,
                          const std::vector<float>& apart_triangles, double known) const {
        std::vector<Probe> triangles(coarse.triangles.size());
        for (std::uint32_t t = 0; t < triangles.size(); ++t) {
            const Triangle& c = coarse.triangles[t];
            double priority = double(std::max({apart[c[0]], apart[c[1]], apart[c[2]], apart_triangles[t]}));
            for (std::size_t k = 0; k < 3; ++k)
                if (single(coarse, stars, c[k], c[(k + 1) % 3]))
                    priority = std::numeric_limits<double>::infinity();
            triangles[t] = {priority, t};
        }
        // A grid of 1/n steps has (n + 1)(n + 2)/2 points.
        const std::size_t per_triangle =
            std::clamp<std::size_t>(kSamples / std::max<std::size_t>(triangles.size(), 1), 6, 153);
        const auto n = std::size_t((std::sqrt(8.0 * double(per_triangle) + 1) - 3) / 2);
        const std::size_t asked = std::min(triangles.size(), kSamples / 6);
        std::nth_element(triangles.begin(), triangles.begin() + std::ptrdiff_t(asked), triangles.end(),
                         [](const Probe& a, const Probe& b) {
                             return a.bound2 != b.bound2 ? a.bound2 > b.bound2 : a.index < b.index;
                         });
        std::atomic<double> farthest2 = known * known;
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, asked, 256),
                          [&](const tbb::blocked_range<std::size_t>& range) {
                              std::uint32_t guess = TriangleTree::kNoGuess;
                              double most = farthest2;
                              for (std::size_t i = range.begin(); i < range.end(); ++i) {
                                  const Triangle& t = coarse.triangles[triangles[i].index];
                                  const Double3 a = to_double(coarse.positions[t[0]]),
                                                ab = to_double(coarse.positions[t[1]]) - a,
                                                ac = to_double(coarse.positions[t[2]]) - a;
                                  for (std::size_t j = 0; j <= n; ++j)
                                      for (std::size_t k = 0; j + k <= n; ++k) {
                                          const Double3 p =
                                              a + ab * (double(j) / double(n)) + ac * (double(k) / double(n));
                                          // Among small triangles a short walk finds something near enough.
                                          if (asked < coarse.triangles.size() &&
                                              walked_distance2(full_, full_stars_, t[0], p, most) <= most)
                                              continue;
                                          const auto hit = tree_->closest(p, guess, most);
                                          guess = hit.slot;
                                          while (most < hit.distance2 &&
                                                 !farthest2.compare_exchange_weak(most, hit.distance2)) {
                                          }
                                          most = std::max(most, hit.distance2);
                                      }
                              }
                          });
        return std::sqrt(farthest2);
    }

    LiveMesh live_;
    std::vector<std::uint32_t> ranks_;  // of vertices in order of birth: their places along the curve
    double enough2_ = 0;
    Mesh full_;
    Stars full_stars_{full_};
    std::optional<TriangleTree> tree_;
};

}  // namespace

bool calibrate_errors(ProgressiveMesh& mesh, const Progress& progress) {
    if (mesh.splits.empty() || mesh.triangles.empty()) return true;
    // Finest first, down to the base.
    std::vector<std::size_t> levels;
    for (double count = 0.9 * double(mesh.triangles.size()); count > double(mesh.base_triangles);
         count *= kLevelRatio) {
        const std::size_t level = level_for_triangles(mesh, std::uint64_t(count));
        if (level > 0 && (levels.empty() || level < levels.back())) levels.push_back(level);
    }
    levels.push_back(0);

    // estimate[i], measured[i] at levels[i]; both grow with i.
    std::vector<double> measured;
    {
        Calibrator calibrator(std::move(mesh));
        const std::size_t most = levels.size() + kMoreLevels;
        const auto measure = [&](std::size_t level, double finer) {
            // Coarser levels are no nearer: what is below the last result need not be known exactly.
            return std::max(finer, kSafety * calibrator.measure(level, 0.5 / kSafety * finer));
        };
        std::size_t done = 0;
        const auto goes_on = [&] {
            return !progress || progress("measure errors", double(done++) / double(most));
        };
        for (const std::size_t level : levels) {
            if (!goes_on()) return false;
            measured.push_back(measure(level, measured.empty() ? 0.0 : measured.back()));
        }
        // More of them where the error jumps.
        while (levels.size() < most) {
            std::size_t at = 0;
            double jump = kJump;
            for (std::size_t i = 1; i < levels.size(); ++i)
                if (levels[i - 1] - levels[i] > 1 + levels[i - 1] / kJumpShare &&
                    measured[i] > jump * measured[i - 1]) {
                    jump = measured[i] / measured[i - 1];
                    at = i;
                }
            if (at == 0) break;
            if (!goes_on()) return false;
            const std::size_t level = levels[at] + (levels[at - 1] - levels[at]) / 2;
            const double result = std::min(measure(level, measured[at - 1]), measured[at]);
            levels.insert(levels.begin() + std::ptrdiff_t(at), level);
            measured.insert(measured.begin() + std::ptrdiff_t(at), result);
        }
        mesh = calibrator.release();
    }
    // Between two measured levels the estimates say how the error grows: the larger of the two scales, within
    // the two.
    const auto scale_of = [&](std::size_t i) {
        const double estimate = double(mesh.splits[levels[i]].error);
        return estimate > 0 ? measured[i] / estimate : 0;
    };
    std::vector<double> scales(levels.size());
    for (std::size_t i = 0; i < levels.size(); ++i) scales[i] = scale_of(i);
    std::vector<float> errors(mesh.splits.size());
    std::size_t at = levels.size() - 1;  // the measured level at or next coarser
    for (std::size_t level = 0; level < mesh.splits.size(); ++level) {
        while (at > 0 && levels[at - 1] <= level) --at;
        const double scale = std::max(scales[at], at > 0 ? scales[at - 1] : 0.0);
        const double wanted =
            std::max(scale * double(mesh.splits[level].error), kShareOfCoarser * measured[at]);
        const double bounded = std::clamp(wanted, at > 0 ? measured[at - 1] : 0.0, measured[at]);
        errors[level] = float(std::min(bounded, double(std::numeric_limits<float>::max())));
    }
    float least = 0;
    for (std::size_t level = mesh.splits.size(); level-- > 0;) {
        least = std::max(least, errors[level]);
        mesh.splits[level].error = least;
    }
    return true;
}

}  // namespace vsplit::bake
