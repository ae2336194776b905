// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "paper_cost.hpp"
#include "vsplit/bake/weights.hpp"

namespace vsplit::bake {

EdgeErrors edge_errors(const Mesh& mesh) {
    const StarMesh stars(mesh);
    const PaperCost cost(stars);
    tbb::enumerable_thread_specific<std::vector<double>> found;
    tbb::parallel_for(
        tbb::blocked_range<std::uint32_t>(0, stars.vertex_count(), 1024),
        [&](const tbb::blocked_range<std::uint32_t>& range) {
            EdgeStar star;
            std::vector<std::uint32_t> others;
            std::vector<double>& errors = found.local();
            for (std::uint32_t u = range.begin(); u < range.end(); ++u) {
                // A hub's star would be gathered once for each of its thousands of edges.
                if (stars.star(u).size() > kLargeStar) continue;
                others.clear();
                for (const std::uint32_t t : stars.star(u))
                    for (const std::uint32_t v : stars.triangle(t))
                        if (v > u) others.push_back(v);
                std::sort(others.begin(), others.end());
                others.erase(std::unique(others.begin(), others.end()), others.end());
                for (const std::uint32_t v : others) {
                    const Fold fold = fold_rule(stars, u, v);
                    if (fold == Fold::kNever || stars.star(v).size() > kLargeStar) continue;
                    star.gather(stars, u, v);
                    errors.push_back(cost.evaluate(stars, star, fold, Placement::kOptimal, 1, 1).cost /
                                     stars.scale());
                }
            }
        });
    std::vector<double> all;
    for (const std::vector<double>& errors : found) all.insert(all.end(), errors.begin(), errors.end());
    if (all.empty()) return {};
    const auto [smallest, largest] = std::minmax_element(all.begin(), all.end());
    EdgeErrors errors{*smallest, 0, *largest};
    const auto middle = all.begin() + std::ptrdiff_t(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    errors.median = *middle;
    return errors;
}

AutomaticWeights automatic_weights(const EdgeErrors& errors) {
    AutomaticWeights weights;
    weights.errors = errors;
    weights.initial = 0.5 * (errors.smallest + errors.largest);
    weights.mark = 0.5 * (weights.initial + errors.largest);
    return weights;
}

double AutomaticWeights::factor() const {
    constexpr double kMost = 1e6;
    if (!(mark > 0)) return 1;
    const double lift = errors.median > 0 ? mark / errors.median : kMost;
    return std::clamp(lift, 1.0, kMost);
}

}  // namespace vsplit::bake
