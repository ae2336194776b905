// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <meshoptimizer.h>

#include <cfloat>

#include "peer.hpp"

namespace vsplit::bench {
namespace {

Result<std::vector<Mesh>> simplify(const Mesh& mesh, std::span<const std::size_t> targets) {
    std::vector<Mesh> levels;
    std::vector<unsigned int> indices(3 * mesh.triangles.size());
    for (const std::size_t target : targets) {
        const std::size_t count = meshopt_simplify(
            indices.data(), mesh.triangles[0].data(), 3 * mesh.triangles.size(), &mesh.positions[0].x,
            mesh.positions.size(), sizeof(Float3), 3 * target, FLT_MAX, 0u, nullptr);
        Mesh level;
        level.positions.resize(mesh.positions.size());
        std::vector<unsigned int> remap(mesh.positions.size());
        level.positions.resize(
            meshopt_optimizeVertexFetchRemap(remap.data(), indices.data(), count, mesh.positions.size()));
        level.triangles.resize(count / 3);
        for (std::size_t i = 0; i < count; ++i) {
            const unsigned int v = remap[indices[i]];
            level.positions[v] = mesh.positions[indices[i]];
            level.triangles[i / 3][i % 3] = v;
        }
        levels.push_back(std::move(level));
    }
    return levels;
}

}  // namespace

Peer meshoptimizer() {
    const int version = MESHOPTIMIZER_VERSION;
    return {"meshoptimizer",
            "meshoptimizer " + std::to_string(version / 1000) + "." + std::to_string(version / 10 % 100),
            "meshopt_simplify, no error limit, options 0; a call for each ratio", "", simplify};
}

}  // namespace vsplit::bench
