// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "measure.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fan_distance.hpp"
#include "star_mesh.hpp"
#include "tail.hpp"
#include "triangle_tree.hpp"
#include "unsplit.hpp"

namespace vsplit::bake {
namespace {

/// Samples that are asked at once, at least, and per triangle of the input: the more, the closer together are
/// those that follow each other.
constexpr std::size_t kBatch = 1 << 15;
constexpr double kBatchShare = 0.125;
/// Samples below this share of the tail are near enough.
constexpr double kNear = 0.5;
/// On a level's triangles together, about, where it has so few that their middles are not enough.
constexpr std::size_t kSamples = 16000;
/// Input vertices times triangles around a collapse: beyond, every other vertex is dropped. Only the last few
/// collapses have so many.
constexpr std::size_t kMostPairs = 20'000;
/// Triangles of the input around a collapse: of more, each sample searches its own.
constexpr std::size_t kMostAround = 200;
/// Of as many triangles a sample takes the nearest: no less than the distance, so a bound of it too.
constexpr std::uint32_t kMostAsked = 400;
/// Of a hub's triangles, about so many have samples: it has thousands, and as many collapses.
constexpr std::size_t kMostFan = 100;

Double3 to_double(const Float3& p) {
    return {double(p.x), double(p.y), double(p.z)};
}

/// The input, in the order of a tree over it.
struct Input {
    explicit Input(const ProgressiveMesh& record) : mesh(Unsplitter::full(record)), tree(mesh) {
        number = tree.arrange(mesh);
    }
    Mesh mesh;
    TriangleTree tree;
    std::vector<std::uint32_t> number;  // of each of the record's vertices, until Measurer has used it
};

class Measurer {
  public:
    explicit Measurer(const ProgressiveMesh& mesh)
        : input_(mesh),
          walk_(mesh),
          first_(full_.triangles.size(), kNoVertex),
          next_(full_.positions.size(), kNoVertex),
          forth_(mesh.splits.size(), 0),
          result_(mesh.splits.size(), 0),
          tail_(mesh.positions.size()) {
        std::vector<bool> seen(full_.positions.size(), false);
        for (std::uint32_t t = 0; t < full_.triangles.size(); ++t)
            for (const std::uint32_t corner : walk_.triangle(t))
                if (const std::uint32_t v = input_.number[corner]; !seen[v]) {
                    seen[v] = true;
                    put(v, t);
                }
        std::vector<std::uint32_t>().swap(input_.number);
    }

    std::vector<float> run(const Progress& progress) {
        const std::size_t count = result_.size();
        const std::size_t batch = std::max(kBatch, std::size_t(kBatchShare * double(full_.triangles.size())));
        while (walk_.splits_left() != 0) {
            const std::uint32_t split = walk_.step();
            walk_.look_ahead([&](std::uint32_t t) { fetch_ahead(&first_[t]); });
            const std::size_t rank = count - 1 - split;
            gather();
            if (!fan_.empty() && !walk_.acts().empty()) {
                forth_[rank] =
                    float(std::min(std::sqrt(follow_points()), double(std::numeric_limits<float>::max())));
                add_samples(split, kNear * tail_.at(forth_, rank));
            }
            if (batch_.samples.size() >= batch || walk_.splits_left() == 0) {
                // Asked while the walk goes on; the one before is done by now, or waited for.
                asking_.wait();
                std::swap(batch_, asked_);
                batch_.clear();
                asking_.run([this] { ask(); });
                if (progress && !progress("measure errors", double(rank + 1) / double(count))) {
                    asking_.wait();
                    return {};
                }
            }
        }
        asking_.wait();
        for (std::size_t rank = 0; rank < count; ++rank) {
            float& result = result_[count - 1 - rank];
            result = std::max(result, forth_[rank]);
        }
        return std::move(result_);
    }

  private:
    /// The samples of a split.
    struct Group {
        std::uint32_t begin, end;
        std::uint32_t split, place;  // place: of those of similar numbers the samples are close together
        float enough, distance;
    };
    struct Batch {
        std::vector<Double3> samples;
        std::vector<Group> groups;
        void clear() {
            samples.clear();
            groups.clear();
        }
    };

    void put(std::uint32_t point, std::uint32_t triangle) {
        next_[point] = first_[triangle];
        first_[triangle] = point;
    }
    Double3 place(std::uint32_t v) const { return to_double(walk_.positions()[v]); }

    /// The triangles around the last collapse, and the points on these and on those that went.
    void gather() {
        fan_.clear();
        points_.clear();
        for (const std::uint32_t v : walk_.acts()) walk_.star(v, [&](std::uint32_t t) { fan_.push_back(t); });
        if (walk_.acts().size() > 1) {
            std::sort(fan_.begin(), fan_.end());
            fan_.erase(std::unique(fan_.begin(), fan_.end()), fan_.end());
        }
        const auto take = [&](std::uint32_t t) {
            for (std::uint32_t p = first_[t]; p != kNoVertex; p = next_[p]) points_.push_back(p);
            first_[t] = kNoVertex;
        };
        for (const std::uint32_t t : fan_) take(t);
        for (std::uint32_t t = walk_.removed_begin(); t < walk_.removed_end(); ++t) take(t);
    }

    /// Hands the points to the nearest triangles; their largest squared distance.
    double follow_points() {
        near_.clear();
        for (const std::uint32_t t : fan_)
            for (const std::uint32_t v : walk_.triangle(t)) near_.corners.push_back(place(v));
        for (const std::uint32_t p : points_) near_.points.push_back(to_double(full_.positions[p]));
        near_.find();
        double most = 0;
        for (const double d : near_.distance2) most = std::max(most, d);
        // Of too many, the farthest and every other stay.
        const bool thin = points_.size() * fan_.size() > kMostPairs;
        for (std::size_t i = 0; i < points_.size(); ++i)
            if (!thin || i % 2 == 0 || near_.distance2[i] == most) put(points_[i], fan_[near_.nearest[i]]);
        return most;
    }

    void add_samples(std::uint32_t split, double enough) {
        const auto begin = std::uint32_t(batch_.samples.size());
        const auto add = [&](Double3 at) { batch_.samples.push_back(at); };
        for (const std::uint32_t v : walk_.acts()) add(place(v));
        const std::size_t each = kSamples / std::max<std::size_t>(walk_.triangles().size(), 1);
        edges_.clear();
        const std::size_t stride = fan_.size() / kMostFan + 1;
        for (std::size_t i = 0; i < fan_.size(); i += stride) {
            const Triangle& c = walk_.triangle(fan_[i]);
            const Double3 a = place(c[0]), ab = place(c[1]) - a, ac = place(c[2]) - a;
            if (each < 6) {
                add(a + (ab + ac) * (1.0 / 3));
                for (std::size_t k = 0; k < 3; ++k) {
                    const auto [low, high] = std::minmax(c[k], c[(k + 1) % 3]);
                    if (acts(low) || acts(high)) edges_.push_back({low, high});
                }
                continue;
            }
            // A grid of 1/n steps has (n + 1)(n + 2)/2 points.
            const auto n =
                std::size_t((std::sqrt(8.0 * double(std::min<std::size_t>(each, 153)) + 1) - 3) / 2);
            for (std::size_t j = 0; j <= n; ++j)
                for (std::size_t k = 0; j + k <= n; ++k)
                    add(a + ab * (double(j) / double(n)) + ac * (double(k) / double(n)));
        }
        std::sort(edges_.begin(), edges_.end());
        edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
        for (const auto& [u, v] : edges_) add((place(u) + place(v)) * 0.5);
        batch_.groups.push_back({begin, std::uint32_t(batch_.samples.size()), split,
                                 points_.empty() ? 0 : points_.front(), float(enough), 0});
    }
    bool acts(std::uint32_t v) const {
        return std::find(walk_.acts().begin(), walk_.acts().end(), v) != walk_.acts().end();
    }

    /// The samples of asked_; the walk may go on meanwhile.
    void ask() {
        auto& groups = asked_.groups;
        std::sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) {
            return a.place != b.place ? a.place < b.place : a.split < b.split;
        });
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, asked_.groups.size(), 64),
                          [&](const tbb::blocked_range<std::size_t>& range) {
                              thread_local FarPoints far;
                              thread_local std::vector<std::uint32_t> around;
                              for (std::size_t i = range.begin(); i < range.end(); ++i)
                                  asked_.groups[i].distance =
                                      float(std::min(farthest(asked_.groups[i], far, around),
                                                     double(std::numeric_limits<float>::max())));
                          });
        for (const Group& group : asked_.groups) result_[group.split] = group.distance;
    }

    /// The largest distance from a group's samples to the input, if it is more than enough.
    double farthest(const Group& group, FarPoints& far, std::vector<std::uint32_t>& around) const {
        far.points.assign(asked_.samples.begin() + std::ptrdiff_t(group.begin),
                          asked_.samples.begin() + std::ptrdiff_t(group.end));
        Double3 low = far.points.front(), high = low;
        for (const Double3 p : far.points) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        // Most have a triangle within reach, and share them.
        const double enough = double(group.enough);
        const Double3 reach{enough, enough, enough};
        around.clear();
        double most = enough * enough;
        if (!input_.tree.overlapping(low - reach, high + reach, kMostAround, around)) around.clear();
        far.drop_near(full_, around, most);
        std::uint32_t guess = TriangleTree::kNoGuess;
        for (std::size_t i = 0; i < far.points.size(); ++i)
            if (far.distance2[i] > most) {
                const auto hit =
                    input_.tree.closest(far.points[i], guess, most, far.distance2[i], kMostAsked);
                guess = hit.slot;
                most = std::max(most, hit.distance2);
            }
        return std::sqrt(most);
    }

    Input input_;
    const Mesh& full_ = input_.mesh;
    Unsplitter walk_;
    std::vector<std::uint32_t> first_, next_;  // chains of input vertices, one a triangle
    std::vector<float> forth_;                 // first collapse first
    std::vector<float> result_;
    Tail tail_;
    Batch batch_, asked_;
    std::vector<std::uint32_t> fan_, points_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_;
    FanDistance near_;
    tbb::task_group asking_;  // last: its task uses the others
};

}  // namespace

std::vector<float> measure_collapses(const ProgressiveMesh& mesh, const Progress& progress) {
    if (mesh.splits.empty() || mesh.triangles.empty()) return std::vector<float>(mesh.splits.size(), 0);
    return Measurer(mesh).run(progress);
}

}  // namespace vsplit::bake
