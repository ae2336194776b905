// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>

#include "command.hpp"
#include "levels.hpp"
#include "model.hpp"
#include "vsplit/bake/scene.hpp"
#include "vsplit/live_mesh.hpp"

namespace vsplit::app {
namespace {

/// A level asked for, and what it was asked for by.
struct Wish {
    std::string name;  ///< "ratio 0.5"
    double ratio = -1, error = -1;
    std::size_t level = 0;
};

struct LodsCommand {
    Common common;
    Output output;
    InputOptions input;
    CollapseFlags collapse;
    std::vector<double> ratios, errors;
    std::string pixels;
    bake::SceneFormat format;
    bool separate = false;

    int run();
    /// The reason if the options do not go together.
    std::optional<std::string> check();
    std::vector<Wish> wishes(const Model& model, std::vector<std::string>& notes) const;
    int write(const Model& model, const std::vector<bake::GltfLevel>& levels, std::vector<std::string>& files,
              std::uint64_t& bytes) const;
    Output separate_output(std::size_t level) const;
};

std::optional<std::string> LodsCommand::check() {
    for (const double ratio : ratios)
        if (!(ratio > 0 && ratio <= 1)) return "--ratios wants numbers above 0 and up to 1";
    for (const double error : errors)
        if (!(error >= 0) || !std::isfinite(error)) return "--errors wants distances";
    if (!ratios.empty() && !errors.empty()) return "--ratios or --errors, not both";
    if (!pixels.empty()) {
        char* end = nullptr;
        format.screen.lines = std::strtod(pixels.c_str(), &end);
        if (*end == ':') format.screen.pixels = std::strtod(end + 1, &end);
        if (*end != 0 || !(format.screen.lines >= 1 && format.screen.lines <= 1e6) ||
            !(format.screen.pixels > 0 && format.screen.pixels <= 1e6))
            return "--pixels wants the lines of a screen and pixels, as 1080:1";
    } else if (ratios.empty() && errors.empty()) {
        return "lods wants --ratios, --errors or --pixels";
    }
    if (format.draco && (format.quantised || format.meshopt || format.shared_vertices))
        return "--draco goes with none of --quantized, --meshopt, --shared-vertices";
    if (separate && format.shared_vertices)
        return "--shared-vertices puts the levels into one file, --separate does not";
    if (extension_of(output.path) != ".glb") return "lods writes .glb";
    // Only then does every vertex stay where it is.
    if (format.shared_vertices) collapse.placement = "endpoint";
    return std::nullopt;
}

std::vector<Wish> LodsCommand::wishes(const Model& model, std::vector<std::string>& notes) const {
    std::vector<Wish> out;
    const ProgressiveMesh& mesh = model.mesh;
    for (const double ratio : ratios) out.push_back({fmt::format("ratio {}", ratio), ratio, -1, 0});
    for (const double error : errors) out.push_back({fmt::format("error {}", error), -1, error, 0});
    if (out.empty() && model.radius > 0) {
        // LOD k is what is needed where the scene's ball is a 2^k-th of the screen high.
        const double first = format.screen.pixels * 2 * model.radius / format.screen.lines;
        for (int k = 0; k < 12; ++k) {
            const double error = std::ldexp(first, k);
            out.push_back(
                {fmt::format("{:g} lines high", std::ldexp(format.screen.lines, -k)), -1, error, 0});
            if (level_for_error(mesh, model.mesh_error(error)) == 0) break;
        }
    }
    if (out.empty()) out.push_back({"ratio 1", 1, -1, 0});
    for (Wish& wish : out) {
        if (wish.ratio < 0) {
            wish.level = level_for_error(mesh, model.mesh_error(wish.error));
            continue;
        }
        const std::uint64_t wanted = triangles_for_ratio(mesh, wish.ratio);
        wish.level = level_for_triangles(mesh, wanted);
        if (const auto note = why_not(mesh, wish.level, wanted))
            notes.push_back(fmt::format("{}: {}", wish.name, *note));
    }
    std::stable_sort(out.begin(), out.end(), [](const Wish& a, const Wish& b) { return a.level > b.level; });
    std::vector<Wish> different;
    for (Wish& wish : out) {
        if (!different.empty() && different.back().level == wish.level)
            notes.push_back(fmt::format("{}: the same level as the one before, left out", wish.name));
        else
            different.push_back(std::move(wish));
    }
    return different;
}

/// "car.glb" becomes "car-lod2.glb".
Output LodsCommand::separate_output(std::size_t level) const {
    std::filesystem::path path(output.path);
    path.replace_filename(fmt::format("{}-lod{}{}", path.stem().string(), level, path.extension().string()));
    return {path.string(), output.force};
}

int LodsCommand::write(const Model& model, const std::vector<bake::GltfLevel>& levels,
                       std::vector<std::string>& files, std::uint64_t& bytes) const {
    if (!separate) {
        auto glb = model.encode(levels, format);
        if (!glb) return fail_output(output.path, glb.error());
        files.push_back(output.path);
        bytes = glb->size();
        return write_output(output, *glb);
    }
    for (std::size_t k = 0; k < levels.size(); ++k) {
        const Output one = separate_output(k);
        auto glb = model.encode({&levels[k], 1}, format);
        if (!glb) return fail_output(one.path, glb.error());
        if (const int failed = write_output(one, *glb)) return failed;
        files.push_back(one.path);
        bytes += glb->size();
    }
    return kDone;
}

int LodsCommand::run() {
    if (const auto reason = check()) return fail_usage(*reason);
    if (!separate)
        if (const int refused = check_output(output)) return refused;
    int exit = kDone;
    auto model = load_model(input, collapse, common, exit);
    if (!model) return exit;
    std::vector<std::string> notes;
    notes = model->notes;
    if (model->scene) notes.insert(notes.end(), model->scene->notes.begin(), model->scene->notes.end());
    const std::vector<Wish> cuts = wishes(*model, notes);
    if (separate)
        for (std::size_t k = 0; k < cuts.size(); ++k)
            if (const int refused = check_output(separate_output(k))) return refused;

    const std::size_t full = model->mesh.triangles.size();
    LiveMesh live(std::move(model->mesh));
    std::vector<bake::GltfLevel> levels;
    Json table = Json::array();
    for (const Wish& cut : cuts) {
        live.go_to(cut.level);
        levels.push_back({live.snapshot(), live.error()});
        const Mesh& mesh = levels.back().mesh;
        table.push_back({{"ratio", cut.ratio >= 0 ? cut.ratio
                                                  : double(mesh.triangles.size()) /
                                                        double(std::max<std::size_t>(full, 1))},
                         {"triangles", mesh.triangles.size()},
                         {"vertices", mesh.positions.size()},
                         {"error", model->world_error(levels.back().error)}});
    }
    std::vector<std::string> files;
    std::uint64_t bytes = 0;
    if (const int failed = write(*model, levels, files, bytes)) return failed;
    if (common.json) {
        if (!common.quiet)
            print_json({{"input", input.path},
                        {"output", output.path},
                        {"files", files},
                        {"levels", table},
                        {"bytes", bytes},
                        {"notes", notes}});
        return kDone;
    }
    say(common, fmt::format("{}: {} levels, {} bytes{}", output.path, levels.size(), with_commas(bytes),
                            separate ? fmt::format(" in {} files", files.size()) : ""));
    if (model->posed) say(common, "  " + *model->posed);
    for (std::size_t i = 0; i < levels.size(); ++i)
        say(common, fmt::format("  LOD {}: {:>11} triangles ({:6.2f} %), error {}", i,
                                with_commas(levels[i].mesh.triangles.size()),
                                100.0 * double(levels[i].mesh.triangles.size()) /
                                    double(std::max<std::size_t>(full, 1)),
                                short_number(model->world_error(levels[i].error))));
    if (!common.quiet)
        for (const std::string& note : notes) fmt::print(stderr, "vsplit: {}: {}\n", output.path, note);
    return kDone;
}

}  // namespace

void add_lods(CLI::App& app, int& exit) {
    auto command = std::make_shared<LodsCommand>();
    CLI::App* sub = app.add_subcommand("lods", "Write levels of detail of a scene as glTF");
    sub->footer(
        "Examples:\n"
        "  vsplit lods hero.glb --ratios 1,0.5,0.25,0.1 -o hero-lods.glb     one GLB with MSFT_lod\n"
        "  vsplit lods hero.glb --ratios 0.5,0.1 --separate --draco -o hero.glb\n"
        "  vsplit lods hero.vsplit.glb --pixels 1080:1 --meshopt --quantized -o hero-lods.glb\n"
        "  vsplit lods bunny.pmesh --errors 0,0.001,0.01 -o bunny-lods.glb\n"
        "Screen coverages come from the recorded errors: docs/lods.md.");
    sub->add_option("input", command->input.path,
                    "Scene or mesh (baked on the spot), progressive GLB, or .pmesh")
        ->required()
        ->type_name("FILE");
    sub->add_option("--ratios", command->ratios,
                    "Triangles kept over triangles of the input, or percentages, a comma between")
        ->delimiter(',')
        ->transform(percents());
    sub->add_option("--errors", command->errors,
                    "Largest distances from the input, in the world's units, a comma between")
        ->delimiter(',');
    sub->add_option("--pixels", command->pixels,
                    "Screen height and the pixels that an error may span, as 1080:1: for the screen "
                    "coverages, and for the levels if neither ratios nor errors name them")
        ->type_name("H:P");
    sub->add_flag("--separate", command->separate, "One GLB a level: OUT-lod0.glb, OUT-lod1.glb, ...");
    sub->add_flag("--shared-vertices", command->format.shared_vertices,
                  "Levels share one vertex buffer and differ in indices (bakes with placement endpoint)");
    sub->add_flag("--quantized", command->format.quantised, "Geometry by KHR_mesh_quantization");
    sub->add_flag("--draco", command->format.draco, "Geometry by KHR_draco_mesh_compression");
    sub->add_flag("--meshopt", command->format.meshopt, "Geometry by EXT_meshopt_compression");
    command->output.add_to(*sub, "The .glb to write");
    command->input.add_to(*sub);
    command->input.add_poses_to(*sub);
    command->collapse.add_to(*sub);
    command->common.add_to(*sub);
    sub->callback([command, &exit] { exit = command->run(); });
}

}  // namespace vsplit::app
