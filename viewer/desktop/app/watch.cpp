// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "watch.hpp"

#include "cloud.hpp"
#include "vsplit/bake/files.hpp"
#ifdef VSPLIT_WITH_CGAL
#include "../window/stages.hpp"
#include "vsplit/bake/points.hpp"
#include "vsplit/bake/surface.hpp"
#endif

namespace vsplit::app {

#ifndef VSPLIT_WITH_CGAL

std::optional<Result<studio::Source>> watch_reconstruction(const std::string&, int, int, int, int&) {
    return std::nullopt;  // opening the file says why
}

#else

std::optional<Result<studio::Source>> watch_reconstruction(const std::string& path, int width, int height,
                                                           int threads, int& exit) {
    const auto bytes = bake::read_file(path);
    if (!bytes || !is_point_cloud(*bytes, extension_of(path))) return std::nullopt;
    const auto failed = [&](const Error& error) -> Result<studio::Source> {
        exit = fail_input(path, error);
        return error;
    };
    auto points = bake::parse_points(*bytes, extension_of(path));
    if (!points) return failed(points.error());
    studio::Stages stages(width, height, "vsplit studio - " + path);
    stages.points(points->cloud.positions);
    const bake::Progress progress = [&](std::string_view stage, double done) {
        return stages.progress(stage, done);
    };
    bake::CleanOptions clean;
    clean.threads = threads;
    auto cleaned = bake::clean_points(std::move(points->cloud), clean, progress);
    if (!cleaned) return failed(cleaned.error());
    bake::ReconstructOptions options;
    options.threads = threads;
    options.dumps = bake::kDumpPoles;
    options.sink = [&](std::string_view name, std::span<const std::byte> data) {
        if (name == "poles.vtp") stages.poles(data);
    };
    auto made = bake::reconstruct(cleaned->cloud.positions, options, progress);
    if (!made) return failed(made.error());
    stages.crust(made->mesh);
    studio::Source source;
    source.path = path;
    source.mesh = std::move(made->mesh);
    return source;
}

#endif

}  // namespace vsplit::app
