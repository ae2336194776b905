// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Point clouds on the command line: read, cleaned, reconstructed. Without CGAL (VSPLIT_WITH_CGAL=OFF) only
// told apart.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "command.hpp"
#include "vsplit/mesh.hpp"

namespace vsplit::app {

/// What bake and reconstruct share.
struct CloudOptions {
    std::string method = "modified";
    std::string clean = "auto";
    std::string thin = "none", smooth = "auto";
    double outlier_factor = 3, grid_cell = 0, wlop_share = 0.5;
    bool open = false;
    std::string medial_axis;         ///< File, or empty.
    std::vector<std::string> dumps;  ///< WHAT DIR, one after the other.
    void add_to(CLI::App& command);
};

/// A mesh made of points, and what happened: as JSON, and a line each for people.
struct CloudSurface {
    Mesh mesh;
    Json report;
    std::vector<std::string> notes;
};

/// By content and extension: a PLY without faces, a PCD, or text of points.
bool is_point_cloud(std::span<const std::byte> bytes, const std::string& extension);

/// On failure the message is said and `exit` set. `force` allows to overwrite the medial axis and dumps.
Result<CloudSurface> reconstruct_cloud(const std::string& path, std::span<const std::byte> bytes,
                                       const CloudOptions& options, const Common& common, bool force,
                                       const bake::Progress& progress, int& exit);

}  // namespace vsplit::app
