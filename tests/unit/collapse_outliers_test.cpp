// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Collapses that deviate much wait: nothing but the order changes, and levels come closer to the input.
#include <tbb/global_control.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <string_view>

#include "collapse/measure.hpp"
#include "collapse/outliers.hpp"
#include "collapse/reorder.hpp"
#include "collapse/triangle_distance.hpp"
#include "family.hpp"
#include "mesh_checks.hpp"
#include "vsplit/bake/collapse.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/write.hpp"

using namespace vsplit;
using namespace vsplit::test;

namespace {

ProgressiveMesh collapsed(const Mesh& mesh, const bake::CollapseOptions& options) {
    auto result = bake::collapse(mesh, options);
    REQUIRE(result.ok());
    const char* fault = progressive_mesh_fault(result->mesh);
    CAPTURE(fault ? fault : "");
    REQUIRE(fault == nullptr);
    return std::move(result->mesh);
}

bake::CollapseOptions record_only() {
    bake::CollapseOptions options;
    options.put_off_outliers = options.calibrate = false;
    return options;
}

/// A sphere with dents and bumps at random, each of its own size.
Mesh rough_sphere(int slices) {
    Mesh mesh = make_sphere(slices, slices / 2);
    std::uint32_t state = 1;
    for (Float3& p : mesh.positions) {
        state = state * 1664525u + 1013904223u;
        const float size = 0.02f * std::pow(float(state >> 8) / float(1 << 24), 4.0f) + 1.0f;
        p = {p.x * size, p.y * size, p.z * size};
    }
    return mesh;
}

bake::Double3 wide(const Float3& p) {
    return {double(p.x), double(p.y), double(p.z)};
}

/// From the vertices of one mesh to the triangles of another, all against all.
double farthest(const Mesh& from, const Mesh& to) {
    double most = 0;
    for (const Float3& p : from.positions) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Triangle& t : to.triangles)
            nearest = std::min(
                nearest, bake::distance2_to_triangle(wide(p), wide(to.positions[t[0]]),
                                                     wide(to.positions[t[1]]), wide(to.positions[t[2]])));
        most = std::max(most, nearest);
    }
    return std::sqrt(most);
}

double both_ways(const Mesh& a, const Mesh& b) {
    return std::max(farthest(a, b), farthest(b, a));
}

std::vector<std::byte> bytes_of(const ProgressiveMesh& mesh) {
    auto file = write_progressive_mesh(mesh);
    REQUIRE(file.ok());
    return *std::move(file);
}

}  // namespace

TEST_CASE("the splits of a record in their own order are the record", "[collapse]") {
    for (const auto& [name, mesh] : mesh_family()) {
        CAPTURE(name);
        const ProgressiveMesh record = collapsed(mesh, record_only());
        ProgressiveMesh same = record;
        std::vector<std::uint32_t> order(record.splits.size());
        std::iota(order.begin(), order.end(), 0u);
        bake::reorder_splits(same, order);
        REQUIRE(same.parents == record.parents);
        REQUIRE(same.triangles == record.triangles);
        REQUIRE(bytes_of(same) == bytes_of(record));
    }
}

TEST_CASE("put off or not, a record has the same collapses", "[collapse]") {
    for (const auto& [name, mesh] : mesh_family()) {
        CAPTURE(name);
        const ProgressiveMesh record = collapsed(mesh, record_only());
        bake::CollapseOptions options;
        const ProgressiveMesh sorted = collapsed(mesh, options);
        REQUIRE(sorted.splits.size() == record.splits.size());
        REQUIRE(triangle_bits(cut(sorted, 0)) == triangle_bits(cut(record, 0)));
        REQUIRE(triangle_bits(cut(sorted, sorted.splits.size())) ==
                triangle_bits(cut(record, record.splits.size())));
    }
}

TEST_CASE("outliers are put off the same way by any number of threads", "[collapse]") {
    const Mesh mesh = rough_sphere(120);
    std::vector<std::byte> first;
    for (const std::size_t threads : {1, 2, 3, 8}) {
        CAPTURE(threads);
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const auto bytes = bytes_of(collapsed(mesh, {}));
        if (first.empty()) first = bytes;
        REQUIRE(bytes == first);
    }
}

TEST_CASE("levels come closer where outliers wait, and errors bound the distance", "[collapse]") {
    const Mesh mesh = rough_sphere(70);
    const ProgressiveMesh record = collapsed(mesh, record_only()), sorted = collapsed(mesh, {});
    double product = 1;
    int levels = 0;
    for (const double share : {0.8, 0.6, 0.4, 0.2}) {
        CAPTURE(share);
        const auto count = std::uint64_t(share * double(mesh.triangles.size()));
        const std::size_t level = level_for_triangles(sorted, count);
        const Mesh before = cut(record, level_for_triangles(record, count)), after = cut(sorted, level);
        REQUIRE(after.triangles.size() + 2 >= before.triangles.size());
        const double distance = both_ways(mesh, after);
        product *= distance / both_ways(mesh, before);
        ++levels;
        CHECK(distance <= error_at(sorted, level));
        CHECK(distance >= error_at(sorted, level) / 3);
    }
    CHECK(std::pow(product, 1.0 / levels) < 0.9);
}

TEST_CASE("what is flat deviates by nothing, and a collapse by what it cut off", "[collapse]") {
    const ProgressiveMesh flat = collapsed(make_grid(20), record_only());
    // The coarsest lose the corners.
    const std::vector<float> none = bake::measure_collapses(flat, {});
    REQUIRE(none.size() > 300);
    for (std::size_t i = 60; i < none.size(); ++i) REQUIRE(none[i] < 1e-6f);

    const Mesh sphere = make_sphere(40, 20);
    const ProgressiveMesh round = collapsed(sphere, record_only());
    const std::vector<float> deviations = bake::measure_collapses(round, {});
    REQUIRE(deviations.size() == round.splits.size());
    // Level n has what all collapses before it did, and no more.
    float most = 0;
    for (std::size_t level = round.splits.size(); level-- > 0;) {
        most = std::max(most, deviations[level]);
        if (level % 100 != 0) continue;
        const double distance = both_ways(sphere, cut(round, level));
        CAPTURE(level, most, distance);
        CHECK(distance <= 1.3 * double(most));
        CHECK(distance >= double(most) / 3);
    }
}

TEST_CASE("measuring stops when asked to", "[collapse]") {
    const ProgressiveMesh record = collapsed(make_sphere(40, 20), record_only());
    REQUIRE(bake::measure_collapses(record, [](std::string_view, double) { return false; }).empty());
}
