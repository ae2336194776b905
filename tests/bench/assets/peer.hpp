// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// meshoptimizer, as published on npm.
#pragma once

#include <string>
#include <vector>

#include "scene.hpp"

namespace vsplit::bench {

/// Weights of attributes, as simplifyWithAttributes takes them: of normals, texture coordinates, colours and
/// joints' weights.
struct PeerSettings {
    std::string name;
    float normal, texcoord, color, joints;
    bool moves = false;  ///< simplifyWithUpdate: vertices may be moved.
};

/// The scene at each ratio of its triangles, each primitive by itself. Throws std::runtime_error.
std::vector<Scene> simplify_by_peer(const Scene& scene, const std::vector<double>& ratios,
                                    const PeerSettings& settings, const std::string& folder);

}  // namespace vsplit::bench
