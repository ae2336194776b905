// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A Stream that refines selectively while its bytes arrive: where a camera looks, or by priorities.
#include "pmesh_bytes.hpp"
#include "view_checks.hpp"
#include "vsplit/stream.hpp"
#include "vsplit/vsplit.h"
#include "vsplit/write.hpp"

using namespace vsplit;
using namespace vsplit::test;

namespace {

using File = std::vector<std::byte>;

File file_of(const ProgressiveMesh& record) {
    WriteOptions options;
    options.block_bytes = 1024;
    auto bytes = write_progressive_mesh(record, options);
    REQUIRE(bytes.ok());
    return *std::move(bytes);
}

ProgressiveMesh read(const File& bytes) {
    auto whole = read_progressive_mesh(bytes);
    REQUIRE(whole.ok());
    return *std::move(whole);
}

/// One small request and one bounded update; what came of it.
Updated step(Stream& stream, const File& bytes, const Budget& budget) {
    for (const ByteRange& range : stream.wants(600)) {
        REQUIRE(range.offset < bytes.size());
        REQUIRE(stream
                    .feed(range.offset,
                          std::span(bytes).subspan(
                              std::size_t(range.offset),
                              std::size_t(std::min<std::uint64_t>(range.size, bytes.size() - range.offset))))
                    .ok());
    }
    const auto updated = stream.update(budget);
    REQUIRE(updated.ok());
    REQUIRE(updated->splits <= budget.max_splits);
    return *updated;
}

void run(Stream& stream, const File& bytes, std::size_t most_splits = ~std::size_t{0}) {
    for (int call = 0; call < 100'000; ++call)
        if (step(stream, bytes, {.max_splits = most_splits}).reached) return;
    FAIL("the target is never reached");
}

CameraView from(Float3 eye, float pixels) {
    CameraView view;
    view.camera = {eye, 0.8, 1000};
    view.pixels = pixels;
    return view;
}

/// Projection times view of a camera at `eye` that looks along -z, as wide as high.
std::array<float, 16> clip(const Float3& eye, float fov) {
    const float f = 1 / std::tan(fov / 2), near = 0.01f, far = 1000;
    const float a = (far + near) / (near - far), b = 2 * far * near / (near - far);
    return {f, 0, 0, 0, 0, f, 0, 0, 0, 0, a, -1, -f * eye.x, -f * eye.y, -a * eye.z + b, eye.z};
}

std::vector<std::pair<std::string, ProgressiveMesh>> records() {
    std::vector<std::pair<std::string, ProgressiveMesh>> all;
    for (auto& [name, record] : samples())
        if (record.positions.size() > 0) all.emplace_back(name, std::move(record));
    return all;
}

}  // namespace

TEST_CASE("A selective stream draws triangles of the levels while bytes arrive, and ends in the full mesh") {
    for (const auto& [name, record] : records()) {
        INFO(name);
        const File bytes = file_of(record);
        const ProgressiveMesh whole = read(bytes);
        const std::set<Drawn> all = all_levels(whole);
        std::mt19937 random(3);
        Stream stream;
        REQUIRE(stream.set_selective(true).ok());
        CHECK(stream.selective() == nullptr);
        const float size = extent(whole);
        for (int frame = 0; frame < 60; ++frame) {
            const auto unit = [&] { return size * (float(random() % 201) / 50 - 2); };
            CameraView view = from({unit(), unit(), unit()}, 0.5f + float(random() % 30));
            if (frame % 3 == 0) view.to_clip = clip(view.camera.eye, 0.8f);
            if (frame % 7 == 6)
                stream.clear_view();
            else
                stream.set_view(view);
            stream.set_target(Target::ratio(double(random() % 100) / 100));
            step(stream, bytes, {.max_splits = random() % 60, .max_visits = 1 + random() % 300});
            REQUIRE((stream.selective() != nullptr) == stream.ready());
            if (!stream.ready()) continue;
            const std::vector<Drawn> now = of_view(*stream.selective());
            REQUIRE(std::all_of(now.begin(), now.end(), [&](const Drawn& d) { return all.contains(d); }));
            REQUIRE(stream.buffers().level() == 0);
        }
        // All in view and no error allowed: the full mesh.
        stream.set_view(from({0, 0, 3 * size}, 0));
        run(stream, bytes, 40);
        CHECK(stream.complete());
        CHECK(of_view(*stream.selective()) == of_level(whole, whole.splits.size()));
        const Mesh full = cut(whole, whole.splits.size());
        CHECK(stream.selective()->attributes() == full.attributes);
        CHECK(std::equal(full.weights.begin(), full.weights.end(), stream.selective()->weights().begin(),
                         stream.selective()->weights().end()));
        // And out of view the base mesh again, byte for byte.
        CameraView away = from({0, 0, 3 * size}, 1);
        away.to_clip = clip({0, 0, -1000 * size}, 0.8f);  // looks away from it
        stream.set_view(away);
        run(stream, bytes);
        CHECK(of_view(*stream.selective()) == of_level(whole, 0));
        CHECK(stream.selective()->attributes() == whole.attributes);
    }
}

TEST_CASE("A stream may become selective at any time, and go back") {
    for (const auto& [name, record] : records()) {
        INFO(name);
        const File bytes = file_of(record);
        const ProgressiveMesh whole = read(bytes);
        for (const double ratio : {0.0, 0.4, 1.0}) {
            Stream stream;
            stream.set_target(Target::ratio(ratio));
            run(stream, bytes);
            const std::size_t level = stream.buffers().level();
            stream.buffers().take_dirty();
            REQUIRE(stream.set_selective(true).ok());
            REQUIRE(stream.selective());
            CHECK(stream.buffers().level() == level);
            const DirtyRanges dirty = stream.buffers().take_dirty();
            CHECK(dirty.triangles_begin == dirty.triangles_end);
            // All priorities are alike: the same level, in the order that it has.
            run(stream, bytes, 30);
            CHECK(of_view(*stream.selective()) == of_level(whole, level));
            for (std::size_t i = 0; i < whole.attributes.size(); ++i) {
                CHECK(stream.selective()->attributes()[i].name == whole.attributes[i].name);
                CHECK(stream.selective()->attributes()[i].semantic == whole.attributes[i].semantic);
            }
            stream.set_view(from({0, 0, 3 * extent(whole)}, 0));
            run(stream, bytes);
            CHECK(of_view(*stream.selective()) == of_level(whole, whole.splits.size()));
            REQUIRE(stream.set_selective(false).ok());
            CHECK(stream.selective() == nullptr);
            run(stream, bytes);
            CHECK(stream.buffers().level() == level);
        }
    }
}

TEST_CASE("The record of live buffers is what was appended, at any level") {
    for (const auto& [name, record] : records()) {
        INFO(name);
        const File bytes = file_of(record);
        ProgressiveMesh whole = read(bytes);
        Stream stream;
        REQUIRE(stream.feed(0, bytes).ok());
        stream.set_target(Target::ratio(1));
        run(stream, bytes);
        stream.set_target(Target::ratio(0.5));
        run(stream, bytes);
        const Mesh before = cut(whole, stream.buffers().level());
        const ProgressiveMesh again = stream.buffers().record();
        CHECK(again.positions == whole.positions);
        CHECK(again.weights == whole.weights);
        CHECK(again.parents == whole.parents);
        CHECK(again.triangles == whole.triangles);
        CHECK(again.groups == whole.groups);
        CHECK(again.moved_values == whole.moved_values);
        REQUIRE(again.splits.size() == whole.splits.size());
        for (std::size_t k = 0; k < whole.splits.size(); ++k) {
            const Split &a = again.splits[k], &b = whole.splits[k];
            REQUIRE(std::tie(a.vertices_end, a.triangles_end, a.corners_end, a.moves_end, a.error) ==
                    std::tie(b.vertices_end, b.triangles_end, b.corners_end, b.moves_end, b.error));
        }
        REQUIRE(again.corner_changes.size() == whole.corner_changes.size());
        for (std::size_t i = 0; i < whole.corner_changes.size(); ++i)
            REQUIRE((again.corner_changes[i].corner == whole.corner_changes[i].corner &&
                     again.corner_changes[i].vertex == whole.corner_changes[i].vertex));
        REQUIRE(again.moves.size() == whole.moves.size());
        for (std::size_t i = 0; i < whole.moves.size(); ++i)
            REQUIRE((again.moves[i].vertex == whole.moves[i].vertex &&
                     again.moves[i].position == whole.moves[i].position &&
                     again.moves[i].weight == whole.moves[i].weight));
        CHECK(std::equal(before.positions.begin(), before.positions.end(),
                         stream.buffers().positions().begin(), stream.buffers().positions().end()));
    }
}

TEST_CASE("A view fetches no more than its nearest place needs, and nothing while it looks away") {
    const File bytes = file_of(naive_record(make_sphere(60, 40), 5));
    Stream stream;
    REQUIRE(stream.set_selective(true).ok());
    CameraView away = from({0, 0, 10}, 1);
    away.to_clip = clip({0, 0, -10}, 0.8f);
    stream.set_view(away);
    run(stream, bytes);
    CHECK(stream.wants().empty());
    CHECK(stream.blocks_decoded() <= 1);
    // As far as the error in the middle of the table is a pixel.
    const std::size_t middle = stream.info()->blocks.size() / 2;
    const double error = double(stream.info()->blocks[middle].error);
    stream.set_view(from({0, 0, float(1 + error * 1000 / (2 * std::tan(0.4)) * 0.99)}, 1));
    run(stream, bytes);
    const std::size_t far = stream.blocks_decoded();
    CHECK(far >= middle + 1);
    // Blocks of one sweep have one error.
    std::size_t enough = middle;
    while (double(stream.info()->blocks[enough].error) > error * 0.95) ++enough;
    CHECK(far <= enough + 1);
    stream.set_view(from({0, 0, 3}, 1));
    run(stream, bytes);
    CHECK(stream.blocks_decoded() > far);
}

TEST_CASE("A triangle budget goes to the painted half first, whatever came when") {
    const ProgressiveMesh record = naive_record(make_sphere(60, 40), 5);
    const File bytes = file_of(record);
    const ProgressiveMesh whole = read(bytes);
    const std::uint64_t budget = whole.triangles.size() / 2;
    const auto painted = [](const ViewMesh& mesh) {
        std::vector<float> priority;
        for (const Float3& p : mesh.positions()) priority.push_back(p.x > 0 ? 1000.0f : 1.0f);
        return priority;
    };
    const auto right = [](const ViewMesh& mesh) {
        return std::count_if(mesh.triangles().begin(), mesh.triangles().end(),
                             [&](const Triangle& t) { return mesh.positions()[t[0]].x > 0; });
    };
    Stream uniform, stream;
    for (Stream* s : {&uniform, &stream}) {
        REQUIRE(s->set_selective(true).ok());
        s->set_target(Target::triangles(budget));
        run(*s, bytes);
        REQUIRE(s->selective()->triangles().size() <= budget);
    }
    // Painted anew whenever vertices came.
    std::vector<float> given;
    while (given.size() != stream.selective()->positions().size()) {
        given = painted(*stream.selective());
        REQUIRE(stream.selective()->set_priority(given).ok());
        run(stream, bytes, 100);
        REQUIRE(stream.selective()->triangles().size() <= budget);
    }
    CHECK(stream.selective()->triangles().size() + 8 > budget);
    // The splits of this record wait for ones all over the sphere, so it is not all that it could be.
    CHECK(right(*stream.selective()) > right(*uniform.selective()));
    // Nothing of what did not come would have been worth more: the error that is left is that of the whole.
    auto judge = ViewMesh::make(whole);
    REQUIRE(judge.ok());
    REQUIRE(judge->set_priority(given).ok());
    judge->rank();
    const ViewMesh& mesh = *stream.selective();
    CHECK(judge->error_at_rank(judge->rank_for_triangles(budget)) ==
          mesh.error_at_rank(mesh.rank_for_triangles(budget)));
}

TEST_CASE("An object's view is that of the world, whatever its transform") {
    std::array<ViewPlane, kViewPlanes> planes;
    CameraView view = from({10, 4, 6}, 2);
    // Twice as large, turned by a quarter about z, moved.
    view.to_world = {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 4, 4, 4, 1};
    view.to_clip = clip(view.camera.eye, 0.8f);
    const View seen = object_view(view, planes);
    CHECK(seen.eye.x == Approx(0).margin(1e-6));
    CHECK(seen.eye.y == Approx(-3));
    CHECK(seen.eye.z == Approx(1));
    CHECK(seen.pixels_at_distance_1 == Approx(1000 / (2 * std::tan(0.4))));
    CHECK(seen.pixels == 2);
    REQUIRE(seen.planes.size() == kViewPlanes);
    std::mt19937 random(1);
    for (int i = 0; i < 1000; ++i) {
        const auto unit = [&] { return float(random() % 2001) / 200 - 5; };
        const Float3 p{unit(), unit(), unit()};
        const double world[3] = {4 - 2 * double(p.y), 4 + 2 * double(p.x), 4 + 2 * double(p.z)};
        const double depth = 6 - world[2], wide = std::tan(0.4) * depth;
        const double inside =
            std::min({depth, wide - std::fabs(world[0] - 10), wide - std::fabs(world[1] - 4)});
        if (std::fabs(inside) < 1e-3) continue;
        bool in = true;
        for (const ViewPlane& plane : seen.planes)
            in = in && plane.x * p.x + plane.y * p.y + plane.z * p.z + plane.w >= 0;
        REQUIRE(in == (inside > 0));
    }
    // Stretched: errors are taken for three times as large as distances.
    view.to_world = {3, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    CHECK(object_view(view, planes).pixels_at_distance_1 == Approx(3000 / (2 * std::tan(0.4))));
    // Flat: not seen.
    view.to_world = {1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0, 1};
    CHECK(std::isinf(error_of_view(object_view(view, planes), {-1, -1, -1}, {1, 1, 1})));
    CHECK(error_of_view(object_view(from({0, 0, 11}, 1), planes), {-1, -1, -1}, {1, 1, 1}) ==
          Approx(10 * 2 * std::tan(0.4) / 1000));
    CHECK(error_of_view(object_view(from({0, 0, 0}, 1), planes), {-1, -1, -1}, {1, 1, 1}) == 0);
}

TEST_CASE("C: a selective stream, its spans and its priorities") {
    Mesh torus = make_torus(24, 16);
    torus.weights = some_weights(torus.positions.size());
    const File bytes = file_of(decorated(naive_record(torus, 5), 4));
    const ProgressiveMesh whole = read(bytes);
    vsplit_stream* s = vsplit_stream_new(nullptr);
    REQUIRE(s);
    float priority = 2;
    CHECK(vsplit_stream_set_priority(s, &priority, 1) == VSPLIT_ERROR_ARGUMENT);
    CHECK(std::string(vsplit_stream_error(s)) != "");
    CHECK(vsplit_stream_use_weights(s) == VSPLIT_ERROR_ARGUMENT);
    CHECK(vsplit_stream_set_selective(s, 1) == VSPLIT_OK);
    CHECK(vsplit_stream_selective(s) == 0);
    REQUIRE(vsplit_stream_feed(s, 0, bytes.data(), bytes.size()) == VSPLIT_OK);
    REQUIRE(vsplit_stream_selective(s) == 1);

    vsplit_view view{};
    view.eye[2] = 6;
    view.vertical_fov = 0.8f;
    view.viewport_height = 1000;
    for (const std::size_t i : {0, 5, 10, 15}) view.to_world[i] = 1;
    std::vector<std::uint32_t> triangles(3 * whole.triangles.size());
    std::vector<float> places(3 * whole.positions.size());
    const float* const before = vsplit_stream_positions(s);
    const auto carry = [&](std::size_t capacity) {
        std::vector<vsplit_span> vertices(capacity), corners(capacity);
        std::size_t nv = 0, nt = 0;
        vsplit_stream_take_dirty_spans(s, capacity, vertices.data(), &nv, corners.data(), &nt);
        REQUIRE((nv <= capacity && nt <= capacity));
        for (std::size_t i = 0; i < nv; ++i)
            std::copy(vsplit_stream_positions(s) + 3 * vertices[i].begin,
                      vsplit_stream_positions(s) + 3 * vertices[i].end,
                      places.begin() + 3 * std::ptrdiff_t(vertices[i].begin));
        for (std::size_t i = 0; i < nt; ++i)
            std::copy(vsplit_stream_triangles(s) + 3 * corners[i].begin,
                      vsplit_stream_triangles(s) + 3 * corners[i].end,
                      triangles.begin() + 3 * std::ptrdiff_t(corners[i].begin));
        REQUIRE(std::equal(places.begin(), places.begin() + 3 * std::ptrdiff_t(vsplit_stream_vertex_count(s)),
                           vsplit_stream_positions(s)));
        REQUIRE(std::equal(triangles.begin(),
                           triangles.begin() + 3 * std::ptrdiff_t(vsplit_stream_triangle_count(s)),
                           vsplit_stream_triangles(s)));
    };
    struct Calls {
        int count = 0;
    } calls;
    for (int frame = 0; frame < 60; ++frame) {
        view.pixels = frame % 2 ? 3.0f : 30.0f;
        vsplit_stream_set_view(s, &view);
        vsplit_budget budget{};
        budget.max_blocks = 1;
        budget.max_splits = 40;
        budget.max_visits = 100;
        budget.user = &calls;
        budget.out_of_time = [](void* user) { return ++static_cast<Calls*>(user)->count % 3 == 0 ? 1 : 0; };
        vsplit_updated updated;
        REQUIRE(vsplit_stream_update_within(s, &budget, &updated) == VSPLIT_OK);
        REQUIRE(updated.splits <= 40);
        carry(frame % 3 == 0 ? 1 : 5);
    }
    view.pixels = 0;
    vsplit_stream_set_view(s, &view);
    vsplit_updated updated{};
    while (!updated.reached) REQUIRE(vsplit_stream_update_within(s, nullptr, &updated) == VSPLIT_OK);
    CHECK(vsplit_stream_triangle_count(s) == whole.triangles.size());
    CHECK(vsplit_stream_vertex_count(s) == whole.positions.size());
    CHECK(vsplit_stream_positions(s) == before);
    CHECK(vsplit_stream_groups(s) != nullptr);
    carry(3);

    vsplit_stream_set_view(s, nullptr);
    const std::vector<float> priorities(whole.positions.size(), 2);
    CHECK(vsplit_stream_set_priority(s, priorities.data(), std::uint32_t(priorities.size())) == VSPLIT_OK);
    CHECK(vsplit_stream_set_priority(s, priorities.data(), std::uint32_t(priorities.size() + 1)) ==
          VSPLIT_ERROR_ARGUMENT);
    vsplit_stream_set_target(s, VSPLIT_TARGET_TRIANGLES, 300);
    REQUIRE(vsplit_stream_update_within(s, nullptr, &updated) == VSPLIT_OK);
    CHECK(updated.reached);
    CHECK(vsplit_stream_triangle_count(s) <= 300);
    CHECK(vsplit_stream_use_weights(s) == VSPLIT_OK);
    CHECK(vsplit_stream_set_priority(s, nullptr, 0) == VSPLIT_OK);
    carry(4);
    CHECK(vsplit_stream_set_selective(s, 0) == VSPLIT_OK);
    CHECK(vsplit_stream_selective(s) == 0);
    carry(1);
    vsplit_stream_free(s);
}
