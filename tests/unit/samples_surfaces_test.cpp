// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "vsplit/bake/meshes.hpp"
#include "vsplit/bake/samples.hpp"

using namespace vsplit;
using namespace vsplit::bake;

namespace {

double distance(const Float3& a, const Float3& b) {
    const double x = double(a.x) - b.x, y = double(a.y) - b.y, z = double(a.z) - b.z;
    return std::sqrt(x * x + y * y + z * z);
}

double area(const Mesh& mesh) {
    double sum = 0;
    for (const Triangle& t : mesh.triangles) {
        const double a = distance(mesh.positions[t[0]], mesh.positions[t[1]]);
        const double b = distance(mesh.positions[t[1]], mesh.positions[t[2]]);
        const double c = distance(mesh.positions[t[2]], mesh.positions[t[0]]), s = (a + b + c) / 2;
        sum += std::sqrt(std::max(0.0, s * (s - a) * (s - b) * (s - c)));
    }
    return sum;
}

double volume(const Mesh& mesh) {
    double sum = 0;
    for (const Triangle& t : mesh.triangles) {
        const Float3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
        sum += double(a.x) * (double(b.y) * c.z - double(b.z) * c.y) +
               double(a.y) * (double(b.z) * c.x - double(b.x) * c.z) +
               double(a.z) * (double(b.x) * c.y - double(b.y) * c.x);
    }
    return sum / 6;
}

double smallest_angle(const Mesh& mesh, const Triangle& t) {
    double e[3];
    for (std::size_t k = 0; k < 3; ++k) e[k] = distance(mesh.positions[t[k]], mesh.positions[t[(k + 1) % 3]]);
    std::sort(e, e + 3);
    return std::acos((e[1] * e[1] + e[2] * e[2] - e[0] * e[0]) / (2 * e[1] * e[2])) * 57.29577951;
}

/// Distance from each of every `step`-th point to its nearest other, sorted.
std::vector<double> spacings(const std::vector<Float3>& points, std::size_t step) {
    std::vector<double> nearest;
    for (std::size_t i = 0; i < points.size(); i += step) {
        double least = 1e300;
        for (std::size_t j = 0; j < points.size(); ++j)
            if (j != i) least = std::min(least, distance(points[i], points[j]));
        nearest.push_back(least);
    }
    std::sort(nearest.begin(), nearest.end());
    return nearest;
}

}  // namespace

TEST_CASE("The whale is one closed manifold of genus 0, of about the size asked for") {
    for (const std::size_t n : {100u, 101u, 150u, 250u, 400u, 1000u, 2645u, 8000u, 30000u}) {
        const Mesh mesh = make_sample_mesh(Sample::kWhale, n);
        INFO(n << " asked, " << mesh.triangles.size() << " made");
        REQUIRE(mesh_fault(mesh) == nullptr);
        CHECK(std::abs(double(mesh.triangles.size()) / double(n) - 1) <= 0.1);
        const MeshSurvey s = survey_mesh(mesh);
        CHECK(s.closed());
        CHECK(s.manifold());
        CHECK(s.components == 1);
        CHECK(s.duplicate_triangles == 0);
        CHECK(s.zero_area_triangles == 0);
        CHECK(2 * s.vertices == s.triangles + 4);
        CHECK(volume(mesh) > 1);  // Faces look outwards.
    }
}

TEST_CASE("The whale's triangles are round, and its volume settles") {
    const Mesh mesh = make_sample_mesh(Sample::kWhale, 40000);
    double mean = 0, least = 180;
    for (const Triangle& t : mesh.triangles) {
        const double a = smallest_angle(mesh, t);
        mean += a;
        least = std::min(least, a);
    }
    CHECK(mean / double(mesh.triangles.size()) > 38);
    CHECK(least > 5);
    CHECK(volume(mesh) == Approx(volume(make_sample_mesh(Sample::kWhale, 12000))).epsilon(0.02));
}

TEST_CASE("The ocean is one sheet with one boundary") {
    for (const std::size_t n : {100u, 333u, 5000u, 40000u}) {
        const Mesh mesh = make_sample_mesh(Sample::kOcean, n);
        INFO(n << " asked, " << mesh.triangles.size() << " made");
        REQUIRE(mesh_fault(mesh) == nullptr);
        CHECK(std::abs(double(mesh.triangles.size()) / double(n) - 1) <= 0.1);
        const MeshSurvey s = survey_mesh(mesh);
        CHECK(s.manifold());
        CHECK(s.components == 1);
        CHECK(s.zero_area_triangles == 0);
        // A disc: V - E + F = 1, and its one boundary loop has as many edges as vertices.
        CHECK(2 * s.vertices == s.triangles + s.boundary_edges + 2);
        // Nothing folds over: seen from above, every triangle shows its front.
        std::size_t folded = 0;
        for (const Triangle& t : mesh.triangles) {
            const Float3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
            folded +=
                (double(b.z) - a.z) * (double(c.x) - a.x) - (double(b.x) - a.x) * (double(c.z) - a.z) <= 0;
        }
        CHECK(folded == 0);
    }
}

TEST_CASE("Sample points are exact in number, evenly spread, and on the surface") {
    for (const Sample sample : {Sample::kWhale, Sample::kOcean}) {
        const std::size_t count = sample == Sample::kWhale ? 5000 : 20000;
        const std::vector<Float3> points = make_sample_points(sample, count);
        REQUIRE(points.size() == count);
        const Mesh mesh = make_sample_mesh(sample, 60000);
        // The widest spacing that this many points can have on this area.
        const double ideal = std::sqrt(2 * area(mesh) / (std::sqrt(3.0) * double(count)));
        const std::vector<double> near = spacings(points, count / 500);
        INFO("nearest " << near.front() / ideal << ", median " << near[near.size() / 2] / ideal);
        CHECK(near.front() > 0.45 * ideal);
        CHECK(near[near.size() / 2] > 0.65 * ideal);
        CHECK(near.back() < 1.3 * ideal);
        // Near some vertex of a fine mesh of the same surface, and the other way round: no part is left bare.
        const double edge = std::sqrt(area(mesh) / double(mesh.triangles.size())) * 2;
        double off = 0, bare = 0;
        for (std::size_t i = 0; i < count; i += count / 100) {
            double least = 1e300;
            for (const Float3& q : mesh.positions) least = std::min(least, distance(points[i], q));
            off = std::max(off, least);
        }
        for (std::size_t i = 0; i < mesh.positions.size(); i += mesh.positions.size() / 300) {
            double least = 1e300;
            for (const Float3& p : points) least = std::min(least, distance(p, mesh.positions[i]));
            bare = std::max(bare, least);
        }
        CHECK(off < edge);
        CHECK(bare < 1.1 * ideal);
    }
    CHECK(make_sample_points(Sample::kWhale, 0).empty());
    CHECK(make_sample_points(Sample::kOcean, 1).size() == 1);
    CHECK(make_sample_points(Sample::kWhale, 7).size() == 7);
}

TEST_CASE("Samples do not depend on the number of threads") {
    const auto make = [](std::size_t threads) {
        const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                                threads);
        return std::tuple(make_sample_mesh(Sample::kWhale, 5000), make_sample_mesh(Sample::kOcean, 5000),
                          make_sample_points(Sample::kWhale, 1000), make_sample_points(Sample::kOcean, 1000));
    };
    const auto one = make(1), four = make(4);
    CHECK(encode_ply(std::get<0>(one)) == encode_ply(std::get<0>(four)));
    CHECK(encode_ply(std::get<1>(one)) == encode_ply(std::get<1>(four)));
    CHECK(std::get<2>(one) == std::get<2>(four));
    CHECK(std::get<3>(one) == std::get<3>(four));
}
