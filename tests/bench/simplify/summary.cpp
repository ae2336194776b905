// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare.hpp"
#include "report.hpp"

namespace vsplit::bench {
namespace {

const std::vector<double> kAll(kRatios.begin(), kRatios.end());

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double over(double a, double b) {
    return b > 0 ? a / b : kNone;
}

void add_quality(std::vector<SummaryRow>& rows, const std::vector<ModelQuality>& quality) {
    const auto against_best = [&](const std::string& figure, Figure member, const std::vector<double>& ratios,
                                  const Limits& limits, const std::string& model = {}) {
        const Comparison best = best_peer(quality, member, ratios, model);
        std::string measured = best.peer.empty()
                                   ? "n/a: no peer"
                                   : fmt::format("{:.3f} ({}, {} levels", best.ratio, best.peer, best.levels);
        if (!best.peer.empty())
            measured += !(std::abs(best.unfloored - best.ratio) >= 5e-4)
                            ? ")"
                            : fmt::format("; {:.3f} unfloored)", best.unfloored);
        rows.push_back(row_of(figure, best.ratio, measured, limits));
    };
    against_best("mean distance over the best peer's", &Level::mean, kAll, {1.00, 0.93});
    against_best("maximum distance over the best peer's", &Level::max, kAll, {0.80, 0.60});
    std::uint64_t defects = 0;
    std::size_t levels = 0;
    std::string where;
    for (const ModelQuality& model : quality)
        for (const Run& run : model.runs)
            for (const Level& level : run.levels) {
                if (run.peer != "vsplit") continue;
                ++levels;
                defects += level.defects();
                if (level.defects())
                    where +=
                        fmt::format(" {} at {:g} %: {};", model.model, 100 * level.ratio, level.defects());
            }
    if (!where.empty()) where.pop_back();
    rows.push_back(row_of(
        "flipped, folded or degenerate triangles that the input did not have",
        levels ? double(defects) : kNone,
        levels ? fmt::format("{} in {} levels{}{}", defects, levels, where.empty() ? "" : ":", where) : "n/a",
        {0, 0}));
    const auto fandisk = std::find_if(quality.begin(), quality.end(),
                                      [](const ModelQuality& m) { return m.model == "fandisk"; });
    if (fandisk != quality.end())
        against_best("fandisk, mean distance at 10 and 1 % over the best peer's", &Level::mean, {0.1, 0.01},
                     {1, 1, 1, "", false}, "fandisk");
}

void add_speed(std::vector<SummaryRow>& rows, const Speed& s) {
    const std::string on = s.model.empty() ? "" : ", " + s.model;
    const auto cell = [](double value, const char* format, const std::string& reason) {
        return std::isnan(value) ? "n/a: " + reason : fmt::format(fmt::runtime(format), value);
    };
    const Timing& one = s.record;
    const std::string why = s.reason.empty() ? one.reason : s.reason;
    const double pace = over(1e-3 * one.collapses, one.cpu_seconds);
    rows.push_back(row_of("recorded collapses per CPU second, one thread" + on, pace,
                          cell(pace, "{:.0f} k", why), {250, 600, -1, " k"}));

    const double calls = over(one.cpu_seconds, s.meshoptimizer.cpu_seconds);
    rows.push_back(row_of("CPU of the full record over one meshoptimizer call to 1 %" + on, calls,
                          cell(calls, "{:.2f}", why.empty() ? s.meshoptimizer.reason : why),
                          {2.5, 1.2, 1, "x"}));
    if (const double reached = over(s.meshoptimizer.triangles, double(s.triangles)); reached > 0.0105)
        rows.back().measured += fmt::format(" (it stops at {:.1f} %)", 100 * reached);

    // The least of the runs: what else the machine does only adds, and to two threads more.
    const double wall = over(s.record_two_threads.wall_least, one.wall_least);
    const bool same = !one.fingerprint.empty() && one.fingerprint != "differs" &&
                      one.fingerprint == s.record_two_threads.fingerprint;
    rows.push_back(row_of("wall on two threads over one, least of the runs" + on, wall,
                          cell(wall, "{:.2f}", why.empty() ? s.record_two_threads.reason : why),
                          {0.9, 0.55}));
    rows.push_back({"the same record on one thread and on two" + on,
                    std::isnan(wall) ? "n/a"
                    : same           ? "yes"
                                     : "no",
                    "yes", "yes",
                    std::isnan(wall) ? "n/a"
                    : same           ? "goal"
                                     : "short"});

    const double peak = over(one.peak_bytes, double(s.triangles));
    rows.push_back(row_of(
        "peak memory of the process per input triangle" + on, peak,
        cell(peak, "{:.0f} bytes", why) +
            (std::isnan(peak)
                 ? ""
                 : fmt::format(", net {:.0f}", (one.peak_bytes - one.start_bytes) / double(s.triangles))),
        {200, 120, 1, " bytes"}));

    const double growth = over(over(s.record_fine.cpu_seconds, double(s.fine_triangles)),
                               over(s.record_again.cpu_seconds, double(s.triangles)));
    rows.push_back(row_of(fmt::format("CPU per triangle at {:.2f} M over that at {:.2f} M",
                                      1e-6 * double(s.fine_triangles), 1e-6 * double(s.triangles)),
                          growth, cell(growth, "{:.2f}", why.empty() ? s.record_fine.reason : why),
                          {1.25, 1.05, 1, "x"}));
}

void add_calibration(std::vector<SummaryRow>& rows, const std::vector<Calibration>& calibration) {
    std::size_t count = 0, within = 0;
    double least = kNone, most = kNone;
    for (const Calibration& c : calibration)
        for (const ErrorCheck& check : c.checks) {
            const double ratio = check.measured / check.error;
            ++count;
            within += ratio <= 1;
            least = std::fmin(least, ratio);
            most = std::fmax(most, ratio);
        }
    const double share = over(100.0 * double(within), double(count));
    const std::string none =
        "n/a: " + (calibration.empty() ? std::string("not measured") : calibration.front().reason);
    rows.push_back(row_of("`--error E`: share with a measured maximum of at most E", share,
                          count ? fmt::format("{:.1f} % of {}, most {:.2f} E", share, count, most) : none,
                          {99, 99, -1, " %", false}));
    rows.push_back(row_of("`--error E`: least measured maximum over E", least,
                          count ? fmt::format("{:.3f}", least) : none, {1.0 / 3, 1.0 / 3, -1, "", false}));
}

void add_weights(std::vector<SummaryRow>& rows, const std::vector<WeightRun>& weights) {
    double least = kNone, most = kNone;
    for (const WeightRun& run : weights)
        for (const WeightCheck& check : run.checks) {
            if (check.ratio == 0.4) least = std::fmin(least, 100 * check.kept);
            most = std::fmax(most, check.rest);
        }
    const auto cell = [](double value, const char* format) {
        return std::isnan(value) ? "n/a: not measured" : fmt::format(fmt::runtime(format), value);
    };
    rows.push_back(row_of("weight 10: least share of marked vertices kept at 40 %", least,
                          cell(least, "{:.1f} %"), {95, 95, -1, " %", false}));
    rows.push_back(row_of("weight 10: greatest mean distance of the rest over the unweighted one's", most,
                          cell(most, "{:.3f}"), {1.05, 1.05, 1, "", false}));
}

}  // namespace

std::vector<SummaryRow> summarise(const Report& report) {
    std::vector<SummaryRow> rows;
    if (!report.quality.empty()) add_quality(rows, report.quality);
    if (report.speed) add_speed(rows, *report.speed);
    if (!report.calibration.empty()) add_calibration(rows, report.calibration);
    if (!report.weights.empty()) add_weights(rows, report.weights);
    return rows;
}

}  // namespace vsplit::bench
