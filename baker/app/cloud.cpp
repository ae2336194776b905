// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "cloud.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#ifdef VSPLIT_WITH_CGAL
#include "input.hpp"
#include "vsplit/bake/files.hpp"
#include "vsplit/bake/points.hpp"
#include "vsplit/bake/surface.hpp"
#endif

namespace vsplit::app {

void CloudOptions::add_to(CLI::App& command) {
    const char* group = "Points";
    command
        .add_option("--method", method,
                    "How a surface is made of points: modified, or classic (docs/reconstruction.md)")
        ->check(CLI::IsMember({"modified", "classic"}))
        ->capture_default_str()
        ->group(group);
    command
        .add_flag("--open", open,
                  "The points cover a sheet with a boundary, like terrain: trim what no point supports")
        ->group(group);
    command
        .add_option(
            "--clean", clean,
            "auto measures spacing and noise and cleans accordingly; none takes the points as they are")
        ->check(CLI::IsMember({"auto", "none"}))
        ->capture_default_str()
        ->group(group);
    command
        .add_option(
            "--outliers", outlier_factor,
            "Drop points whose third neighbour is so many times farther than usual around; 0 keeps all")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str()
        ->group(group);
    command.add_option("--thin", thin, "Thin the points: none, grid, or wlop")
        ->check(CLI::IsMember({"none", "grid", "wlop"}))
        ->capture_default_str()
        ->group(group);
    command.add_option("--grid-cell", grid_cell, "Side of a cell of --thin grid; 0: twice the spacing")
        ->check(CLI::NonNegativeNumber)
        ->group(group);
    command.add_option("--wlop-share", wlop_share, "Share of the points that --thin wlop keeps")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str()
        ->group(group);
    command.add_option("--smooth", smooth, "Smooth noise: auto, none, jet, or bilateral")
        ->check(CLI::IsMember({"auto", "none", "jet", "bilateral"}))
        ->capture_default_str()
        ->group(group);
}

bool is_point_cloud(std::span<const std::byte> bytes, const std::string& extension) {
    for (const char* points : {".xyz", ".txt", ".pts", ".asc", ".csv", ".pcd"})
        if (extension == points) return true;
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()),
                                std::min<std::size_t>(bytes.size(), 65536));
    if (text.substr(0, 3) != "ply") return false;
    const std::string_view header = text.substr(0, text.find("end_header"));
    const auto has = [&](std::string_view element) {
        const std::size_t at = header.find(element);
        return at != std::string_view::npos && header.substr(at + element.size(), 2) != " 0";
    };
    return header.find("element vertex") != std::string_view::npos && !has("element face") &&
           !has("element tristrips");
}

#ifndef VSPLIT_WITH_CGAL

Result<CloudSurface> reconstruct_cloud(const std::string& path, std::span<const std::byte>,
                                       const CloudOptions&, const Common&, bool, const bake::Progress&,
                                       int& exit) {
    const Error error{
        ErrorCode::kUnsupported,
        "a point cloud, and this vsplit was built without reconstruction (VSPLIT_WITH_CGAL=OFF)",
        Error::kNowhere, 0};
    exit = fail_input(path, error);
    return error;
}

#else

namespace {

Json to_json(const bake::CleanReport& r) {
    return {{"points_in", r.points_in},
            {"duplicates", r.duplicates},
            {"outliers", r.outliers},
            {"thinned", r.thinned},
            {"points_out", r.points_out},
            {"spacing", r.measure.spacing},
            {"noise", r.measure.noise},
            {"smooth_neighbours", r.smooth_neighbours},
            {"steps", r.steps}};
}

Json to_json(const bake::CrustReport& r) {
    Json stages = Json::array();
    for (const bake::CrustStage& s : r.stages)
        stages.push_back({{"name", s.name},
                          {"cpu_seconds", s.cpu_seconds},
                          {"wall_seconds", s.wall_seconds},
                          {"peak_bytes", s.peak_bytes}});
    return {{"points_in", r.points_in},
            {"duplicates", r.duplicates},
            {"cells", r.cells},
            {"poles", r.poles},
            {"poles_hidden", r.poles_hidden},
            {"samples_unused", r.samples_unused},
            {"components_dropped", r.components_dropped},
            {"triangles_dropped", r.triangles_dropped},
            {"triangles_trimmed", r.triangles_trimmed},
            {"slivers_left", r.slivers_left},
            {"vertices", r.vertices},
            {"triangles", r.triangles},
            {"components", r.components},
            {"boundary_loops", r.boundary_loops},
            {"genus", r.genus},
            {"watertight", r.watertight},
            {"stages", stages}};
}

unsigned dump_of(const std::string& name) {
    if (name == "voronoi") return bake::kDumpVoronoi;
    if (name == "poles") return bake::kDumpPoles;
    if (name == "power") return bake::kDumpPower;
    if (name == "labels") return bake::kDumpLabels;
    return 0;
}

bake::CleanOptions clean_options(const CloudOptions& options, int threads) {
    bake::CleanOptions clean;
    clean.threads = threads;
    clean.outlier_factor = options.outlier_factor;
    clean.grid_cell = options.grid_cell;
    clean.wlop_share = options.wlop_share;
    clean.thin = options.thin == "grid"   ? bake::Thin::kGrid
                 : options.thin == "wlop" ? bake::Thin::kWlop
                                          : bake::Thin::kNone;
    clean.smooth = options.smooth == "none"        ? bake::Smooth::kNone
                   : options.smooth == "jet"       ? bake::Smooth::kJet
                   : options.smooth == "bilateral" ? bake::Smooth::kBilateral
                                                   : bake::Smooth::kAuto;
    return clean;
}

}  // namespace

Result<CloudSurface> reconstruct_cloud(const std::string& path, std::span<const std::byte> bytes,
                                       const CloudOptions& options, const Common& common, bool force,
                                       const bake::Progress& progress, int& exit) {
    const auto failed = [&](const std::string& file, const Error& error, bool output) {
        exit = output ? fail_output(file, error) : fail_input(file, error);
        return error;
    };
    auto file = bake::parse_points(bytes, extension_of(path));
    if (!file) return failed(path, file.error(), false);
    CloudSurface surface;
    surface.report = {{"format", file->report.format},
                      {"points", file->report.points_in},
                      {"points_dropped_non_finite", file->report.points_dropped_non_finite},
                      {"columns_ignored", file->report.columns_ignored}};
    surface.notes.push_back(
        fmt::format("{} points ({})", with_commas(file->report.points_in), file->report.format));
    if (file->report.points_dropped_non_finite > 0)
        surface.notes.push_back(fmt::format("{} points left out that are no finite numbers",
                                            with_commas(file->report.points_dropped_non_finite)));
    if (options.clean == "auto") {
        auto cleaned =
            bake::clean_points(std::move(file->cloud), clean_options(options, common.threads), progress);
        if (!cleaned) return failed(path, cleaned.error(), false);
        surface.report["clean"] = to_json(cleaned->report);
        for (const std::string& step : cleaned->report.steps) surface.notes.push_back(step);
        file->cloud = std::move(cleaned->cloud);
    }
    bake::ReconstructOptions reconstruct;
    reconstruct.method =
        options.method == "classic" ? bake::CrustMethod::kClassic : bake::CrustMethod::kModified;
    reconstruct.open = options.open;
    reconstruct.medial_axis = !options.medial_axis.empty();
    reconstruct.threads = common.threads;
    std::string folder;
    Status dumped = Ok{};
    std::string dump_file;
    if (!options.dumps.empty()) {
        folder = options.dumps.back();
        for (std::size_t i = 0; i + 1 < options.dumps.size(); ++i)
            reconstruct.dumps |= dump_of(options.dumps[i]);
        reconstruct.sink = [&](std::string_view name, std::span<const std::byte> data) {
            if (!dumped) return;
            dump_file = (std::filesystem::path(folder) / name).string();
            dumped = bake::write_file(dump_file, data, force);
        };
    }
    if (!file->cloud.positions.empty()) {
        auto low = file->cloud.positions.front(), high = low;
        for (const auto& p : file->cloud.positions)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                low[axis] = std::min(low[axis], p[axis]);
                high[axis] = std::max(high[axis], p[axis]);
            }
        reconstruct.origin = bake::local_origin(low, high);
    }
    auto made = bake::reconstruct(file->cloud.positions, reconstruct, progress);
    if (!made) return failed(path, made.error(), false);
    if (!dumped) return failed(dump_file, dumped.error(), true);
    if (!options.medial_axis.empty()) {
        if (const Status written =
                bake::write_file(options.medial_axis, bake::encode_medial_axis(made->medial_axis), force);
            !written)
            return failed(options.medial_axis, written.error(), true);
    }
    surface.mesh = std::move(made->mesh);
    const bake::CrustReport& r = made->report;
    surface.report["reconstruct"] = to_json(r);
    surface.notes.push_back(
        fmt::format("surface: {} triangles, {} vertices, {}, genus {}, {}", with_commas(r.triangles),
                    with_commas(r.vertices),
                    r.components == 1 ? "1 component" : with_commas(r.components) + " components", r.genus,
                    r.watertight ? "watertight" : fmt::format("{} boundary loops", r.boundary_loops)));
    if (const auto note = origin_note(surface.mesh)) surface.notes.push_back(*note);
    surface.report["origin"] = surface.mesh.origin;
    if (r.components_dropped > 0)
        surface.notes.push_back(fmt::format("{} small components dropped ({} triangles)",
                                            with_commas(r.components_dropped),
                                            with_commas(r.triangles_dropped)));
    if (r.triangles_trimmed > 0)
        surface.notes.push_back(
            fmt::format("{} triangles trimmed that no point supports", with_commas(r.triangles_trimmed)));
    return surface;
}

#endif

}  // namespace vsplit::app
