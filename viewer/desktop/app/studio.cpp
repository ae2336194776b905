// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <memory>

#include "../edit/script.hpp"
#include "open.hpp"
#include "vsplit/bake/files.hpp"
#ifdef VSPLIT_VIEWER
#include "../window/display.hpp"
#include "../window/picture.hpp"
#include "../window/window.hpp"
#include "watch.hpp"
#endif

namespace vsplit::app {
namespace {

struct StudioCommand {
    Common common;
    InputOptions input;
    CollapseFlags collapse;
    std::string script, marks, size = "1280x800";
    bool force = false, bench = false;

    int run() const;
    int run_script(studio::Document& document) const;
};

int StudioCommand::run_script(studio::Document& document) const {
    auto text = bake::read_file(script);
    if (!text) return fail_input(script, text.error());
    ProgressBar bar(common);
    studio::ScriptHost host;
    std::string refused;
    host.write = [&](const std::string& path, std::span<const std::byte> bytes) {
        const Status written = bake::write_file(path, bytes, force);
        if (!written) refused = path;
        return written;
    };
    host.read = [](const std::string& path) { return bake::read_file(path); };
    host.progress = bar.callback();
#ifdef VSPLIT_VIEWER
    host.picture = studio::script_picture;
#endif
    Json report;
    const Status done = studio::run_script(
        document, {reinterpret_cast<const char*>(text->data()), text->size()}, host, report);
    if (common.json && !common.quiet)
        print_json({{"input", input.path}, {"script", script}, {"steps", report}});
    if (!common.json)
        for (const Json& step : report) say(common, step.dump());
    if (done) return kDone;
    return refused.empty() ? fail_input(script, done.error()) : fail_output(refused, done.error());
}

int StudioCommand::run() const {
    int exit = kDone;
    if (script.empty()) {
#ifdef VSPLIT_VIEWER
        studio::WindowOptions options;
        if (!studio::parse_size(size, options.width, options.height))
            return fail_usage("--size wants WIDTHxHEIGHT, 320x240 to 8192x8192, not " + size);
        options.bench = bench;
        options.marks = marks;
        if (const Status there = studio::check_display(); !there) return fail_input("studio", there.error());
        bake::CollapseOptions chosen;
        if (const auto reason = collapse.set(chosen)) return fail_usage(*reason);
        auto watched = watch_reconstruction(input.path, options.width, options.height, common.threads, exit);
        if (watched && !*watched) return exit;
        auto document = watched ? document_of(std::move(**watched), collapse, marks, common, exit)
                                : open_document(input, collapse, marks, common, exit);
        if (!document) return exit;
        studio::run_window(std::move(*document), options);
        return kDone;
#else
        return fail_usage(
            "this vsplit was built without the studio's window (VSPLIT_VIEWER); it runs --script");
#endif
    }
    auto document = open_document(input, collapse, marks, common, exit);
    if (!document) return exit;
    return run_script(**document);
}

}  // namespace

void add_studio(CLI::App& app, int& exit) {
    auto command = std::make_shared<StudioCommand>();
    CLI::App* sub = app.add_subcommand("studio", "Paint what matters, see every level, bake again");
    sub->footer(
        "Examples:\n"
        "  vsplit studio hero.glb                                 a window; F1 shows every key\n"
        "  vsplit studio hero.ply --marks hero.marks\n"
        "  vsplit studio hero.ply --script strokes.json           without one (docs/studio.md)");
    sub->add_option("input", command->input.path, "Mesh, scene, point cloud, .pmesh or progressive GLB")
        ->required()
        ->type_name("IN");
    command->input.add_to(*sub);
    command->collapse.add_to(*sub);
    sub->add_option("--marks", command->marks, "Marks or weights to begin with")->type_name("FILE");
    sub->add_option("--script", command->script, "Run these strokes and steps, and end")->type_name("FILE");
    sub->add_flag("--force", command->force, "Let a script overwrite files");
    sub->add_option("--size", command->size, "The window's size")->type_name("WxH")->capture_default_str();
    sub->add_flag("--bench", command->bench,
                  "Measure frames, strokes and bakes in the window, print them, and end");
    command->common.add_to(*sub);
    sub->callback([command, &exit] { exit = command->run(); });
}

}  // namespace vsplit::app
