// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "model.hpp"
#include "vsplit/bake/files.hpp"
#include "vsplit/bake/gltf.hpp"

namespace vsplit::app {
namespace {

bake::Weld weld_of(const std::string& name) {
    if (name == "none") return bake::Weld::kNone;
    if (name == "boundary") return bake::Weld::kBoundary;
    if (name == "all") return bake::Weld::kAll;
    return bake::Weld::kAuto;
}

}  // namespace

void InputOptions::add_to(CLI::App& command) {
    command
        .add_option("--weights", weights,
                    "Painted weights: a text file with one number a vertex, the name of a PLY property, or a "
                    "colour channel of a glTF "
                    "(COLOR_0.r). Without: a PLY's own 'quality' or 'weight'")
        ->type_name("FILE|NAME");
    command
        .add_option("--weld", weld, "Which vertices at the same place become one: auto, none, boundary, all")
        ->check(CLI::IsMember({"auto", "none", "boundary", "all"}))
        ->capture_default_str();
}

void InputOptions::add_poses_to(CLI::App& command) {
    poses = 8;
    command
        .add_option(
            "--poses", poses,
            "Of a scene: moments of its animations at which skinned and morphing meshes are measured, "
            "besides the bind pose; 0: none")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
}

std::optional<std::string> poses_note(const bake::PoseSets& poses) {
    std::size_t most = 0;
    for (const auto& set : poses.sets) most = std::max(most, set.size());
    if (most == 0) return {};
    return fmt::format("measured in {} pose{} of its animations, too", most, most == 1 ? "" : "s");
}

Result<bake::MeshFile> load_mesh(const InputOptions& options, int& exit) {
    const auto failed = [&](const std::string& file, const Error& error) {
        exit = fail_input(file, error);
        return error;
    };
    auto bytes = bake::read_file(options.path);
    if (!bytes) return failed(options.path, bytes.error());
    const std::string extension = extension_of(options.path);
    const bool scene = is_gltf(*bytes, extension);
    std::error_code ignored;
    const bool weights_are_file =
        !options.weights.empty() && std::filesystem::exists(options.weights, ignored);

    auto file = [&]() -> Result<bake::MeshFile> {
        if (scene) {
            bake::GltfOptions gltf;
            gltf.weld = weld_of(options.weld);
            if (!weights_are_file) gltf.weight_channel = options.weights;
            std::filesystem::path folder = std::filesystem::path(options.path).parent_path();
            return bake::parse_gltf(*bytes, folder.empty() ? "." : folder.string(), gltf);
        }
        bake::ReadOptions mesh;
        mesh.weld = weld_of(options.weld);
        if (!weights_are_file) mesh.weight_property = options.weights;
        return bake::parse_mesh(*bytes, extension, mesh);
    }();
    if (!file) return failed(options.path, file.error());
    if (weights_are_file) {
        auto text = bake::read_file(options.weights);
        if (!text) return failed(options.weights, text.error());
        auto weights = bake::parse_weights(*text, file->report.vertices_in);
        if (!weights) return failed(options.weights, weights.error());
        if (const Status applied = bake::apply_weights(*file, *weights); !applied)
            return failed(options.weights, applied.error());
    }
    return file;
}

Result<bake::MeshFile> load_placed(const InputOptions& options, std::vector<std::string>& notes,
                                   bake::PoseSets& poses, int& exit) {
    std::error_code ignored;
    if (options.weld != "auto" ||
        (!options.weights.empty() && std::filesystem::exists(options.weights, ignored)))
        return load_mesh(options, exit);
    bake::MeshFile file;
    {
        auto bytes = bake::read_file(options.path);
        if (!bytes) {
            exit = fail_input(options.path, bytes.error());
            return bytes.error();
        }
        if (!is_gltf(*bytes, extension_of(options.path))) return load_mesh(options, exit);
        auto scene = load_scene(options, *bytes, exit);
        if (!scene) return scene.error();
        auto placed = bake::placed_mesh(*scene);
        if (!placed) {
            exit = fail_input(options.path, placed.error());
            return placed.error();
        }
        file.mesh = std::move(*placed);
        file.report = std::move(scene->report);
        notes = std::move(scene->notes);
        poses = bake::placed_poses(*scene);
    }
    if (file.mesh.attributes.empty() && file.mesh.groups.empty()) {
        poses = {};
        return load_mesh(options, exit);
    }
    return file;
}

std::vector<std::string> describe(const bake::MeshReport& r) {
    std::vector<std::string> lines;
    const auto note = [&](std::uint64_t count, const char* what) {
        if (count > 0) lines.push_back(fmt::format("{} {}", with_commas(count), what));
    };
    note(r.polygons_triangulated, "polygons triangulated");
    note(r.faces_dropped_degenerate, "triangles left out that name a point twice");
    note(r.faces_dropped_non_finite, "triangles left out with a corner that is no finite number");
    note(r.vertices_welded, "vertices welded to another at the same place");
    note(r.vertices_dropped_unused, "vertices left out that no triangle uses");
    note(r.weights_clamped, "weights that were negative or not a number, read as 0");
    return lines;
}

std::optional<std::string> origin_note(const Mesh& mesh) {
    if (mesh.origin == std::array<double, 3>{}) return {};
    return fmt::format("far from 0 for single precision: places are relative to ({}, {}, {})", mesh.origin[0],
                       mesh.origin[1], mesh.origin[2]);
}

Json to_json(const bake::MeshReport& r) {
    return {{"format", r.format},
            {"vertices", r.vertices_in},
            {"faces", r.faces_in},
            {"polygons_triangulated", r.polygons_triangulated},
            {"faces_dropped_degenerate", r.faces_dropped_degenerate},
            {"faces_dropped_non_finite", r.faces_dropped_non_finite},
            {"vertices_welded", r.vertices_welded},
            {"vertices_dropped_unused", r.vertices_dropped_unused},
            {"weights_clamped", r.weights_clamped}};
}

Json to_json(const bake::MeshSurvey& s) {
    return {{"vertices", s.vertices},
            {"triangles", s.triangles},
            {"components", s.components},
            {"boundary_edges", s.boundary_edges},
            {"non_manifold_edges", s.non_manifold_edges},
            {"misoriented_edges", s.misoriented_edges},
            {"non_manifold_vertices", s.non_manifold_vertices},
            {"duplicate_triangles", s.duplicate_triangles},
            {"zero_area_triangles", s.zero_area_triangles}};
}

}  // namespace vsplit::app
