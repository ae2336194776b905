// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "peer.hpp"
#include "vsplit/bake/collapse.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/version.hpp"

namespace vsplit::bench {
namespace {

/// One record, cut at every target.
Result<std::vector<Mesh>> simplify(const Mesh& mesh, std::span<const std::size_t> targets) {
    bake::CollapseOptions options;
    options.calibrate = false;  // Recorded errors decide nothing here; calibrating has a row of its own.
    auto record = bake::collapse(mesh, options);
    if (!record) return record.error();
    LiveMesh live(std::move(record->mesh));
    std::vector<Mesh> levels;
    for (const std::size_t target : targets) {
        live.go_to(level_for_triangles(live.state(), target));
        levels.push_back(live.snapshot());
    }
    return levels;
}

}  // namespace

Peer vsplit_engine() {
    return {"vsplit", "this commit", "defaults; one record, cut at each ratio", "", simplify};
}

}  // namespace vsplit::bench
