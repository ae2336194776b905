// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Meshes that break collapsers: hubs, extremes of scale, no extent, slivers, soups.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "family.hpp"
#include "mesh_checks.hpp"
#include "naive_record.hpp"
#include "vsplit/bake/collapse.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/read.hpp"
#include "vsplit/write.hpp"

using namespace vsplit;
using namespace vsplit::test;

namespace {

/// Collapses by each cost and asks for what holds of any mesh: soundness, the input back, every level sound,
/// the file too.
template <class Also>
void require_sound(const Mesh& mesh, const Also& also) {
    for (const bake::Cost cost : {bake::Cost::kQuadric, bake::Cost::kPaper})
        for (const bake::Placement placement : {bake::Placement::kOptimal, bake::Placement::kEndpoint}) {
            CAPTURE(int(cost), int(placement));
            bake::CollapseOptions options;
            options.cost = cost;
            options.placement = placement;
            const auto result = bake::collapse(mesh, options);
            if (!result.ok()) FAIL("refused: " << result.error().describe());
            const char* fault = progressive_mesh_fault(result->mesh);
            if (fault) FAIL("unsound: " << fault);
            LiveMesh live(result->mesh);
            live.go_to(live.max_level());
            REQUIRE(live.positions().size() + result->report.unused_vertices == mesh.positions.size());
            REQUIRE(triangle_bits(live.snapshot()) == triangle_bits(mesh));
            WriteOptions lossless;
            lossless.position_bits = 0;
            for (const WriteOptions& written : {WriteOptions{}, lossless}) {
                const auto bytes = write_progressive_mesh(result->mesh, written);
                REQUIRE(bytes.ok());
                const auto back = read_progressive_mesh(*bytes);
                REQUIRE(back.ok());
                const auto promised = canonical_progressive_mesh(result->mesh, written);
                REQUIRE(promised.ok());
                REQUIRE(same_bytes(*back, *promised));
                if (written.position_bits == 0)
                    REQUIRE(triangle_bits(cut(*back, back->splits.size())) == triangle_bits(mesh));
            }
            also(*result);
        }
}
void require_sound(const Mesh& mesh) {
    require_sound(mesh, [](const bake::CollapseResult&) {});
}

/// A cone of n triangles, or two of them base to base.
Mesh make_fan(std::uint32_t n, bool closed) {
    Mesh mesh;
    mesh.positions.push_back({0, 0, 1});
    for (std::uint32_t i = 0; i < n; ++i) {
        const double a = 6.283185307179586 * i / n;
        mesh.positions.push_back({float(std::cos(a)), float(std::sin(a)), 0});
    }
    for (std::uint32_t i = 0; i < n; ++i) mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % n});
    if (!closed) return mesh;
    mesh.positions.push_back({0, 0, -1});
    for (std::uint32_t i = 0; i < n; ++i) mesh.triangles.push_back({n + 1, 1 + (i + 1) % n, 1 + i});
    return mesh;
}

Mesh scaled(Mesh mesh, double scale) {
    for (Float3& p : mesh.positions) p = {float(p.x * scale), float(p.y * scale), float(p.z * scale)};
    return mesh;
}

}  // namespace

TEST_CASE("Hard: the errors of a fan of 1,000 triangles fall from level to level") {
    const Mesh mesh = make_fan(1000, true);
    const auto result = bake::collapse(mesh, {});
    REQUIRE(result.ok());
    for (std::size_t level = 1; level < result->mesh.splits.size(); ++level)
        REQUIRE(error_at(result->mesh, level) <= error_at(result->mesh, level - 1));
    REQUIRE(error_at(result->mesh, result->mesh.splits.size()) == 0);
}

TEST_CASE("Hard: a fan of 20,000 triangles around one vertex") {
    for (const bool closed : {false, true})
        for (const bake::Cost cost : {bake::Cost::kQuadric, bake::Cost::kPaper}) {
            CAPTURE(closed, int(cost));
            bake::CollapseOptions options;
            options.cost = cost;
            const Mesh mesh = make_fan(20000, closed);
            const auto result = bake::collapse(mesh, options);
            REQUIRE(result.ok());
            CHECK(progressive_mesh_fault(result->mesh) == nullptr);
            CHECK(triangle_bits(cut(result->mesh, result->mesh.splits.size())) == triangle_bits(mesh));
            CHECK(result->mesh.base_vertices <= 64);
        }
}

TEST_CASE("Hard: far from the origin") {
    for (const float shift : {1e3f, 1e5f, 1e7f}) {
        Mesh mesh = make_sphere(24, 16);
        for (Float3& p : mesh.positions) p = {p.x + shift, p.y + shift, p.z - shift};
        CAPTURE(shift);
        require_sound(mesh);
    }
}

TEST_CASE("Hard: huge and tiny") {
    for (const double scale : {1e-44, 1e-38, 1e-20, 1e-10, 1e10, 1e20, 1e30, 3e38}) {
        CAPTURE(scale);
        const Mesh mesh = scaled(make_sphere(16, 10), scale);
        if (mesh_fault(mesh)) FAIL("the test's own mesh is unsound");
        require_sound(mesh, [&](const bake::CollapseResult& result) {
            // Coordinates of a few denormal steps leave hardly a triangle with area; where there is precision
            // it does collapse.
            if (scale > 1e-37) {
                CHECK(result.mesh.base_vertices <= 64);
                CHECK(error_at(result.mesh, 0) > 0.01 * scale);
                CHECK(error_at(result.mesh, 0) < 4 * scale);
            }
        });
    }
    // Side by side.
    require_sound(join(scaled(make_sphere(12, 8), 1e-18), scaled(make_sphere(12, 8), 1e18)));
}

TEST_CASE("Hard: the result does not depend on the scale, for powers of two") {
    const Mesh mesh = make_torus(20, 10);
    const auto one = bake::collapse(mesh);
    REQUIRE(one.ok());
    for (const double scale : {std::ldexp(1.0, -60), std::ldexp(1.0, 60)}) {
        const auto other = bake::collapse(scaled(mesh, scale));
        REQUIRE(other.ok());
        REQUIRE(other->mesh.splits.size() == one->mesh.splits.size());
        REQUIRE(other->mesh.triangles == one->mesh.triangles);
        REQUIRE(other->mesh.parents == one->mesh.parents);
    }
}

TEST_CASE("Hard: all in one plane, on one line, in one point") {
    require_sound(make_grid(20),
                  [](const bake::CollapseResult& result) { REQUIRE(result.mesh.base_vertices <= 64); });
    Mesh tilted = make_grid(20);
    for (Float3& p : tilted.positions) p = {p.x, p.y, 0.3f * p.x - 1.7f * p.y + 100};
    require_sound(tilted);
    Mesh line = make_grid(10);
    for (Float3& p : line.positions) p = {p.x, p.x, p.x};
    require_sound(line);
    Mesh point = make_sphere(10, 8);
    for (Float3& p : point.positions) p = {3, 4, 5};
    require_sound(point);
    Mesh zero = make_torus(10, 8);
    for (Float3& p : zero.positions) p = {};
    require_sound(zero);
}

TEST_CASE("Hard: long slivers") {
    Mesh mesh = make_grid(30);
    for (Float3& p : mesh.positions) p = {p.x * 1000, p.y * 1e-3f, 0.01f * std::sin(p.x * 30)};
    require_sound(mesh);
    Mesh needle = make_sphere(24, 16);
    for (Float3& p : needle.positions) p = {p.x, p.y, p.z * 1e5f};
    require_sound(needle,
                  [](const bake::CollapseResult& result) { REQUIRE(result.mesh.base_vertices <= 64); });
}

TEST_CASE("Hard: vertices that no triangle uses are left out and counted") {
    Mesh mesh = make_sphere(10, 8);
    mesh.positions.push_back({7, 7, 7});
    mesh.positions.insert(mesh.positions.begin(), {-7, 0, 0});
    for (Triangle& t : mesh.triangles)
        for (std::uint32_t& v : t) ++v;
    require_sound(mesh);
    require_sound(Mesh{{{1, 2, 3}}, {}, {}});
}

TEST_CASE("Hard: duplicates, both ways round, and triangles stacked on an edge") {
    Mesh mesh = make_sphere(12, 8);
    const auto triangles = mesh.triangles;
    for (const Triangle& t : triangles) mesh.triangles.push_back(t);
    require_sound(mesh);
    for (const Triangle& t : triangles) mesh.triangles.push_back({t[0], t[2], t[1]});
    require_sound(mesh);
    Mesh book{{{0, 0, 0}, {0, 0, 1}}, {}, {}};
    for (std::uint32_t i = 0; i < 300; ++i) {
        book.positions.push_back({float(std::cos(i)), float(std::sin(i)), float(i % 5) * 0.2f});
        book.triangles.push_back({0, 1, 2 + i});
    }
    require_sound(book);
    // A pillow: two triangles back to back.
    require_sound(Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}, {}});
    // The same triangle a thousand times.
    Mesh stack{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}};
    stack.triangles.assign(1000, {0, 1, 2});
    require_sound(stack);
}

TEST_CASE("Hard: copies of triangles collapse as their originals do") {
    const Mesh singles[] = {make_torus(24, 12), make_grid(12),
                            join(make_sphere(12, 8), make_sphere(6, 4), {3, 0, 0})};
    const auto distinct = [](Mesh level, bool turned) {
        if (turned)
            for (Triangle& t : level.triangles) std::swap(t[1], t[2]);
        auto bits = triangle_bits(level);
        bits.erase(std::unique(bits.begin(), bits.end()), bits.end());
        return bits;
    };
    for (const Mesh& single : singles)
        for (const bool both_ways : {false, true})
            for (const bool shuffled : {false, true}) {
                CAPTURE(both_ways, shuffled, single.triangles.size());
                // Each beginning at another corner, and some before their originals.
                Mesh mesh = single;
                for (std::size_t i = 0; i < single.triangles.size(); ++i) {
                    const Triangle& t = single.triangles[i];
                    const std::size_t k = i % 3;
                    Triangle copy{t[k], t[(k + 1) % 3], t[(k + 2) % 3]};
                    if (both_ways) std::swap(copy[1], copy[2]);
                    mesh.triangles.push_back(copy);
                    if (i % 7 == 0) mesh.triangles.push_back(copy);
                    if (shuffled && i % 5 != 0) std::swap(mesh.triangles[i], mesh.triangles.back());
                }
                require_sound(mesh);
                const auto one = bake::collapse(single), more = bake::collapse(mesh);
                REQUIRE(one.ok());
                REQUIRE(more.ok());
                const ProgressiveMesh& copies = more->mesh;
                REQUIRE(copies.groups.empty());
                CHECK(more->report.duplicate_triangles == mesh.triangles.size() - single.triangles.size());
                CHECK(copies.base_vertices <= one->mesh.base_vertices + 2);
                for (std::size_t level = 0; level <= copies.splits.size(); ++level) {
                    const Mesh here = cut(copies, level);
                    const auto sides = distinct(here, false);
                    // Each triangle has its other side at every level.
                    if (both_ways)
                        REQUIRE(sides == distinct(here, true));
                    else
                        REQUIRE(2 * sides.size() <= here.triangles.size());
                    if (shuffled) continue;
                    const Mesh there = cut(one->mesh, level);
                    REQUIRE(error_at(copies, level) == error_at(one->mesh, level));
                    REQUIRE(sides.size() == there.triangles.size() * (both_ways ? 2 : 1));
                    if (!both_ways) REQUIRE(sides == distinct(there, false));
                }
            }
}

TEST_CASE("Hard: triangles that run either way collapse as if they agreed, and come back as they were") {
    for (const Mesh& single : {make_torus(24, 12), make_grid(12), make_sphere(16, 10)}) {
        std::mt19937 random(7);
        Mesh mesh = single;
        for (Triangle& t : mesh.triangles)
            if (random() % 3 == 0) std::swap(t[1], t[2]);
        CAPTURE(mesh.triangles.size());
        require_sound(mesh);
        const auto one = bake::collapse(single), either = bake::collapse(mesh);
        REQUIRE(one.ok());
        REQUIRE(either.ok());
        CHECK(either->report.duplicate_triangles == 0);
        CHECK(either->mesh.groups.empty());
        CHECK(either->mesh.positions == one->mesh.positions);
        CHECK(either->mesh.splits.size() == one->mesh.splits.size());
        CHECK(either->mesh.parents == one->mesh.parents);
    }
}

TEST_CASE("Hard: sheets that cross, touch and share edges come down to few vertices") {
    const auto welded = [](const std::vector<Mesh>& parts) {
        Mesh all;
        for (const Mesh& part : parts) {
            std::vector<std::uint32_t> at;
            for (const Float3& p : part.positions) {
                auto same = std::find_if(all.positions.begin(), all.positions.end(), [&](const Float3& q) {
                    return std::abs(p.x - q.x) + std::abs(p.y - q.y) + std::abs(p.z - q.z) < 1e-5f;
                });
                at.push_back(std::uint32_t(same - all.positions.begin()));
                if (same == all.positions.end()) all.positions.push_back(p);
            }
            for (const Triangle& t : part.triangles) all.triangles.push_back({at[t[0]], at[t[1]], at[t[2]]});
        }
        return all;
    };
    const auto turned = [](Mesh mesh, int axis, float shift) {
        for (Float3& p : mesh.positions)
            p = axis == 0   ? Float3{shift, p.x, p.y}
                : axis == 1 ? Float3{p.x, shift, p.y}
                            : Float3{p.x, p.y, shift};
        return mesh;
    };
    const Mesh grid = make_grid(12);
    // Cells of foam: walls in three directions, where they meet there are edges of four triangles and points
    // of many fans.
    std::vector<Mesh> walls;
    for (const int axis : {0, 1, 2})
        for (const float shift : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) walls.push_back(turned(grid, axis, shift));
    // Spheres in a row, each touching the next in a point.
    std::vector<Mesh> beads;
    for (int i = 0; i < 6; ++i) {
        beads.push_back(make_sphere(16, 10));
        for (Float3& p : beads.back().positions) p.z += 2 * float(i);
    }
    // Patches, each hanging on the next by one corner.
    std::vector<Mesh> chain;
    for (int i = 0; i < 40; ++i) {
        chain.push_back(make_grid(2));
        for (Float3& p : chain.back().positions) {
            p = {p.x + float(i), p.y + float(i), 0};
            p.z = 0.3f * std::sin(p.x + p.y);
        }
    }
    const struct {
        const char* name;
        Mesh mesh;
        std::size_t most;
    } cases[] = {{"foam", welded(walls), 64}, {"beads", welded(beads), 32}, {"chain", welded(chain), 130}};
    for (const auto& [name, mesh, most] : cases) {
        CAPTURE(name);
        const Topology input = topology(mesh);
        REQUIRE_FALSE(input.manifold());
        require_sound(mesh);
        const auto result = bake::collapse(mesh);
        REQUIRE(result.ok());
        CHECK(result->mesh.base_vertices <= most);
        for (std::size_t level = 0; level <= result->mesh.splits.size();
             level += 1 + result->mesh.splits.size() / 20) {
            const Topology here = topology(cut(result->mesh, level));
            // What is connected, and how often around, stays.
            CHECK(here.parts.size() == input.parts.size());
            CHECK(here.parts.front().euler == input.parts.front().euler);
            CHECK(here.boundary_edges <= input.boundary_edges);
            CHECK(here.non_manifold_edges <= input.non_manifold_edges);
            CHECK(here.non_manifold_vertices <= input.non_manifold_vertices);
        }
    }
}

TEST_CASE("Hard: a Moebius strip and a Klein bottle have no two sides") {
    for (const bool closed : {false, true}) {
        constexpr int n = 30, m = 10;
        Mesh mesh;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < m; ++j) {
                const double u = 6.283185307179586 * i / n, v = closed ? 6.283185307179586 * j / m : 0;
                const double s = closed ? 0.4 * std::sin(v) : 0.08 * (j - (m - 1) / 2.0),
                             c = closed ? 0.4 * std::sin(2 * v) : 0;
                const double r = 1 + s * std::cos(u / 2) - c * std::sin(u / 2);
                mesh.positions.push_back({float(r * std::cos(u)), float(r * std::sin(u)),
                                          float(s * std::sin(u / 2) + c * std::cos(u / 2))});
            }
        const auto at = [&](int i, int j) {
            if (i == n) j = closed ? (m - j) % m : m - 1 - j;
            return std::uint32_t((i % n) * m + j % m);
        };
        for (int i = 0; i < n; ++i)
            for (int j = 0; j + (closed ? 0 : 1) < m; ++j) {
                mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, (j + 1) % (closed ? m : m + 1))});
                mesh.triangles.push_back({at(i, j), at(i + 1, (j + 1) % (closed ? m : m + 1)),
                                          at(i, (j + 1) % (closed ? m : m + 1))});
            }
        if (mesh_fault(mesh)) FAIL("the test's own mesh is unsound");
        CAPTURE(closed);
        require_sound(mesh);
    }
}

TEST_CASE("Hard: random soups") {
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        CAPTURE(seed);
        std::mt19937 random(seed);
        Mesh mesh;
        const std::uint32_t vertices = 4 + random() % 40, triangles = 1 + random() % 200;
        // Every third on a coarse lattice, so that points coincide.
        for (std::uint32_t i = 0; i < vertices; ++i) {
            const auto c = [&] {
                return seed % 3 == 0 ? float(random() % 3) : float(random() % 10000) * 1e-4f;
            };
            const float x = c(), y = c(), z = c();
            mesh.positions.push_back({x, y, z});
        }
        std::vector<bool> used(vertices, false);
        while (mesh.triangles.size() < triangles) {
            const Triangle t{std::uint32_t(random() % vertices), std::uint32_t(random() % vertices),
                             std::uint32_t(random() % vertices)};
            if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
            mesh.triangles.push_back(t);
            for (const std::uint32_t v : t) used[v] = true;
        }
        for (std::uint32_t v = 0; v < vertices; ++v)
            if (!used[v]) mesh.triangles.push_back({v, (v + 1) % vertices, (v + 2) % vertices});
        if (seed % 2) mesh.weights = some_weights(vertices);
        const Topology input = topology(mesh);
        require_sound(mesh, [&](const bake::CollapseResult& result) {
            // Whatever comes in: nothing gets worse.
            LiveMesh live(result.mesh);
            for (std::size_t level = 0; level <= live.max_level(); ++level) {
                live.go_to(level);
                const Topology here = topology(live.snapshot());
                REQUIRE(here.boundary_edges <= input.boundary_edges);
                REQUIRE(here.non_manifold_edges <= input.non_manifold_edges);
                REQUIRE(here.non_manifold_vertices <= input.non_manifold_vertices);
            }
        });
    }
}
