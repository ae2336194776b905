// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// LiveBuffers against LiveMesh, byte by byte, and what a GPU would hold that is sent the dirty ranges alone.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <string>

#include "decorated.hpp"
#include "family.hpp"
#include "naive_record.hpp"
#include "vsplit/live_buffers.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/read.hpp"
#include "vsplit/write.hpp"

using namespace vsplit;
using test::decorated;
using test::naive_record;

namespace {

template <class T>
bool same(std::span<const T> a, std::span<const T> b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

template <class T>
std::span<const T> of(const std::vector<T>& v) {
    return v;
}

bool same(const LiveBuffers& live, const LiveMesh& judge) {
    const ProgressiveMesh& state = judge.state();
    bool equal = live.vertex_count() == judge.positions().size() &&
                 live.triangle_count() == judge.triangles().size() &&
                 same(live.positions(), judge.positions()) && same(live.triangles(), judge.triangles()) &&
                 same(live.weights(), judge.weights()) &&
                 same(live.parents(), of(state.parents).first(live.vertex_count())) &&
                 live.attribute_count() == state.attributes.size();
    for (std::size_t i = 0; equal && i < state.attributes.size(); ++i)
        equal =
            same(live.attribute(i),
                 of(state.attributes[i].values).first(state.attributes[i].components * live.vertex_count()));
    return equal && same(live.groups(), state.groups.empty() ? std::span<const std::uint32_t>{}
                                                             : of(state.groups).first(live.triangle_count()));
}

/// What BlockDecoder::mesh() holds after so many splits.
ProgressiveMesh prefix(const ProgressiveMesh& whole, std::size_t splits) {
    ProgressiveMesh mesh = whole;
    mesh.splits.resize(splits);
    const std::size_t vertices = vertices_at(mesh, splits), triangles = triangles_at(mesh, splits);
    const std::size_t moves = splits == 0 ? 0 : mesh.splits.back().moves_end;
    mesh.positions.resize(vertices);
    mesh.parents.resize(vertices);
    mesh.triangles.resize(triangles);
    if (!mesh.weights.empty()) mesh.weights.resize(vertices);
    if (!mesh.groups.empty()) mesh.groups.resize(triangles);
    mesh.corner_changes.resize(splits == 0 ? 0 : mesh.splits.back().corners_end);
    mesh.moves.resize(moves);
    for (std::size_t i = 0; i < mesh.attributes.size(); ++i) {
        mesh.attributes[i].values.resize(mesh.attributes[i].components * vertices);
        mesh.moved_values[i].resize(mesh.attributes[i].components * moves);
    }
    return mesh;
}

void begin(LiveBuffers& live, const ProgressiveMesh& front, const ProgressiveMesh& whole) {
    live.begin(front, std::uint32_t(whole.positions.size()), std::uint32_t(whole.triangles.size()),
               std::uint32_t(whole.splits.size()), std::uint32_t(whole.corner_changes.size()),
               std::uint32_t(whole.moves.size()));
}

/// Buffers that get nothing but the dirty ranges.
struct Gpu {
    std::vector<Float3> positions;
    std::vector<Triangle> triangles;
    std::vector<float> weights;
    std::vector<std::vector<float>> attributes;
    std::vector<std::uint32_t> groups;
    bool within = true;

    template <class T>
    static void send(std::vector<T>& to, std::span<const T> from, std::size_t begin, std::size_t end) {
        if (from.empty() || begin >= end) return;
        to.resize(std::max(to.size(), end));
        std::copy(from.begin() + std::ptrdiff_t(begin), from.begin() + std::ptrdiff_t(end),
                  to.begin() + std::ptrdiff_t(begin));
    }
    void update(LiveBuffers& live) { send_all(live, live.take_dirty()); }
    void update_by_runs(LiveBuffers& live) {
        std::vector<ElementRange> vertices, triangles;
        live.take_dirty_runs(vertices, triangles);
        for (auto* ranges : {&vertices, &triangles})
            for (std::size_t i = 0; i < ranges->size(); ++i)
                within = within && (*ranges)[i].begin < (*ranges)[i].end &&
                         (i == 0 || (*ranges)[i - 1].end < (*ranges)[i].begin);
        for (const ElementRange& r : vertices) send_all(live, {r.begin, r.end, 0, 0});
        for (const ElementRange& r : triangles) send_all(live, {0, 0, r.begin, r.end});
    }
    void send_all(const LiveBuffers& live, const DirtyRanges& d) {
        within = within && d.vertices_end <= live.vertex_count() && d.triangles_end <= live.triangle_count();
        if (!within) return;
        send(positions, live.positions(), d.vertices_begin, d.vertices_end);
        send(weights, live.weights(), d.vertices_begin, d.vertices_end);
        attributes.resize(live.attribute_count());
        for (std::size_t i = 0; i < attributes.size(); ++i) {
            const std::size_t n =
                live.vertex_count() == 0 ? 0 : live.attribute(i).size() / live.vertex_count();
            send(attributes[i], live.attribute(i), n * d.vertices_begin, n * d.vertices_end);
        }
        send(triangles, live.triangles(), d.triangles_begin, d.triangles_end);
        send(groups, live.groups(), d.triangles_begin, d.triangles_end);
    }
    template <class T>
    static bool holds(const std::vector<T>& gpu, std::span<const T> alive) {
        return gpu.size() >= alive.size() && same(std::span<const T>(gpu).first(alive.size()), alive);
    }
    bool holds(const LiveBuffers& live) const {
        bool all = within && holds(positions, live.positions()) && holds(triangles, live.triangles()) &&
                   holds(weights, live.weights()) && holds(groups, live.groups());
        for (std::size_t i = 0; i < attributes.size(); ++i)
            all = all && holds(attributes[i], live.attribute(i));
        return all;
    }
};

/// Wanders over the levels, alone and appended to in pieces.
void check(const ProgressiveMesh& mesh, std::uint32_t seed) {
    REQUIRE(progressive_mesh_fault(mesh) == nullptr);
    std::mt19937 random(seed);
    const std::size_t splits = mesh.splits.size();
    LiveMesh judge(mesh);
    LiveBuffers live;
    std::size_t known = splits == 0 ? 0 : random() % (splits + 1) / 4;
    live.track_runs(true);
    begin(live, prefix(mesh, known), mesh);
    REQUIRE(live.level() == 0);
    REQUIRE(live.available() == known);
    REQUIRE(live.triangle_count() == mesh.base_triangles);
    const auto* const positions = live.positions().data();
    const auto* const triangles = live.triangles().data();
    const std::size_t memory = live.memory();
    Gpu gpu, finer;
    const auto compare = [&] {
        judge.go_to(live.level());
        gpu.update(live);
        finer.update_by_runs(live);
        INFO("level " << live.level() << " of " << live.available());
        REQUIRE(same(live, judge));
        REQUIRE(gpu.holds(live));
        REQUIRE(finer.holds(live));
        REQUIRE(live.positions().data() == positions);
        REQUIRE(live.triangles().data() == triangles);
    };
    compare();
    for (int i = 0; i < 60; ++i) {
        if (i == 40 || (known < splits && random() % 3 == 0)) {
            known = i == 40 ? splits : known + random() % std::min<std::size_t>(splits - known + 1, 300);
            const std::size_t level = live.level();
            live.append(prefix(mesh, known));
            REQUIRE(live.available() == known);
            REQUIRE(live.level() == level);
            compare();
        }
        const std::size_t level = random() % (known + 1), step = random() % 9;
        switch (random() % 4) {
            case 0:
                live.refine(step);
                break;
            case 1:
                live.coarsen(step);
                break;
            default:
                live.jump(level);
                REQUIRE(live.level() == level);
        }
        if (random() % 4 != 0) compare();  // else dirty ranges add up
    }
    live.refine(splits + 7);
    REQUIRE(live.level() == splits);
    compare();
    live.coarsen(std::numeric_limits<std::size_t>::max());
    REQUIRE(live.level() == 0);
    compare();
    for (std::size_t k = 0; k < splits && k < 300; ++k) live.refine(1), compare();
    live.jump(0);
    compare();
    const DirtyRanges clean = live.take_dirty();
    CHECK(clean.vertices_begin >= clean.vertices_end);
    CHECK(clean.triangles_begin >= clean.triangles_end);
    // What takes splits is let go of when all are there: a number for each vertex.
    CHECK(live.memory() + 4 * mesh.positions.size() >= memory);
}

/// Counts and levels for them, of what is known, at any level.
void check_levels(const ProgressiveMesh& mesh, std::size_t known) {
    LiveBuffers live;
    const ProgressiveMesh part = prefix(mesh, known);
    begin(live, part, mesh);
    live.jump(known / 2);
    for (std::size_t level = 0; level <= known; ++level) {
        REQUIRE(live.vertices_at(level) == vertices_at(mesh, level));
        REQUIRE(live.triangles_at(level) == triangles_at(mesh, level));
        const float error = float(error_at(mesh, level));
        if (level < known || known == mesh.splits.size())
            REQUIRE(live.error_at(level) == error);
        else
            REQUIRE(live.error_at(level) >= error);
        for (const std::uint32_t off : {0u, 1u}) {
            REQUIRE(live.level_for_triangles(triangles_at(mesh, level) + off) ==
                    level_for_triangles(part, triangles_at(mesh, level) + off));
            REQUIRE(live.level_for_vertices(vertices_at(mesh, level) + off) ==
                    level_for_vertices(part, vertices_at(mesh, level) + off));
        }
        for (const double e : {double(error), 0.999 * double(error), 1.001 * double(error)})
            REQUIRE(live.level_for_error(e) == level_for_error(part, e));
    }
    CHECK(live.level_for_triangles(0) == level_for_triangles(part, 0));
    CHECK(live.level_for_vertices(std::uint64_t{1} << 40) == known);
}

}  // namespace

TEST_CASE("Live buffers equal the live mesh at every level visited") {
    std::uint32_t seed = 1;
    for (const test::NamedMesh& named : test::mesh_family()) {
        INFO(named.name);
        const ProgressiveMesh plain = naive_record(named.mesh, seed);
        check(plain, ++seed);
        check(decorated(plain, seed), seed + 100);
        const auto canonical = canonical_progressive_mesh(decorated(plain, seed), {});
        REQUIRE(canonical);
        check(*canonical, seed + 200);
    }
}

TEST_CASE("Live buffers: seams, returning components, larger meshes") {
    for (const bool moving : {false, true}) check(test::seam(moving), 5);
    check(test::returning(), 6);
    check(decorated(test::returning(), 7), 7);
    const ProgressiveMesh large = naive_record(test::make_torus(60, 40), 8);
    REQUIRE(large.splits.size() > 1000);
    check(large, 8);
    check(decorated(large, 9), 9);
    ProgressiveMesh weighted = large;
    weighted.weights = test::some_weights(weighted.positions.size());
    check(weighted, 10);
}

TEST_CASE("Dirty runs are a few elements where the hull is nearly all") {
    const ProgressiveMesh mesh = naive_record(test::make_torus(60, 40), 8);
    LiveBuffers live, plain;
    live.track_runs(true);
    begin(live, mesh, mesh);
    begin(plain, mesh, mesh);
    std::vector<ElementRange> vertices, triangles;
    live.jump(mesh.splits.size() - 8);
    live.take_dirty_runs(vertices, triangles);
    REQUIRE(vertices == std::vector<ElementRange>{{0, live.vertex_count()}});
    vertices.clear(), triangles.clear();
    live.refine(8);
    live.take_dirty_runs(vertices, triangles);
    std::size_t sent = 0;
    for (const ElementRange& range : triangles) sent += range.end - range.begin;
    CHECK(sent >= 16);  // two born a split
    CHECK(sent < 8 * 10 * DirtyRuns::kRun);
    CHECK(sent < live.triangle_count() / 2);
    vertices.clear(), triangles.clear();
    live.take_dirty_runs(vertices, triangles);
    CHECK(vertices.empty());
    CHECK(triangles.empty());
    plain.refine(8);
    plain.take_dirty_runs(vertices, triangles);
    CHECK(vertices.empty());
    CHECK(triangles.empty());
}

TEST_CASE("Live buffers: endpoint records, where nothing moves") {
    ProgressiveMesh still = naive_record(test::make_sphere(40, 30), 11);
    still.moves.clear();
    for (Split& split : still.splits) split.moves_end = 0;
    check(still, 11);
    LiveBuffers live;
    begin(live, still, still);
    live.take_dirty();
    live.refine(3);
    const DirtyRanges dirty = live.take_dirty();  // exact: only births
    CHECK(dirty.vertices_begin == vertices_at(still, 0));
    CHECK(dirty.vertices_end == vertices_at(still, 3));
    live.coarsen(3);
    CHECK(live.take_dirty().vertices_end == 0);
}

TEST_CASE("Live buffers: corners beyond three bytes") {
    // The width of a corner is chosen by the total announced.
    const ProgressiveMesh mesh = naive_record(test::make_torus(20, 12), 12);
    LiveBuffers live;
    live.begin(mesh, std::uint32_t(mesh.positions.size()), 6'000'000, std::uint32_t(mesh.splits.size()),
               std::uint32_t(mesh.corner_changes.size()), std::uint32_t(mesh.moves.size()));
    LiveMesh judge(mesh);
    for (const std::size_t level :
         {mesh.splits.size(), mesh.splits.size() / 3, mesh.splits.size() / 2, std::size_t{0}}) {
        live.jump(level);
        judge.go_to(level);
        REQUIRE(same(live, judge));
    }
}

TEST_CASE("Live buffers: counts, errors and levels for them") {
    const ProgressiveMesh mesh = naive_record(test::make_torus(30, 20), 13);
    REQUIRE(mesh.splits.size() > 300);
    for (const std::size_t known :
         {std::size_t{0}, std::size_t{1}, std::size_t{128}, std::size_t{200}, mesh.splits.size()})
        check_levels(mesh, known);
    check_levels(test::returning(), test::returning().splits.size());
    check_levels(test::seam(true), 1);
    LiveBuffers none;
    CHECK(none.available() == 0);
    CHECK(none.vertex_count() == 0);
    CHECK(none.vertices_at(5) == 0);
    CHECK(none.level_for_triangles(5) == 0);
    CHECK(none.level_for_error(0) == 0);
    none.jump(3);
    none.refine(1);
    none.coarsen(1);
    CHECK(none.triangles().empty());
    CHECK(none.take_dirty().vertices_end == 0);
}

TEST_CASE("Live buffers take nothing beyond the totals announced") {
    const ProgressiveMesh mesh = naive_record(test::make_torus(20, 12), 14);
    const std::size_t half = mesh.splits.size() / 2;
    LiveBuffers live;
    begin(live, prefix(mesh, half / 2), prefix(mesh, half));
    const auto* const positions = live.positions().data();
    live.append(mesh);
    CHECK(live.available() == half);
    live.refine(mesh.splits.size());
    CHECK(live.vertex_count() == vertices_at(mesh, half));
    CHECK(live.positions().data() == positions);
}

TEST_CASE("Places on a grid, and ones that leave it on the way, go forward and back byte by byte") {
    for (const std::uint32_t bits : {6u, 14u, 20u})
        for (const int odd : {0, 1, 2}) {
            INFO(bits << " bits, kind " << odd);
            const auto file = write_progressive_mesh(decorated(naive_record(test::make_sphere(30, 20), 5), 4),
                                                     {.position_bits = bits});
            REQUIRE(file.ok());
            ProgressiveMesh whole = *read_progressive_mesh(*file);
            const FileInfo info = *read_info(*file);
            REQUIRE(whole.moves.size() > 20);
            VertexMove& late = whole.moves[2 * whole.moves.size() / 3];
            if (odd == 1) late.position.y = std::nextafter(late.position.y, 10.0f);  // between the points
            if (odd == 2) late.position.x += float(40000 * info.lattice_step);       // on one, but far away
            PlaceGrid grid{info.lattice_origin, info.lattice_step};
            LiveBuffers live;
            LiveBuffers plain;
            const auto totals = [&](LiveBuffers& to, const PlaceGrid& of) {
                to.begin(prefix(whole, 0), std::uint32_t(whole.positions.size()),
                         std::uint32_t(whole.triangles.size()), std::uint32_t(whole.splits.size()),
                         std::uint32_t(whole.corner_changes.size()), std::uint32_t(whole.moves.size()), of);
            };
            totals(live, grid);
            totals(plain, {});
            LiveMesh judge(whole);
            std::mt19937 random(3);
            for (std::size_t known = 0; known < whole.splits.size();) {
                known = std::min(whole.splits.size(), known + 1 + random() % 60);
                live.append(prefix(whole, known));
                plain.append(prefix(whole, known));
                for (int i = 0; i < 3; ++i) {
                    const std::size_t level = random() % (known + 1);
                    live.jump(level);
                    judge.go_to(level);
                    REQUIRE(same(live, judge));
                }
            }
            for (const std::size_t level : {whole.splits.size(), std::size_t{0}, whole.splits.size() / 2}) {
                live.jump(level);
                judge.go_to(level);
                REQUIRE(same(live, judge));
            }
            if (odd != 0)
                CHECK(live.memory() + 64 > plain.memory());
            else if (bits < 20)
                CHECK(live.memory() < plain.memory());
        }
}
