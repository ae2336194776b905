// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// View-dependent refinement of what the baker makes: closed, of the same kind, and folded nowhere, whatever
// the camera sees.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "family.hpp"
#include "mesh_checks.hpp"
#include "vsplit/bake/collapse.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/view_mesh.hpp"

using namespace vsplit;
using namespace vsplit::test;

namespace {

/// The triangles drawn and the vertices that they name.
Mesh compact(const ViewMesh& view) {
    Mesh mesh;
    std::vector<std::uint32_t> number(view.positions().size(), kNoVertex);
    for (const Triangle& t : view.triangles()) {
        Triangle named{};
        for (std::size_t i = 0; i < 3; ++i) {
            if (number[t[i]] == kNoVertex) {
                number[t[i]] = std::uint32_t(mesh.positions.size());
                mesh.positions.push_back(view.positions()[t[i]]);
            }
            named[i] = number[t[i]];
        }
        mesh.triangles.push_back(named);
    }
    return mesh;
}

}  // namespace

TEST_CASE("view: closed meshes stay closed and unfolded under a moving camera") {
    for (const bake::Placement placement : {bake::Placement::kEndpoint, bake::Placement::kOptimal}) {
        const Mesh input = make_torus(48, 32);
        bake::CollapseOptions options;
        options.placement = placement;
        const auto record = bake::collapse(input, options);
        REQUIRE(record.ok());
        const Topology full = topology(input);
        const std::size_t folds = folded_edges(cut(record->mesh, 0));
        auto mesh = ViewMesh::make(record->mesh);
        REQUIRE(mesh.ok());
        std::size_t partial = 0;
        for (int frame = 0; frame < 40; ++frame) {
            const float angle = 0.3f * float(frame);
            View view;
            view.eye = {2.2f * std::cos(angle), 2.2f * std::sin(angle), 0.6f};
            view.pixels = 0.4f + 0.3f * float(frame % 5);
            // What lies before the camera, a quarter turn wide.
            const float c = std::cos(angle), s = std::sin(angle);
            const ViewPlane planes[] = {{c, s, 0, 0}};
            if (frame % 2) view.planes = planes;
            ViewBudget budget;
            if (frame % 3 == 0) budget.max_splits = 100;
            mesh->update(view, budget);
            const Mesh now = compact(*mesh);
            const Topology topo = topology(now);
            REQUIRE(topo.manifold());
            REQUIRE(topo.boundary_edges == 0);
            REQUIRE(topo.parts == full.parts);
            REQUIRE(folded_edges(now) <= folds);
            partial += mesh->active_splits() > 0 && mesh->active_splits() < record->mesh.splits.size();
        }
        REQUIRE(partial > 30);
    }
}

TEST_CASE("view: the painted half gets most of a triangle budget, closed and unfolded") {
    const Mesh input = make_torus(64, 48);
    const auto record = bake::collapse(input, {});
    REQUIRE(record.ok());
    const Topology full = topology(input);
    const std::size_t folds = folded_edges(cut(record->mesh, 0));
    const auto painted = [](const ViewMesh& mesh) {
        return std::size_t(
            std::count_if(mesh.triangles().begin(), mesh.triangles().end(), [&](const Triangle& t) {
                return mesh.positions()[t[0]].x > 0 && mesh.positions()[t[1]].x > 0 &&
                       mesh.positions()[t[2]].x > 0;
            }));
    };
    auto plain = ViewMesh::make(record->mesh), marked = ViewMesh::make(record->mesh);
    REQUIRE((plain.ok() && marked.ok()));
    std::vector<float> priority;
    for (const Float3& p : record->mesh.positions) priority.push_back(p.x > 0 ? 1000.0f : 1.0f);
    REQUIRE(marked->set_priority(priority).ok());
    const std::size_t budget = input.triangles.size() / 2;
    for (ViewMesh* mesh : {&*plain, &*marked}) {
        mesh->rank();
        REQUIRE(mesh->refine_to(mesh->rank_for_triangles(budget)).settled);
        REQUIRE(mesh->triangles().size() <= budget);
        REQUIRE(mesh->triangles().size() + 2 >= budget);
        const Mesh now = compact(*mesh);
        const Topology topo = topology(now);
        REQUIRE(topo.manifold());
        REQUIRE(topo.boundary_edges == 0);
        REQUIRE(topo.parts == full.parts);
        REQUIRE(folded_edges(now) <= folds);
    }
    // Not all of it: splits wait for some in the other half.
    CHECK(double(painted(*marked)) > 1.25 * double(painted(*plain)));
    CHECK(double(painted(*marked)) > 0.6 * double(budget));
}
