// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <tuple>

#include "vsplit/bake/weights.hpp"
#include "vsplit/live_mesh.hpp"

namespace vsplit::bake {
namespace {

/// Weights are searched as powers of two. More than the most makes no difference but to be infinite.
constexpr double kLeastExponent = -40, kMostExponent = 20;
constexpr std::size_t kMaxBakes = 40;
/// Where the share jumps over what is asked, weights this near to the jump are tried, too.
constexpr double kProbes[] = {0.0005, 0.001, 0.002, 0.004, 0.008, 0.016, 0.032, 0.064};

std::tuple<std::uint32_t, std::uint32_t, std::uint32_t> bits(const Float3& p) {
    // 0 and -0 are the same place.
    return {std::bit_cast<std::uint32_t>(p.x + 0.0f), std::bit_cast<std::uint32_t>(p.y + 0.0f),
            std::bit_cast<std::uint32_t>(p.z + 0.0f)};
}

/// For each vertex the least group of a triangle that has it.
std::vector<std::uint32_t> groups_of(const Mesh& mesh) {
    std::vector<std::uint32_t> groups(mesh.positions.size(), 0);
    if (mesh.groups.empty()) return groups;
    std::fill(groups.begin(), groups.end(), kNoVertex);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (const std::uint32_t v : mesh.triangles[t]) groups[v] = std::min(groups[v], mesh.groups[t]);
    return groups;
}

/// Vertices of a mesh by group and place.
struct Places {
    const Mesh& mesh;
    std::vector<std::uint32_t> groups = groups_of(mesh), order = sorted();

    auto key(std::uint32_t v) const { return std::tuple(groups[v], bits(mesh.positions[v])); }

  private:
    std::vector<std::uint32_t> sorted() const {
        std::vector<std::uint32_t> all(mesh.positions.size());
        std::iota(all.begin(), all.end(), 0u);
        std::sort(all.begin(), all.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::tuple(key(a), a) < std::tuple(key(b), b);
        });
        return all;
    }
};

/// The search for one region's weight, the others being as they are.
struct Search {
    const Mesh& mesh;
    const CollapseOptions& options;
    const Progress& progress;
    Marks& marks;
    double automatic;
    std::vector<char> used;  ///< By a triangle: others are not in the record.
    std::size_t bakes = 0;
    std::uint32_t least_triangles = 0;  ///< Of the base mesh, without what the search weighs.

    std::size_t size_of(std::size_t number) const {
        std::size_t count = 0;
        for (std::size_t v = 0; v < marks.region.size(); ++v) count += used[v] && marks.region[v] == number;
        return count;
    }

    struct Kept {
        double share;
        std::uint32_t vertices;  ///< Of the whole level.
        bool at_level;           ///< Not if even the base mesh has more triangles than the level is to have.
    };

    /// `rough`: of the sequence before outliers are put off, which takes a third of the time.
    Result<Kept> share(std::size_t number, double weight, double ratio, bool rough = false) {
        marks.regions[number - 1].weight = weight;
        Mesh painted = mesh;
        painted.weights = weights_of(marks, automatic);
        CollapseOptions chosen = options;
        chosen.put_off_outliers = options.put_off_outliers && !rough;
        auto baked = collapse(painted, chosen, progress);
        if (!baked) return baked.error();
        ++bakes;
        const ProgressiveMesh& record = baked->mesh;
        const std::vector<std::uint32_t> origins = record_origins(mesh, record);
        const auto wanted = std::uint64_t(std::llround(ratio * double(record.triangles.size())));
        const std::size_t level = level_for_triangles(record, wanted);
        // The first record is that of weight 1: what it does not reach, none does.
        if (bakes == 1) least_triangles = record.base_triangles;
        const auto kept = double(region_vertices_at(record, origins, marks, number, level));
        return Kept{kept / double(region_vertices_at(record, origins, marks, number, record.splits.size())),
                    vertices_at(record, level),
                    record.base_triangles <= std::max<std::uint64_t>(wanted, least_triangles)};
    }

    Result<KeepResult> run(std::size_t number, const Keep& wish);
    /// From a weight of 2^start, by steps of at first `step`.
    Result<KeepResult> run(std::size_t number, const Keep& wish, double start, double step, bool rough);
};

Result<KeepResult> Search::run(std::size_t number, const Keep& wish) {
    if (!options.put_off_outliers || options.cost == Cost::kPaper) return run(number, wish, 0, 1, false);
    // What is put off moves shares a little: the rough weight is nearly that which is sought.
    auto rough = run(number, wish, 0, 1, true);
    if (!rough) return rough;
    const double start = std::isinf(rough->weight) ? kMostExponent : std::log2(rough->weight);
    auto found = run(number, wish, start, 0.25, false);
    if (found) found->bakes += rough->bakes;
    return found;
}

Result<KeepResult> Search::run(std::size_t number, const Keep& wish, double start, double first_step,
                               bool rough) {
    const std::size_t before = bakes;
    KeepResult best;
    double best_miss = 2;
    const auto miss = [&](double exponent) -> Result<double> {
        const double weight = std::exp2(exponent);
        auto kept = share(number, weight, wish.ratio, rough);
        if (!kept) return kept.error();
        // What keeps so much that the level cannot be had weighs too much.
        if (!kept->at_level) return 1.0;
        const double off = kept->share - wish.share;
        // Of equals the later is nearer to the edge between too little and too much.
        if (std::abs(off) <= best_miss) {
            best_miss = std::abs(off);
            best.weight = weight;
            best.share = kept->share;
            best.level_vertices = kept->vertices;
        }
        return off;
    };
    const double size = double(std::max<std::size_t>(size_of(number), 1));
    const double enough = std::max(0.002, 0.5 / size);
    const auto finish = [&]() {
        marks.regions[number - 1].weight = best.weight;
        best.bakes = bakes - before;
        return best;
    };
    double low = start, high = start;
    auto at_low = miss(start);
    if (!at_low) return at_low.error();
    auto at_high = at_low;
    // Steps that double, until the wish lies between.
    for (double step = first_step; best_miss > enough && (*at_low > 0) == (*at_high > 0); step *= 2) {
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
    if (best_miss > enough && *at_high < 0) {
        // A finite weight was not enough.
        if (const auto off = miss(std::numeric_limits<double>::infinity()); !off) return off.error();
        return finish();
    }
    while (best_miss > enough && bakes - before < kMaxBakes && high - low > 1e-4 &&
           (*at_low > 0) != (*at_high > 0)) {
        const double middle = 0.5 * (low + high);
        auto at_middle = miss(middle);
        if (!at_middle) return at_middle.error();
        (*at_middle > 0 ? high : low) = middle;
        (*at_middle > 0 ? at_high : at_low) = *at_middle;
    }
    if ((*at_low > 0) == (*at_high > 0)) return finish();
    // The share is not quite monotonic: what jumps here may be met beside it.
    for (const double probe : kProbes)
        for (const double exponent : {low - probe, high + probe}) {
            if (best_miss <= std::max(0.009, 0.5 / size) || rough) return finish();
            if (const auto off = miss(exponent); !off) return off.error();
        }
    return finish();
}

}  // namespace

std::vector<std::uint32_t> record_origins(const Mesh& input, const ProgressiveMesh& record) {
    const Mesh full = cut(record, record.splits.size());
    const Places theirs{input}, ours{full};
    std::vector<std::uint32_t> origins(full.positions.size(), kNoVertex);
    const std::vector<std::uint32_t>& there = theirs.order;
    std::size_t i = 0;
    for (const std::uint32_t v : ours.order) {
        const auto place = ours.key(v);
        while (i < there.size() && theirs.key(there[i]) < place) ++i;
        if (i == there.size() || theirs.key(there[i]) != place) continue;
        origins[v] = there[i];
        // The last one at a place serves all that are left there.
        if (i + 1 < there.size() && theirs.key(there[i + 1]) == place) ++i;
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
                  automatic_weights(edge_errors(mesh)).factor(),
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
    const auto percent = [](double share) {
        const long tenths = std::lround(1000 * share);
        return std::to_string(tenths / 10) + (tenths % 10 ? "." + std::to_string(tenths % 10) : "") + " %";
    };
    const auto number = [](double weight) {
        char text[32];
        std::snprintf(text, sizeof text, "%.4g", weight);
        return std::string(text);
    };
    std::vector<KeepResult> results(wishes.size());
    // One region's weight moves what others keep a little: in turns, until all are met.
    for (int turn = 0; turn < (wishes.size() > 1 ? 4 : 1); ++turn) {
        bool moved = false;
        for (std::size_t i = 0; i < wishes.size(); ++i) {
            if (turn > 0) {
                auto now = search.share(numbers[i], results[i].weight, wishes[i].ratio);
                if (!now) return now.error();
                results[i].share = now->share;
                results[i].level_vertices = now->vertices;
                if (now->at_level && std::abs(now->share - wishes[i].share) <= 0.008) continue;
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
                          percent(results[i].share) + ", by weight " + number(results[i].weight) +
                          "; the region has " + std::to_string(search.size_of(numbers[i])) +
                          " vertices, the whole level " + std::to_string(results[i].level_vertices));
    return results;
}

}  // namespace vsplit::bake
