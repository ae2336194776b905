// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The hand-over struct and the live mesh: rules, levels, law 2 (a split undoes its collapse).
#include <catch2/catch.hpp>
#include <cstring>
#include <limits>
#include <string>

#include "../../lib/bytes/checksum.hpp"
#include "family.hpp"
#include "naive_record.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/progressive_mesh.hpp"

using namespace vsplit;

namespace {

/// A triangle (0,1,2); the first split makes 3 of 2 and the quad 0 1 3 2 of it; the second brings a whole
/// component back: the triangle 4 5 6.
ProgressiveMesh hand_made() {
    ProgressiveMesh m;
    m.base_vertices = 3;
    m.base_triangles = 1;
    m.positions = {{0, 0, 0}, {1, 0, 0}, {0.5f, 1, 0}, {1, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}};
    m.weights = {1, 2, 3, 4, 5, 6, 7};
    m.parents = {kNoVertex, kNoVertex, kNoVertex, 2, kNoVertex, kNoVertex, kNoVertex};
    m.triangles = {{0, 1, 2}, {0, 3, 2}, {4, 5, 6}};
    m.corner_changes = {{2, 3}};
    m.moves = {{2, {0, 1, 0}, 2}};
    m.splits = {{4, 2, 1, 1, 0.5f}, {7, 3, 1, 1, 0.25f}};
    return m;
}

/// Two renderer vertices at one place, torn apart by a seam: one split gives birth to two vertices with a
/// parent each.
ProgressiveMesh seam() {
    ProgressiveMesh m;
    m.base_vertices = 6;
    m.base_triangles = 2;
    m.positions = {{0, 0, 0}, {1, 0, 0},  {0, 1, 0},    {0, 0, 0},
                   {1, 0, 0}, {0, -1, 0}, {0.5f, 0, 0}, {0.5f, 0, 0}};
    m.parents = {kNoVertex, kNoVertex, kNoVertex, kNoVertex, kNoVertex, kNoVertex, 1, 4};
    m.triangles = {{0, 1, 2}, {3, 5, 4}, {6, 1, 2}, {7, 5, 4}};
    m.corner_changes = {{1, 6}, {5, 7}};
    m.splits = {{8, 4, 2, 0, 0.1f}};
    return m;
}

std::uint64_t buffers_hash(const LiveMesh& live) {
    return checksum64(std::as_bytes(live.positions())) ^ 3 * checksum64(std::as_bytes(live.triangles())) ^
           5 * checksum64(std::as_bytes(live.weights()));
}

}  // namespace

TEST_CASE("progressive_mesh_fault accepts what is sound") {
    REQUIRE(progressive_mesh_fault(ProgressiveMesh{}) == nullptr);
    REQUIRE(progressive_mesh_fault(hand_made()) == nullptr);
    REQUIRE(progressive_mesh_fault(seam()) == nullptr);
    for (const auto& [name, mesh] : test::mesh_family())
        for (std::uint32_t seed = 0; seed < 3; ++seed) {
            CAPTURE(name, seed);
            const char* fault = progressive_mesh_fault(test::naive_record(mesh, seed));
            CAPTURE(fault ? fault : "");
            REQUIRE(fault == nullptr);
        }
}

TEST_CASE("progressive_mesh_fault names every rule that is broken") {
    using Change = void (*)(ProgressiveMesh&);
    struct Violation {
        const char* expected;
        Change change;
    };
    const Violation violations[] = {
        {"the base mesh is larger than the full mesh", [](ProgressiveMesh& m) { m.base_vertices = 8; }},
        {"the base mesh is larger than the full mesh", [](ProgressiveMesh& m) { m.base_triangles = 4; }},
        {"there are not as many weights as vertices", [](ProgressiveMesh& m) { m.weights.pop_back(); }},
        {"there are not as many parents as vertices", [](ProgressiveMesh& m) { m.parents.push_back(0); }},
        {"a position is not finite",
         [](ProgressiveMesh& m) { m.positions[6].y = std::numeric_limits<float>::quiet_NaN(); }},
        {"a position is not finite",
         [](ProgressiveMesh& m) { m.positions[0].z = std::numeric_limits<float>::infinity(); }},
        {"a weight is negative or not a number", [](ProgressiveMesh& m) { m.weights[0] = -1; }},
        {"a weight is negative or not a number",
         [](ProgressiveMesh& m) { m.weights[6] = std::numeric_limits<float>::quiet_NaN(); }},
        {"a vertex of the base mesh has a parent", [](ProgressiveMesh& m) { m.parents[1] = 0; }},
        {"the last split does not end where the arrays end", [](ProgressiveMesh& m) { m.splits.pop_back(); }},
        {"the last split does not end where the arrays end", [](ProgressiveMesh& m) { m.splits.clear(); }},
        {"the last split does not end where the arrays end",
         [](ProgressiveMesh& m) { m.splits.back().vertices_end = 8; }},
        {"the last split does not end where the arrays end",
         [](ProgressiveMesh& m) {
             m.moves.push_back({0, {}, 1});
         }},
        {"the last split does not end where the arrays end",
         [](ProgressiveMesh& m) {
             m.corner_changes.push_back({0, 3});
         }},
        {"a triangle of the base mesh names a vertex that does not exist",
         [](ProgressiveMesh& m) { m.triangles[0][1] = 3; }},
        {"a triangle of the base mesh names a vertex twice",
         [](ProgressiveMesh& m) {
             m.triangles[0] = {0, 1, 1};
         }},
        {"a split ends before it begins", [](ProgressiveMesh& m) { m.splits[0].vertices_end = 2; }},
        {"a split ends before it begins", [](ProgressiveMesh& m) { m.splits[0].triangles_end = 0; }},
        {"a split ends before it begins",
         [](ProgressiveMesh& m) {
             m.splits = {{4, 2, 1, 1, 0.5f}, {4, 2, 0, 1, 0.25f}, {7, 3, 1, 1, 0.25f}};
         }},
        {"a split ends behind the arrays", [](ProgressiveMesh& m) { m.splits[0].corners_end = 2; }},
        {"a split ends behind the arrays", [](ProgressiveMesh& m) { m.splits[0].triangles_end = 9; }},
        {"a split ends behind the arrays", [](ProgressiveMesh& m) { m.splits[0].moves_end = 0xFFFFFFFFu; }},
        {"an error is negative, not finite, or grows", [](ProgressiveMesh& m) { m.splits[1].error = -1; }},
        {"an error is negative, not finite, or grows", [](ProgressiveMesh& m) { m.splits[1].error = 0.75f; }},
        {"an error is negative, not finite, or grows",
         [](ProgressiveMesh& m) { m.splits[0].error = std::numeric_limits<float>::infinity(); }},
        {"an error is negative, not finite, or grows",
         [](ProgressiveMesh& m) { m.splits[0].error = std::numeric_limits<float>::quiet_NaN(); }},
        {"a vertex is not younger than its parent", [](ProgressiveMesh& m) { m.parents[3] = 3; }},
        {"a vertex is not younger than its parent", [](ProgressiveMesh& m) { m.parents[5] = 4; }},
        {"a vertex is not younger than its parent", [](ProgressiveMesh& m) { m.parents[3] = 0xFFFFFFFEu; }},
        {"a corner change names a triangle that does not exist",
         [](ProgressiveMesh& m) { m.corner_changes[0].corner = 3; }},
        {"a corner change names a triangle that does not exist",
         [](ProgressiveMesh& m) { m.corner_changes[0].corner = 0xFFFFFFFFu; }},
        {"a corner change names a vertex that its split did not make",
         [](ProgressiveMesh& m) { m.corner_changes[0].vertex = 2; }},
        {"a corner change names a vertex that its split did not make",
         [](ProgressiveMesh& m) { m.corner_changes[0].vertex = 4; }},
        {"a corner does not hold the parent of its new vertex",
         [](ProgressiveMesh& m) { m.corner_changes[0].corner = 1; }},
        {"a new triangle names a vertex that does not exist",
         [](ProgressiveMesh& m) { m.triangles[1][0] = 4; }},
        {"a new triangle names a vertex twice",
         [](ProgressiveMesh& m) {
             m.triangles[1] = {0, 3, 3};
         }},
        {"a move names a vertex that does not exist", [](ProgressiveMesh& m) { m.moves[0].vertex = 3; }},
        {"a position is not finite",
         [](ProgressiveMesh& m) { m.moves[0].position.x = std::numeric_limits<float>::quiet_NaN(); }},
        {"a weight is negative or not a number", [](ProgressiveMesh& m) { m.moves[0].weight = -2; }},
    };
    for (const Violation& violation : violations) {
        ProgressiveMesh mesh = hand_made();
        violation.change(mesh);
        const char* fault = progressive_mesh_fault(mesh);
        REQUIRE(std::string(fault ? fault : "sound") == violation.expected);
    }
    // One corner changed twice in a split: the second time it no longer holds the parent.
    ProgressiveMesh twice = seam();
    twice.parents[7] = 1;
    twice.corner_changes = {{1, 6}, {1, 7}};
    const char* fault = progressive_mesh_fault(twice);
    REQUIRE(std::string(fault ? fault : "sound") == "a corner does not hold the parent of its new vertex");
}

TEST_CASE("Levels are found by triangles, vertices and error") {
    const ProgressiveMesh m = hand_made();  // triangles 1 2 3, vertices 3 4 7, error 0.5 0.25 0
    REQUIRE(m.levels() == 3);
    REQUIRE(triangles_at(m, 0) == 1);
    REQUIRE(triangles_at(m, 2) == 3);
    REQUIRE(vertices_at(m, 1) == 4);
    REQUIRE(error_at(m, 0) == 0.5);
    REQUIRE(error_at(m, 1) == 0.25);
    REQUIRE(error_at(m, 2) == 0.0);
    const auto for_triangles = [&](std::uint64_t n) { return level_for_triangles(m, n); };
    REQUIRE(for_triangles(0) == 0);
    REQUIRE(for_triangles(1) == 0);
    REQUIRE(for_triangles(2) == 1);
    REQUIRE(for_triangles(3) == 2);
    REQUIRE(for_triangles(~std::uint64_t{0}) == 2);
    const auto for_vertices = [&](std::uint64_t n) { return level_for_vertices(m, n); };
    REQUIRE(for_vertices(0) == 0);
    REQUIRE(for_vertices(3) == 0);
    REQUIRE(for_vertices(6) == 1);
    REQUIRE(for_vertices(7) == 2);
    const auto for_error = [&](double e) { return level_for_error(m, e); };
    REQUIRE(for_error(1e300) == 0);
    REQUIRE(for_error(0.5) == 0);
    REQUIRE(for_error(0.49) == 1);
    REQUIRE(for_error(0.25) == 1);
    REQUIRE(for_error(0.2) == 2);
    REQUIRE(for_error(0) == 2);

    // Equal counts and errors at several levels: the finest for counts, the coarsest for errors.
    ProgressiveMesh flat = hand_made();
    flat.splits = {{4, 2, 1, 1, 0.5f}, {4, 2, 1, 1, 0.5f}, {7, 3, 1, 1, 0.0f}};
    REQUIRE(progressive_mesh_fault(flat) == nullptr);
    REQUIRE(level_for_triangles(flat, 2) == 2);
    REQUIRE(level_for_error(flat, 0.5) == 0);
    REQUIRE(level_for_error(flat, 0.4) == 2);
    REQUIRE(level_for_triangles(ProgressiveMesh{}, 5) == 0);
    REQUIRE(level_for_error(ProgressiveMesh{}, 0) == 0);
}

TEST_CASE("A live mesh by hand") {
    LiveMesh live(hand_made());
    REQUIRE(live.level() == 0);
    REQUIRE(live.max_level() == 2);
    REQUIRE(live.positions().size() == 3);
    REQUIRE(live.triangles()[0] == Triangle{0, 1, 2});
    REQUIRE(live.positions()[2] == Float3{0.5f, 1, 0});
    REQUIRE(live.weights()[2] == 3);
    REQUIRE(live.error() == 0.5);

    live.go_to(1);
    REQUIRE(live.triangles().size() == 2);
    REQUIRE(live.triangles()[0] == Triangle{0, 1, 3});
    REQUIRE(live.triangles()[1] == Triangle{0, 3, 2});
    REQUIRE(live.positions()[2] == Float3{0, 1, 0});
    REQUIRE(live.weights()[2] == 2);
    REQUIRE(live.weights()[3] == 4);

    live.go_to(77);  // clamped
    REQUIRE(live.level() == 2);
    REQUIRE(live.snapshot().triangles[2] == Triangle{4, 5, 6});
    live.go_to(0);
    REQUIRE(test::same_bytes(live.state(), hand_made()));

    LiveMesh torn(seam());
    torn.go_to(1);
    REQUIRE(torn.triangles()[0] == Triangle{0, 6, 2});
    REQUIRE(torn.triangles()[1] == Triangle{3, 5, 7});
    torn.go_to(0);
    REQUIRE(test::same_bytes(torn.state(), seam()));
}

TEST_CASE("Law 2: forward, then back restores every byte, at every level of every mesh") {
    for (auto [name, mesh] : test::mesh_family())
        for (const bool weighted : {false, true}) {
            CAPTURE(name, weighted);
            if (weighted) mesh.weights = test::some_weights(mesh.positions.size());
            const ProgressiveMesh record = test::naive_record(mesh, 1);
            LiveMesh live(record);
            std::vector<std::uint64_t> hashes;
            for (std::size_t level = 0; level <= live.max_level(); ++level) {
                live.go_to(level);
                hashes.push_back(buffers_hash(live));
            }
            bool restored = true;
            for (std::size_t level = live.max_level() + 1; level-- > 0;) {
                live.go_to(level);
                restored &= buffers_hash(live) == hashes[level];
            }
            REQUIRE(restored);
            REQUIRE(test::same_bytes(live.state(), record));
            // By leaps, there and back.
            for (const std::size_t share : {100, 10, 60, 0, 40, 100, 0}) {
                const std::size_t level = live.max_level() * share / 100;
                live.go_to(level);
                restored &= buffers_hash(live) == hashes[level];
                const Mesh there = cut(record, level);
                restored &= mesh_fault(there) == nullptr && there.positions.size() == live.positions().size();
            }
            REQUIRE(restored);
            REQUIRE(test::same_bytes(live.state(), record));
        }
}

TEST_CASE("Both children of a split take the parent's weight") {
    const ProgressiveMesh m = hand_made();
    // Painted on the base: 3 comes of 2; the component that returns has no parents.
    REQUIRE(inherit_weights(m, 0, {10, 20, 30}) == std::vector<float>{10, 20, 30, 30, 1, 1, 1});
    REQUIRE(inherit_weights(m, 1, {10, 20, 30, 40}) == std::vector<float>{10, 20, 30, 40, 1, 1, 1});
    REQUIRE(inherit_weights(m, 2, {1, 2, 3, 4, 5, 6, 7}) == std::vector<float>{1, 2, 3, 4, 5, 6, 7});
    // Grandchildren.
    for (const auto& [name, mesh] : test::mesh_family()) {
        const ProgressiveMesh record = test::naive_record(mesh, 2);
        std::vector<float> painted(record.base_vertices);
        for (std::size_t v = 0; v < painted.size(); ++v) painted[v] = float(v + 2);
        const std::vector<float> all = inherit_weights(record, 0, painted);
        REQUIRE(all.size() == record.positions.size());
        bool right = true;
        for (std::uint32_t v = 0; v < all.size(); ++v) {
            std::uint32_t ancestor = v;
            while (ancestor >= record.base_vertices) ancestor = record.parents[ancestor];
            right &= all[v] == painted[ancestor];
        }
        CAPTURE(name);
        REQUIRE(right);
    }
}
