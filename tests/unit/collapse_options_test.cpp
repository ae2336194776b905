// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What the options promise: locks, the same result for any number of threads, stopping, refusing.
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "family.hpp"
#include "mesh_checks.hpp"
#include "naive_record.hpp"
#include "vsplit/bake/collapse.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/write.hpp"

using namespace vsplit;
using namespace vsplit::test;

namespace {

bake::CollapseResult collapsed(const Mesh& mesh, const bake::CollapseOptions& options = {}) {
    auto result = bake::collapse(mesh, options);
    REQUIRE(result.ok());
    const char* fault = progressive_mesh_fault(result->mesh);
    CAPTURE(fault ? fault : "");
    REQUIRE(fault == nullptr);
    REQUIRE(triangle_bits(cut(result->mesh, result->mesh.splits.size())) == triangle_bits(mesh));
    return *std::move(result);
}

std::array<float, 3> key(const Float3& p) {
    return {p.x, p.y, p.z};
}

std::multiset<std::array<float, 3>> places(const Mesh& mesh) {
    std::multiset<std::array<float, 3>> all;
    for (const Float3& p : mesh.positions) all.insert(key(p));
    return all;
}

/// A cube of side 1, n * n cells a face, welded.
Mesh make_cube(int n) {
    Mesh soup;
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {0, 1}) {
            const auto first = std::uint32_t(soup.positions.size());
            for (int i = 0; i <= n; ++i)
                for (int j = 0; j <= n; ++j) {
                    float c[3];
                    c[axis] = float(side);
                    c[(axis + 1) % 3] = float(i) / float(n);
                    c[(axis + 2) % 3] = float(j) / float(n);
                    soup.positions.push_back({c[0], c[1], c[2]});
                }
            const auto at = [&](int i, int j) { return first + std::uint32_t(i * (n + 1) + j); };
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    Triangle a{at(i, j), at(i + 1, j), at(i + 1, j + 1)},
                        b{at(i, j), at(i + 1, j + 1), at(i, j + 1)};
                    if (side == 0) {
                        std::swap(a[1], a[2]);
                        std::swap(b[1], b[2]);
                    }
                    soup.triangles.push_back(a);
                    soup.triangles.push_back(b);
                }
        }
    Mesh mesh;
    std::vector<std::uint32_t> welded;
    for (const Float3& p : soup.positions) {
        const auto same = std::find(mesh.positions.begin(), mesh.positions.end(), p);
        welded.push_back(std::uint32_t(same - mesh.positions.begin()));
        if (same == mesh.positions.end()) mesh.positions.push_back(p);
    }
    for (const Triangle& t : soup.triangles)
        mesh.triangles.push_back({welded[t[0]], welded[t[1]], welded[t[2]]});
    return mesh;
}

constexpr bake::Cost kCosts[] = {bake::Cost::kQuadric, bake::Cost::kPaper};

}  // namespace

TEST_CASE("Lock boundary: no vertex of the border moves or goes") {
    for (const auto& [name, mesh] : mesh_family()) {
        if (name != "grid" && name != "bowl" && name != "many components" && name != "non-manifold") continue;
        // The vertices of edges with one triangle, counted apart from the baker.
        std::set<std::pair<std::uint32_t, std::uint32_t>> once, seen;
        for (const Triangle& t : mesh.triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                const auto edge = std::minmax(t[k], t[(k + 1) % 3]);
                if (seen.insert(edge).second)
                    once.insert(edge);
                else
                    once.erase(edge);
            }
        std::multiset<std::array<float, 3>> border;
        std::set<std::uint32_t> on_border;
        for (const auto& [a, b] : once) on_border.insert({a, b});
        for (const std::uint32_t v : on_border) border.insert(key(mesh.positions[v]));
        REQUIRE_FALSE(border.empty());
        for (const bake::Cost cost : kCosts) {
            CAPTURE(name, int(cost));
            bake::CollapseOptions options;
            options.cost = cost;
            options.lock_boundary = true;
            const bake::CollapseResult result = collapsed(mesh, options);
            const Mesh base = cut(result.mesh, 0);
            const auto kept = places(base);
            REQUIRE(std::includes(kept.begin(), kept.end(), border.begin(), border.end()));
            REQUIRE(topology(base).boundary_edges == topology(mesh).boundary_edges);
            // And it is no empty promise: the inside went.
            if (name == "grid" || name == "bowl") REQUIRE(base.positions.size() < border.size() + 20);
        }
    }
}

TEST_CASE("Lock features: a cube keeps its edges, a locked angle above 90 degrees keeps nothing") {
    const Mesh cube = make_cube(8);
    REQUIRE(topology(cube).manifold());
    REQUIRE(topology(cube).boundary_edges == 0);
    std::multiset<std::array<float, 3>> ridges;
    for (const Float3& p : cube.positions) {
        const int flat = (p.x == 0 || p.x == 1) + (p.y == 0 || p.y == 1) + (p.z == 0 || p.z == 1);
        if (flat >= 2) ridges.insert(key(p));
    }
    REQUIRE(ridges.size() == 12 * 7 + 8);
    for (const bake::Cost cost : kCosts) {
        bake::CollapseOptions options;
        options.cost = cost;
        options.lock_features_degrees = 30;
        const bake::CollapseResult locked = collapsed(cube, options);
        const auto kept = places(cut(locked.mesh, 0));
        REQUIRE(std::includes(kept.begin(), kept.end(), ridges.begin(), ridges.end()));
        REQUIRE(kept.size() < ridges.size() + 30);
        REQUIRE(locked.report.fixed_vertices == ridges.size());
        options.lock_features_degrees = 120;
        const bake::CollapseResult free = collapsed(cube, options);
        REQUIRE(free.report.fixed_vertices == 0);
        REQUIRE(free.mesh.base_vertices <= 24);
    }
}

TEST_CASE("A cube keeps its shape by itself down to its corners") {
    const Mesh cube = make_cube(8);
    const ProgressiveMesh record = collapsed(cube).mesh;
    const Mesh twelve = cut(record, level_for_triangles(record, 12));
    REQUIRE(twelve.triangles.size() == 12);
    REQUIRE(distance_to(twelve, cube.positions) < 1e-4);
}

TEST_CASE("Law 3: the same bytes for any number of threads, and every time") {
    std::vector<NamedMesh> meshes = mesh_family();
    // Large enough that the loops are cut among threads.
    Mesh large = make_torus(110, 60);
    for (std::size_t v = 0; v < large.positions.size(); ++v)
        large.positions[v].z += 0.01f * float(std::sin(double(v)));
    large.weights = some_weights(large.positions.size());
    meshes.push_back({"large torus", large});
    for (const auto& [name, mesh] : meshes)
        for (const bake::Cost cost : kCosts) {
            CAPTURE(name, int(cost));
            bake::CollapseOptions options;
            options.cost = cost;
            std::vector<std::vector<std::byte>> files;
            for (const std::size_t threads : {1u, 2u, 8u, 8u}) {
                const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
                const auto result = bake::collapse(mesh, options);
                REQUIRE(result.ok());
                auto bytes = write_progressive_mesh(result->mesh);
                REQUIRE(bytes.ok());
                files.push_back(*std::move(bytes));
            }
            for (std::size_t i = 1; i < files.size(); ++i) REQUIRE(files[i] == files[0]);
        }
}

TEST_CASE("Law 3 holds where regions of a mesh are worked on at once") {
    Mesh mesh = make_torus(260, 140);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        mesh.positions[v].z += 0.003f * float(std::sin(double(v)));
    // A boundary, and parts that vanish.
    mesh.triangles.resize(mesh.triangles.size() - 1000);
    for (const float shift : {3.0f, 4.0f, 5.0f}) mesh = join(mesh, make_sphere(8, 6), {shift, 0, 0});
    std::vector<std::byte> first;
    for (const std::size_t threads : {1u, 2u, 8u}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        bake::CollapseOptions options;
        options.calibrate = false;
        const auto result = bake::collapse(mesh, options);
        REQUIRE(result.ok());
        REQUIRE(progressive_mesh_fault(result->mesh) == nullptr);
        REQUIRE(result->report.components_vanished == 3);
        auto bytes = write_progressive_mesh(result->mesh);
        REQUIRE(bytes.ok());
        if (first.empty()) first = *bytes;
        REQUIRE(*bytes == first);
    }
}

TEST_CASE("Progress: names the stage, never falls, and stops the work when asked") {
    const Mesh mesh = make_torus(120, 60);
    std::size_t calls = 0;
    double last = 0;
    std::string stage;
    bool ordered = true;
    const auto result = bake::collapse(mesh, {}, [&](std::string_view name, double done) {
        if (name != stage) last = 0;
        stage = name;
        ordered &= done >= last && done <= 1;
        last = done;
        ++calls;
        return true;
    });
    REQUIRE(result.ok());
    REQUIRE(calls > 0);
    REQUIRE(ordered);
    const auto quiet = bake::collapse(mesh);
    REQUIRE(quiet.ok());
    REQUIRE(same_bytes(quiet->mesh, result->mesh));

    // How often it is called depends on the machine's speed; that each stage calls, and stops when told to,
    // does not.
    for (const std::string_view stop_in : {"collapse", "measure errors"}) {
        std::size_t after = 0;
        bool asked = false;
        const auto stopped = bake::collapse(mesh, {}, [&](std::string_view name, double) {
            after += asked;
            asked |= name == stop_in;
            return !asked;
        });
        REQUIRE_FALSE(stopped.ok());
        REQUIRE(stopped.error().code == ErrorCode::kCancelled);
        REQUIRE(after == 0);
    }
}

TEST_CASE("Unsound meshes are refused") {
    const auto code = [](const Mesh& mesh) {
        const auto result = bake::collapse(mesh);
        REQUIRE_FALSE(result.ok());
        REQUIRE_FALSE(result.error().message.empty());
        return result.error().code;
    };
    const Mesh good = make_grid(3);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Mesh bad = good;
    bad.positions[2].y = nan;
    REQUIRE(code(bad) == ErrorCode::kArgument);
    bad = good;
    bad.positions[2].y = std::numeric_limits<float>::infinity();
    REQUIRE(code(bad) == ErrorCode::kArgument);
    bad = good;
    bad.triangles[1][1] = std::uint32_t(bad.positions.size());
    REQUIRE(code(bad) == ErrorCode::kArgument);
    bad = good;
    bad.triangles[1] = {1, 1, 2};
    REQUIRE(code(bad) == ErrorCode::kArgument);
    bad = good;
    bad.weights = {1, 2};
    REQUIRE(code(bad) == ErrorCode::kArgument);
    bad = good;
    bad.weights.assign(bad.positions.size(), 1);
    bad.weights[3] = -0.5f;
    REQUIRE(code(bad) == ErrorCode::kArgument);
    bad.weights[3] = nan;
    REQUIRE(code(bad) == ErrorCode::kArgument);
}

TEST_CASE("Senseless options are refused") {
    const Mesh good = make_grid(3);
    const auto refused = [&](const bake::CollapseOptions& options) {
        const auto result = bake::collapse(good, options);
        return !result.ok() && result.error().code == ErrorCode::kArgument;
    };
    bake::CollapseOptions options;
    options.boundary_weight = -1;
    CHECK(refused(options));
    options = {};
    options.lock_features_degrees = std::numeric_limits<double>::quiet_NaN();
    CHECK(refused(options));
    options = {};
    options.min_quality = std::numeric_limits<double>::quiet_NaN();
    CHECK(refused(options));
    options = {};
    options.min_normal_cosine = 2;
    CHECK(refused(options));
    for (double bake::CollapseOptions::*member :
         {&bake::CollapseOptions::volume_weight, &bake::CollapseOptions::regularisation,
          &bake::CollapseOptions::deviation_limit}) {
        options = {};
        options.*member = std::numeric_limits<double>::quiet_NaN();
        CHECK(refused(options));
        options.*member = std::numeric_limits<double>::infinity();
        CHECK(refused(options));
    }
}
