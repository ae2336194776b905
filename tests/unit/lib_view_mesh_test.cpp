// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// View-dependent refinement: whatever the cameras saw, every triangle is one of a uniform level's, and both
// ends are the base mesh and the full one, byte for byte.
#include "mesh_checks.hpp"
#include "view_checks.hpp"

using namespace vsplit;
using namespace vsplit::test;

TEST_CASE("view: every triangle that a camera meets is one of a uniform level") {
    for (const auto& [name, record] : samples()) {
        INFO(name);
        const std::set<Drawn> all = all_levels(record);
        auto mesh = ViewMesh::make(record);
        REQUIRE(mesh.ok());
        RandomView cameras{std::mt19937(3), {}};
        std::mt19937 random(8);
        for (int frame = 0; frame < 60; ++frame) {
            const View view = cameras.next(extent(record));
            ViewBudget budget;
            if (frame % 3) budget.max_splits = random() % 40;
            if (frame % 4 == 1) budget.max_visits = random() % 100;
            const ViewUpdated done = mesh->update(view, budget);
            REQUIRE(done.refined + done.coarsened <= budget.max_splits);
            REQUIRE(done.visits <= budget.max_visits);
            const std::vector<Drawn> now = of_view(*mesh);
            REQUIRE(std::adjacent_find(now.begin(), now.end(), [](const Drawn& a, const Drawn& b) {
                        return a[0] == b[0];
                    }) == now.end());
            REQUIRE(std::all_of(now.begin(), now.end(), [&](const Drawn& d) { return all.contains(d); }));
        }
    }
}

TEST_CASE("view: everything wanted is the uniform level, nothing wanted the base mesh") {
    for (const auto& [name, record] : samples()) {
        INFO(name);
        auto mesh = ViewMesh::make(record);
        REQUIRE(mesh.ok());
        RandomView cameras{std::mt19937(11), {}};
        for (int round = 0; round < 3; ++round) {
            for (int frame = 0; frame < 5; ++frame) mesh->update(cameras.next(extent(record)));
            settle(*mesh, everything());
            REQUIRE(mesh->active_splits() == record.splits.size());
            REQUIRE(mesh->active_vertices() == record.positions.size());
            REQUIRE(of_view(*mesh) == of_level(record, record.splits.size()));
            const Mesh full = cut(record, record.splits.size());
            REQUIRE(mesh->attributes() == full.attributes);
            REQUIRE(std::equal(mesh->weights().begin(), mesh->weights().end(), full.weights.begin(),
                               full.weights.end()));
            View none;
            none.planes = kNothing;
            settle(*mesh, none);
            REQUIRE(mesh->active_splits() == 0);
            REQUIRE(of_view(*mesh) == of_level(record, 0));
            REQUIRE(
                (record.positions.empty() || std::memcmp(mesh->positions().data(), record.positions.data(),
                                                         record.positions.size() * sizeof(Float3)) == 0));
            REQUIRE(mesh->attributes() == record.attributes);
        }
    }
}

TEST_CASE("view: a prefix of the splits gives the level that it ends at") {
    const ProgressiveMesh record = test::naive_record(test::make_torus(16, 12), 2);
    for (const std::size_t level : {std::size_t{1}, record.splits.size() / 3, record.splits.size() - 1}) {
        ProgressiveMesh part = record;
        part.splits.resize(level);
        const Split& end = part.splits.back();
        part.positions.resize(end.vertices_end);
        part.parents.resize(end.vertices_end);
        part.triangles.resize(end.triangles_end);
        part.corner_changes.resize(end.corners_end);
        part.moves.resize(end.moves_end);
        auto mesh = ViewMesh::make(part);
        REQUIRE(mesh.ok());
        settle(*mesh, everything());
        REQUIRE(of_view(*mesh) == of_level(record, level));
    }
}

TEST_CASE("view: dirty ranges carry a copy along") {
    const ProgressiveMesh record = test::naive_record(test::make_torus(40, 30), 6);
    auto mesh = ViewMesh::make(record);
    REQUIRE(mesh.ok());
    std::vector<Triangle> triangles(record.triangles.size());
    std::vector<Float3> places(record.positions.size());
    RandomView cameras{std::mt19937(21), {}};
    for (int frame = 0; frame < 40; ++frame) {
        ViewBudget budget;
        budget.max_splits = 50;
        mesh->update(cameras.next(1.4f), budget);
        const ViewMesh::Dirty dirty = mesh->take_dirty();
        std::size_t sent = 0;
        for (const auto& [begin, end] : dirty.triangles) {
            REQUIRE(begin < end);
            REQUIRE(end <= mesh->triangles().size());
            std::copy(mesh->triangles().begin() + begin, mesh->triangles().begin() + end,
                      triangles.begin() + begin);
            sent += end - begin;
        }
        for (const auto& [begin, end] : dirty.vertices)
            std::copy(mesh->positions().begin() + begin, mesh->positions().begin() + end,
                      places.begin() + begin);
        REQUIRE(std::equal(mesh->triangles().begin(), mesh->triangles().end(), triangles.begin()));
        REQUIRE((places.empty() ||
                 std::memcmp(places.data(), mesh->positions().data(), places.size() * sizeof(Float3)) == 0));
        REQUIRE(mesh->take_dirty().triangles.empty());
        REQUIRE(sent <= mesh->triangles().size());
    }
}

TEST_CASE("view: only what is in the frustum is refined") {
    const ProgressiveMesh record = test::naive_record(test::make_grid(48), 4);
    auto mesh = ViewMesh::make(record);
    REQUIRE(mesh.ok());
    const ViewPlane right[] = {{1, 0, 0, -0.9f}};  // x >= 0.9
    View view = everything();
    view.planes = right;
    settle(*mesh, view);
    // Whatever reaches into it is there as in the full mesh.
    const std::vector<Drawn> full = of_level(record, record.splits.size()), now = of_view(*mesh);
    const Mesh all = cut(record, record.splits.size());
    const auto inside = [&](const Drawn& d) {
        return all.positions[d[1]].x > 0.9f && all.positions[d[2]].x > 0.9f && all.positions[d[3]].x > 0.9f;
    };
    std::size_t found = 0;
    for (const Drawn& d : full)
        if (inside(d)) {
            REQUIRE(std::binary_search(now.begin(), now.end(), d));
            ++found;
        }
    REQUIRE(found > 0);
    REQUIRE(now.size() < full.size());
}
