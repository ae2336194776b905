// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Borders that lie on each other but for rounding: no gap opens between them at any level.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "family.hpp"
#include "mesh_checks.hpp"
#include "vsplit/bake/collapse.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/read.hpp"
#include "vsplit/write.hpp"

using namespace vsplit;
using namespace vsplit::test;

namespace {

constexpr int kSlices = 48, kStacks = 24;

/// A sphere of two sheets whose borders, at the equator, are `gap` apart; `normals`: with them.
Mesh make_shells(float gap, bool normals) {
    const Mesh sphere = make_sphere(kSlices, kStacks);
    Mesh mesh;
    for (const float side : {1.0f, -1.0f}) {
        std::vector<std::uint32_t> index(sphere.positions.size(), ~0u);
        for (const Triangle& t : sphere.triangles) {
            const float z = sphere.positions[t[0]].z + sphere.positions[t[1]].z + sphere.positions[t[2]].z;
            if ((z > 0) != (side > 0)) continue;
            Triangle own;
            for (std::size_t k = 0; k < 3; ++k) {
                std::uint32_t& v = index[t[k]];
                if (v == ~0u) {
                    v = std::uint32_t(mesh.positions.size());
                    Float3 p = sphere.positions[t[k]];
                    // The lower sheet's border stands out, more here than there.
                    if (side < 0 && std::abs(p.z) < 1e-6f) {
                        const float out = 1 + gap * (0.6f + 0.4f * std::cos(7 * p.x));
                        p = {out * p.x, out * p.y, p.z};
                    }
                    mesh.positions.push_back(p);
                }
                own[k] = v;
            }
            mesh.triangles.push_back(own);
        }
    }
    if (normals) {
        mesh.attributes = {{"NORMAL", Semantic::kNormal, 3, {}}};
        for (const Float3& p : mesh.positions) {
            const float r = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
            mesh.attributes[0].values.insert(mesh.attributes[0].values.end(), {p.x / r, p.y / r, p.z / r});
        }
    }
    return mesh;
}

/// Boundary edges of the mesh whose vertices at one place are one.
std::size_t open_edges(const Mesh& mesh) {
    Mesh welded;
    std::vector<std::array<float, 3>> places;
    const auto place = [](const Float3& p) { return std::array{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}; };
    for (const Float3& p : mesh.positions) places.push_back(place(p));
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    for (const auto& p : places) welded.positions.push_back({p[0], p[1], p[2]});
    for (Triangle t : mesh.triangles) {
        for (std::uint32_t& v : t)
            v = std::uint32_t(std::lower_bound(places.begin(), places.end(), place(mesh.positions[v])) -
                              places.begin());
        welded.triangles.push_back(t);
    }
    return topology(welded).boundary_edges;
}

std::vector<std::array<std::uint32_t, 12>> full_bits(const ProgressiveMesh& mesh) {
    return triangle_bits(cut(mesh, mesh.splits.size()));
}

}  // namespace

TEST_CASE("Stitch: sheets that meet but for rounding stay closed, and come apart at the end") {
    const float gap = 1e-4f;
    for (const bool normals : {false, true})
        for (const auto placement : {bake::Placement::kOptimal, bake::Placement::kEndpoint})
            for (const bool weighted : {false, true}) {
                Mesh mesh = make_shells(gap, normals);
                if (weighted)
                    for (const Float3& p : mesh.positions) mesh.weights.push_back(p.x > 0.52f ? 2.0f : 1.0f);
                CAPTURE(normals, placement == bake::Placement::kEndpoint, weighted);
                REQUIRE(open_edges(mesh) == 2 * kSlices);
                bake::CollapseOptions options;
                options.placement = placement;
                const auto result = bake::collapse(mesh, options);
                REQUIRE(result.ok());
                REQUIRE(result->report.stitched_vertices == kSlices);
                REQUIRE(result->report.unused_vertices == 0);
                const ProgressiveMesh& baked = result->mesh;
                REQUIRE(progressive_mesh_fault(baked) == nullptr);
                REQUIRE(full_bits(baked) == triangle_bits(mesh));
                for (const double ratio : {0.95, 0.5, 0.25, 0.1, 0.04}) {
                    const std::size_t level =
                        level_for_triangles(baked, std::uint64_t(ratio * double(mesh.triangles.size())));
                    CAPTURE(ratio);
                    REQUIRE(triangles_at(baked, level) > 0);
                    REQUIRE(open_edges(cut(baked, level)) == 0);
                    REQUIRE(error_at(baked, level) >= double(gap));
                }
                // The last splits bring nothing but the gap.
                const std::size_t last = baked.splits.size() - 1;
                REQUIRE(triangles_at(baked, last) == mesh.triangles.size());
                REQUIRE(error_at(baked, last) >= 0.2 * double(gap));
                REQUIRE(error_at(baked, last) <= 1.01 * double(gap));
                // And through the file.
                WriteOptions exact;
                exact.position_bits = 0;
                const auto bytes = write_progressive_mesh(baked, exact);
                REQUIRE(bytes.ok());
                const auto back = read_progressive_mesh(*bytes);
                REQUIRE(back.ok());
                REQUIRE(full_bits(*back) == triangle_bits(mesh));
            }
}

TEST_CASE("Stitch: what is farther apart, kept apart or turned off is not stitched") {
    const auto stitched = [](const Mesh& mesh, const bake::CollapseOptions& options) {
        const auto result = bake::collapse(mesh, options);
        REQUIRE(result.ok());
        REQUIRE(full_bits(result->mesh) == triangle_bits(mesh));
        return result->report.stitched_vertices;
    };
    for (const bool normals : {false, true}) {
        CAPTURE(normals);
        bake::CollapseOptions off;
        off.stitch = 0;
        const Mesh near = make_shells(1e-4f, normals);
        REQUIRE(stitched(near, off) == 0);
        // Without it a gap opens, as the other test would see.
        const auto open = bake::collapse(near, off);
        REQUIRE(open_edges(cut(open->mesh, level_for_triangles(open->mesh, near.triangles.size() / 4))) > 0);
        bake::CollapseOptions locked;
        locked.lock_boundary = true;
        REQUIRE(stitched(near, locked) == 0);
        REQUIRE(stitched(make_shells(0.01f, normals), {}) == 0);
        Mesh pinned = near;
        pinned.weights.assign(pinned.positions.size(), std::numeric_limits<float>::infinity());
        REQUIRE(stitched(pinned, {}) == 0);
    }
    // Of different parts.
    const Mesh shells = make_shells(1e-4f, true);
    bake::CollapseOptions parts;
    for (std::size_t v = 0; v < shells.positions.size(); ++v)
        parts.part_of.push_back(v < shells.positions.size() / 2);
    REQUIRE(stitched(shells, parts) == 0);
    // A plain mesh whose sheets share places, but no vertices.
    REQUIRE(stitched(make_shells(0, false), {}) == 0);
}

TEST_CASE("Stitch: thin strips, slivers and borders all at one place keep their triangles") {
    // A strip narrower than what counts as near, folded onto itself: its own ends must not meet.
    Mesh strip;
    for (int i = 0; i <= 20; ++i)
        for (const float y : {0.0f, 5e-5f}) strip.positions.push_back({float(i) / 20, y, 0});
    for (std::uint32_t i = 0; i < 20; ++i) {
        strip.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 3});
        strip.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 1});
    }
    // Two hundred spikes whose tips are nearly at one place.
    Mesh spikes;
    for (int i = 0; i < 200; ++i) {
        const float a = 0.0314159f * float(i), e = 1e-6f * float(i % 7);
        const auto first = std::uint32_t(spikes.positions.size());
        spikes.positions.push_back({e, 1e-6f * float(i % 5), 0});
        spikes.positions.push_back({std::cos(a), std::sin(a), 0});
        spikes.positions.push_back(
            {std::cos(a + 0.0314159f), std::sin(a + 0.0314159f), 1e-6f * float(i % 3)});
        spikes.triangles.push_back({first, first + 1, first + 2});
    }
    // A double-sided sheet, one side a little above the other.
    Mesh sides = make_grid(12);
    Mesh other = make_grid(12);
    for (Float3& p : other.positions) p.z = 1e-5f;
    for (Triangle& t : other.triangles) std::swap(t[0], t[1]);
    sides = join(sides, other);
    for (Mesh mesh : {strip, spikes, sides})
        for (const bool normals : {false, true}) {
            if (normals) {
                mesh.attributes = {{"NORMAL", Semantic::kNormal, 3, {}}};
                for (std::size_t v = 0; v < mesh.positions.size(); ++v)
                    mesh.attributes[0].values.insert(mesh.attributes[0].values.end(), {0, 0, 1});
            }
            const auto result = bake::collapse(mesh, {});
            REQUIRE(result.ok());
            REQUIRE(progressive_mesh_fault(result->mesh) == nullptr);
            REQUIRE(full_bits(result->mesh) == triangle_bits(mesh));
        }
}
