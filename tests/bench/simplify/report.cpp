// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "compare.hpp"
#include "summary.hpp"

namespace vsplit::bench {
namespace {

using Out = std::back_insert_iterator<std::string>;

const std::vector<double> kAll(kRatios.begin(), kRatios.end());

std::string percent(double ratio) {
    return fmt::format("{:g} %", 100 * ratio);
}

std::string ratio_cell(const Comparison& c) {
    if (c.levels == 0) return "n/a";
    return c.levels == c.wanted ? fmt::format("{:.3f}", c.ratio)
                                : fmt::format("{:.3f} ({} of {})", c.ratio, c.levels, c.wanted);
}

void write_head(Out out, const Report& r) {
    fmt::format_to(out, "# Benchmarks\n\nWritten by `{}`; do not edit.\n\n", r.command);
    fmt::format_to(out,
                   "| | |\n| --- | --- |\n| machine | {}, {} cores, {:.0f} GiB |\n| system | {} |\n| "
                   "compiler | {} |\n| date | {} |\n| commit | {} |\n| models | {} |\n",
                   r.machine.cpu, r.machine.cores, r.machine.memory_gib, r.machine.system, r.machine.compiler,
                   r.machine.date, r.machine.commit, r.models);
    for (const Peer& p : r.peers)
        fmt::format_to(out, "| {} | {} |\n", p.name,
                       p.missing.empty() ? p.library + ": " + p.setting : "**missing**: " + p.missing);
}

void write_summary(Out out, const Report& r) {
    fmt::format_to(
        out,
        "\n## Against the bars\n\nBest peer: the one of this run that is hardest to beat in that row.\n\n"
        "| figure | measured | bar | goal | |\n| --- | --- | --- | --- | --- |\n");
    for (const SummaryRow& row : summarise(r))
        fmt::format_to(out, "| {} | {} | {} | {} | {} |\n", row.figure, row.measured, row.bar, row.goal,
                       row.verdict);
}

void write_ratios(Out out, const Report& r) {
    const std::pair<const char*, Figure> figures[] = {
        {"mean distance", &Level::mean},
        {"RMS distance", &Level::rms},
        {"maximum distance", &Level::max},
        {"normal deviation", &Level::normal_degrees},
        {"triangle quality (mean; above 1 vsplit is better)", &Level::quality_mean}};
    fmt::format_to(
        out,
        "\n## vsplit over each peer\n\nGeometric means over the models; below 1 vsplit is better. In "
        "brackets: levels that the peer reached. "
        "Distances below 1e-7 of the diagonal, what 32-bit positions resolve, count as that (the floor).\n");
    for (const auto& [name, figure] : figures) {
        fmt::format_to(out, "\n{}:\n\n| peer |", name);
        for (const double ratio : kRatios) fmt::format_to(out, " {} |", percent(ratio));
        fmt::format_to(out, " all |\n| --- | --- | --- | --- | --- | --- |\n");
        for (const std::string& peer : peers_that_ran(r.quality)) {
            fmt::format_to(out, "| {} |", peer);
            for (const double ratio : kRatios)
                fmt::format_to(out, " {} |", ratio_cell(compare(r.quality, peer, figure, {ratio})));
            fmt::format_to(out, " {} |\n", ratio_cell(compare(r.quality, peer, figure, kAll)));
        }
    }
}

void write_model(Out out, const ModelQuality& model) {
    fmt::format_to(out, "\n### {}\n\n", model.model);
    if (!model.reason.empty()) {
        fmt::format_to(out, "n/a: {}\n", model.reason);
        return;
    }
    fmt::format_to(out, "{} triangles, {} vertices; its own degenerate triangles {}, folded edges {}.\n\n",
                   model.triangles, model.vertices, model.degenerate, model.folded);
    fmt::format_to(out,
                   "| ratio | simplifier | triangles | mean | RMS | max | normals | quality mean (min) | "
                   "flipped + folded + degenerate |\n"
                   "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (std::size_t i = 0; i < kRatios.size(); ++i)
        for (const Run& run : model.runs) {
            fmt::format_to(out, "| {} | {} |", percent(kRatios[i]), run.peer);
            if (!run.reason.empty() || i >= run.levels.size()) {
                fmt::format_to(out, " n/a: {} | | | | | | |\n", run.reason);
                continue;
            }
            const Level& l = run.levels[i];
            fmt::format_to(out, " {}{} | {:.4g} | {:.4g} | {:.4g} | {:.3f} | {:.3f} ({:.2g}) | {} |\n",
                           l.triangles, l.reason.empty() ? "" : ", n/a: " + l.reason, l.mean, l.rms, l.max,
                           l.normal_degrees, l.quality_mean, l.quality_min,
                           l.defects()
                               ? fmt::format("{} + {} + {}", l.new_flipped, l.new_folded, l.new_degenerate)
                               : "0");
        }
}

void write_cpu(Out out, const Report& r) {
    fmt::format_to(out,
                   "\n## CPU seconds for the four levels\n\nOne thread, from plain mesh to plain meshes, "
                   "each run in its own process.\n\n| model |");
    for (const Peer& p : r.peers) fmt::format_to(out, " {} |", p.name);
    fmt::format_to(out, "\n| --- |");
    for (std::size_t i = 0; i < r.peers.size(); ++i) fmt::format_to(out, " --- |");
    fmt::format_to(out, "\n");
    for (const ModelQuality& model : r.quality) {
        fmt::format_to(out, "| {} |", model.model);
        for (const Run& run : model.runs)
            fmt::format_to(
                out, " {} |",
                run.reason.empty() ? fmt::format("{:.2f}", run.cpu_seconds) : "n/a: " + run.reason);
        fmt::format_to(out, "\n");
    }
}

void write_speed(Out out, const Speed& s) {
    fmt::format_to(out, "\n## Speed\n\n");
    if (!s.reason.empty()) {
        fmt::format_to(out, "n/a: {}: {}\n", s.model, s.reason);
        return;
    }
    fmt::format_to(out,
                   "{}, {} triangles; its subdivision, {}. Runs in turns, each in its own process; medians. "
                   "Net memory leaves out what was there before: the input and all code.\n\n",
                   s.model, s.triangles, s.fine_triangles);
    fmt::format_to(out,
                   "| what | runs | CPU s (least to most) | wall s (least) | removed vertices per CPU s | "
                   "peak bytes per triangle | net |\n| --- | --- | --- | --- | --- | --- | --- |\n");
    const auto line = [&](const char* name, const Timing& t, std::uint64_t triangles) {
        if (!t.reason.empty()) {
            fmt::format_to(out, "| {} | n/a: {} | | | | | |\n", name, t.reason);
            return;
        }
        fmt::format_to(
            out, "| {} | {} | {:.2f} ({:.2f} to {:.2f}) | {:.2f} ({:.2f}) | {:.0f} k | {:.0f} | {:.0f} |\n",
            name, t.runs, t.cpu_seconds, t.cpu_least, t.cpu_most, t.wall_seconds, t.wall_least,
            1e-3 * t.collapses / t.cpu_seconds, t.peak_bytes / double(triangles),
            (t.peak_bytes - t.start_bytes) / double(triangles));
    };
    line("vsplit, full record, 1 thread", s.record, s.triangles);
    line("vsplit, full record, 2 threads", s.record_two_threads, s.triangles);
    line("vsplit, the same, outliers put off, errors measured, 1 thread", s.record_calibrated, s.triangles);
    line("meshoptimizer, one call to 1 %", s.meshoptimizer, s.triangles);
    line("OpenMesh, to 1 %", s.openmesh, s.triangles);
    line("vsplit, subdivided, 1 thread", s.record_fine, s.fine_triangles);
    line("vsplit, in turns with the subdivided", s.record_again, s.triangles);
}

void write_calibration(Out out, const Report& r) {
    fmt::format_to(out,
                   "\n## `--error E`\n\nTwenty E a model, evenly in the logarithm; the measured two-sided "
                   "maximum over E.\n\n"
                   "| model | E, 1e-4 of the diagonal | at most 1 | least | median | most |\n| --- | --- | "
                   "--- | --- | --- | --- |\n");
    for (const Calibration& c : r.calibration) {
        if (c.checks.empty()) {
            fmt::format_to(out, "| {} | n/a: {} | | | | |\n", c.model, c.reason);
            continue;
        }
        std::vector<double> over;
        for (const ErrorCheck& check : c.checks) over.push_back(check.measured / check.error);
        std::sort(over.begin(), over.end());
        const auto within = std::upper_bound(over.begin(), over.end(), 1.0) - over.begin();
        fmt::format_to(out, "| {} | {:.3g} to {:.3g} | {} of {} | {:.3f} | {:.3f} | {:.3f} |\n", c.model,
                       c.checks.front().error, c.checks.back().error, within, over.size(), over.front(),
                       over[over.size() / 2], over.back());
    }
}

void write_weights(Out out, const Report& r) {
    fmt::format_to(
        out,
        "\n## Weights\n\nWeight 10 on as large a share of the vertices as the paper marks (568 of "
        "2,645), a ball. Kept: marked vertices at a level of so many vertices, beside the same "
        "without weights; the paper's Table III keeps 95 % at 40 %. Rest: mean distance of "
        "the input's unmarked surface to the level, over that to the unweighted level with as many "
        "triangles there.\n\n| model |");
    const WeightRun* measured = nullptr;
    for (const WeightRun& run : r.weights)
        if (!run.checks.empty()) measured = &run;
    if (measured)
        for (const WeightCheck& check : measured->checks)
            fmt::format_to(out, " kept at {} | rest |", percent(check.ratio));
    fmt::format_to(out, "\n| --- |");
    for (std::size_t i = 0; measured && i < measured->checks.size(); ++i) fmt::format_to(out, " --- | --- |");
    fmt::format_to(out, "\n");
    for (const WeightRun& run : r.weights) {
        fmt::format_to(out, "| {} |", run.model);
        if (run.checks.empty()) fmt::format_to(out, " n/a: {} |", run.reason);
        for (const WeightCheck& check : run.checks)
            fmt::format_to(out, " {:.1f} % (plain {:.1f} %) | {:.3f} |", 100 * check.kept,
                           100 * check.plain_kept, check.rest);
        fmt::format_to(out, "\n");
    }
}

}  // namespace

std::string to_markdown(const Report& r) {
    std::string text;
    const Out out(text);
    write_head(out, r);
    write_summary(out, r);
    if (!r.quality.empty()) write_ratios(out, r);
    if (r.speed) write_speed(out, *r.speed);
    if (!r.calibration.empty()) write_calibration(out, r);
    if (!r.weights.empty()) write_weights(out, r);
    if (!r.quality.empty()) {
        write_cpu(out, r);
        fmt::format_to(out,
                       "\n## Each model\n\nDistances both ways from {} samples on each mesh and all "
                       "vertices, in 1e-4 of the model's diagonal; normals in degrees; "
                       "quality 4 sqrt(3) area / sum of squared edges; defects that the input did not have. "
                       "A level too far from its count is marked n/a and not compared.\n",
                       r.samples);
        for (const ModelQuality& model : r.quality) write_model(out, model);
    }
    return text;
}

Json to_json(const Report& r) {
    Json json{{"machine", r.machine}, {"command", r.command}, {"models", r.models},
              {"samples", r.samples}, {"quality", r.quality}, {"calibration", r.calibration},
              {"weights", r.weights}};
    if (r.speed) json["speed"] = *r.speed;
    for (const Peer& p : r.peers)
        json["peers"].push_back(
            {{"name", p.name}, {"library", p.library}, {"setting", p.setting}, {"missing", p.missing}});
    for (const SummaryRow& row : summarise(r))
        json["summary"].push_back({{"figure", row.figure},
                                   {"measured", row.measured},
                                   {"bar", row.bar},
                                   {"goal", row.goal},
                                   {"verdict", row.verdict}});
    return json;
}

}  // namespace vsplit::bench
