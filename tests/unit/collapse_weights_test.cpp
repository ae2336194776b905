// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Painted weights: averaged on a collapse, carried through the file, kept where they are large.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

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

constexpr float kInf = std::numeric_limits<float>::infinity();

bake::CollapseResult collapsed(const Mesh& mesh, bake::Cost cost = bake::Cost::kQuadric,
                               bake::Placement placement = bake::Placement::kOptimal) {
    bake::CollapseOptions options;
    options.cost = cost;
    options.placement = placement;
    auto result = bake::collapse(mesh, options);
    REQUIRE(result.ok());
    const char* fault = progressive_mesh_fault(result->mesh);
    CAPTURE(fault ? fault : "");
    REQUIRE(fault == nullptr);
    return *std::move(result);
}

constexpr bake::Cost kCosts[] = {bake::Cost::kQuadric, bake::Cost::kPaper};

}  // namespace

TEST_CASE("Weights: on a collapse the vertex that remains takes the average") {
    for (auto [name, mesh] : mesh_family())
        for (const bake::Cost cost : kCosts) {
            CAPTURE(name, int(cost));
            mesh.weights = some_weights(mesh.positions.size());
            const ProgressiveMesh record = collapsed(mesh, cost).mesh;
            LiveMesh live(record);
            std::size_t wrong = 0;
            for (std::size_t level = 0; level < live.max_level(); ++level) {
                live.go_to(level);
                const std::vector<float> before(live.weights().begin(), live.weights().end());
                live.go_to(level + 1);
                for (std::uint32_t child = std::uint32_t(before.size()); child < live.weights().size();
                     ++child) {
                    const std::uint32_t parent = record.parents[child];
                    if (parent == kNoVertex) continue;
                    wrong += before[parent] != 0.5f * (live.weights()[parent] + live.weights()[child]);
                }
            }
            REQUIRE(wrong == 0);
            REQUIRE(triangle_bits(live.snapshot()) == triangle_bits(mesh));
        }
}

TEST_CASE("Weights: a tetrahedron's by hand") {
    // Two tetrahedra base to base: one collapse leads to a tetrahedron, and no further.
    Mesh mesh = make_sphere(3, 2);
    mesh.weights = {2, 4, 4, 4, 2};
    const ProgressiveMesh record = collapsed(mesh).mesh;
    REQUIRE(record.base_vertices == 4);
    REQUIRE(record.base_triangles == 4);
    REQUIRE(record.splits.size() == 1);
    // A pole (2) and a vertex of the ring (4) became one of 3, or two of the ring one of 4.
    const Mesh base = cut(record, 0);
    std::vector<float> weights = base.weights;
    std::sort(weights.begin(), weights.end());
    const bool pole = weights == std::vector<float>{2, 3, 4, 4},
               ring = weights == std::vector<float>{2, 2, 4, 4};
    CAPTURE(weights);
    REQUIRE((pole || ring));
    const Mesh full = cut(record, 1);
    weights = full.weights;
    std::sort(weights.begin(), weights.end());
    REQUIRE(weights == std::vector<float>{2, 2, 4, 4, 4});
}

TEST_CASE("Weights: through the file and back") {
    for (auto [name, mesh] : mesh_family()) {
        CAPTURE(name);
        mesh.weights = some_weights(mesh.positions.size());
        for (std::size_t v = 0; v < mesh.weights.size(); v += 7) mesh.weights[v] = v % 2 ? kInf : 0;
        const ProgressiveMesh record = collapsed(mesh).mesh;
        WriteOptions lossless;
        lossless.position_bits = 0;
        const auto bytes = write_progressive_mesh(record, lossless);
        REQUIRE(bytes.ok());
        const auto back = read_progressive_mesh(*bytes);
        REQUIRE(back.ok());
        REQUIRE(triangle_bits(cut(*back, back->splits.size())) == triangle_bits(mesh));
    }
}

TEST_CASE("Weights: a painted area keeps clearly more of its vertices") {
    // A bumpy sheet, a third of it painted.
    Mesh mesh = make_grid(40);
    for (Float3& p : mesh.positions) p.z = 0.05f * std::sin(19 * p.x) * std::cos(23 * p.y);
    const auto marked = [](const Float3& p) { return p.x < 0.34f; };
    const double area = double(std::count_if(mesh.positions.begin(), mesh.positions.end(), marked));
    Mesh painted = mesh;
    for (const Float3& p : mesh.positions) painted.weights.push_back(marked(p) ? 10.0f : 1.0f);
    for (const bake::Cost cost : kCosts)
        for (const bake::Placement placement : {bake::Placement::kOptimal, bake::Placement::kEndpoint}) {
            CAPTURE(int(cost), int(placement));
            const auto kept = [&](const Mesh& input, std::size_t percent) {
                const ProgressiveMesh record = collapsed(input, cost, placement).mesh;
                const Mesh now =
                    cut(record, level_for_triangles(record, input.triangles.size() * percent / 100));
                return double(std::count_if(now.positions.begin(), now.positions.end(), marked)) / area;
            };
            for (const std::size_t percent : {60, 40}) {
                const double plain = kept(mesh, percent), with = kept(painted, percent);
                CAPTURE(percent, plain, with);
                CHECK(with > plain + 0.15);
                CHECK(with > 0.01 * double(percent) + 0.15);
            }
        }
}

TEST_CASE(
    "Weights: weight 10 keeps half as much again of a marked area, and the rest is as good as without") {
    // A bumpy torus of as many vertices as the paper's whale, as many of them marked.
    Mesh mesh = make_torus(69, 38);
    for (Float3& p : mesh.positions) {
        const float bump = 1 + 0.03f * std::sin(21 * p.x) * std::cos(17 * p.y) * std::sin(13 * p.z + 1);
        p = {p.x * bump, p.y * bump, p.z * bump};
    }
    const Float3 centre = mesh.positions.front();
    const auto distance2 = [&](const Float3& p) {
        return (p.x - centre.x) * (p.x - centre.x) + (p.y - centre.y) * (p.y - centre.y) +
               (p.z - centre.z) * (p.z - centre.z);
    };
    std::vector<float> distances;
    for (const Float3& p : mesh.positions) distances.push_back(distance2(p));
    std::nth_element(distances.begin(), distances.begin() + 568, distances.end());
    const float limit = distances[568];
    const auto marked = [&](const Float3& p) { return distance2(p) <= limit; };
    Mesh painted = mesh;
    std::vector<Float3> rest;
    for (const Float3& p : mesh.positions) {
        painted.weights.push_back(marked(p) ? 10.0f : 1.0f);
        if (!marked(p)) rest.push_back(p);
    }
    const double area = double(mesh.positions.size() - rest.size());
    const ProgressiveMesh with = collapsed(painted).mesh, plain = collapsed(mesh).mesh;
    const auto rest_triangles = [&](const Mesh& level) {
        return std::count_if(level.triangles.begin(), level.triangles.end(), [&](const Triangle& t) {
            return std::none_of(t.begin(), t.end(),
                                [&](std::uint32_t v) { return marked(level.positions[v]); });
        });
    };
    const auto mean_distance = [&](const Mesh& level) {
        double sum = 0;
        for (const Float3& p : rest) sum += distance_to(level, {p});
        return sum / double(rest.size());
    };
    for (const double ratio : {0.6, 0.4}) {
        const Mesh level =
            cut(with, level_for_vertices(with, std::uint64_t(ratio * double(mesh.positions.size()))));
        const double kept =
            double(std::count_if(level.positions.begin(), level.positions.end(), marked)) / area;
        CAPTURE(ratio, kept);
        CHECK(kept >= ratio + 0.2);
        // The unweighted level with as many triangles in the rest.
        const auto wanted = rest_triangles(level);
        std::size_t at = 0;
        while (at < plain.splits.size() && rest_triangles(cut(plain, at)) < wanted) ++at;
        const double ours = mean_distance(level), theirs = mean_distance(cut(plain, at));
        CAPTURE(ours, theirs);
        CHECK(ours <= 1.05 * theirs);
    }
}

TEST_CASE("Weights: a weight of 1 everywhere changes nothing") {
    Mesh plain = make_torus(20, 10);
    Mesh ones = plain;
    ones.weights.assign(ones.positions.size(), 1.0f);
    for (const bake::Cost cost : kCosts) {
        ProgressiveMesh a = collapsed(plain, cost).mesh, b = collapsed(ones, cost).mesh;
        REQUIRE(std::all_of(b.weights.begin(), b.weights.end(), [](float w) { return w == 1; }));
        b.weights.clear();
        REQUIRE(same_bytes(a, b));
    }
}

TEST_CASE("Weights: infinite ones never move nor go") {
    for (auto [name, mesh] : mesh_family())
        for (const bake::Cost cost : kCosts) {
            CAPTURE(name, int(cost));
            mesh.weights.assign(mesh.positions.size(), 1.0f);
            std::multiset<std::array<float, 3>> fixed;
            for (std::size_t v = 0; v < mesh.positions.size(); v += 17) {
                mesh.weights[v] = kInf;
                fixed.insert({mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z});
            }
            const bake::CollapseResult result = collapsed(mesh, cost);
            REQUIRE(result.report.fixed_vertices >= fixed.size());
            const Mesh base = cut(result.mesh, 0);
            std::multiset<std::array<float, 3>> found;
            for (std::size_t v = 0; v < base.positions.size(); ++v)
                if (std::isinf(base.weights[v]))
                    found.insert({base.positions[v].x, base.positions[v].y, base.positions[v].z});
            // Others fold into them, and so take an infinite average: those that were marked are among the
            // found.
            REQUIRE(std::includes(found.begin(), found.end(), fixed.begin(), fixed.end()));
            // None of them ever moves.
            for (const VertexMove& move : result.mesh.moves)
                if (move.vertex < base.positions.size() && std::isinf(base.weights[move.vertex]))
                    REQUIRE(std::memcmp(&move.position, &base.positions[move.vertex], sizeof(Float3)) == 0);
        }
}

TEST_CASE("Weights: all infinite, nothing collapses; all zero, everything may") {
    Mesh mesh = make_sphere(12, 8);
    mesh.weights.assign(mesh.positions.size(), kInf);
    const bake::CollapseResult fixed = collapsed(mesh);
    REQUIRE(fixed.mesh.splits.empty());
    REQUIRE(fixed.mesh.base_triangles == mesh.triangles.size());
    REQUIRE(triangle_bits(cut(fixed.mesh, 0)) == triangle_bits(mesh));
    mesh.weights.assign(mesh.positions.size(), 0.0f);
    for (const bake::Cost cost : kCosts) {
        const bake::CollapseResult free = collapsed(mesh, cost);
        REQUIRE(free.mesh.base_vertices <= 64);
        REQUIRE(triangle_bits(cut(free.mesh, free.mesh.splits.size())) == triangle_bits(mesh));
    }
    // From tiny to huge, in one mesh.
    for (std::size_t v = 0; v < mesh.weights.size(); ++v)
        mesh.weights[v] = std::pow(10.0f, float(int(v % 71)) - 35);
    for (const bake::Cost cost : kCosts) {
        const bake::CollapseResult wide = collapsed(mesh, cost);
        REQUIRE(triangle_bits(cut(wide.mesh, wide.mesh.splits.size())) == triangle_bits(mesh));
    }
}
