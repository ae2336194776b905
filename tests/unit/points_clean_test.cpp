// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Cleaning and the Voronoi tessellation, checked against what is known or counted by brute force.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "vsplit/bake/points.hpp"

using namespace vsplit;
using namespace vsplit::bake;

namespace {

using Position = std::array<double, 3>;

std::vector<Position> sphere(int count, double noise, std::uint64_t seed = 1) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::vector<Position> points;
    for (int i = 0; i < count; ++i) {
        Position p{normal(random), normal(random), normal(random)};
        const double r = (1 + noise * normal(random)) / std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        points.push_back({p[0] * r, p[1] * r, p[2] * r});
    }
    return points;
}

double mean_miss(const std::vector<Position>& points) {
    double sum = 0;
    for (const Position& p : points) sum += std::abs(std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) - 1);
    return sum / double(points.size());
}

CleanedCloud clean(std::vector<Position> points, const CleanOptions& options = {}) {
    PointCloud cloud;
    cloud.positions = std::move(points);
    auto result = clean_points(std::move(cloud), options);
    REQUIRE(result.ok());
    return std::move(result).value();
}

}  // namespace

TEST_CASE("a clean cloud is left as it is") {
    const auto points = sphere(3000, 0);
    const CleanedCloud cleaned = clean(points);
    CHECK(cleaned.cloud.positions == points);
    CHECK(cleaned.report.duplicates == 0);
    CHECK(cleaned.report.outliers == 0);
    CHECK(cleaned.report.smooth_neighbours == 0);
    CHECK(cleaned.report.measure.spacing == Approx(std::sqrt(4 * 3.14159 / 3000 / 3.14159)).epsilon(0.15));
    CHECK_FALSE(cleaned.report.steps.empty());
}

TEST_CASE("duplicates go, the first of each stays, and attributes stay with their points") {
    PointCloud cloud;
    for (int i = 0; i < 50; ++i) {
        cloud.positions.push_back({double(i % 20), double(i % 20 * i % 7), 0.5});
        cloud.normals.push_back({float(i), 0, 0});
    }
    std::vector<Position> seen;
    std::vector<float> marks;
    for (std::size_t i = 0; i < 50; ++i)
        if (std::find(seen.begin(), seen.end(), cloud.positions[i]) == seen.end()) {
            seen.push_back(cloud.positions[i]);
            marks.push_back(cloud.normals[i][0]);
        }
    CleanOptions only;
    only.outlier_factor = 0;
    only.smooth = Smooth::kNone;
    const auto result = clean_points(cloud, only);
    REQUIRE(result.ok());
    CHECK(result->cloud.positions == seen);
    CHECK(result->report.duplicates == 50 - seen.size());
    for (std::size_t i = 0; i < marks.size(); ++i) CHECK(result->cloud.normals[i][0] == marks[i]);
}

TEST_CASE("outliers in space go, samples of the surface stay") {
    auto points = sphere(5000, 0);
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> box(-1.2, 1.2);
    const std::size_t samples = points.size();
    std::size_t far = 0;
    for (int i = 0; i < 250; ++i) {
        points.push_back({box(random), box(random), box(random)});
        const Position& p = points.back();
        far += std::abs(std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) - 1) > 0.2;
    }
    const CleanedCloud cleaned = clean(points);
    std::size_t kept_far = 0, kept_samples = 0;
    for (const Position& p : cleaned.cloud.positions) {
        const double miss = std::abs(std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) - 1);
        kept_far += miss > 0.2;
        kept_samples += miss < 1e-9;
    }
    CHECK(far > 100);
    CHECK(kept_far == 0);
    CHECK(kept_samples >= samples - 5);
}

TEST_CASE("noise is measured, and smoothed if there is enough of it") {
    const auto noisy = sphere(4000, 0.02);
    const CloudMeasure measured = measure_points(noisy);
    CHECK(measured.noise == Approx(0.02).epsilon(0.25));
    const CleanedCloud cleaned = clean(noisy);
    CHECK(cleaned.report.smooth_neighbours > 0);
    CHECK(mean_miss(cleaned.cloud.positions) < 0.6 * mean_miss(noisy));
    CleanOptions bilateral;
    bilateral.smooth = Smooth::kBilateral;
    CHECK(mean_miss(clean(noisy, bilateral).cloud.positions) < 0.8 * mean_miss(noisy));
}

TEST_CASE("thinning by a grid keeps one point a cell, by WLOP the share asked for") {
    CleanOptions grid;
    grid.thin = Thin::kGrid;
    grid.grid_cell = 0.2;
    const auto points = sphere(4000, 0);
    const CleanedCloud thinned = clean(points, grid);
    CHECK(thinned.cloud.positions.size() < 900);
    CHECK(thinned.cloud.positions.size() > 200);
    CHECK(thinned.report.thinned == 4000 - thinned.cloud.positions.size());
    for (const Position& p : thinned.cloud.positions)
        CHECK(std::find(points.begin(), points.end(), p) != points.end());
    CleanOptions wlop;
    wlop.thin = Thin::kWlop;
    wlop.wlop_share = 0.25;
    const CleanedCloud even = clean(sphere(800, 0.01), wlop);
    CHECK(even.cloud.positions.size() == 200);
    CHECK(mean_miss(even.cloud.positions) < 0.03);
}

TEST_CASE("cleaning refuses nonsense and stops when asked to") {
    CleanOptions bad;
    bad.outlier_factor = -1;
    CHECK(clean_points({}, bad).error().code == ErrorCode::kArgument);
    bad = {};
    bad.smooth_neighbours = 3;
    CHECK(clean_points({}, bad).error().code == ErrorCode::kArgument);
    PointCloud nan;
    nan.positions = {{0, 0, std::nan("")}};
    CHECK(clean_points(nan).error().code == ErrorCode::kArgument);
    CHECK(clean_points({}).ok());
    PointCloud cloud;
    cloud.positions = sphere(100, 0);
    CHECK(clean_points(cloud, {}, [](std::string_view, double) { return false; }).error().code ==
          ErrorCode::kCancelled);
}

TEST_CASE("cleaning gives the same for any number of threads and any scale") {
    auto noisy = sphere(3000, 0.02, 9);
    CleanOptions one, two;
    one.threads = 1;
    two.threads = 2;
    CHECK(clean(noisy, one).cloud.positions == clean(noisy, two).cloud.positions);
    for (Position& p : noisy)
        for (double& x : p) x *= 0x1p90;
    CHECK(clean(noisy).report.smooth_neighbours > 0);
}

TEST_CASE("Voronoi cells of a grid are its cubes") {
    std::vector<Position> grid;
    constexpr int n = 5;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < n; ++k) grid.push_back({i * 0.5, j * 0.5, k * 0.5});
    const auto cells = voronoi_cells(grid);
    REQUIRE(cells.ok());
    for (std::size_t v = 0; v < grid.size(); ++v) {
        const auto inner = [](double x) { return x > 0 && x < 2; };
        if (inner(grid[v][0]) && inner(grid[v][1]) && inner(grid[v][2])) {
            CHECK(cells->volumes[v] == Approx(0.125));
            CHECK(cells->densities[v] == Approx(8));
            CHECK(cells->neighbour_starts[v + 1] - cells->neighbour_starts[v] >= 6);
        } else {
            CHECK(std::isinf(cells->volumes[v]));
            CHECK(cells->densities[v] == 0);
        }
    }
}

TEST_CASE("Voronoi volumes and neighbours against brute force") {
    // Points in a unit cube whose boundary layer makes the inner cells bounded; volumes by sampling.
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> u(0, 1);
    std::vector<Position> points;
    for (int i = 0; i < 120; ++i) points.push_back({u(random), u(random), u(random)});
    points.push_back(points[7]);  // a duplicate shares its cell
    const auto cells = voronoi_cells(points);
    REQUIRE(cells.ok());
    CHECK(cells->volumes[7] == cells->volumes[120]);
    std::vector<double> counted(points.size(), 0);
    constexpr int kDice = 400000;
    // A cell that is bounded may still leave the cube: count over a larger one.
    const double side = 3, volume = side * side * side;
    for (int i = 0; i < kDice; ++i) {
        const Position p{side * u(random) - 1, side * u(random) - 1, side * u(random) - 1};
        std::size_t best = 0;
        double least = 1e300;
        for (std::size_t v = 0; v < 120; ++v) {
            double d = 0;
            for (std::size_t k = 0; k < 3; ++k) d += (p[k] - points[v][k]) * (p[k] - points[v][k]);
            if (d < least) least = d, best = v;
        }
        counted[best] += volume / kDice;
    }
    int compared = 0;
    for (std::size_t v = 0; v < 120; ++v) {
        if (std::isinf(cells->volumes[v]) || cells->volumes[v] > 0.03) continue;
        CHECK(cells->volumes[v] ==
              Approx(counted[v]).margin(4 * std::sqrt(counted[v] * volume / kDice) + 1e-4));
        ++compared;
        // Neighbourhood is mutual, and the nearest point is always a neighbour.
        std::size_t nearest = 0;
        double least = 1e300;
        for (std::size_t w = 0; w < 120; ++w) {
            double d = 0;
            for (std::size_t k = 0; k < 3; ++k)
                d += (points[w][k] - points[v][k]) * (points[w][k] - points[v][k]);
            if (w != v && d < least) least = d, nearest = w;
        }
        const auto has = [&](std::size_t a, std::size_t b) {
            return std::binary_search(cells->neighbours.begin() + cells->neighbour_starts[a],
                                      cells->neighbours.begin() + cells->neighbour_starts[a + 1],
                                      std::uint32_t(b));
        };
        CHECK(has(v, nearest));
        CHECK(has(nearest, v));
    }
    CHECK(compared > 20);
}

TEST_CASE("Voronoi cells refuse what has none") {
    CHECK(voronoi_cells({}).error().code == ErrorCode::kArgument);
    std::vector<Position> flat;
    for (int i = 0; i < 30; ++i) flat.push_back({double(i % 6), double(i / 6), 1});
    CHECK(voronoi_cells(flat).error().code == ErrorCode::kArgument);
    flat[0][2] = std::numeric_limits<double>::infinity();
    CHECK(voronoi_cells(flat).error().code == ErrorCode::kArgument);
}
