// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What levels are cut from: a progressive mesh, read or baked on the spot, and the scene around it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "collapse_flags.hpp"
#include "command.hpp"
#include "input.hpp"
#include "vsplit/bake/manyfold.hpp"
#include "vsplit/bake/scene.hpp"
#include "vsplit/progressive_mesh.hpp"

namespace vsplit::app {

/// A .pmesh file, or the progressive GLB that carries one.
struct StreamFile {
    std::vector<std::byte> bytes;
    std::size_t offset = 0, size = 0;
    bool carried = false;  ///< In a GLB.
    std::span<const std::byte> stream() const { return std::span(bytes).subspan(offset, size); }
};

/// On failure the message is said and `exit` set, here and below.
Result<StreamFile> read_stream_file(const std::string& path, int& exit);

/// A GLB with MANYFOLD_mesh_progressive; nothing if it is none. `bytes` are a scene's.
Result<std::optional<bake::ManyfoldFile>> load_manyfold(const std::string& path,
                                                        std::span<const std::byte> bytes, int& exit);
/// Why not all of its records were taken, if so.
std::optional<std::string> manyfold_note(const bake::ManyfoldFile& file);

struct Model {
    ProgressiveMesh mesh;
    std::optional<bake::Scene> scene;
    std::vector<std::string> notes;    ///< On what was read, for people; others are the scene's.
    std::optional<std::string> posed;  ///< If it was baked in poses, in how many, for people.
    double radius = 0;                 ///< Of a ball around it, in the units of world_error().

    /// An error of the mesh in the world that a viewer sees: of a scene the largest that it can be there.
    double world_error(double error) const { return scene ? error * scene->unit : error; }
    double mesh_error(double world) const { return scene ? world / scene->unit : world; }

    /// A GLB of these levels, finest first.
    Result<std::vector<std::byte>> encode(std::span<const bake::GltfLevel> levels,
                                          const bake::SceneFormat& format) const;
};

/// Whether the bytes are a scene, by content or by name.
bool is_gltf(std::span<const std::byte> bytes, const std::string& extension);
Result<bake::Scene> load_scene(const InputOptions& input, std::span<const std::byte> bytes, int& exit);

/// A .pmesh or a progressive GLB is read, a mesh or a scene baked.
Result<Model> load_model(const InputOptions& input, const CollapseFlags& flags, const Common& common,
                         int& exit);

}  // namespace vsplit::app
