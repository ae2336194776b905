// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <memory>

#include "cloud.hpp"
#include "command.hpp"
#include "vsplit/bake/files.hpp"
#include "vsplit/bake/gltf.hpp"
#include "vsplit/bake/meshes.hpp"

namespace vsplit::app {
namespace {

struct ReconstructCommand {
    Common common;
    Output output;
    CloudOptions cloud;
    std::string input;

    int run() const;
};

int ReconstructCommand::run() const {
    const std::string extension = extension_of(output.path);
    if (extension != ".ply" && extension != ".obj" && extension != ".glb")
        return fail_usage("reconstruct writes .ply, .glb or .obj, not '" + extension + "'");
    for (std::size_t i = 0; i + 1 < cloud.dumps.size(); ++i)
        if (const std::string& what = cloud.dumps[i];
            what != "voronoi" && what != "poles" && what != "power" && what != "labels")
            return fail_usage("--dump knows voronoi, poles, power and labels, then a folder; not '" + what +
                              "'");
    if (cloud.dumps.size() == 1)
        return fail_usage("--dump wants what to write, then a folder: --dump poles DIR");
    if (const int refused = check_output(output)) return refused;
    auto bytes = bake::read_file(input);
    if (!bytes) return fail_input(input, bytes.error());
    int exit = kDone;
    ProgressBar bar(common);
    auto surface = reconstruct_cloud(input, *bytes, cloud, common, output.force, bar.callback(), exit);
    if (!surface) return exit;
    std::vector<std::byte> out;
    if (extension == ".glb") {
        const bake::GltfLevel one{std::move(surface->mesh), 0};
        auto glb = bake::encode_glb({&one, 1});
        if (!glb) return fail_output(output.path, glb.error());
        out = std::move(*glb);
    } else {
        out = extension == ".ply" ? bake::encode_ply(surface->mesh) : bake::encode_obj(surface->mesh);
    }
    if (const int failed = write_output(output, out)) return failed;
    if (common.json && !common.quiet) {
        Json json = {{"input", input}, {"output", output.path}, {"bytes", out.size()}};
        json.update(surface->report);
        print_json(json);
    }
    say(common, fmt::format("{}: {} bytes", output.path, with_commas(out.size())));
    for (const std::string& note : surface->notes) say(common, "  " + note);
    return kDone;
}

}  // namespace

void add_reconstruct(CLI::App& app, int& exit) {
    auto command = std::make_shared<ReconstructCommand>();
    CLI::App* sub = app.add_subcommand("reconstruct", "Make a surface of a point cloud (Power Crust)");
    sub->footer(
        "Examples:\n"
        "  vsplit reconstruct scan.xyz -o scan.ply\n"
        "  vsplit reconstruct tile.ply --open -o terrain.glb              terrain: one sheet with a "
        "boundary\n"
        "  vsplit reconstruct scan.xyz --method classic --medial-axis axis.vtp --dump poles labels DIR -o "
        "scan.obj\n"
        "Reads .xyz .txt .pts .asc .csv .ply .pcd.");
    sub->add_option("input", command->input, "Point cloud")->required()->type_name("IN");
    command->output.add_to(*sub, "Mesh to write: .ply, .glb or .obj");
    command->cloud.add_to(*sub);
    sub->add_option("--medial-axis", command->cloud.medial_axis,
                    "Write the poles and the power shape as VTK XML (.vtp)")
        ->type_name("FILE")
        ->group("Points");
    sub->add_option("--dump", command->cloud.dumps,
                    "Write voronoi, poles, power or labels as VTK XML into a folder")
        ->type_name("WHAT... DIR")
        ->group("Points");
    command->common.add_to(*sub);
    sub->callback([command, &exit] { exit = command->run(); });
}

}  // namespace vsplit::app
