// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Any mesh or scene file as one mesh, weights applied.
#pragma once

#include <optional>
#include <string>

#include "command.hpp"
#include "vsplit/bake/meshes.hpp"

namespace vsplit::app {

struct InputOptions {
    std::string path;
    std::string
        weights;  ///< A file, a PLY property, or a glTF channel (COLOR_0.r); empty: what the mesh brings.
    std::string weld = "auto";
    void add_to(CLI::App& command);
};

/// On failure the message is said and `exit` set.
Result<bake::MeshFile> load_mesh(const InputOptions& options, int& exit);

/// What was met on the way, a line each, for people.
std::vector<std::string> describe(const bake::MeshReport& report);
/// Of a mesh whose places are relative to an origin, where that is.
std::optional<std::string> origin_note(const Mesh& mesh);
Json to_json(const bake::MeshReport& report);
Json to_json(const bake::MeshSurvey& survey);

}  // namespace vsplit::app
