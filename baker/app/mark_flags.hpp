// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What matters, on the command line: marked regions, their weights, and what is to be kept of them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "command.hpp"
#include "vsplit/bake/weights.hpp"

namespace vsplit::app {

struct MarkFlags {
    std::string marks;                 ///< A file of marks, or empty: what is painted is one region.
    std::vector<std::string> regions;  ///< NAME=WEIGHT.
    std::vector<std::string> keeps;    ///< NAME=SHARE@RATIO.
    bool automatic = false;

    void add_to(CLI::App& command);
    bool any() const { return !marks.empty() || !regions.empty() || !keeps.empty() || automatic; }
    /// The reason if a flag is not what it should be.
    std::optional<std::string> fault() const;
};

/// What was done, for people and --json.
struct MarkReport {
    struct Line {
        std::string name;
        std::size_t vertices = 0;
        double weight = 1;
        bool automatic = false, searched = false;
        double share = 0, ratio = 0;  ///< Kept, if searched.
        std::size_t bakes = 0;
    };
    std::vector<Line> regions;
    bake::AutomaticWeights automatic;
    Json json() const;
    std::vector<std::string> describe() const;
};

/// Sets the mesh's weights. `vertex_of` and `file_vertices` say how the file lists its vertices (MeshFile).
/// On failure the message is said and `exit` set.
Result<MarkReport> apply_marks(const MarkFlags& flags, const std::string& input, Mesh& mesh,
                               std::span<const std::uint32_t> vertex_of, std::size_t file_vertices,
                               const bake::CollapseOptions& options, const bake::Progress& progress,
                               int& exit);

}  // namespace vsplit::app
