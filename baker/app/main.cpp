// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The vsplit command.
#include <fmt/format.h>

#include <cstdlib>
#include <new>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include "command.hpp"
#include "vsplit/version.hpp"

int main(int argc, char** argv) {
    using namespace vsplit::app;
#if defined(__GLIBC__)
    // What a stage frees is for the next one or the system; by itself glibc raises this limit until arrays of
    // megabytes stay in its heap. A bake's peak is a seventh lower.
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
    CLI::App app{
        "vsplit: progressive meshes. One .pmesh file holds a base mesh and every vertex split back to the "
        "full model.\n\n"
        "  vsplit bake hero.glb -o hero.pmesh              record the whole collapse sequence\n"
        "  vsplit extract hero.pmesh --ratio 0.4 -o hero-40.glb\n"
        "  vsplit lods hero.pmesh --ratios 1,0.5,0.25 -o hero-lods.glb\n"};
    app.name("vsplit");
    app.set_version_flag("--version", std::string("vsplit ") + vsplit::version());
    app.require_subcommand(1);
    app.failure_message(CLI::FailureMessage::simple);
    int exit = kDone;
    add_bake(app, exit);
    add_reconstruct(app, exit);
    add_extract(app, exit);
    add_lods(app, exit);
    add_info(app, exit);
    add_verify(app, exit);
    add_sample(app, exit);
    add_serve(app, exit);
    add_studio(app, exit);
#ifdef VSPLIT_VIEWER
    add_render(app, exit);
#endif
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? kDone : kUsage;
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "vsplit: not enough memory\n");
        return kFailed;
    }
    if (std::fflush(stdout) != 0 && exit == kDone) {
        fmt::print(stderr, "vsplit: cannot write to the standard output\n");
        return kBadOutput;
    }
    return exit;
}
