// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Any mesh or scene file as one mesh, weights applied.
#pragma once

#include <optional>
#include <string>

#include "command.hpp"
#include "vsplit/bake/meshes.hpp"
#include "vsplit/bake/poses.hpp"

namespace vsplit::app {

struct InputOptions {
    std::string path;
    std::string
        weights;  ///< A file, a PLY property, or a glTF channel (COLOR_0.r); empty: what the mesh brings.
    std::string weld = "auto";
    std::size_t poses = 0;  ///< Of a scene, moments of its animations to sample.
    void add_to(CLI::App& command);
    /// `--poses`, of the commands that bake scenes, with its default.
    void add_poses_to(CLI::App& command);
};

/// On failure the message is said and `exit` set.
Result<bake::MeshFile> load_mesh(const InputOptions& options, int& exit);

/// The same of a scene with its attributes and materials, its nodes' meshes where they place them
/// (bake::placed_mesh). `notes` gets what was met and not carried along, `poses` those sampled. Where there
/// is neither an attribute nor more than one material, or the options name what only a mesh has (a file of
/// weights, a weld): load_mesh.
Result<bake::MeshFile> load_placed(const InputOptions& options, std::vector<std::string>& notes,
                                   bake::PoseSets& poses, int& exit);
/// "8 poses", the most that any of its meshes has; nothing without.
std::optional<std::string> poses_note(const bake::PoseSets& poses);

/// What was met on the way, a line each, for people.
std::vector<std::string> describe(const bake::MeshReport& report);
/// Of a mesh whose places are relative to an origin, where that is.
std::optional<std::string> origin_note(const Mesh& mesh);
Json to_json(const bake::MeshReport& report);
Json to_json(const bake::MeshSurvey& survey);

}  // namespace vsplit::app
