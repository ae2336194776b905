// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// --keep over a grid of targets: shares of a small and of a large region at four levels, on meshes and a
// scene. Each search ends within 1 % (or a vertex) of what was asked, or says that this cannot be reached;
// then what was asked is compared with the most and the least that any weight keeps.
// vsplit_bench_keep [--corpus DIR] [--cost paper] [--only MODEL]...
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "vsplit/bake/files.hpp"
#include "vsplit/bake/meshes.hpp"
#include "vsplit/bake/samples.hpp"
#include "vsplit/bake/scene.hpp"
#include "vsplit/bake/weights.hpp"
#include "vsplit/live_mesh.hpp"

namespace {

using namespace vsplit;
using namespace vsplit::bake;

constexpr double kShares[] = {0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 1};
constexpr double kRatios[] = {0.6, 0.4, 0.2, 0.1};
constexpr double kRegions[] = {0.03, 0.25};  // of the vertices

template <class T>
T need(Result<T>&& result, const std::string& of) {
    if (!result) {
        fmt::print(stderr, "{}: {}\n", of, result.error().describe());
        std::exit(1);
    }
    return *std::move(result);
}

Mesh load(const std::string& name, const std::string& corpus) {
    if (name == "whale") return make_sample_mesh(Sample::kWhale, 5'000);
    if (name == "2CylinderEngine" || name == "CesiumMan" || name == "Duck") {
        const std::string folder = corpus + "/gltf", path = folder + "/" + name + ".glb";
        return std::move(need(parse_scene(need(read_file(path), path), folder), path).mesh);
    }
    const std::string path = corpus + "/meshes/" + name + ".obj";
    return std::move(need(parse_mesh(need(read_file(path), path), "obj"), path).mesh);
}

/// The vertices nearest to the foremost one, as many as `part` of all.
Marks region_of(const Mesh& mesh, double part) {
    const std::vector<Float3>& p = mesh.positions;
    const std::size_t front = std::size_t(
        std::max_element(p.begin(), p.end(), [](Float3 a, Float3 b) { return a.x < b.x; }) - p.begin());
    std::vector<std::uint32_t> order(p.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto distance2 = [&](std::uint32_t v) {
        const double x = double(p[v].x) - double(p[front].x), y = double(p[v].y) - double(p[front].y),
                     z = double(p[v].z) - double(p[front].z);
        return x * x + y * y + z * z;
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return distance2(a) < distance2(b); });
    Marks marks = no_marks(p.size());
    marks.regions.push_back({"region", {}, 0xE6550D});
    for (std::size_t i = 0; i < std::size_t(part * double(p.size())); ++i) marks.region[order[i]] = 1;
    return marks;
}

/// What weights 0 and a million keep.
std::pair<double, double> range(const Mesh& mesh, Marks marks, double ratio, const CollapseOptions& options) {
    double kept[2];
    for (const int side : {0, 1}) {
        marks.regions[0].weight = side == 0 ? 0.0 : 1e6;
        Mesh painted = mesh;
        painted.weights = weights_of(marks, 1);
        CollapseOptions quick = options;
        quick.calibrate = false;
        const ProgressiveMesh record = need(collapse(painted, quick), "collapse").mesh;
        const auto origins = record_origins(mesh, record);
        const auto at = [&](std::size_t level) {
            return double(region_vertices_at(record, origins, marks, 1, level));
        };
        const auto wanted = std::uint64_t(std::llround(ratio * double(record.triangles.size())));
        const std::size_t level = level_for_triangles(record, wanted);
        const double all = at(record.splits.size());
        kept[side] = at(level) / all;
        // Infinite weights keep all, if that many triangles are enough for them.
        if (side == 1 && double(vertices_at(record, level)) > all) kept[side] = 1;
    }
    return {kept[0], kept[1]};
}

struct Tally {
    std::size_t asked = 0, hit = 0, impossible = 0, missed = 0, records = 0;
    double worst = 0;
};

Tally measure(const std::string& name, const Mesh& mesh, double part, const CollapseOptions& options) {
    Tally tally;
    const Marks marks = region_of(mesh, part);
    const double size = double(std::count(marks.region.begin(), marks.region.end(), 1));
    const double tolerance = std::max(0.01, 1 / size);
    for (const double ratio : kRatios) {
        const auto [least, most] = range(mesh, marks, ratio, options);
        for (const double share : kShares) {
            Marks searched = marks;
            const Keep wish{"region", share, ratio};
            const auto found = find_weights(mesh, searched, {&wish, 1}, options);
            ++tally.asked;
            if (found) {
                tally.records += found->front().bakes;
                const double miss = std::abs(found->front().share - share);
                tally.worst = std::max(tally.worst, miss);
                if (miss <= tolerance)
                    ++tally.hit;
                else
                    ++tally.missed;
            } else if (share > most + tolerance || share < least - tolerance) {
                ++tally.impossible;
            } else {
                ++tally.missed;
                fmt::print(stderr, "{}, {:.0f} % of the vertices (weights keep {:.1f} to {:.1f} %): {}\n",
                           name, 100 * part, 100 * least, 100 * most, found.error().message);
            }
        }
    }
    return tally;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("--keep over a grid of targets");
    std::string corpus = VSPLIT_CORPUS;
    std::vector<std::string> only;
    bool paper = false;
    app.add_option("--corpus", corpus, "Folder with the shared models");
    app.add_option("--only", only, "Models to take");
    app.add_flag("--paper", paper, "Cost paper, instead of cost quadric");
    CLI11_PARSE(app, argc, argv);
    if (only.empty()) only = {"whale", "fandisk", "CesiumMan", "stanford-bunny", "nefertiti"};
    CollapseOptions options;
    if (paper) options.cost = Cost::kPaper;
    fmt::print(
        "| model | vertices | region | asked | hit within 1 % | cannot be reached, and said so | missed | "
        "worst "
        "hit | records a search |\n| --- | --: | --: | --: | --: | --: | --: | --: | --: |\n");
    std::size_t missed = 0;
    for (const std::string& name : only) {
        const Mesh mesh = load(name, corpus);
        for (const double part : kRegions) {
            const Tally t = measure(name, mesh, part, options);
            fmt::print("| {} | {} | {:.0f} % | {} | {} | {} | {} | {:.2f} % | {:.1f} |\n", name,
                       mesh.positions.size(), 100 * part, t.asked, t.hit, t.impossible, t.missed,
                       100 * t.worst, double(t.records) / double(std::max<std::size_t>(t.hit + t.missed, 1)));
            std::fflush(stdout);
            missed += t.missed;
        }
    }
    return missed == 0 ? 0 : 1;
}
