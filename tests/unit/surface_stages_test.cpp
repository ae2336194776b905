// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// The stages against brute force, degenerate and hostile clouds, and what the interface promises.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include "points/frame.hpp"
#include "points/tetrahedra.hpp"
#include "surface/boundary.hpp"
#include "surface/labels.hpp"
#include "surface/power.hpp"
#include "surface/tidy.hpp"
#include "surface_samples.hpp"
#include "vsplit/bake/meshes.hpp"
#include "vsplit/bake/surface.hpp"

using namespace vsplit;
using namespace vsplit::bake;
using namespace vsplit::test;

namespace {

Tetrahedra boxed_delaunay(const std::vector<Position>& positions, std::vector<Vec3>& points) {
    points.clear();
    for (const Position& p : positions) points.push_back({p[0], p[1], p[2]});
    points = unique_points(points).points;
    std::vector<Vec3> all = points;
    for (int k = 0; k < 8; ++k)
        all.push_back({k & 1 ? 10.0 : -10.0, k & 2 ? 10.0 : -10.0, k & 4 ? 10.0 : -10.0});
    return tetrahedralise(all, points.size(), 1);
}

void check_manifold(const Mesh& mesh) {
    REQUIRE(mesh_fault(mesh) == nullptr);
    const MeshSurvey survey = survey_mesh(mesh);
    CHECK(survey.closed());
    CHECK(survey.manifold());
}

}  // namespace

TEST_CASE("Delaunay cells: empty balls, mutual neighbours, the promised order") {
    std::vector<Vec3> points;
    const Tetrahedra t = boxed_delaunay(sphere_points(60, {0, 0, 0}, 1, 21), points);
    const Balls balls = circumscribe(t);
    CHECK(std::is_sorted(t.cells.begin(), t.cells.end()));
    for (std::uint32_t c = 0; c < t.cells.size(); ++c) {
        const Corners& v = t.cells[c];
        CHECK(v[0] < v[1]);
        CHECK(v[1] < std::min(v[2], v[3]));
        const Vec3 a = t.points[v[0]];
        CHECK(dot(cross(t.points[v[1]] - a, t.points[v[2]] - a), t.points[v[3]] - a) > 0);
        for (const Vec3& p : t.points)
            CHECK(squared_length(p - balls.centres[c]) >= balls.squared_radii[c] * (1 - 1e-7));
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t n = t.neighbours[c][k];
            if (n == kNoCell) continue;
            CHECK(std::count(t.neighbours[n].begin(), t.neighbours[n].end(), c) == 1);
            for (std::size_t i = 0; i < 4; ++i)
                if (i != k) CHECK(std::count(t.cells[n].begin(), t.cells[n].end(), v[i]) == 1);
        }
    }
}

TEST_CASE("poles are the farthest Voronoi vertices on either side, by brute force") {
    std::vector<Vec3> points;
    const Tetrahedra t = boxed_delaunay(torus_points(300, {0, 0, 0}, 1, 0.4, false, 22), points);
    const Balls balls = circumscribe(t);
    const Poles poles = find_poles(t, balls);
    for (std::uint32_t s = 0; s < points.size(); ++s) {
        double first = 0, second = 0;
        std::uint32_t best = kNoCell;
        for (std::uint32_t c = 0; c < t.cells.size(); ++c) {
            if (std::count(t.cells[c].begin(), t.cells[c].end(), s) == 0) continue;
            const double d = length(balls.centres[c] - points[s]);
            if (d > first * (1 + 1e-12)) first = d, best = c;
        }
        REQUIRE(best != kNoCell);
        for (std::uint32_t c = 0; c < t.cells.size(); ++c)
            if (std::count(t.cells[c].begin(), t.cells[c].end(), s) &&
                dot(balls.centres[c] - points[s], balls.centres[best] - points[s]) < 0)
                second = std::max(second, length(balls.centres[c] - points[s]));
        CHECK(length(balls.centres[poles.first[s]] - points[s]) == Approx(first));
        REQUIRE((poles.second[s] == kNoCell) == (second == 0));
        if (second > 0) CHECK(length(balls.centres[poles.second[s]] - points[s]) == Approx(second));
    }
}

TEST_CASE("labels of poles agree with the shape that was sampled") {
    std::vector<Vec3> points;
    const Tetrahedra t = boxed_delaunay(torus_points(2500, {0, 0, 0}, 1, 0.4, false, 23), points);
    const Balls balls = circumscribe(t);
    const Poles poles = find_poles(t, balls);
    const auto inside = label_cells(t, balls, poles, false);
    std::size_t judged = 0;
    for (const auto* list : {&poles.first, &poles.second})
        for (const std::uint32_t c : *list) {
            if (c == kNoCell) continue;
            const Vec3 p = balls.centres[c];
            const double ring = std::sqrt(p.x * p.x + p.y * p.y) - 1,
                         depth = 0.4 - std::sqrt(ring * ring + p.z * p.z);
            if (std::abs(depth) < 0.1) continue;  // too near the surface for samples to say
            ++judged;
            CHECK((inside[c] != 0) == (depth > 0));
        }
    CHECK(judged > 4000);
}

TEST_CASE("any labelling has a manifold boundary") {
    std::vector<Vec3> points;
    std::vector<Position> cube;
    scatter(cube, 200, 1, 24);
    const Tetrahedra t = boxed_delaunay(cube, points);
    std::mt19937 random(25);
    for (int round = 0; round < 30; ++round) {
        std::vector<std::uint8_t> inside(t.cells.size());
        for (std::size_t c = 0; c < inside.size(); ++c) {
            const bool box = std::any_of(t.cells[c].begin(), t.cells[c].end(),
                                         [&](std::uint32_t v) { return v >= t.samples; });
            inside[c] = !box && int(random() % 30) < round;
        }
        BoundaryReport report;
        Crust crust = extract_boundary(t, inside, report);
        if (crust.triangles.empty()) continue;
        Mesh mesh;
        for (const Vec3& p : crust.points) mesh.positions.push_back({float(p.x), float(p.y), float(p.z)});
        mesh.triangles = crust.triangles;
        check_manifold(mesh);
        // No two vertices in one place: a reader that welds by position must not undo it.
        std::set<std::array<float, 3>> places;
        for (const Float3& p : mesh.positions) places.insert({p.x, p.y, p.z});
        CHECK(places.size() == mesh.positions.size());
        TidyReport tidy;
        repair_slivers(crust, 0.3, tidy);
        mesh.positions.clear();
        for (const Vec3& p : crust.points) mesh.positions.push_back({float(p.x), float(p.y), float(p.z)});
        mesh.triangles = crust.triangles;
        check_manifold(mesh);
    }
}

TEST_CASE("the regular triangulation is empty of nearer balls, by brute force") {
    std::vector<Position> places;
    scatter(places, 80, 1, 26);
    std::vector<Vec3> points;
    std::vector<double> weights;
    for (const Position& p : places) {
        points.push_back({p[0], p[1], p[2]});
        weights.push_back(0.05 * std::abs(p[0] * p[1]));
    }
    const PowerDiagram diagram = regular_triangulation(points, weights);
    REQUIRE(diagram.cells.size() > 100);
    for (const Corners& c : diagram.cells) {
        const Vec3 a = points[c[0]], u = points[c[1]] - a, v = points[c[2]] - a, w = points[c[3]] - a;
        const auto right = [&](Vec3 e, std::uint32_t q) {
            return squared_length(e) + weights[c[0]] - weights[q];
        };
        const Vec3 centre =
            a + (cross(v, w) * right(u, c[1]) + cross(w, u) * right(v, c[2]) + cross(u, v) * right(w, c[3])) *
                    (0.5 / dot(u, cross(v, w)));
        const double power = squared_length(centre - a) - weights[c[0]];
        for (std::size_t i = 0; i < points.size(); ++i)
            CHECK(squared_length(centre - points[i]) - weights[i] >= power - 1e-6 * (1 + std::abs(power)));
    }
}

TEST_CASE("clouds without a surface give an error, degenerate ones a result or an error, and no crash") {
    const auto code = [](const std::vector<Position>& points) {
        const auto r = reconstruct(points);
        return r.ok() ? std::string("ok") : error_code_name(r.error().code);
    };
    CHECK(code({}) == std::string("argument"));
    CHECK(code({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}) == std::string("argument"));
    CHECK(code(std::vector<Position>(50, Position{1, 2, 3})) == std::string("argument"));
    CHECK(code({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, std::nan("")}}) == std::string("argument"));
    CHECK(code({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, std::numeric_limits<double>::infinity()}}) ==
          std::string("argument"));
    std::vector<Position> line, plane, block, huge, spread;
    for (int i = 0; i < 40; ++i) line.push_back({double(i), 2.0 * i, -3.0 * i});
    for (int i = 0; i < 100; ++i) plane.push_back({double(i % 10), double(i / 10), 5});
    for (int i = 0; i < 125; ++i) block.push_back({double(i % 5), double(i / 5 % 5), double(i / 25)});
    for (const Position& p : sphere_points(500, {0, 0, 0}, 1e30, 27)) huge.push_back(p);
    for (int i = 0; i < 200; ++i)
        spread.push_back({std::ldexp(1.0, i - 100), std::ldexp(double(i % 7), -i), double(i % 3)});
    for (const auto* points : {&line, &plane, &block, &huge, &spread})
        for (const CrustMethod method : {CrustMethod::kModified, CrustMethod::kClassic}) {
            ReconstructOptions options;
            options.method = method;
            const auto r = reconstruct(*points, options);
            if (r.ok())
                check_manifold(r->mesh);
            else
                CHECK(r.error().code == ErrorCode::kArgument);
        }
    CHECK(code(line) == std::string("argument"));
    CHECK(code(plane) == std::string("argument"));
    CHECK(code(huge) == std::string("ok"));
    huge[0][0] = 1.7e308, huge[1][0] = -1.7e308;
    CHECK(code(huge) == std::string("argument"));
    // A plane is a fine sheet, though.
    ReconstructOptions open;
    open.open = true;
    const auto sheet = reconstruct(plane, open);
    REQUIRE(sheet.ok());
    CHECK(sheet->mesh.triangles.size() == 162);
    CHECK(sheet->report.boundary_loops == 1);
    // A tetrahedron's corners, and a cube's, are closed surfaces.
    const auto tetrahedron = reconstruct(std::vector<Position>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    if (tetrahedron.ok()) check_manifold(tetrahedron->mesh);
}

TEST_CASE("random clouds of any size: closed and manifold, or an error") {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        std::vector<Position> points;
        scatter(points, 4 + int(seed * 7), 1, seed + 100);
        // Some on a coarse grid, so that much is cospherical, and repeated.
        if (seed % 3 == 0)
            for (Position& p : points)
                for (double& x : p) x = std::round(x * 4) / 4;
        const auto r = reconstruct(points);
        INFO(seed);
        if (!r.ok())
            CHECK(r.error().code == ErrorCode::kArgument);
        else
            check_manifold(r->mesh);
        ReconstructOptions open;
        open.open = true;
        const auto sheet = reconstruct(points, open);
        if (sheet.ok()) CHECK(survey_mesh(sheet->mesh).manifold());
    }
}

TEST_CASE("duplicates do not matter") {
    auto points = sphere_points(800, {0, 0, 0}, 1, 28);
    const auto once = reconstruct(points);
    points.insert(points.end(), points.begin(), points.begin() + 300);
    const auto twice = reconstruct(points);
    REQUIRE((once.ok() && twice.ok()));
    CHECK(twice->report.duplicates == 300);
    CHECK(once->mesh.positions == twice->mesh.positions);
    CHECK(once->mesh.triangles == twice->mesh.triangles);
}

TEST_CASE("same bytes for any number of threads, concurrent triangulation included") {
    auto points = torus_points(101000, {0, 0, 0}, 2, 0.7, false, 29);
    // A part on a grid: ties between cospherical points must not depend on who came first.
    for (std::size_t i = 0; i < 20000; ++i)
        for (double& x : points[i]) x = std::round(x * 256) / 256;
    ReconstructOptions one, two;
    one.threads = 1;
    two.threads = 2;
    const auto a = reconstruct(points, one), b = reconstruct(points, two), c = reconstruct(points);
    REQUIRE((a.ok() && b.ok() && c.ok()));
    CHECK(a->mesh.positions == b->mesh.positions);
    CHECK(a->mesh.triangles == b->mesh.triangles);
    CHECK(a->mesh.positions == c->mesh.positions);
    CHECK(a->mesh.triangles == c->mesh.triangles);
}

TEST_CASE("stages report and can be stopped") {
    const auto points = sphere_points(500, {0, 0, 0}, 1, 30);
    std::vector<std::string> names;
    double last = 0;
    const auto r = reconstruct(points, {}, [&](std::string_view name, double done) {
        names.emplace_back(name);
        CHECK(done >= last);
        last = done;
        return true;
    });
    REQUIRE(r.ok());
    CHECK(last == 1);
    REQUIRE(r->report.stages.size() + 1 == names.size());
    for (std::size_t i = 0; i < r->report.stages.size(); ++i) {
        CHECK(r->report.stages[i].name == names[i]);
        CHECK(r->report.stages[i].cpu_seconds >= 0);
        CHECK(r->report.stages[i].peak_bytes > 1000000);
    }
    for (std::size_t stop = 0; stop < names.size(); ++stop) {
        std::size_t calls = 0;
        const auto stopped =
            reconstruct(points, {}, [&](std::string_view, double) { return calls++ < stop; });
        REQUIRE_FALSE(stopped.ok());
        CHECK(stopped.error().code == ErrorCode::kCancelled);
    }
    ReconstructOptions bad;
    bad.open = true;
    bad.method = CrustMethod::kClassic;
    CHECK(reconstruct(points, bad).error().code == ErrorCode::kArgument);
}

TEST_CASE("the medial axis of a torus is its circle; dumps are VTK files of the right size") {
    const auto points = torus_points(3000, {0, 0, 0}, 2, 0.5, false, 31);
    for (const CrustMethod method : {CrustMethod::kModified, CrustMethod::kClassic}) {
        ReconstructOptions options;
        options.method = method;
        options.medial_axis = true;
        options.dumps = kDumpVoronoi | kDumpPoles | kDumpPower | kDumpLabels;
        std::vector<std::string> files;
        options.sink = [&](std::string_view name, std::span<const std::byte> bytes) {
            files.emplace_back(name);
            const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
            CHECK(text.starts_with("<?xml"));
            CHECK(text.ends_with("</VTKFile>\n"));
            // The last array's announced size must end the appended data.
            const std::size_t data = text.find("encoding=\"raw\">\n_") + 17;
            const std::size_t last = std::stoull(text.substr(text.rfind("offset=\"") + 8));
            std::uint64_t size = 0;
            REQUIRE(data + last + 8 <= text.size());
            std::memcpy(&size, text.data() + data + last, 8);
            CHECK(text.substr(data + last + 8 + size).starts_with("\n</AppendedData>"));
        };
        const auto r = reconstruct(points, options);
        REQUIRE(r.ok());
        CHECK(files.size() == (method == CrustMethod::kClassic ? 3 : 4));
        CHECK(r->report.poles > 3000);
        const MedialAxis& axis = r->medial_axis;
        REQUIRE(axis.centres.size() == axis.radii.size());
        REQUIRE(axis.centres.size() > 1000);
        CHECK_FALSE(axis.triangles.empty());
        std::size_t near = 0;
        for (std::size_t i = 0; i < axis.centres.size(); ++i) {
            const auto& c = axis.centres[i];
            const double ring = std::sqrt(c[0] * c[0] + c[1] * c[1]) - 2,
                         off = std::sqrt(ring * ring + c[2] * c[2]);
            near += off < 0.15 && std::abs(axis.radii[i] - 0.5) < 0.15;
        }
        CHECK(double(near) > 0.9 * double(axis.centres.size()));
        for (const auto& e : axis.edges) CHECK((e[0] < e[1] && e[1] < axis.centres.size()));
        CHECK(encode_medial_axis(axis).size() > axis.centres.size() * 32);
    }
}
