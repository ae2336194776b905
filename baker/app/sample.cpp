// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <memory>

#include "command.hpp"
#include "vsplit/bake/gltf.hpp"
#include "vsplit/bake/meshes.hpp"
#include "vsplit/bake/samples.hpp"

namespace vsplit::app {
namespace {

struct SampleCommand {
    Common common;
    Output output;
    std::string name;
    std::uint64_t points = 0;
    bool mesh = false;
    std::uint64_t triangles = 100000;

    int run() const;
};

std::vector<std::byte> text_of(const std::vector<Float3>& points) {
    std::string text;
    text.reserve(points.size() * 36);
    for (const Float3& p : points) fmt::format_to(std::back_inserter(text), "{} {} {}\n", p.x, p.y, p.z);
    const auto* data = reinterpret_cast<const std::byte*>(text.data());
    return {data, data + text.size()};
}

int SampleCommand::run() const {
    if (mesh == (points > 0)) return fail_usage("sample wants one of --points N and --mesh");
    const auto sample = name == "whale" ? bake::Sample::kWhale : bake::Sample::kOcean;
    const std::string extension = extension_of(output.path);
    if (const int refused = check_output(output)) return refused;
    std::vector<std::byte> bytes;
    std::string what;
    if (mesh) {
        if (extension != ".ply" && extension != ".obj" && extension != ".glb")
            return fail_usage("a sample mesh is written as .ply, .obj or .glb");
        const Mesh made = bake::make_sample_mesh(sample, triangles);
        if (extension == ".glb") {
            const bake::GltfLevel one{made, 0};
            auto glb = bake::encode_glb({&one, 1});
            if (!glb) return fail_output(output.path, glb.error());
            bytes = std::move(*glb);
        } else {
            bytes = extension == ".ply" ? bake::encode_ply(made) : bake::encode_obj(made);
        }
        what = with_commas(made.triangles.size()) + " triangles";
    } else {
        if (extension != ".xyz" && extension != ".txt")
            return fail_usage("sample points are written as .xyz or .txt");
        bytes = text_of(bake::make_sample_points(sample, points));
        what = with_commas(points) + " points";
    }
    if (const int failed = write_output(output, bytes)) return failed;
    if (common.json && !common.quiet)
        print_json({{"output", output.path}, {"sample", name}, {"bytes", bytes.size()}});
    say(common,
        fmt::format("{}: {} of the {}, {} bytes", output.path, what, name, with_commas(bytes.size())));
    return kDone;
}

}  // namespace

void add_sample(CLI::App& app, int& exit) {
    auto command = std::make_shared<SampleCommand>();
    CLI::App* sub = app.add_subcommand("sample", "Make a sample model: a closed whale, or a bounded sea");
    sub->footer(
        "Examples:\n"
        "  vsplit sample whale --mesh -o whale.ply\n"
        "  vsplit sample ocean --points 20000 -o ocean.xyz");
    sub->add_option("name", command->name, "whale or ocean")
        ->required()
        ->check(CLI::IsMember({"whale", "ocean"}));
    sub->add_option("--points", command->points, "Write so many points of the surface")
        ->check(CLI::Range(4, 20'000'000));
    sub->add_flag("--mesh", command->mesh, "Write a mesh");
    sub->add_option("--triangles", command->triangles, "About so many triangles, with --mesh")
        ->check(CLI::Range(100, 20'000'000))
        ->capture_default_str();
    command->output.add_to(*sub, "The file to write: .xyz or .txt for points; .ply, .obj or .glb for a mesh");
    command->common.add_to(*sub);
    sub->callback([command, &exit] { exit = command->run(); });
}

}  // namespace vsplit::app
