// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "family.hpp"
#include "mesh_files.hpp"

using namespace vsplit;
using namespace vsplit::bake;
using namespace vsplit::test;

namespace {

PolygonSoup soup_of(std::vector<Float3> positions, const std::vector<std::vector<std::uint32_t>>& faces) {
    PolygonSoup soup;
    soup.positions = std::move(positions);
    for (const auto& face : faces) {
        soup.corners.insert(soup.corners.end(), face.begin(), face.end());
        soup.face_starts.push_back(soup.corners.size());
    }
    return soup;
}

PolygonSoup polygon(const std::vector<Float3>& outline) {
    std::vector<std::uint32_t> face;
    for (std::uint32_t i = 0; i < outline.size(); ++i) face.push_back(i);
    return soup_of(outline, {face});
}

/// Signed areas about z: sum, and the sum of their absolute values. Equal where no triangle overlaps another.
std::pair<double, double> areas(const Mesh& mesh) {
    double sum = 0, absolute = 0;
    for (const Triangle& t : mesh.triangles) {
        const Float3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
        const double area =
            ((double(b.x) - a.x) * (double(c.y) - a.y) - (double(c.x) - a.x) * (double(b.y) - a.y)) / 2;
        sum += area;
        absolute += std::abs(area);
    }
    return {sum, absolute};
}

double shoelace(const std::vector<Float3>& p) {
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Float3 a = p[i], b = p[(i + 1) % p.size()];
        sum += double(a.x) * b.y - double(b.x) * a.y;
    }
    return sum / 2;
}

}  // namespace

TEST_CASE("Polygons of any outline become triangles that tile them") {
    std::vector<std::vector<Float3>> outlines = {
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
        {{0, 0, 0}, {2, 0, 0}, {0.2f, 0.2f, 0}, {0, 2, 0}},  // dart
        {{0.2f, 0.2f, 0}, {0, 2, 0}, {0, 0, 0}, {2, 0, 0}},  // the same, turned
        {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2, 3, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}},  // U
        {{0, 0, 0},
         {1, 0, 0},
         {2, 0, 0},
         {2, 1, 0},
         {2, 2, 0},
         {1, 2, 0},
         {0, 2, 0},
         {0, 1, 0}},  // collinear
                      // corners
        {{0, 0, 0},
         {4, 0, 0},
         {4, 4, 0},
         {0, 4, 0},
         {0, 0, 0},
         {1, 1, 0},
         {1, 3, 0},
         {3, 3, 0},
         {3, 1, 0},
         {1, 1, 0}},  // a bridged hole
    };
    std::vector<Float3> gear, spiral;
    for (int i = 0; i < 1200; ++i) {
        const double r = i % 6 < 3 ? 1 : 0.8, a = 2 * 3.14159265358979 * i / 1200;
        gear.push_back({float(r * std::cos(a)), float(r * std::sin(a)), 0});
    }
    for (int i = 0; i < 400; ++i)
        spiral.push_back(
            {float((1 + 0.02 * i) * std::cos(i * 0.1)), float((1 + 0.02 * i) * std::sin(i * 0.1)), 0});
    for (int i = 399; i >= 0; --i)
        spiral.push_back(
            {float((1.4 + 0.02 * i) * std::cos(i * 0.1)), float((1.4 + 0.02 * i) * std::sin(i * 0.1)), 0});
    outlines.push_back(gear);
    outlines.push_back({spiral.rbegin(), spiral.rend()});
    for (const std::vector<Float3>& outline : outlines) {
        INFO(outline.size() << " corners");
        const auto file = assemble_mesh(polygon(outline), Weld::kNone, {});
        REQUIRE(file.ok());
        CHECK(file->mesh.triangles.size() == outline.size() - 2);
        CHECK(file->report.polygons_triangulated == 1);
        const auto [sum, absolute] = areas(file->mesh);
        CHECK(sum == Approx(shoelace(outline)).epsilon(1e-6));
        CHECK(absolute == Approx(sum).epsilon(1e-6));
        CHECK(survey_mesh(file->mesh).manifold());
    }
}

TEST_CASE("Polygons lie in any plane, and keep their side") {
    const std::vector<Float3> u = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2, 3, 0},
                                   {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
    const auto turned = [&](auto&& turn) {
        std::vector<Float3> outline;
        for (const Float3& p : u) outline.push_back(turn(p));
        const auto file = assemble_mesh(polygon(outline), Weld::kNone, {});
        REQUIRE(file.ok());
        return file->mesh.triangles;
    };
    const auto flat = turned([](Float3 p) { return p; });
    CHECK(turned([](Float3 p) { return Float3{0, p.x, p.y}; }) == flat);
    CHECK(turned([](Float3 p) { return Float3{p.y, 5, p.x}; }) == flat);
    // Seen from behind.
    CHECK(turned([](Float3 p) { return Float3{p.y, p.x, 0}; }).size() == 6);
    CHECK(turned([](Float3 p) { return Float3{p.x + 1e6f, p.y - 1e6f, p.x}; }).size() == 6);
}

TEST_CASE("A hostile polygon is finished in reasonable time") {
    std::vector<Float3> zigzag;
    for (int i = 0; i < 20000; ++i)
        zigzag.push_back({float(i * 7919 % 10007), float(i * 104729 % 10009), float(i % 3)});
    const auto file = assemble_mesh(polygon(zigzag), Weld::kNone, {});
    REQUIRE(file.ok());
    CHECK(file->mesh.triangles.size() == zigzag.size() - 2);
}

TEST_CASE("What is no triangle is dropped and counted, what is odd is kept") {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                    inf = std::numeric_limits<float>::infinity();
    const std::vector<Float3> p = {{0, 0, 0},   {1, 0, 0},   {0, 1, 0},     {1, 1, 0},
                                   {nan, 0, 0}, {0, inf, 0}, {0, -0.0f, 0}, {5, 5, 5}};
    const auto file = assemble_mesh(soup_of(p, {{0, 1, 2},
                                                {0, 1, 2},     // duplicate
                                                {2, 1, 0},     // reversed
                                                {0, 1, 1},     // names 1 twice
                                                {0, 1},        // no area
                                                {1, 3, 2, 4},  // two triangles with a NaN corner
                                                {0, 5, 1},
                                                {6, 1, 3},    // 6 is 0
                                                {0, 6, 3}}),  // becomes degenerate by welding
                                    Weld::kAll, {});
    REQUIRE(file.ok());
    CHECK(file->mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}, {2, 1, 0}, {0, 1, 3}});
    const MeshReport& r = file->report;
    CHECK(r.vertices_in == 8);
    CHECK(r.faces_in == 9);
    CHECK(r.faces_dropped_degenerate == 3);
    CHECK(r.faces_dropped_non_finite == 3);
    CHECK(r.vertices_welded == 1);
    CHECK(r.vertices_dropped_unused == 3);
    CHECK(r.polygons_triangulated == 1);
    CHECK(file->vertex_of == std::vector<std::uint32_t>{0, 1, 2, 3, MeshFile::kDropped, MeshFile::kDropped, 0,
                                                        MeshFile::kDropped});
    CHECK(survey_mesh(file->mesh).duplicate_triangles == 2);
}

TEST_CASE("Soups that do not fit together are refused") {
    CHECK(!assemble_mesh(soup_of({{0, 0, 0}}, {{0, 1, 2}}), Weld::kNone, {}).ok());
    CHECK(!assemble_mesh(soup_of({{0, 0, 0}}, {}), Weld::kNone, {}).ok());
    PolygonSoup soup = soup_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    soup.weights = {1};
    CHECK(!assemble_mesh(PolygonSoup(soup), Weld::kNone, {}).ok());
    soup.weights.clear();
    soup.face_starts = {0, 7, 3};
    CHECK(!assemble_mesh(PolygonSoup(soup), Weld::kNone, {}).ok());
    soup.face_starts.clear();
    CHECK(!assemble_mesh(PolygonSoup(soup), Weld::kNone, {}).ok());
}

TEST_CASE("Welding: nothing, along boundaries, or all") {
    // Two tetrahedra that touch in a point of two names, and a sheet cut along a seam.
    const Mesh tetrahedron = make_sphere(3, 2);
    const Mesh touching = join(tetrahedron, tetrahedron, {0, 0, 2});  // The one's top is the other's bottom.
    const Mesh grid = make_grid(4);
    const Mesh sheets = join(grid, grid, {1, 0, 0});
    const auto welded = [](const Mesh& mesh, Weld weld) {
        PolygonSoup soup;
        soup.positions = mesh.positions;
        for (const Triangle& t : mesh.triangles) {
            soup.corners.insert(soup.corners.end(), t.begin(), t.end());
            soup.face_starts.push_back(soup.corners.size());
        }
        auto file = assemble_mesh(std::move(soup), weld, {});
        REQUIRE(file.ok());
        CHECK(file->mesh.triangles.size() == mesh.triangles.size());
        return file->report.vertices_welded;
    };
    CHECK(welded(touching, Weld::kNone) == 0);
    CHECK(welded(touching, Weld::kBoundary) == 0);
    CHECK(welded(touching, Weld::kAuto) == 0);
    CHECK(welded(touching, Weld::kAll) == 1);
    CHECK(welded(sheets, Weld::kNone) == 0);
    CHECK(welded(sheets, Weld::kBoundary) == 5);
    CHECK(welded(sheets, Weld::kAll) == 5);
}

TEST_CASE("Surveys of shapes that are known") {
    const MeshSurvey sphere = survey_mesh(make_sphere(24, 16));
    CHECK(sphere.vertices == 2 + 24 * 15);
    CHECK(sphere.triangles == 2 * 24 * 15);
    CHECK((sphere.closed() && sphere.manifold() && sphere.components == 1));
    const MeshSurvey torus = survey_mesh(make_torus(30, 14));
    CHECK((torus.closed() && torus.manifold() && 2 * torus.vertices == torus.triangles));
    const MeshSurvey grid = survey_mesh(make_grid(15));
    CHECK((grid.boundary_edges == 60 && grid.manifold() && !grid.closed() && grid.components == 1));
    const MeshSurvey empty = survey_mesh({});
    CHECK((empty.triangles == 0 && empty.components == 0 && !empty.closed()));

    for (const auto& [name, mesh] : mesh_family()) {
        INFO(name);
        const MeshSurvey s = survey_mesh(mesh);
        if (name == "many components") CHECK(s.components == 24);
        if (name == "single triangle") CHECK((s.boundary_edges == 3 && s.manifold()));
        if (name == "non-manifold") {
            CHECK(s.non_manifold_edges == 6);     // The book's spine.
            CHECK(s.non_manifold_vertices == 1);  // Where the tetrahedron hangs.
            CHECK(s.boundary_edges == 5 * 18);
            CHECK(s.components == 1);
            CHECK(!s.manifold());
        }
        if (name == "degenerate") {
            CHECK(s.duplicate_triangles == 2);
            CHECK(s.zero_area_triangles == 17);  // A row of 16 and the two at a doubled corner, of which one.
        }
    }
    // One face turned round: its three edges run the wrong way.
    Mesh turned = make_sphere(8, 6);
    std::swap(turned.triangles[20][0], turned.triangles[20][1]);
    CHECK(survey_mesh(turned).misoriented_edges == 3);
    CHECK(!survey_mesh(turned).manifold());
}
