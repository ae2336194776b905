// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "quality.hpp"

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "vsplit/bake/collapse.hpp"
#include "vsplit/live_mesh.hpp"

namespace vsplit::bench {
namespace {

constexpr double kLimitSeconds = 600;
constexpr double kShortSeconds = 2;

/// A level counts at its ratio if it has no more than this above the target, or this below.
bool near_target(std::uint64_t triangles, std::uint64_t target) {
    const auto slack = std::max<std::uint64_t>(1, target / 50);
    return triangles <= target + slack && triangles + slack >= target;
}

Level describe(const ruler::Ruler& ruler, const Mesh& mesh, double ratio, std::uint64_t target) {
    Level level;
    level.ratio = ratio;
    level.target = target;
    level.triangles = mesh.triangles.size();
    if (!near_target(level.triangles, target))
        level.reason =
            (level.triangles > target ? "stops at " : "falls to ") + std::to_string(level.triangles);
    auto measured = ruler.measure(mesh);
    if (!measured) {
        level.reason = measured.error().message;
        return level;
    }
    const double unit = 1e4 / ruler.diagonal();
    const ruler::Shape& shape = measured->shape;
    level.mean = measured->mean * unit;
    level.rms = measured->rms * unit;
    level.max = measured->max * unit;
    level.normal_degrees = measured->normal_degrees;
    level.quality_mean = shape.quality_mean;
    level.quality_min = shape.quality_min;
    level.new_flipped = shape.new_flipped;
    level.new_folded = shape.new_folded;
    level.new_degenerate = shape.new_degenerate;
    level.non_manifold_edges = shape.non_manifold_edges;
    level.boundary_edges = shape.boundary_edges;
    level.components = shape.components;
    return level;
}

/// Simplifies on one thread; then, if asked, measures on all.
Result<Json> run_once(const Peer& peer, const Mesh& mesh, const std::vector<std::size_t>& targets,
                      const ruler::Ruler* ruler) {
    Run run;
    const Meter meter;
    auto levels = [&] {
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        return peer.simplify(mesh, targets);
    }();
    run.cpu_seconds = meter.stop().cpu_seconds;
    if (!levels) return levels.error();
    for (std::size_t i = 0; ruler && i < targets.size(); ++i)
        run.levels.push_back(describe(*ruler, (*levels)[i], kRatios[i], targets[i]));
    return Json(run);
}

}  // namespace

ModelQuality measure_quality(const Model& model, const std::vector<Peer>& peers,
                             const ruler::RulerOptions& options, bool quick) {
    ModelQuality quality;
    quality.model = model.name;
    const auto mesh = model.load();
    if (!mesh) {
        quality.reason = mesh.error().describe();
        return quality;
    }
    auto ruler = ruler::Ruler::over(*mesh, options);
    if (!ruler) {
        quality.reason = ruler.error().describe();
        return quality;
    }
    if (!(ruler->diagonal() > 0)) {
        quality.reason = "the model has no extent";
        return quality;
    }
    quality.vertices = mesh->positions.size();
    quality.triangles = mesh->triangles.size();
    std::vector<std::size_t> targets;
    for (const double ratio : kRatios)
        targets.push_back(std::size_t(std::llround(ratio * double(mesh->triangles.size()))));
    if (auto own = in_child(
            [&]() -> Result<Json> {
                const auto shape = ruler->measure(*mesh);
                if (!shape) return shape.error();
                return Json{shape->shape.degenerate, shape->shape.folded};
            },
            kLimitSeconds)) {
        quality.degenerate = (*own)[0];
        quality.folded = (*own)[1];
    }
    for (const Peer& peer : peers) {
        Run run;
        run.peer = peer.name;
        run.reason = peer.missing.empty() ? "" : "missing";
        if (peer.missing.empty()) {
            std::fprintf(stderr, "%s: %s\n", model.name.c_str(), peer.name.c_str());
            const auto answer =
                in_child([&] { return run_once(peer, *mesh, targets, &*ruler); }, kLimitSeconds);
            if (answer) {
                run = answer->get<Run>();
                run.peer = peer.name;
                std::vector<double> times{run.cpu_seconds};
                while (!quick && run.cpu_seconds < kShortSeconds && times.size() < 3) {
                    const auto again =
                        in_child([&] { return run_once(peer, *mesh, targets, nullptr); }, kLimitSeconds);
                    if (!again) break;
                    times.push_back(again->get<Run>().cpu_seconds);
                }
                std::sort(times.begin(), times.end());
                run.cpu_seconds = times[times.size() / 2];
            } else {
                run.reason = answer.error().message;
            }
        }
        quality.runs.push_back(std::move(run));
    }
    return quality;
}

Calibration measure_calibration(const Model& model, const ruler::RulerOptions& options) {
    Calibration calibration;
    const auto mesh = model.load();
    if (mesh) {
        std::fprintf(stderr, "%s: --error\n", model.name.c_str());
        const auto answer = in_child(
            [&]() -> Result<Json> {
                auto ruler = ruler::Ruler::over(*mesh, options);
                if (!ruler) return ruler.error();
                auto record = bake::collapse(*mesh);
                if (!record) return record.error();
                LiveMesh live(std::move(record->mesh));
                const auto at_share = [&](double share) {
                    return error_at(live.state(),
                                    level_for_triangles(
                                        live.state(), std::uint64_t(share * double(mesh->triangles.size()))));
                };
                const double first = at_share(0.95), last = at_share(0.01);
                if (!(first > 0) || !(last > first))
                    return Error{ErrorCode::kUnsupported, "recorded errors do not grow from 95 % to 1 %",
                                 Error::kNowhere, 0};
                const double unit = 1e4 / ruler->diagonal();
                constexpr int kErrors = 20;
                Calibration checked;
                for (int i = 0; i < kErrors; ++i) {
                    const double error = first * std::pow(last / first, double(i) / (kErrors - 1));
                    live.go_to(level_for_error(live.state(), error));
                    const auto measured = ruler->max_distance(live.snapshot());
                    if (!measured) return measured.error();
                    checked.checks.push_back({error * unit, *measured * unit, live.triangles().size()});
                }
                return Json(checked);
            },
            kLimitSeconds);
        if (answer)
            calibration = answer->get<Calibration>();
        else
            calibration.reason = answer.error().message;
    } else {
        calibration.reason = mesh.error().describe();
    }
    calibration.model = model.name;
    return calibration;
}

}  // namespace vsplit::bench
