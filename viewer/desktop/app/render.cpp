// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <memory>

#include "../window/display.hpp"
#include "../window/picture.hpp"
#include "cloud.hpp"
#include "model.hpp"
#include "open.hpp"
#include "vsplit/bake/files.hpp"
#ifdef VSPLIT_WITH_CGAL
#include "vsplit/bake/points.hpp"
#endif

namespace vsplit::app {
namespace {

struct RenderCommand {
    Common common;
    InputOptions input;
    CollapseFlags collapse;
    Output output;
    std::string marks, view = "iso", heat = "none", size = "1280x800";
    double ratio = 1;
    std::optional<double> error;
    bool wireframe = false, flat = false, plain = false;

    int run() const;
    int finish(Result<std::vector<std::byte>> png, Json shown) const;
    Result<std::vector<std::byte>> textured(const studio::Document& document, int width, int height) const;
};

int RenderCommand::finish(Result<std::vector<std::byte>> png, Json shown) const {
    if (!png) return fail_input(input.path, png.error());
    if (const int failed = write_output(output, *png)) return failed;
    if (common.json && !common.quiet) {
        Json report{{"input", input.path}, {"output", output.path}, {"bytes", png->size()}, {"size", size}};
        report.update(shown);
        print_json(report);
    }
    say(common, fmt::format("{}: {} bytes", output.path, with_commas(png->size())));
    return kDone;
}

Result<std::vector<std::byte>> RenderCommand::textured(const studio::Document& document, int width,
                                                       int height) const {
    const bake::GltfLevel level{document.live().snapshot(), document.live().error()};
    auto glb = bake::encode_scene(*document.source().scene, {&level, 1});
    if (!glb) return glb.error();
    // VTK's importer wants a file; external textures were taken into the GLB.
    std::string folder = (std::filesystem::temp_directory_path() / "vsplit-render-XXXXXX").string();
    if (!mkdtemp(folder.data())) return Error{ErrorCode::kIo, "no temporary folder", Error::kNowhere, 0};
    const std::string path = folder + "/level.glb";
    const Status written = bake::write_file(path, *glb, true);
    auto png = written ? studio::picture_of_glb(path, view, width, height, wireframe)
                       : Result<std::vector<std::byte>>(written.error());
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    return png;
}

int RenderCommand::run() const {
    int width = 0, height = 0;
    if (!studio::parse_size(size, width, height))
        return fail_usage("--size wants WIDTHxHEIGHT, 16 to 8192, not " + size);
    if (!studio::camera_for({{0, 0, 0}, {1, 1, 1}}, view, width, height))
        return fail_usage("--view is front, back, left, right, top, bottom, iso, or AZIMUTH,ELEVATION, not " +
                          view);
    if (extension_of(output.path) != ".png") return fail_usage("pictures are written as .png");
    if (const int refused = check_output(output)) return refused;
    if (const Status there = studio::check_display(); !there) return fail_input("render", there.error());
    int exit = kDone;
#ifdef VSPLIT_WITH_CGAL
    {
        auto bytes = bake::read_file(input.path);
        if (!bytes) return fail_input(input.path, bytes.error());
        if (is_point_cloud(*bytes, extension_of(input.path))) {
            auto points = bake::parse_points(*bytes, extension_of(input.path));
            if (!points) return fail_input(input.path, points.error());
            std::vector<Float3> positions;
            for (const auto& p : points->cloud.positions)
                positions.push_back({float(p[0]), float(p[1]), float(p[2])});
            const auto camera = studio::camera_for(studio::box_of(positions), view, width, height);
            return finish(studio::picture_of_points(positions, *camera), {{"points", positions.size()}});
        }
    }
#endif
    auto document = open_document(input, collapse, marks, common, exit);
    if (!document) return exit;
    studio::Document& d = **document;
    d.go_to(error ? level_for_error(d.live().state(), *error) : d.level_for_ratio(ratio));
    const studio::Look look{flat, wireframe, *studio::heat_of(heat)};
    const Json shown{{"triangles", d.live().triangles().size()},
                     {"vertices", d.live().positions().size()},
                     {"ratio", d.ratio()},
                     {"error", d.live().error()}};
    const bool painted = !d.painting().marks().regions.empty();
    if (d.source().scene && look.heat == studio::Heat::kNone && !plain && !painted)
        return finish(textured(d, width, height), shown);
    return finish(studio::picture(d, *studio::camera_for(d.box(), view, width, height), look), shown);
}

}  // namespace

void add_render(CLI::App& app, int& exit) {
    auto command = std::make_shared<RenderCommand>();
    CLI::App* sub = app.add_subcommand("render", "Draw a level as a PNG");
    sub->footer(
        "Examples:\n"
        "  vsplit render hero.pmesh --ratio 0.4 --view right --wireframe -o hero-40.png\n"
        "  vsplit render hero.ply --marks hero.marks --heat weight -o weights.png\n"
        "  vsplit render scan.xyz -o points.png\n"
        "Needs an X display; without one: xvfb-run -a vsplit render ...");
    sub->add_option("input", command->input.path, "Mesh, scene, point cloud, .pmesh or progressive GLB")
        ->required()
        ->type_name("IN");
    command->output.add_to(*sub, "The .png to write");
    auto* ratio = sub->add_option("--ratio", command->ratio,
                                  "The finest level with so many of the triangles, 0 to 1, or as 40%")
                      ->transform(percents())
                      ->check(CLI::Range(0.0, 1.0))
                      ->capture_default_str();
    sub->add_option("--error", command->error, "The coarsest level with at most this error, object's units")
        ->check(CLI::NonNegativeNumber)
        ->excludes(ratio);
    sub->add_option("--view", command->view,
                    "front, back, left, right, top, bottom, iso, or AZIMUTH,ELEVATION in degrees")
        ->capture_default_str();
    sub->add_option("--size", command->size, "Pixels")->type_name("WxH")->capture_default_str();
    sub->add_option("--heat", command->heat, "Colour by error, weight, curvature or quality; none: regions")
        ->check(CLI::IsMember({"none", "error", "weight", "curvature", "quality"}))
        ->capture_default_str();
    sub->add_option("--marks", command->marks, "Marks or weights to show")->type_name("FILE");
    sub->add_flag("--wireframe", command->wireframe, "Draw the edges too");
    sub->add_flag("--flat", command->flat, "A shade a triangle");
    sub->add_flag("--plain", command->plain, "Of a scene: without its materials and textures");
    command->input.add_to(*sub);
    command->collapse.add_to(*sub);
    command->common.add_to(*sub);
    sub->callback([command, &exit] { exit = command->run(); });
}

}  // namespace vsplit::app
