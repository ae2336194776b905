// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <memory>

#include "command.hpp"
#include "levels.hpp"
#include "model.hpp"
#include "vsplit/bake/gltf.hpp"
#include "vsplit/bake/meshes.hpp"
#include "vsplit/live_mesh.hpp"

namespace vsplit::app {
namespace {

struct ExtractCommand {
    Common common;
    Output output;
    std::string input;
    double ratio = -1, error = -1;
    std::int64_t triangles = -1, vertices = -1;

    int run() const;
};

int ExtractCommand::run() const {
    if ((ratio >= 0) + (error >= 0) + (triangles >= 0) + (vertices >= 0) != 1)
        return fail_usage("extract wants one of --ratio, --triangles, --vertices, --error");
    const std::string extension = extension_of(output.path);
    if (extension != ".glb" && extension != ".ply" && extension != ".obj")
        return fail_usage("extract writes .glb, .ply or .obj, not '" + extension + "'");
    if (const int refused = check_output(output)) return refused;
    int exit = kDone;
    InputOptions source;
    source.path = input;
    auto model = load_model(source, {}, common, exit);
    if (!model) return exit;
    ProgressiveMesh* mesh = &model->mesh;

    std::optional<std::string> note;
    std::size_t level = 0;
    if (ratio >= 0 || triangles >= 0) {
        const std::uint64_t wanted =
            ratio >= 0 ? triangles_for_ratio(*mesh, ratio) : std::uint64_t(triangles);
        level = level_for_triangles(*mesh, wanted);
        if (wanted <= mesh->triangles.size())
            note = why_not(*mesh, level, wanted);
        else
            note = fmt::format("{} triangles asked for, the full mesh has {}", with_commas(wanted),
                               with_commas(mesh->triangles.size()));
    } else if (vertices >= 0) {
        level = level_for_vertices(*mesh, std::uint64_t(vertices));
        const std::uint64_t got = vertices_at(*mesh, level);
        if (got != std::uint64_t(vertices))
            note = fmt::format("{} vertices asked for, {} is the nearest",
                               with_commas(std::uint64_t(vertices)), with_commas(got));
    } else {
        level = level_for_error(*mesh, model->mesh_error(error));
    }
    const double recorded = model->world_error(error_at(*mesh, level));
    const std::size_t full = mesh->triangles.size();
    const double own_error = error_at(*mesh, level);
    LiveMesh live(std::move(*mesh));
    live.go_to(level);
    const bake::GltfLevel one{live.snapshot(), own_error};
    const Mesh& cut = one.mesh;
    std::vector<std::byte> bytes;
    if (extension == ".glb" || model->scene) {
        auto glb = model->encode({&one, 1}, {});
        if (!glb) return fail_output(output.path, glb.error());
        bytes = std::move(*glb);
    }
    if (extension != ".glb") {
        // A scene's meshes are put where its nodes place them.
        Mesh placed;
        if (model->scene) {
            auto world = bake::parse_gltf(bytes, "");
            if (!world) return fail_output(output.path, world.error());
            placed = std::move(world->mesh);
        }
        const Mesh& written = model->scene ? placed : cut;
        bytes = extension == ".ply" ? bake::encode_ply(written) : bake::encode_obj(written);
    }
    if (const int failed = write_output(output, bytes)) return failed;
    const double kept = full > 0 ? double(cut.triangles.size()) / double(full) : 1;
    if (common.json) {
        Json json = {{"input", input},
                     {"output", output.path},
                     {"level", level},
                     {"triangles", cut.triangles.size()},
                     {"vertices", cut.positions.size()},
                     {"ratio", kept},
                     {"error", recorded},
                     {"bytes", bytes.size()}};
        if (note) json["note"] = *note;
        if (!model->notes.empty()) json["notes"] = model->notes;
        if (!common.quiet) print_json(json);
        return kDone;
    }
    say(common, fmt::format("{}: {} triangles ({:.2f} %), {} vertices, error {}, {} bytes", output.path,
                            with_commas(cut.triangles.size()), 100 * kept, with_commas(cut.positions.size()),
                            short_number(recorded), with_commas(bytes.size())));
    if (!common.quiet)
        for (const std::string& line : model->notes) fmt::print(stderr, "vsplit: {}: {}\n", input, line);
    if (note && !common.quiet) fmt::print(stderr, "vsplit: {}: {}\n", output.path, *note);
    return kDone;
}

}  // namespace

void add_extract(CLI::App& app, int& exit) {
    auto command = std::make_shared<ExtractCommand>();
    CLI::App* sub =
        app.add_subcommand("extract", "Cut one level of detail out of a .pmesh or progressive GLB");
    sub->footer(
        "Examples:\n"
        "  vsplit extract bunny.pmesh --ratio 0.4 -o bunny-40.glb\n"
        "  vsplit extract bunny.pmesh --triangles 5000 -o bunny-5k.ply\n"
        "  vsplit extract bunny.pmesh --error 0.001 -o bunny-fine.obj     coarsest level within that "
        "distance");
    sub->add_option("input", command->input,
                    "The .pmesh, progressive GLB, or a mesh or scene (baked on the spot)")
        ->required()
        ->type_name("FILE");
    command->output.add_to(*sub, "Mesh to write: .glb, .ply or .obj");
    sub->add_option("--ratio", command->ratio,
                    "Triangles kept over triangles of the input, 0 to 1, or as 40%")
        ->transform(percents())
        ->check(CLI::Range(0.0, 1.0));
    sub->add_option("--triangles", command->triangles, "At most so many triangles")
        ->check(CLI::NonNegativeNumber);
    sub->add_option("--vertices", command->vertices, "At most so many vertices")
        ->check(CLI::NonNegativeNumber);
    sub->add_option("--error", command->error, "At most this distance from the full mesh, in its units")
        ->check(CLI::NonNegativeNumber);
    command->common.add_to(*sub);
    sub->callback([command, &exit] { exit = command->run(); });
}

}  // namespace vsplit::app
