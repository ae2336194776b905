// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "compare.hpp"

#include <algorithm>
#include <cmath>

namespace vsplit::bench {
namespace {

const Run* run_of(const ModelQuality& model, const std::string& peer) {
    const auto found =
        std::find_if(model.runs.begin(), model.runs.end(), [&](const Run& run) { return run.peer == peer; });
    return found == model.runs.end() || !found->reason.empty() ? nullptr : &*found;
}

}  // namespace

Comparison compare(const std::vector<ModelQuality>& quality, const std::string& peer, Figure figure,
                   const std::vector<double>& ratios, const std::string& model) {
    Comparison result;
    result.peer = peer;
    double logs = 0, raw_logs = 0;
    int raw_levels = 0;
    for (const ModelQuality& one : quality) {
        const Run* ours = run_of(one, "vsplit");
        if (!ours || (!model.empty() && one.model != model)) continue;
        const Run* theirs = run_of(one, peer);
        for (std::size_t i = 0; i < ours->levels.size(); ++i) {
            const Level& a = ours->levels[i];
            if (std::find(ratios.begin(), ratios.end(), a.ratio) == ratios.end() || !a.reason.empty())
                continue;
            ++result.wanted;
            if (!theirs || !theirs->levels[i].reason.empty()) continue;
            const double x = a.*figure, y = theirs->levels[i].*figure;
            logs += std::log(std::max(x, kFloor) / std::max(y, kFloor));
            ++result.levels;
            if (!(x > 0) || !(y > 0)) continue;
            raw_logs += std::log(x / y);
            ++raw_levels;
        }
    }
    if (result.levels) result.ratio = std::exp(logs / result.levels);
    if (raw_levels) result.unfloored = std::exp(raw_logs / raw_levels);
    return result;
}

Comparison best_peer(const std::vector<ModelQuality>& quality, Figure figure,
                     const std::vector<double>& ratios, const std::string& model) {
    Comparison best;
    for (const std::string& peer : peers_that_ran(quality)) {
        const Comparison one = compare(quality, peer, figure, ratios, model);
        if (one.levels == 0 || 4 * one.levels < 3 * one.wanted) continue;
        if (best.peer.empty() || one.ratio > best.ratio) best = one;
    }
    return best;
}

std::vector<std::string> peers_that_ran(const std::vector<ModelQuality>& quality) {
    std::vector<std::string> names;
    for (const ModelQuality& model : quality)
        for (const Run& run : model.runs)
            if (run.peer != "vsplit" && run.reason.empty() &&
                std::find(names.begin(), names.end(), run.peer) == names.end())
                names.push_back(run.peer);
    return names;
}

}  // namespace vsplit::bench
