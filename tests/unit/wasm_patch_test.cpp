// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What the WebAssembly module does beside the library, compiled for the machine at hand: patches of arrays,
// in every order of levels, keep a page's arrays as the level is.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "decorated.hpp"
#include "patch.hpp"
#include "vsplit/live_mesh.hpp"

using namespace vsplit;

namespace {

template <class Value>
void apply(const web::Stretches<Value>& patch, std::vector<Value>& to) {
    std::size_t at = 0;
    for (std::size_t r = 0; r < patch.ranges.size(); r += 2) {
        const std::size_t first = patch.ranges[r], count = patch.ranges[r + 1];
        REQUIRE(count > 0);
        to.resize(std::max(to.size(), first + count));
        for (std::size_t i = 0; i < count; ++i) to[first + i] = patch.values[at + i];
        at += count;
    }
    REQUIRE(at == patch.values.size());
}

struct Page {
    std::vector<float> positions;
    std::vector<std::vector<float>> attributes;
    std::vector<std::int16_t> normals;
    std::vector<std::vector<std::uint32_t>> indices;
    std::size_t sent = 0;

    void take(web::Patcher& patcher, LiveBuffers& live) {
        patcher.take(live);
        apply(patcher.positions(live), positions);
        attributes.resize(live.attribute_count());
        for (std::size_t i = 0; i < attributes.size(); ++i) {
            const auto values = live.attribute(i);
            apply(patcher.vertex_values(values, std::uint32_t(values.size() / live.vertex_count())),
                  attributes[i]);
        }
        apply(patcher.normals(live), normals);
        sent = 0;
        for (std::uint32_t g = 0; g < indices.size(); ++g) {
            sent += patcher.group(g).values.size();
            apply(patcher.group(g), indices[g]);
        }
    }
};

void check(const ProgressiveMesh& mesh, std::uint32_t groups, std::uint32_t seed, float scale) {
    REQUIRE(progressive_mesh_fault(mesh) == nullptr);
    std::mt19937 random(seed);
    LiveBuffers live;
    live.track_runs(true);
    live.begin(mesh, std::uint32_t(mesh.positions.size()), std::uint32_t(mesh.triangles.size()),
               std::uint32_t(mesh.splits.size()), std::uint32_t(mesh.corner_changes.size()),
               std::uint32_t(mesh.moves.size()));
    web::Patcher patcher(groups, true);
    if (scale != 1)
        for (std::uint32_t g = 0; g < groups; ++g) patcher.set_scale(g, scale);
    Page page;
    page.indices.resize(groups);
    for (int i = 0; i < 40; ++i) {
        live.jump(i == 0 ? mesh.splits.size() / 2 : random() % (mesh.splits.size() + 1));
        if (i % 5 == 4) continue;  // patches add up
        page.take(patcher, live);
        const Mesh level = cut(mesh, live.level());
        std::vector<std::vector<std::uint32_t>> wanted(groups);
        for (std::size_t t = 0; t < level.triangles.size(); ++t)
            wanted[level.groups.empty() ? 0 : level.groups[t]].insert(
                wanted[level.groups.empty() ? 0 : level.groups[t]].end(), level.triangles[t].begin(),
                level.triangles[t].end());
        std::vector<char> drawn(level.positions.size());
        for (std::uint32_t g = 0; g < groups; ++g) {
            REQUIRE(patcher.group_triangles(g) * std::size_t{3} == wanted[g].size());
            REQUIRE(page.indices[g].size() >= wanted[g].size());
            REQUIRE(std::equal(wanted[g].begin(), wanted[g].end(), page.indices[g].begin()));
            for (const std::uint32_t v : wanted[g]) drawn[v] = 1;
        }
        for (std::size_t v = 0; v < drawn.size(); ++v) {
            if (!drawn[v]) continue;
            const Float3& p = level.positions[v];
            REQUIRE(page.positions[3 * v] == scale * p.x);
            REQUIRE(page.positions[3 * v + 1] == scale * p.y);
            REQUIRE(page.positions[3 * v + 2] == scale * p.z);
            const double length =
                std::hypot(page.normals[4 * v], page.normals[4 * v + 1], page.normals[4 * v + 2]);
            REQUIRE(std::abs(length - 32767) < 3);
        }
        for (std::size_t a = 0; a < level.attributes.size(); ++a)
            REQUIRE(std::equal(level.attributes[a].values.begin(), level.attributes[a].values.end(),
                               page.attributes[a].begin()));
    }
    page.take(patcher, live);
    page.take(patcher, live);
    CHECK(page.sent == 0);
}

}  // namespace

TEST_CASE("Patches keep a page's arrays as the level is") {
    const ProgressiveMesh plain = test::naive_record(test::make_torus(40, 30), 3);
    check(plain, 1, 3, 1);
    check(plain, 1, 4, 0.25f);
    check(test::decorated(plain, 5), 5, 5, 1);
    check(test::decorated(plain, 6), 5, 6, 8);
}

TEST_CASE("Patches: seams, components that return, groups without triangles") {
    check(test::seam(true), 1, 7, 1);
    check(test::returning(), 1, 8, 2);
    check(test::decorated(test::returning(), 9), 7, 9, 2);
}

TEST_CASE("A patch after a few splits is small") {
    const ProgressiveMesh mesh = test::naive_record(test::make_torus(80, 60), 10);
    LiveBuffers live;
    live.track_runs(true);
    live.begin(mesh, std::uint32_t(mesh.positions.size()), std::uint32_t(mesh.triangles.size()),
               std::uint32_t(mesh.splits.size()), std::uint32_t(mesh.corner_changes.size()),
               std::uint32_t(mesh.moves.size()));
    web::Patcher patcher(1, true);
    live.jump(mesh.splits.size() - 5);
    Page page;
    page.indices.resize(1);
    page.take(patcher, live);
    REQUIRE(page.sent == std::size_t{3} * live.triangle_count());
    live.refine(5);
    page.take(patcher, live);
    CHECK(page.sent > 0);
    CHECK(page.sent < std::size_t{3} * live.triangle_count() / 4);
}
