// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Assemblies: small parts vanish before large ones lose their shape.
#include <catch2/catch.hpp>
#include <cmath>

#include "family.hpp"
#include "mesh_checks.hpp"
#include "vsplit/bake/collapse.hpp"
#include "vsplit/live_mesh.hpp"

using namespace vsplit;
using namespace vsplit::test;

namespace {

constexpr float kScrew = 0.03f;
constexpr int kScrews = 200;

Mesh scaled(Mesh mesh, float factor) {
    for (Float3& p : mesh.positions) p = {factor * p.x, factor * p.y, factor * p.z};
    return mesh;
}

/// A sphere of radius 1 and its screws, half sunk into it; or all around the origin, as parts of a scene are.
Mesh assembly(const Mesh& large, bool in_place) {
    const Mesh screw = scaled(make_sphere(8, 6), kScrew);
    Mesh mesh = large;
    for (int i = 0; i < kScrews; ++i) {
        const float z = 1 - (2 * float(i) + 1) / float(kScrews), r = std::sqrt(1 - z * z);
        const float turn = 2.399963f * float(i);
        mesh = join(mesh, screw, in_place ? Float3{r * std::cos(turn), r * std::sin(turn), z} : Float3{});
    }
    return mesh;
}

}  // namespace

TEST_CASE("Components: screws vanish before what they sit on changes by more than their size") {
    const Mesh large = make_sphere(140, 70);
    for (const bool scene : {false, true}) {
        Mesh mesh = assembly(large, !scene);
        bake::CollapseOptions options;
        if (scene) {
            const std::size_t of_large = large.triangles.size();
            const std::size_t of_screw = (mesh.triangles.size() - of_large) / kScrews;
            for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
                mesh.groups.push_back(t < of_large ? 0 : std::uint32_t(1 + (t - of_large) / of_screw));
            options.part_of.resize(mesh.positions.size());
            for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
                for (const std::uint32_t v : mesh.triangles[t]) options.part_of[v] = mesh.groups[t];
        }
        const std::size_t triangles = mesh.triangles.size();
        auto result = bake::collapse(mesh, options);
        REQUIRE(result.ok());
        CAPTURE(scene);
        REQUIRE(result->report.components == kScrews + 1);
        REQUIRE(result->report.components_vanished == kScrews);
        // A screw's split brings all of its triangles at once.
        REQUIRE(progressive_mesh_fault(result->mesh) == nullptr);
        LiveMesh live(result->mesh);
        // Wherever a screw is left, the large part is there and has kept its shape to a screw's diagonal.
        std::size_t parts = 0;
        for (const double ratio : {0.1, 0.05, 0.03, 0.02, 0.01, 0.007, 0.005, 0.003, 0.002}) {
            live.go_to(level_for_triangles(result->mesh, std::uint64_t(ratio * double(triangles))));
            const Mesh level = live.snapshot();
            parts = topology(level).parts.size();
            const double off = distance_to(level, large.positions);
            CAPTURE(ratio, level.triangles.size(), parts, off);
            CHECK(off < (parts > 1 ? 3.5 * double(kScrew) : 0.5));
        }
        CHECK(parts == 1);
    }
}

TEST_CASE("Components: no large part vanishes because guards hold back another's small triangles") {
    // A body like a chess board over a quarter of it, whose corners the strict guards keep, and a plain
    // cover.
    constexpr std::size_t kAcross = 60;
    Mesh mesh = make_torus(120, int(kAcross));
    std::size_t number = 0;
    std::erase_if(mesh.triangles, [&](const Triangle&) {
        const std::size_t cell = number++ / 2, along = cell / kAcross, across = cell % kAcross;
        return along < 30 && (along + across) % 2 == 0;
    });
    mesh.groups.assign(mesh.triangles.size(), 0);
    const std::size_t of_body = mesh.positions.size();
    const std::vector<std::uint32_t> groups = mesh.groups;
    mesh = join(mesh, scaled(make_sphere(60, 30), 0.25f));
    mesh.groups = groups;
    mesh.groups.resize(mesh.triangles.size(), 1);
    bake::CollapseOptions options;
    options.part_of.assign(of_body, 0);
    options.part_of.resize(mesh.positions.size(), 1);
    auto result = bake::collapse(mesh, options);
    REQUIRE(result.ok());
    LiveMesh live(result->mesh);
    for (const double ratio : {0.1, 0.05, 0.02, 0.01}) {
        live.go_to(level_for_triangles(result->mesh, std::uint64_t(ratio * double(mesh.triangles.size()))));
        const Mesh level = live.snapshot();
        std::size_t cover = 0;
        for (const std::uint32_t group : level.groups) cover += group == 1;
        CAPTURE(ratio, level.triangles.size(), cover);
        CHECK(cover >= 4);
    }
}
