// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// ViewMesh: splits that arrive later, and the order in which priorities want them.
#include "view_checks.hpp"

using namespace vsplit;
using namespace vsplit::test;

namespace {

ProgressiveMesh prefix(const ProgressiveMesh& record, std::size_t level) {
    ProgressiveMesh part = record;
    part.splits.resize(level);
    const Split end =
        level == 0 ? Split{record.base_vertices, record.base_triangles, 0, 0, 0} : part.splits.back();
    part.positions.resize(end.vertices_end);
    part.parents.resize(end.vertices_end);
    if (!part.weights.empty()) part.weights.resize(end.vertices_end);
    part.triangles.resize(end.triangles_end);
    if (!part.groups.empty()) part.groups.resize(end.triangles_end);
    part.corner_changes.resize(end.corners_end);
    part.moves.resize(end.moves_end);
    for (std::size_t i = 0; i < part.attributes.size(); ++i) {
        part.attributes[i].values.resize(std::size_t{part.attributes[i].components} * end.vertices_end);
        part.moved_values[i].resize(std::size_t{part.attributes[i].components} * end.moves_end);
    }
    return part;
}

ViewRoom room_of(const ProgressiveMesh& record) {
    return {std::uint32_t(record.positions.size()), std::uint32_t(record.triangles.size()),
            std::uint32_t(record.splits.size()), std::uint32_t(record.corner_changes.size()),
            std::uint32_t(record.moves.size())};
}

/// All that a renderer reads.
struct Bytes {
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> groups;
    std::vector<float> places, weights;
    std::vector<Attribute> attributes;
    friend bool operator==(const Bytes&, const Bytes&) = default;
};
Bytes bytes_of(const ViewMesh& mesh) {
    Bytes out{{mesh.triangles().begin(), mesh.triangles().end()},
              {mesh.groups().begin(), mesh.groups().end()},
              {},
              {mesh.weights().begin(), mesh.weights().end()},
              mesh.attributes()};
    for (const Float3& p : mesh.positions()) out.places.insert(out.places.end(), {p.x, p.y, p.z});
    return out;
}

void check_groups(const ViewMesh& mesh, const ProgressiveMesh& record) {
    REQUIRE(mesh.groups().size() == (record.groups.empty() ? 0 : mesh.triangles().size()));
    for (std::size_t i = 0; i < mesh.groups().size(); ++i)
        REQUIRE(mesh.groups()[i] == record.groups[mesh.triangle_number(i)]);
}

std::vector<float> half_marked(const ProgressiveMesh& record, float high, float low = 1) {
    std::vector<float> out;
    for (const Float3& p : record.positions) out.push_back(p.x > 0 ? high : low);
    return out;
}

}  // namespace

TEST_CASE("view: a mesh that grows is the one that was there at once") {
    for (const auto& [name, record] : samples()) {
        INFO(name);
        const std::set<Drawn> all = all_levels(record);
        std::mt19937 random(5);
        RandomView cameras{std::mt19937(6), {}};
        const std::size_t splits = record.positions.empty() ? 0 : record.splits.size();
        std::size_t known = splits / 7;
        auto mesh = ViewMesh::make(prefix(record, known), room_of(record));
        REQUIRE(mesh.ok());
        const auto* places = mesh->positions().data();
        const auto* triangles = mesh->triangles().data();
        while (known < splits) {
            known = std::min(splits, known + 1 + random() % (1 + splits / 5));
            for (int frame = 0; frame < 3; ++frame) {
                ViewBudget budget;
                if (random() % 2) budget.max_splits = random() % 30;
                mesh->update(cameras.next(extent(record)), budget);
            }
            REQUIRE(mesh->append(prefix(record, known)).ok());
            REQUIRE(mesh->available() == known);
            const std::vector<Drawn> now = of_view(*mesh);
            REQUIRE(std::all_of(now.begin(), now.end(), [&](const Drawn& d) { return all.contains(d); }));
            check_groups(*mesh, record);
        }
        REQUIRE(mesh->positions().data() == places);
        REQUIRE(mesh->triangles().data() == triangles);
        auto whole = ViewMesh::make(record);
        REQUIRE(whole.ok());
        View none;
        none.planes = kNothing;
        for (int round = 0; round < 8; ++round) {
            settle(*mesh, none);
            settle(*whole, none);
            const View view = cameras.next(extent(record));
            settle(*mesh, view);
            settle(*whole, view);
            REQUIRE(of_view(*mesh) == of_view(*whole));
        }
        settle(*mesh, everything());
        REQUIRE(of_view(*mesh) == of_level(record, splits));
        settle(*mesh, none);
        REQUIRE(of_view(*mesh) == of_level(record, 0));
        REQUIRE(mesh->attributes() == record.attributes);
    }
}

TEST_CASE("view: dirty ranges carry a copy along while the mesh grows") {
    const ProgressiveMesh record = decorated(naive_record(make_torus(24, 20), 6), 4);
    auto mesh = ViewMesh::make(prefix(record, 0), room_of(record));
    REQUIRE(mesh.ok());
    std::vector<Triangle> triangles(record.triangles.size());
    std::vector<Float3> places(record.positions.size());
    RandomView cameras{std::mt19937(4), {}};
    for (std::size_t known = 0; known <= record.splits.size(); known += 37) {
        REQUIRE(mesh->append(prefix(record, known)).ok());
        mesh->update(cameras.next(1.4f), {.max_splits = 60});
        const ViewMesh::Dirty dirty = mesh->take_dirty();
        for (const auto& [begin, end] : dirty.triangles)
            std::copy(mesh->triangles().begin() + begin, mesh->triangles().begin() + end,
                      triangles.begin() + begin);
        for (const auto& [begin, end] : dirty.vertices) {
            REQUIRE(end <= mesh->positions().size());
            std::copy(mesh->positions().begin() + begin, mesh->positions().begin() + end,
                      places.begin() + begin);
        }
        REQUIRE(std::equal(mesh->triangles().begin(), mesh->triangles().end(), triangles.begin()));
        REQUIRE(std::equal(mesh->positions().begin(), mesh->positions().end(), places.begin()));
    }
}

TEST_CASE("view: more splits than there is room for are refused") {
    const ProgressiveMesh record = naive_record(make_torus(10, 8), 3);
    auto mesh = ViewMesh::make(prefix(record, 5));
    REQUIRE(mesh.ok());
    CHECK(mesh->append(prefix(record, 5)).ok());
    const Status refused = mesh->append(record);
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().code == ErrorCode::kArgument);
}

TEST_CASE("priority: all alike, ranks are the levels of the file") {
    for (const auto& [name, record] : samples()) {
        INFO(name);
        auto mesh = ViewMesh::make(record);
        REQUIRE(mesh.ok());
        mesh->rank();
        const std::size_t splits = mesh->ranked();
        REQUIRE(splits == (record.positions.empty() ? 0 : record.splits.size()));
        for (const std::size_t level : {splits / 3, splits, std::size_t{0}, splits / 2, splits / 5}) {
            REQUIRE(mesh->refine_to(level).settled);
            REQUIRE(of_view(*mesh) == of_level(record, level));
            if (splits > 0)
                REQUIRE(mesh->rank_for_triangles(triangles_at(record, level)) ==
                        level_for_triangles(record, triangles_at(record, level)));
        }
    }
}

TEST_CASE("priority: every rank is a mesh of triangles of the levels, forward and back restores every byte") {
    for (const auto& [name, record] : samples()) {
        if (record.positions.empty()) continue;
        INFO(name);
        const std::set<Drawn> all = all_levels(record);
        auto mesh = ViewMesh::make(record);
        REQUIRE(mesh.ok());
        std::mt19937 random(12);
        std::vector<float> priority(record.positions.size());
        for (float& p : priority) p = float(random() % 4) * float(random() % 3);
        REQUIRE(mesh->set_priority(priority).ok());
        mesh->rank();
        const std::size_t splits = record.splits.size(), step = 1 + splits / 9;
        std::vector<Bytes> seen;
        for (std::size_t rank = 0; rank <= splits; rank += step) {
            REQUIRE(mesh->refine_to(rank).settled);
            REQUIRE(mesh->active_splits() == rank);
            seen.push_back(bytes_of(*mesh));
            const std::vector<Drawn> now = of_view(*mesh);
            REQUIRE(std::all_of(now.begin(), now.end(), [&](const Drawn& d) { return all.contains(d); }));
            REQUIRE(mesh->rank_for_triangles(mesh->triangles().size()) >= rank);
            REQUIRE(mesh->rank_for_vertices(mesh->active_vertices()) >= rank);
            if (rank > 0) REQUIRE(mesh->error_at_rank(rank) <= mesh->error_at_rank(rank - 1));
            check_groups(*mesh, record);
        }
        REQUIRE(mesh->refine_to(splits).settled);
        REQUIRE(of_view(*mesh) == of_level(record, splits));
        for (std::size_t i = seen.size(); i-- > 0;) {
            REQUIRE(mesh->refine_to(i * step).settled);
            REQUIRE((bytes_of(*mesh) == seen[i]));
        }
    }
}

TEST_CASE("priority: from anything a view left, within any budget, to the same set of splits") {
    for (const auto& [name, record] : samples()) {
        if (record.positions.empty()) continue;
        INFO(name);
        std::mt19937 random(13);
        RandomView cameras{std::mt19937(14), {}};
        std::size_t known = record.splits.size() / 2;
        auto mesh = ViewMesh::make(prefix(record, known), room_of(record));
        auto judge = ViewMesh::make(record);
        REQUIRE((mesh.ok() && judge.ok()));
        const std::vector<float> all = half_marked(record, 3, 0.25f);
        std::vector<float> some = all;
        some.resize(mesh->positions().size());
        REQUIRE(mesh->set_priority(some).ok());
        // What came later takes its parent's.
        std::vector<float> inherited = some;
        inherited.resize(record.positions.size(), 1);
        for (std::size_t v = some.size(); v < inherited.size(); ++v)
            if (record.parents[v] != kNoVertex) inherited[v] = inherited[record.parents[v]];
        REQUIRE(judge->set_priority(inherited).ok());
        judge->rank();
        mesh->rank();
        const auto walk = [&](std::size_t rank) {
            for (int call = 0; call < 100'000; ++call) {
                const ViewUpdated done =
                    mesh->refine_to(rank, {.max_splits = random() % 50, .max_visits = random() % 200});
                REQUIRE(done.refined + done.coarsened <= 50);
                REQUIRE(done.visits <= 200);
                if (done.settled) return;
            }
            FAIL("does not get there");
        };
        walk(mesh->ranked() / 2);
        REQUIRE(mesh->append(record).ok());
        mesh->update(cameras.next(extent(record)));  // may apply splits that have no rank yet
        walk(mesh->ranked() / 3);
        REQUIRE(mesh->active_splits() == mesh->ranked() / 3);
        mesh->rank();
        for (int round = 0; round < 5; ++round) {
            mesh->update(cameras.next(extent(record)));
            const std::size_t rank = random() % (record.splits.size() + 1);
            walk(rank);
            REQUIRE(judge->refine_to(rank).settled);
            REQUIRE(of_view(*mesh) == of_view(*judge));
        }
    }
}

TEST_CASE("priority: a marked region gets more of a triangle budget, in ranks and before a camera") {
    const ProgressiveMesh record = naive_record(make_sphere(40, 30), 4);
    const auto marked = [](const ViewMesh& mesh) {
        return std::count_if(mesh.triangles().begin(), mesh.triangles().end(), [&](const Triangle& t) {
            return mesh.positions()[t[0]].x > 0 && mesh.positions()[t[1]].x > 0 &&
                   mesh.positions()[t[2]].x > 0;
        });
    };
    auto plain = ViewMesh::make(record), painted = ViewMesh::make(record);
    REQUIRE((plain.ok() && painted.ok()));
    CHECK(plain->largest_priority() == 1.0f);
    REQUIRE(painted->set_priority(half_marked(record, 1000, 0.001f)).ok());
    CHECK(painted->largest_priority() == 1000.0f);
    const std::size_t budget = record.triangles.size() / 2;
    for (ViewMesh* mesh : {&*plain, &*painted}) {
        mesh->rank();
        REQUIRE(mesh->refine_to(mesh->rank_for_triangles(budget)).settled);
        REQUIRE(mesh->triangles().size() <= budget);
        REQUIRE(mesh->triangles().size() + 4 > budget);
    }
    // The splits of this record wait for ones all over the sphere; collapse_view_test.cpp has a baker's.
    CHECK(marked(*painted) > marked(*plain));

    View view;
    view.eye = {0, 0, 6};
    view.pixels_at_distance_1 = 500;
    view.pixels = 20;
    view.facing = 1;
    settle(*painted, view);
    const auto with = double(marked(*painted)) / double(painted->triangles().size());
    REQUIRE(painted->set_priority({}).ok());
    CHECK(painted->largest_priority() == 1.0f);
    settle(*painted, view);
    CHECK(with > double(marked(*painted)) / double(painted->triangles().size()));
}

TEST_CASE("priority: the file's painted weights are those at birth, whatever is applied") {
    Mesh torus = make_torus(16, 12);
    torus.weights = some_weights(torus.positions.size());
    const ProgressiveMesh record = decorated(naive_record(torus, 9), 4);
    REQUIRE_FALSE(record.weights.empty());
    auto mesh = ViewMesh::make(prefix(record, record.splits.size() / 2), room_of(record));
    auto judge = ViewMesh::make(record);
    REQUIRE((mesh.ok() && judge.ok()));
    settle(*mesh, everything());
    mesh->use_weights();
    REQUIRE(mesh->append(record).ok());
    REQUIRE(judge->set_priority(record.weights).ok());
    CHECK(mesh->largest_priority() == judge->largest_priority());
    mesh->rank();
    judge->rank();
    REQUIRE(mesh->ranked() == judge->ranked());
    for (const std::size_t rank : {mesh->ranked() / 4, mesh->ranked() / 2}) {
        REQUIRE(mesh->refine_to(rank).settled);
        REQUIRE(judge->refine_to(rank).settled);
        REQUIRE(of_view(*mesh) == of_view(*judge));
    }
}

TEST_CASE("priority: weights of a mesh that has none are all alike") {
    const ProgressiveMesh record = decorated(naive_record(make_torus(16, 12), 9), 4);
    REQUIRE((record.weights.empty() && !record.moves.empty()));
    auto mesh = ViewMesh::make(prefix(record, record.splits.size() / 2), room_of(record));
    REQUIRE(mesh.ok());
    settle(*mesh, everything());
    mesh->use_weights();
    REQUIRE(mesh->append(record).ok());
    settle(*mesh, everything());
    mesh->use_weights();
    CHECK(mesh->largest_priority() == 1.0f);
    mesh->rank();
    for (const std::size_t rank : {record.splits.size(), record.splits.size() / 3}) {
        REQUIRE(mesh->refine_to(rank).settled);
        CHECK(of_view(*mesh) == of_level(record, rank));
    }
}

TEST_CASE("priority: what is no priority is refused") {
    const ProgressiveMesh record = naive_record(make_torus(10, 8), 3);
    auto mesh = ViewMesh::make(record);
    REQUIRE(mesh.ok());
    const float inf = std::numeric_limits<float>::infinity();
    for (const float wrong : {-1.0f, inf, std::nanf("")})
        CHECK_FALSE(mesh->set_priority(std::vector<float>{1, wrong}).ok());
    CHECK_FALSE(mesh->set_priority(std::vector<float>(record.positions.size() + 1, 1)).ok());
    CHECK(mesh->set_priority(std::vector<float>{0.0f, -0.0f, 1e30f}).ok());
    mesh->rank();
    CHECK(mesh->refine_to(mesh->ranked()).settled);
    CHECK(of_view(*mesh) == of_level(record, record.splits.size()));
}
