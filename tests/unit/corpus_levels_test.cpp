// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Real models, where they are: the levels at 60 and 40 % have the input's topology and no triangle that
// flipped.
#include <algorithm>
#include <catch2/catch.hpp>

#include "family.hpp"
#include "mesh_checks.hpp"
#include "vsplit/bake/collapse.hpp"
#include "vsplit/bake/files.hpp"
#include "vsplit/bake/meshes.hpp"
#include "vsplit/live_mesh.hpp"

using namespace vsplit;
using namespace vsplit::test;

namespace {

/// Every n-th triangle of a mesh, about `count` of them, over the same vertices.
Mesh some_triangles(const Mesh& mesh, std::size_t count) {
    Mesh some{mesh.positions, {}, {}};
    const std::size_t stride = std::max<std::size_t>(1, mesh.triangles.size() / count);
    for (std::size_t t = 0; t < mesh.triangles.size(); t += stride)
        some.triangles.push_back(mesh.triangles[t]);
    return some;
}

}  // namespace

TEST_CASE("Corpus: levels at 60 and 40 %") {
    for (const char* name :
         {"meshes/stanford-bunny.obj", "meshes/armadillo.obj", "meshes/nefertiti.obj", "meshes/fandisk.obj",
          "meshes/rocker-arm.obj", "meshes/spot.obj", "meshes/homer.obj"}) {
        const auto path = corpus_file(name);
        if (!path) continue;
        const auto bytes = bake::read_file(*path);
        REQUIRE(bytes.ok());
        const auto file = bake::parse_mesh(*bytes, ".obj");
        REQUIRE(file.ok());
        const Mesh& mesh = file->mesh;
        const Topology input = topology(mesh);
        const std::size_t folded = folded_edges(mesh), degenerate = degenerate_triangles(mesh);
        const auto result = bake::collapse(mesh);
        REQUIRE(result.ok());
        LiveMesh live(result->mesh);
        for (const std::size_t percent : {60, 40, 10}) {
            const std::uint64_t wanted = mesh.triangles.size() * percent / 100;
            live.go_to(level_for_triangles(live.state(), wanted));
            const Mesh now = live.snapshot();
            const Topology here = topology(now);
            CAPTURE(name, percent, mesh.triangles.size(), now.triangles.size());
            CHECK(wanted - now.triangles.size() <= 1);
            CHECK(here.boundary_edges <= input.boundary_edges);
            CHECK(here.non_manifold_edges <= input.non_manifold_edges);
            CHECK(here.non_manifold_vertices <= input.non_manifold_vertices);
            if (input.manifold()) CHECK(parts_survive(here, input));
            CHECK(degenerate_triangles(now) <= degenerate);
            CHECK(folded_edges(now) <= folded);
            // Each against all of the input's: some hundreds tell as much as all would.
            CHECK(flipped_triangles(some_triangles(now, 300), mesh) == 0);
        }
    }
}
