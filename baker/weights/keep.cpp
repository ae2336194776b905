// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <tuple>

#include "vsplit/bake/weights.hpp"
#include "vsplit/live_mesh.hpp"

namespace vsplit::bake {
namespace {

/// Weights are searched as powers of two.
constexpr double kLeastExponent = -40, kMostExponent = 60;
constexpr std::size_t kMaxBakes = 40;

std::tuple<std::uint32_t, std::uint32_t, std::uint32_t> bits(const Float3& p) {
    // 0 and -0 are the same place.
    return {std::bit_cast<std::uint32_t>(p.x + 0.0f), std::bit_cast<std::uint32_t>(p.y + 0.0f),
            std::bit_cast<std::uint32_t>(p.z + 0.0f)};
}

std::vector<std::uint32_t> by_place(std::span<const Float3> positions) {
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::tuple(bits(positions[a]), a) < std::tuple(bits(positions[b]), b);
    });
    return order;
}

/// The search for one region's weight, the others being as they are.
struct Search {
    const Mesh& mesh;
    const CollapseOptions& options;
    const Progress& progress;
    Marks& marks;
    double automatic;
    std::vector<char> used;  ///< By a triangle: others are not in the record.
    std::size_t bakes = 0;

    std::size_t size_of(std::size_t number) const {
        std::size_t count = 0;
        for (std::size_t v = 0; v < marks.region.size(); ++v) count += used[v] && marks.region[v] == number;
        return count;
    }

    Result<double> share(std::size_t number, double weight, double ratio) {
        marks.regions[number - 1].weight = weight;
        Mesh painted = mesh;
        painted.weights = weights_of(marks, automatic);
        auto baked = collapse(painted, options, progress);
        if (!baked) return baked.error();
        ++bakes;
        const ProgressiveMesh& record = baked->mesh;
        const std::vector<std::uint32_t> origins = record_origins(mesh, record);
        const auto wanted = std::uint64_t(std::llround(ratio * double(record.triangles.size())));
        const std::size_t level = level_for_triangles(record, wanted);
        const auto kept = double(region_vertices_at(record, origins, marks, number, level));
        return kept / double(region_vertices_at(record, origins, marks, number, record.splits.size()));
    }

    Result<KeepResult> run(std::size_t number, const Keep& wish);
};

Result<KeepResult> Search::run(std::size_t number, const Keep& wish) {
    const std::size_t before = bakes;
    KeepResult best;
    double best_miss = 2;
    const auto miss = [&](double exponent) -> Result<double> {
        const double weight = std::exp2(exponent);
        auto kept = share(number, weight, wish.ratio);
        if (!kept) return kept.error();
        const double off = *kept - wish.share;
        // Of equals the later is nearer to the edge between too little and too much.
        if (std::abs(off) <= best_miss) {
            best_miss = std::abs(off);
            best.weight = weight;
            best.share = *kept;
        }
        return off;
    };
    const double enough = std::max(0.002, 0.5 / double(std::max<std::size_t>(size_of(number), 1)));
    const auto finish = [&]() {
        marks.regions[number - 1].weight = best.weight;
        best.bakes = bakes - before;
        return best;
    };
    double low = 0, high = 0;
    auto at_low = miss(0);
    if (!at_low) return at_low.error();
    auto at_high = at_low;
    // Steps that double, until the wish lies between.
    for (double step = 1; best_miss > enough && (*at_low > 0) == (*at_high > 0); step *= 2) {
        const bool up = *at_high < 0;
        double& from = up ? low : high;
        double& to = up ? high : low;
        auto& at_from = up ? at_low : at_high;
        auto& at_to = up ? at_high : at_low;
        if (to == (up ? kMostExponent : kLeastExponent)) break;
        from = to;
        at_from = *at_to;
        to = std::clamp(to + (up ? step : -step), kLeastExponent, kMostExponent);
        at_to = miss(to);
        if (!at_to) return at_to.error();
    }
    while (best_miss > enough && bakes - before < kMaxBakes && high - low > 1e-4 &&
           (*at_low > 0) != (*at_high > 0)) {
        const double middle = 0.5 * (low + high);
        auto at_middle = miss(middle);
        if (!at_middle) return at_middle.error();
        (*at_middle > 0 ? high : low) = middle;
        (*at_middle > 0 ? at_high : at_low) = *at_middle;
    }
    return finish();
}

}  // namespace

std::vector<std::uint32_t> record_origins(const Mesh& input, const ProgressiveMesh& record) {
    const Mesh full = cut(record, record.splits.size());
    const std::vector<std::uint32_t> theirs = by_place(input.positions), ours = by_place(full.positions);
    std::vector<std::uint32_t> origins(full.positions.size(), kNoVertex);
    std::size_t i = 0;
    for (const std::uint32_t v : ours) {
        const auto place = bits(full.positions[v]);
        while (i < theirs.size() && bits(input.positions[theirs[i]]) < place) ++i;
        if (i == theirs.size() || bits(input.positions[theirs[i]]) != place) continue;
        origins[v] = theirs[i];
        // The last one at a place serves all that are left there.
        if (i + 1 < theirs.size() && bits(input.positions[theirs[i + 1]]) == place) ++i;
    }
    return origins;
}

std::size_t region_vertices_at(const ProgressiveMesh& record, std::span<const std::uint32_t> origins,
                               const Marks& marks, std::size_t number, std::size_t level) {
    std::size_t count = 0;
    for (std::uint32_t v = 0; v < vertices_at(record, level); ++v)
        count += origins[v] != kNoVertex && marks.region[origins[v]] == number;
    return count;
}

Result<std::vector<KeepResult>> find_weights(const Mesh& mesh, Marks& marks, std::span<const Keep> wishes,
                                             const CollapseOptions& options, const Progress& progress) {
    const auto refuse = [](std::string message) {
        return Error{ErrorCode::kArgument, std::move(message), Error::kNowhere, 0};
    };
    if (const char* fault = mesh_fault(mesh)) return refuse(std::string("unsound mesh: ") + fault);
    if (marks.region.size() != mesh.positions.size() || marks.strength.size() != mesh.positions.size())
        return refuse("there are not as many marks as vertices");
    CollapseOptions quick = options;
    quick.calibrate = false;  // the sequence is the same without
    Search search{mesh,
                  quick,
                  progress,
                  marks,
                  automatic_weights(edge_errors(mesh)).factor(options.cost),
                  std::vector<char>(mesh.positions.size(), 0)};
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t) search.used[v] = 1;
    std::vector<std::size_t> numbers;
    for (const Keep& wish : wishes) {
        const auto it = std::find_if(marks.regions.begin(), marks.regions.end(),
                                     [&](const Region& region) { return region.name == wish.region; });
        if (it == marks.regions.end()) return refuse("there is no region " + wish.region);
        numbers.push_back(std::size_t(it - marks.regions.begin()) + 1);
        if (search.size_of(numbers.back()) == 0) return refuse("nothing is in region " + wish.region);
        if (std::count(numbers.begin(), numbers.end(), numbers.back()) > 1)
            return refuse("region " + wish.region + " is to keep two things");
    }
    const auto percent = [](double share) { return std::to_string(std::lround(1000 * share) / 10) + "%"; };
    std::vector<KeepResult> results(wishes.size());
    // One region's weight moves what others keep a little: in turns, until all are met.
    for (int turn = 0; turn < (wishes.size() > 1 ? 4 : 1); ++turn) {
        bool moved = false;
        for (std::size_t i = 0; i < wishes.size(); ++i) {
            if (turn > 0) {
                auto now = search.share(numbers[i], results[i].weight, wishes[i].ratio);
                if (!now) return now.error();
                results[i].share = *now;
                if (std::abs(*now - wishes[i].share) <= 0.008) continue;
            }
            auto result = search.run(numbers[i], wishes[i]);
            if (!result) return result.error();
            result->bakes += results[i].bakes;
            results[i] = *result;
            moved = true;
        }
        if (!moved) break;
    }
    for (std::size_t i = 0; i < wishes.size(); ++i)
        if (std::abs(results[i].share - wishes[i].share) >
            std::max(0.01, 1.0 / double(search.size_of(numbers[i]))))
            return refuse("no weight keeps " + percent(wishes[i].share) + " of region " + wishes[i].region +
                          " at " + percent(wishes[i].ratio) + " of the triangles: the nearest is " +
                          percent(results[i].share));
    return results;
}

}  // namespace vsplit::bake
