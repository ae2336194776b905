// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <sys/resource.h>
#include <tbb/global_control.h>

#include <chrono>
#include <memory>
#include <optional>

#include "cloud.hpp"
#include "collapse_flags.hpp"
#include "command.hpp"
#include "input.hpp"
#include "levels.hpp"
#include "mark_flags.hpp"
#include "model.hpp"
#include "vsplit/bake/collapse.hpp"
#include "vsplit/bake/files.hpp"
#include "vsplit/bake/manyfold.hpp"
#include "vsplit/bake/scene.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/write.hpp"

namespace vsplit::app {
namespace {

struct BakeCommand {
    Common common;
    InputOptions input;
    CloudOptions cloud;
    Output output;
    CollapseFlags collapse;
    MarkFlags marks;
    WriteOptions write;
    double show = 0;  ///< Of a progressive GLB, the ratio that viewers see.
    bool meshopt = false, draco = false;
    bool lossless = false;
    bool shape_only = false;
    bool manyfold = false;  ///< The GLB is one of MANYFOLD_mesh_progressive.
    std::string profile = "quality";

    int run() const;
    WriteOptions rounding() const {
        WriteOptions options = write;
        if (lossless) options.position_bits = 0;
        return options;
    }
    /// A scene into a progressive GLB.
    int run_scene(bake::CollapseOptions options) const;
    /// A mesh, or a scene's shape, into a GLB with MANYFOLD_mesh_progressive.
    int run_manyfold(bake::CollapseOptions options) const;
    /// The mesh to bake; if the input is a cloud of points, the surface made of it, told in `surface`.
    Result<bake::MeshFile> load(const bake::Progress& progress, std::optional<CloudSurface>& surface,
                                std::vector<std::string>& notes, bake::PoseSets& poses, int& exit) const;
};

Result<bake::MeshFile> BakeCommand::load(const bake::Progress& progress, std::optional<CloudSurface>& surface,
                                         std::vector<std::string>& notes, bake::PoseSets& poses,
                                         int& exit) const {
    const auto failed = [&](const Error& error) {
        exit = fail_input(input.path, error);
        return error;
    };
    {
        auto bytes = bake::read_file(input.path);
        if (!bytes) return failed(bytes.error());
        if (is_point_cloud(*bytes, extension_of(input.path))) {
            if (!input.weights.empty())
                return failed({ErrorCode::kArgument, "a point cloud takes no --weights: reconstruct it first",
                               Error::kNowhere, 0});
            auto made = reconstruct_cloud(input.path, *bytes, cloud, common, false, progress, exit);
            if (!made) return made.error();
            bake::MeshFile file;
            file.mesh = std::move(made->mesh);
            file.report.format = "reconstructed from points";
            file.report.vertices_in = file.mesh.positions.size();
            file.report.faces_in = file.mesh.triangles.size();
            surface = std::move(*made);
            return file;
        }
    }
    // Marks of a file number its vertices.
    return shape_only || !marks.marks.empty() ? load_mesh(input, exit)
                                              : load_placed(input, notes, poses, exit);
}

int BakeCommand::run_scene(bake::CollapseOptions options) const {
    const auto start = std::chrono::steady_clock::now();
    auto bytes = bake::read_file(input.path);
    if (!bytes) return fail_input(input.path, bytes.error());
    if (!is_gltf(*bytes, extension_of(input.path)))
        return fail_usage("a progressive GLB is made of a glTF scene; bake a mesh to a .pmesh");
    int exit = kDone;
    auto scene = load_scene(input, *bytes, exit);
    if (!scene) return exit;
    *bytes = {};
    ProgressBar bar(common);
    options.part_of = scene->part_of;
    options.poses = std::move(scene->poses);
    const auto posed = poses_note(options.poses);
    std::optional<MarkReport> marked;
    if (marks.any()) {
        auto report = apply_marks(marks, input.path, scene->mesh, {}, scene->mesh.positions.size(), options,
                                  bar.callback(), exit);
        if (!report) return exit;
        marked = std::move(*report);
    }
    auto result = bake::collapse(scene->mesh, options, bar.callback());
    if (!result) return fail_input(input.path, result.error());
    auto stream = write_progressive_mesh(result->mesh, rounding());
    if (!stream) return fail_output(output.path, stream.error());
    const std::size_t triangles = result->mesh.triangles.size(), splits = result->mesh.splits.size();
    const std::size_t level = level_for_triangles(result->mesh, triangles_for_ratio(result->mesh, show));
    LiveMesh live(std::move(result->mesh));
    live.go_to(level);
    const bake::GltfLevel shown{live.snapshot(), live.error()};
    bake::SceneFormat format;
    format.meshopt = meshopt;
    format.draco = draco;
    auto glb = bake::encode_progressive_scene(*scene, shown, *stream, format);
    if (!glb) return fail_output(output.path, glb.error());
    if (const int failed = write_output(output, *glb)) return failed;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double error = shown.error * scene->unit;
    if (common.json && !common.quiet) {
        Json json = {{"input", input.path},
                     {"output", output.path},
                     {"read", to_json(scene->report)},
                     {"ratio_1_triangles", triangles},
                     {"meshes", scene->parts.size()},
                     {"primitives", scene->primitives.size()},
                     {"attributes", scene->mesh.attributes.size()},
                     {"splits", splits},
                     {"degenerate_triangles", result->report.degenerate_triangles},
                     {"stitched_vertices", result->report.stitched_vertices},
                     {"shown", {{"triangles", shown.mesh.triangles.size()}, {"error", error}}},
                     {"stream_bytes", stream->size()},
                     {"bytes", glb->size()},
                     {"seconds", seconds},
                     {"notes", scene->notes}};
        if (marked) json["marks"] = marked->json();
        print_json(json);
    }
    say(common, fmt::format("{}: {} triangles in {} meshes, {} primitives, {} attributes ({})", input.path,
                            with_commas(triangles), scene->parts.size(), scene->primitives.size(),
                            scene->mesh.attributes.size(), scene->report.format));
    for (const std::string& line : describe(scene->report)) say(common, "  " + line);
    if (result->report.stitched_vertices > 0)
        say(common, fmt::format("  {} boundary vertices beside others collapse with them",
                                with_commas(result->report.stitched_vertices)));
    if (marked)
        for (const std::string& line : marked->describe()) say(common, "  " + line);
    if (posed) say(common, "  " + *posed);
    if (const std::uint64_t dropped = result->report.degenerate_triangles)
        say(common, fmt::format("  {} triangles with two corners at one point, in the full mesh alone",
                                with_commas(dropped)));
    say(common,
        fmt::format("{}: shows {} triangles (error {}), {} splits, {} bytes, {} of them stream, in {:.2f} s",
                    output.path, with_commas(shown.mesh.triangles.size()), short_number(error),
                    with_commas(splits), with_commas(glb->size()), with_commas(stream->size()), seconds));
    if (!common.quiet)
        for (const std::string& note : scene->notes) fmt::print(stderr, "vsplit: {}: {}\n", input.path, note);
    return kDone;
}

int BakeCommand::run_manyfold(bake::CollapseOptions options) const {
    // What is stitched comes apart in splits that the extension cannot tell.
    options.stitch = 0;
    int exit = kDone;
    ProgressBar bar(common);
    auto file = load_mesh(input, exit);
    if (!file) return exit;
    auto result = bake::collapse(file->mesh, options, bar.callback());
    if (!result) return fail_input(input.path, result.error());
    file->mesh = {};
    auto glb = bake::encode_manyfold(result->mesh);
    if (!glb) return fail_input(input.path, glb.error());
    if (const int failed = write_output(output, glb->bytes)) return failed;
    const std::size_t triangles = result->mesh.triangles.size();
    if (common.json) {
        if (!common.quiet)
            print_json({{"input", input.path},
                        {"output", output.path},
                        {"read", to_json(file->report)},
                        {"ratio_1_triangles", triangles},
                        {"base", {{"vertices", glb->base_vertices}, {"triangles", glb->base_triangles}}},
                        {"records", glb->records},
                        {"left_out", glb->left_out},
                        {"bytes", glb->bytes.size()}});
        return kDone;
    }
    for (const std::string& line : describe(file->report)) say(common, "  " + line);
    say(common, fmt::format("{}: {} records from a base of {} triangles to {}, the shape alone, {} bytes",
                            output.path, with_commas(glb->records), with_commas(glb->base_triangles),
                            with_commas(triangles), with_commas(glb->bytes.size())));
    if (glb->left_out > 0)
        say(common,
            fmt::format("  no coarser base: a split before it bears no single vertex in a fan of triangles "
                        "({} coarser splits left out)",
                        with_commas(glb->left_out)));
    return kDone;
}

int BakeCommand::run() const {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    std::optional<tbb::global_control> limit;
    if (common.threads > 0)
        limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(common.threads));
    bake::CollapseOptions options;
    if (const auto reason = collapse.set(options)) return fail_usage(*reason);
    if (const auto reason = marks.fault()) return fail_usage(*reason);
    if (profile == "stream") options.placement = bake::Placement::kEndpoint;
    if (const int refused = check_output(output)) return refused;
    const bool glb = extension_of(output.path) == ".glb";
    if (manyfold && (!glb || meshopt || draco || lossless || shape_only || marks.any() || show != 0))
        return fail_usage(
            "--manyfold writes a .glb of the shape alone, and goes with none of --show, --meshopt, "
            "--draco, --lossless, --shape-only, --marks, --region, --auto-weights and --keep");
    if (shape_only && glb)
        return fail_usage("--shape-only is of a .pmesh; a progressive GLB keeps the scene");
    if (manyfold) return run_manyfold(options);
    if (glb) return run_scene(options);

    int exit = kDone;
    ProgressBar bar(common);
    std::optional<CloudSurface> surface;
    std::vector<std::string> notes;
    auto file = load(bar.callback(), surface, notes, options.poses, exit);
    if (!file) return exit;
    const bake::MeshSurvey survey = bake::survey_mesh(file->mesh);
    std::optional<MarkReport> marked;
    if (marks.any()) {
        auto report = apply_marks(marks, input.path, file->mesh, file->vertex_of, file->report.vertices_in,
                                  options, bar.callback(), exit);
        if (!report) return exit;
        marked = std::move(*report);
    }
    auto result = bake::collapse(file->mesh, options, bar.callback());
    if (!result) return fail_input(input.path, result.error());
    const std::size_t triangles = file->mesh.triangles.size();
    const auto posed = poses_note(options.poses);
    const bool with_attributes = !file->mesh.attributes.empty() || !file->mesh.groups.empty();
    const auto moved = surface ? std::nullopt : origin_note(file->mesh);
    file->mesh = {};
    auto bytes = write_progressive_mesh(result->mesh, rounding());
    if (!bytes) return fail_output(output.path, bytes.error());
    if (const int failed = write_output(output, *bytes)) return failed;

    const ProgressiveMesh& mesh = result->mesh;
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    if (common.json) {
        Json json = {{"input", input.path},
                     {"output", output.path},
                     {"notes", notes},
                     {"read", to_json(file->report)},
                     {"mesh", to_json(survey)},
                     {"ratio_1_triangles", triangles},
                     {"base",
                      {{"vertices", mesh.base_vertices},
                       {"triangles", mesh.base_triangles},
                       {"error", error_at(mesh, 0)}}},
                     {"splits", mesh.splits.size()},
                     {"degenerate_triangles", result->report.degenerate_triangles},
                     {"stitched_vertices", result->report.stitched_vertices},
                     {"components_vanished", result->report.components_vanished},
                     {"fixed_vertices", result->report.fixed_vertices},
                     {"stopped_by", result->report.stopped_by},
                     {"weights", !mesh.weights.empty()},
                     {"attributes", mesh.attributes.size()},
                     {"origin", mesh.origin},
                     {"bytes", bytes->size()},
                     {"seconds", seconds},
                     {"collapse_cpu_seconds", result->report.collapse_cpu_seconds},
                     {"calibrate_cpu_seconds", result->report.calibrate_cpu_seconds},
                     {"peak_memory_bytes", std::uint64_t(usage.ru_maxrss) * 1024}};
        if (surface) json["points"] = surface->report;
        if (marked) json["marks"] = marked->json();
        if (!common.quiet) print_json(json);
        return kDone;
    }
    if (surface)
        for (const std::string& note : surface->notes) say(common, fmt::format("{}: {}", input.path, note));
    say(common,
        fmt::format(
            "{}: {} triangles, {} vertices, {} components, {} boundary edges, {} non-manifold edges ({})",
            input.path, with_commas(survey.triangles), with_commas(survey.vertices),
            with_commas(survey.components), with_commas(survey.boundary_edges),
            with_commas(survey.non_manifold_edges), file->report.format));
    for (const std::string& line : describe(file->report)) say(common, "  " + line);
    if (moved) say(common, "  " + *moved);
    if (file->report.format.starts_with("glTF"))
        say(common,
            with_attributes
                ? fmt::format("  as one mesh in the world's units, with {} attributes; nodes, materials "
                              "and textures are kept by a .glb",
                              mesh.attributes.size())
                : std::string("  the shape alone, as one mesh"));
    if (posed) say(common, "  " + *posed);
    if (const std::uint64_t dropped = result->report.degenerate_triangles)
        say(common, fmt::format("  {} triangles with two corners at one point, in the full mesh alone",
                                with_commas(dropped)));
    if (result->report.stitched_vertices > 0)
        say(common, fmt::format("  {} boundary vertices beside others collapse with them",
                                with_commas(result->report.stitched_vertices)));
    if (marked)
        for (const std::string& line : marked->describe()) say(common, "  " + line);
    if (survey.duplicate_triangles)
        say(common, fmt::format("  {} duplicate triangles, kept", with_commas(survey.duplicate_triangles)));
    if (survey.zero_area_triangles)
        say(common,
            fmt::format("  {} triangles without area, kept", with_commas(survey.zero_area_triangles)));
    say(common,
        fmt::format("{}: {} splits from a base of {} triangles, {} bytes, {:.1f} bits a vertex, in {:.2f} s",
                    output.path, with_commas(mesh.splits.size()), with_commas(mesh.base_triangles),
                    with_commas(bytes->size()),
                    8.0 * double(bytes->size()) / double(std::max<std::size_t>(mesh.positions.size(), 1)),
                    seconds));
    if (!common.quiet)
        for (const std::string& note : notes) fmt::print(stderr, "vsplit: {}: {}\n", input.path, note);
    if (mesh.base_vertices > 64 * std::max<std::uint64_t>(result->report.components, 1))
        say(common, "  no coarser base: " + result->report.stopped_by);
    return kDone;
}

}  // namespace

void add_bake(CLI::App& app, int& exit) {
    auto command = std::make_shared<BakeCommand>();
    CLI::App* sub =
        app.add_subcommand("bake", "Record the full collapse sequence of a mesh or scene as one .pmesh");
    sub->footer(
        "Examples:\n"
        "  vsplit bake bunny.obj -o bunny.pmesh\n"
        "  vsplit bake hero.glb --weights COLOR_0.r -o hero.pmesh     painted red = keep\n"
        "  vsplit bake scan.ply --weights scan-weights.txt --cost paper -o scan.pmesh\n"
        "  vsplit bake hero.ply --marks hero.marks --keep face=95%@40% -o hero.pmesh\n"
        "  vsplit bake scan.xyz -o scan.pmesh                         points: reconstructed first\n"
        "  vsplit bake hero.glb -o hero.vsplit.glb                    the scene too, as a progressive GLB\n"
        "A .pmesh of a scene has its meshes with their attributes, as one mesh; a progressive GLB keeps all "
        "that the scene has.\n"
        "Reads OBJ, PLY, OFF, STL, glTF and GLB; point clouds as .xyz .txt .pts .asc .csv .ply .pcd.");
    sub->add_option("input", command->input.path, "Mesh or scene")->required()->type_name("IN");
    command->output.add_to(*sub,
                           "The .pmesh to write; or .glb, of a scene: a progressive GLB (formats/gltf)");
    command->input.add_to(*sub);
    command->input.add_poses_to(*sub);
    command->cloud.add_to(*sub);
    command->collapse.add_to(*sub);
    command->marks.add_to(*sub);
    sub->add_option(
           "--profile", command->profile,
           "quality: vertices go where levels are best; stream: each stays where it is born, and the "
           "file is a third smaller (--placement endpoint)")
        ->check(CLI::IsMember({"quality", "stream"}))
        ->capture_default_str()
        ->excludes("--placement");
    auto* bits = sub->add_option("--position-bits", command->write.position_bits,
                                 "Places are rounded to this many bits of the longest side")
                     ->check(CLI::Range(2, 20))
                     ->capture_default_str();
    sub->add_flag("--shape-only", command->shape_only,
                  "Of a scene baked to .pmesh: places alone, vertices at one place welded, no attributes");
    sub->add_flag("--lossless", command->lossless, "Keep every float of places and attributes")
        ->excludes(bits);
    sub->add_option("--block-bytes", command->write.block_bytes, "Size that blocks of splits aim at")
        ->check(CLI::Range(1024, 1 << 24))
        ->capture_default_str();
    sub->add_option("--show", command->show, "Of a progressive GLB: the ratio that any viewer shows")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    sub->add_flag("--manyfold", command->manyfold,
                  "A .glb with the proposed extension MANYFOLD_mesh_progressive instead, of any mesh's shape "
                  "(formats/gltf)");
    sub->add_flag("--meshopt", command->meshopt,
                  "Of a progressive GLB: EXT_meshopt_compression of what it shows");
    sub->add_flag("--draco", command->draco, "The same with KHR_draco_mesh_compression")
        ->excludes("--meshopt");
    command->common.add_to(*sub);
    sub->callback([command, &exit] { exit = command->run(); });
}

}  // namespace vsplit::app
