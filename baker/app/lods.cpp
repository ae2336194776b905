// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>

#include "command.hpp"
#include "levels.hpp"
#include "vsplit/bake/gltf.hpp"
#include "vsplit/live_mesh.hpp"

namespace vsplit::app {
namespace {

struct LodsCommand {
    Common common;
    Output output;
    std::string input;
    std::vector<double> ratios;

    int run() const;
};

int LodsCommand::run() const {
    for (const double ratio : ratios)
        if (!(ratio > 0 && ratio <= 1)) return fail_usage("--ratios wants numbers above 0 and up to 1");
    if (extension_of(output.path) != ".glb") return fail_usage("lods writes one .glb");
    if (const int refused = check_output(output)) return refused;
    int exit = kDone;
    auto mesh = load_progressive(input, common, exit);
    if (!mesh) return exit;

    std::vector<double> finest_first(ratios);
    std::sort(finest_first.begin(), finest_first.end(), std::greater<>());
    std::vector<bake::GltfLevel> levels;
    std::vector<std::string> notes;
    Json table = Json::array();
    const std::size_t full = mesh->triangles.size();
    std::vector<std::pair<double, std::size_t>> cuts;
    for (const double ratio : finest_first) {
        const std::uint64_t wanted = triangles_for_ratio(*mesh, ratio);
        const std::size_t level = level_for_triangles(*mesh, wanted);
        if (const auto note = why_not(*mesh, level, wanted))
            notes.push_back(fmt::format("ratio {}: {}", ratio, *note));
        if (!cuts.empty() && cuts.back().second == level) {
            notes.push_back(fmt::format("ratio {}: the same level as the one before, left out", ratio));
            continue;
        }
        cuts.emplace_back(ratio, level);
    }
    LiveMesh live(std::move(*mesh));
    for (const auto& [ratio, level] : cuts) {
        live.go_to(level);
        levels.push_back({live.snapshot(), live.error()});
        table.push_back({{"ratio", ratio},
                         {"triangles", levels.back().mesh.triangles.size()},
                         {"vertices", levels.back().mesh.positions.size()},
                         {"error", levels.back().error}});
    }
    auto glb = bake::encode_glb(levels);
    if (!glb) return fail_output(output.path, glb.error());
    if (const int failed = write_output(output, *glb)) return failed;
    if (common.json) {
        if (!common.quiet)
            print_json({{"input", input},
                        {"output", output.path},
                        {"levels", table},
                        {"bytes", glb->size()},
                        {"notes", notes}});
        return kDone;
    }
    say(common, fmt::format("{}: {} levels, {} bytes", output.path, levels.size(), with_commas(glb->size())));
    for (std::size_t i = 0; i < levels.size(); ++i)
        say(common, fmt::format("  LOD {}: {:>11} triangles ({:6.2f} %), error {}", i,
                                with_commas(levels[i].mesh.triangles.size()),
                                100.0 * double(levels[i].mesh.triangles.size()) /
                                    double(std::max<std::size_t>(full, 1)),
                                short_number(levels[i].error)));
    if (!common.quiet)
        for (const std::string& note : notes) fmt::print(stderr, "vsplit: {}: {}\n", output.path, note);
    return kDone;
}

}  // namespace

void add_lods(CLI::App& app, int& exit) {
    auto command = std::make_shared<LodsCommand>();
    CLI::App* sub = app.add_subcommand("lods", "Write a chain of levels as one GLB with MSFT_lod");
    sub->footer(
        "Example:\n"
        "  vsplit lods bunny.pmesh --ratios 1,0.5,0.25,0.1 -o bunny-lods.glb\n"
        "Screen coverages come from the recorded errors: docs/lods.md.");
    sub->add_option("input", command->input, "The .pmesh")->required()->type_name("FILE");
    sub->add_option("--ratios", command->ratios,
                    "Triangles kept over triangles of the input, a comma between")
        ->required()
        ->delimiter(',');
    command->output.add_to(*sub, "The .glb to write");
    command->common.add_to(*sub);
    sub->callback([command, &exit] { exit = command->run(); });
}

}  // namespace vsplit::app
