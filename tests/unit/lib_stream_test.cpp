// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Stream: bytes in any order and sizes, any target, servers and connections that misbehave; against cut().
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>

#include "../../lib/bytes/base_mesh.hpp"
#include "decorated.hpp"
#include "pmesh_bytes.hpp"
#include "vsplit/geomorph.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/stream.hpp"
#include "vsplit/write.hpp"

using namespace vsplit;
using test::Bytes;

namespace {

Bytes file_of(const ProgressiveMesh& record, std::uint32_t bits = 14) {
    WriteOptions options;
    options.position_bits = bits;
    options.block_bytes = 1024;
    auto bytes = write_progressive_mesh(record, options);
    REQUIRE(bytes.ok());
    return *std::move(bytes);
}

std::span<const std::byte> piece(const Bytes& bytes, std::uint64_t offset, std::uint64_t size) {
    offset = std::min<std::uint64_t>(offset, bytes.size());
    return std::span(bytes).subspan(std::size_t(offset),
                                    std::size_t(std::min<std::uint64_t>(size, bytes.size() - offset)));
}

/// Fetches and updates until the target is reached.
void run(Stream& stream, const Bytes& bytes, std::size_t most_splits = ~std::size_t{0}) {
    for (int calls = 0; calls < 100000; ++calls) {
        for (const ByteRange& range : stream.wants(700))
            REQUIRE(stream.feed(range.offset, piece(bytes, range.offset, range.size)).ok());
        const auto updated = stream.update({most_splits, ~std::size_t{0}, {}});
        REQUIRE(updated.ok());
        REQUIRE(updated->splits <= most_splits);
        if (updated->reached) return;
    }
    FAIL("the target is never reached");
}

/// memcmp() takes no null pointer, not even of nothing.
bool same(const void* a, const void* b, std::size_t bytes) {
    return bytes == 0 || std::memcmp(a, b, bytes) == 0;
}

void check_level(const Stream& stream, const ProgressiveMesh& whole) {
    const LiveBuffers& live = stream.buffers();
    const Mesh level = cut(whole, live.level());
    REQUIRE(live.positions().size() == level.positions.size());
    REQUIRE(same(live.positions().data(), level.positions.data(), 12 * level.positions.size()));
    REQUIRE(std::equal(level.triangles.begin(), level.triangles.end(), live.triangles().begin(),
                       live.triangles().end()));
    REQUIRE(
        std::equal(level.weights.begin(), level.weights.end(), live.weights().begin(), live.weights().end()));
    for (std::size_t a = 0; a < level.attributes.size(); ++a) {
        const auto values = live.attribute(a);
        REQUIRE(values.size() == level.attributes[a].values.size());
        REQUIRE(same(values.data(), level.attributes[a].values.data(), 4 * values.size()));
    }
    REQUIRE(std::equal(level.groups.begin(), level.groups.end(), live.groups().begin(), live.groups().end()));
    REQUIRE(double(stream.level_error()) == Approx(error_at(whole, live.level())));
}

std::vector<std::pair<std::string, ProgressiveMesh>> records() {
    std::vector<std::pair<std::string, ProgressiveMesh>> all;
    for (const auto& [name, mesh] : test::mesh_family()) {
        if (mesh.triangles.size() > 1000) continue;
        all.emplace_back(name, test::naive_record(mesh, 7));
        if (!mesh.positions.empty())
            all.emplace_back(name + ", decorated", test::decorated(test::naive_record(mesh, 8), 3));
    }
    return all;
}

const ProgressiveMesh& sphere() {
    static const ProgressiveMesh record = test::naive_record(test::make_sphere(60, 40), 5);
    return record;
}

}  // namespace

TEST_CASE("Every target is reached with the bytes it needs, and is the level that cut() gives") {
    for (const auto& [name, record] : records())
        for (const std::uint32_t bits : {14u, 0u}) {
            INFO(name << ", bits " << bits);
            const Bytes bytes = file_of(record, bits);
            const auto whole = read_progressive_mesh(bytes);
            REQUIRE(whole.ok());
            Stream stream;
            for (const Target& target : {Target::ratio(0.1), Target::ratio(0.6), Target::triangles(20),
                                         Target::vertices(33), Target::error(0.5), Target::ratio(1),
                                         Target::ratio(0), Target::error(0), Target::ratio(0.4)}) {
                stream.set_target(target);
                run(stream, bytes, 37);
                check_level(stream, *whole);
                const std::size_t level = stream.buffers().level();
                switch (target.kind) {
                    case Target::Kind::kRatio:
                        CHECK(level == level_for_triangles(
                                           *whole, std::uint64_t(std::llround(
                                                       target.value * double(whole->triangles.size())))));
                        break;
                    case Target::Kind::kTriangles:
                        CHECK(level == level_for_triangles(*whole, std::uint64_t(target.value)));
                        break;
                    case Target::Kind::kVertices:
                        CHECK(level == level_for_vertices(*whole, std::uint64_t(target.value)));
                        break;
                    default:
                        CHECK(level == level_for_error(*whole, target.value));
                }
            }
            CHECK(stream.complete());
            CHECK(stream.wants().empty());
            CHECK(stream.bytes_received() == bytes.size());
        }
}

TEST_CASE("A coarse target does not ask for the end of the file") {
    const Bytes bytes = file_of(sphere());
    Stream stream;
    stream.set_target(Target::ratio(0.1));
    run(stream, bytes);
    CHECK_FALSE(stream.complete());
    CHECK(stream.bytes_received() < bytes.size() / 2 + 16384);
    CHECK(stream.buffers().triangle_count() <= sphere().triangles.size() / 10);
}

TEST_CASE("Bytes may come in any order and size, more than once, and as a whole file") {
    const Bytes bytes = file_of(sphere());
    const auto whole = read_progressive_mesh(bytes);
    std::mt19937 random(1);
    for (int turn = 0; turn < 40; ++turn) {
        Stream stream;
        std::vector<std::pair<std::uint64_t, std::uint64_t>> pieces;
        const std::uint64_t most = 1 + random() % 3000;
        for (std::uint64_t at = 0; at < bytes.size();) {
            const std::uint64_t size = 1 + random() % most;
            pieces.emplace_back(at, size);
            if (random() % 4 == 0) pieces.emplace_back(at / 2, size);
            at += size;
        }
        if (turn % 2) std::shuffle(pieces.begin(), pieces.end(), random);
        for (int round = 0; round < 2; ++round)  // blocks are passed over while the front is not known
            for (const auto& [at, size] : pieces) {
                REQUIRE(stream.feed(at, piece(bytes, at, size)).ok());
                if (random() % 3 == 0) REQUIRE(stream.update({random() % 50, 1, {}}).ok());
            }
        REQUIRE(stream.update().ok());
        REQUIRE(stream.complete());
        check_level(stream, *whole);
    }
    Stream stream;  // a server that ignores ranges
    REQUIRE(stream.feed(0, bytes).ok());
    REQUIRE(stream.update()->reached);
    check_level(stream, *whole);
}

TEST_CASE("A connection that dies a hundred times ends in the same mesh") {
    const Bytes bytes = file_of(sphere());
    const auto whole = read_progressive_mesh(bytes);
    std::mt19937 random(2);
    for (int turn = 0; turn < 20; ++turn) {
        Stream stream;
        for (int dead = 0; dead < 100 && !stream.complete(); ++dead)
            for (const ByteRange& range : stream.wants(4000)) {
                const std::uint64_t got = dead < 99 ? random() % (range.size + 1) : range.size;
                REQUIRE(stream.feed(range.offset, piece(bytes, range.offset, got)).ok());
                REQUIRE(stream.update({random() % 30, ~std::size_t{0}, {}}).ok());
            }
        run(stream, bytes);
        check_level(stream, *whole);
    }
}

TEST_CASE("A damaged block is asked for again, and given up after a few tries") {
    const Bytes good = file_of(sphere());
    const auto whole = read_progressive_mesh(good);
    const auto info = read_info(good);
    REQUIRE(info->blocks.size() > 2);
    Bytes bad = good;
    bad[std::size_t(info->blocks[1].offset) + 10] ^= std::byte{4};
    Stream stream;
    const Status fed = stream.feed(0, bad);
    REQUIRE_FALSE(fed.ok());
    CHECK(fed.error().code == ErrorCode::kChecksum);
    CHECK(fed.error().offset == info->blocks[1].offset);
    CHECK_FALSE(stream.broken());
    REQUIRE(stream.update().ok());
    CHECK(stream.blocks_decoded() == 1);
    const auto again = stream.wants(1 << 20);
    REQUIRE(again.size() == 1);
    CHECK(again[0] == ByteRange{info->blocks[1].offset, info->blocks[1].bytes});
    REQUIRE(stream.feed(again[0].offset, piece(good, again[0].offset, again[0].size)).ok());
    REQUIRE(stream.update()->reached);
    check_level(stream, *whole);

    Stream unlucky;
    for (int turn = 0; turn < 3; ++turn) CHECK_FALSE(unlucky.feed(0, bad).ok());
    CHECK(unlucky.broken());
    CHECK(unlucky.wants().empty());
    CHECK(unlucky.ready());
    CHECK(unlucky.buffers().triangle_count() == whole->base_triangles);

    // The front, too.
    Bytes front = good;
    front[100] ^= std::byte{1};
    Stream third;
    CHECK_FALSE(third.feed(0, front).ok());
    CHECK_FALSE(third.broken());
    CHECK(third.wants().front().offset == 0);
    REQUIRE(third.feed(0, good).ok());
    REQUIRE(third.update()->reached);
}

TEST_CASE("What is no .pmesh is refused at once, and a file that is cut says so") {
    const std::string html = "<!DOCTYPE html><html>sign in</html>";
    Stream stream;
    const Status fed = stream.feed(0, std::as_bytes(std::span(html)));
    REQUIRE_FALSE(fed.ok());
    CHECK(stream.broken());
    CHECK(stream.wants().empty());
    CHECK_FALSE(stream.update().ok());

    const Bytes bytes = file_of(sphere());
    for (const std::size_t size : {std::size_t{100}, std::size_t{250}, bytes.size() - 1}) {
        Stream cut_off;
        REQUIRE(cut_off.feed(0, piece(bytes, 0, size)).ok());
        CHECK_FALSE(cut_off.set_file_size(size).ok());
        CHECK(cut_off.broken());
    }
    Stream longer;
    REQUIRE(longer.set_file_size(bytes.size() + 1).ok());
    CHECK_FALSE(longer.feed(0, bytes).ok());
}

TEST_CASE("Flipped bits under repaired checksums end in an error or a sound mesh") {
    const Bytes good = file_of(test::decorated(test::naive_record(test::make_torus(12, 8), 3), 4));
    std::mt19937 random(9);
    for (int turn = 0; turn < 400; ++turn) {
        Bytes bytes = good;
        for (int flips = 1 + int(random() % 3); flips > 0; --flips)
            bytes[12 + random() % (bytes.size() - 12)] ^= std::byte(1u << random() % 8);
        test::reseal(bytes);
        Stream stream;
        for (int calls = 0; calls < 50 && !stream.broken() && !stream.complete(); ++calls) {
            for (const ByteRange& range : stream.wants(5000))
                (void)stream.feed(range.offset, piece(bytes, range.offset, range.size));
            (void)stream.update();
        }
        const LiveBuffers& live = stream.buffers();
        for (const Triangle& t : live.triangles())
            for (const std::uint32_t v : t) REQUIRE(v < live.vertex_count());
    }
}

TEST_CASE("A job decodes elsewhere; meanwhile the stream goes on within what it has") {
    const Bytes bytes = file_of(sphere());
    const auto whole = read_progressive_mesh(bytes);
    Stream stream;
    REQUIRE(stream.feed(0, bytes).ok());
    while (!stream.complete()) {
        auto job = stream.take_job();
        REQUIRE(job);
        CHECK_FALSE(stream.take_job());
        CHECK(stream.update()->wants_bytes == false);
        job->run();
        REQUIRE(stream.finish_job(std::move(*job)).ok());
    }
    stream.jump_to_target();
    check_level(stream, *whole);
}

TEST_CASE("A host may decode the base mesh; what it gives is checked") {
    WriteOptions with_draco;
    with_draco.base_coding = BaseCoding::kDraco;
    const auto written =
        write_progressive_mesh(test::naive_record(test::make_sphere(30, 20), 5, 300), with_draco);
    REQUIRE(written.ok());
    const Bytes& bytes = *written;
    const auto whole = read_progressive_mesh(bytes);
    int asked = 0;
    StreamOptions options;
    options.decode_base = [&](std::span<const std::byte> draco, std::span<std::int32_t> places,
                              std::span<std::uint32_t> corners) {
        ++asked;
        return decode_draco(draco, places, corners).ok();
    };
    Stream stream(options);
    run(stream, bytes);
    CHECK(asked == 1);
    check_level(stream, *whole);
    const auto read = read_progressive_mesh(bytes, {}, options.decode_base);
    REQUIRE(read.ok());
    CHECK(read->positions == whole->positions);
    CHECK(read_prefix(bytes, {}, options.decode_base).ok());
    for (const int kind : {0, 1, 2, 3}) {
        options.decode_base = [kind](std::span<const std::byte> draco, std::span<std::int32_t> places,
                                     std::span<std::uint32_t> corners) {
            if (!decode_draco(draco, places, corners).ok()) return false;
            if (kind == 1) corners[1] = 1'000'000;
            if (kind == 2) corners[1] = corners[0];
            if (kind == 3) places[2] = std::numeric_limits<std::int32_t>::min();
            return kind != 0;
        };
        Stream wrong(options);
        const Status fed = wrong.feed(0, bytes);
        REQUIRE_FALSE(fed.ok());
        CHECK(fed.error().code == ErrorCode::kMalformed);
        CHECK(wrong.broken());
    }
}

TEST_CASE("Pending bytes are bounded") {
    const Bytes bytes = file_of(sphere());
    StreamOptions options;
    options.max_pending_bytes = 3000;
    Stream stream(options);
    REQUIRE(stream.feed(0, bytes).ok());
    CHECK(stream.bytes_received() < 16384 + 8000);
    run(stream, bytes);
    CHECK(stream.complete());
}

TEST_CASE("Pixels: the nearer, the finer; and small changes are not followed") {
    const Bytes bytes = file_of(sphere());
    Stream stream;
    REQUIRE(stream.feed(0, bytes).ok());
    REQUIRE(stream.update().ok());
    const FileInfo& info = *stream.info();
    const float identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const float twice[16] = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1};
    const auto error = [&](float distance, const float(&m)[16]) {
        return error_of_pixels({{0, 0, distance}, 0.8, 1000}, info.bounds_min, info.bounds_max, m, 1);
    };
    CHECK(error(1, identity) == 0);  // within
    CHECK(error(100, identity) > error(10, identity));
    CHECK(error(1e6f, twice) == Approx(error(1e6f, identity) / 2).epsilon(1e-4));
    CHECK(pixels_of_error({{0, 0, 50}, 0.8, 1000}, info.bounds_min, info.bounds_max, identity,
                          error(50, identity)) == Approx(1));
    const double middle = double(info.blocks[info.blocks.size() / 2].error);
    stream.set_target(Target::pixels(middle));
    REQUIRE(stream.update()->reached);
    const std::size_t level = stream.buffers().level();
    for (const double change : {1.05, 1.0, 1.1, 0.99999}) {
        stream.set_target(Target::pixels(middle * change));
        REQUIRE(stream.update()->reached);
        if (change >= 1) CHECK(stream.buffers().level() == level);
        CHECK(double(stream.level_error()) <= middle * change);
    }
    stream.set_target(Target::pixels(middle * 3));
    REQUIRE(stream.update()->reached);
    CHECK(stream.buffers().level() < level);
}

TEST_CASE("A geomorph starts at one level and ends at the other, finer and coarser") {
    const Bytes bytes = file_of(sphere());
    Stream stream;
    REQUIRE(stream.feed(0, bytes).ok());
    for (const auto& [first, second] : {std::pair{0.2, 0.7}, {0.7, 0.2}, {0.5, 0.5}}) {
        stream.set_target(Target::ratio(first));
        REQUIRE(stream.update()->reached);
        const std::vector<Float3> a(stream.buffers().positions().begin(), stream.buffers().positions().end());
        Geomorph morph(stream.buffers());
        stream.set_target(Target::ratio(second));
        REQUIRE(stream.update()->reached);
        const std::vector<Float3> b(stream.buffers().positions().begin(), stream.buffers().positions().end());
        morph.turn(stream.buffers());
        const auto start = morph.blend(0);
        REQUIRE(start.size() == std::max(a.size(), b.size()));
        CHECK(std::equal(a.begin(), a.end(), start.begin()));
        for (const Float3& p :
             start.subspan(std::min(a.size(), start.size())))  // all on the coarser level's places
            REQUIRE(std::find(a.begin(), a.end(), p) != a.end());
        const auto end = morph.blend(1);
        CHECK(std::equal(b.begin(), b.end(), end.begin()));
        for (const Triangle& t : morph.triangles())
            for (const std::uint32_t v : t) REQUIRE(v < end.size());
        const auto half = morph.blend(0.5);
        for (std::size_t v = 0; v < half.size(); ++v)
            REQUIRE(half[v].x ==
                    Approx(0.5 * (double(morph.from()[v].x) + double(morph.to()[v].x))).margin(1e-6));
    }
}

/// The places of a triangle's corners.
std::array<Float3, 3> corners(const Triangle& t, std::span<const Float3> places) {
    return {places[t[0]], places[t[1]], places[t[2]]};
}

TEST_CASE("A geomorph does not jump, corner by corner, also when its target changes on the way") {
    for (const auto& [name, record] : records()) {
        INFO(name);
        const Bytes bytes = file_of(record);
        const auto whole = read_progressive_mesh(bytes);
        Stream stream;
        REQUIRE(stream.feed(0, bytes).ok());
        REQUIRE(stream.update().ok());
        if (stream.buffers().positions().empty()) continue;
        std::mt19937 random(4);
        const auto go = [&](double ratio) {
            stream.set_target(Target::ratio(ratio));
            REQUIRE(stream.update()->reached);
        };
        const auto copy = [](auto span) { return std::vector(span.begin(), span.end()); };
        go(0.5);
        Geomorph morph(stream.buffers());
        std::vector<Triangle> shown = copy(stream.buffers().triangles());
        std::vector<Float3> places = copy(stream.buffers().positions());
        for (int turn = 0; turn < 12; ++turn) {
            // Sometimes to the end, sometimes it is turned before.
            const double from_t = turn == 0 ? 0 : turn % 3 == 0 ? 1 : double(random() % 100) / 100;
            if (turn > 0) {
                shown = copy(morph.triangles());
                places = copy(morph.blend(from_t));
            }
            go(double(random() % 101) / 100);
            const std::vector<Triangle> wanted = copy(stream.buffers().triangles());
            const std::vector<Float3> wanted_places = copy(stream.buffers().positions());
            morph.turn(stream.buffers(), from_t);
            const std::vector<Triangle> drawn = copy(morph.triangles());
            const std::vector<Float3> start = copy(morph.blend(0)), end = copy(morph.blend(1));
            REQUIRE(drawn.size() >= std::max(shown.size(), wanted.size()));
            for (std::size_t t = 0; t < drawn.size(); ++t) {
                const auto a = corners(drawn[t], start), b = corners(drawn[t], end);
                // What was shown starts where it is, what is wanted ends where it is; all else is no wider
                // than an edge there. A component that comes back has no place to come from.
                if (t < shown.size())
                    REQUIRE(a == corners(shown[t], places));
                else if (whole->parents[*std::max_element(drawn[t].begin(), drawn[t].end())] != kNoVertex)
                    REQUIRE((a[0] == a[1] || a[1] == a[2] || a[2] == a[0]));
                if (t < wanted.size())
                    REQUIRE(b == corners(wanted[t], wanted_places));
                else if (whole->parents[*std::max_element(drawn[t].begin(), drawn[t].end())] != kNoVertex)
                    REQUIRE((b[0] == b[1] || b[1] == b[2] || b[2] == b[0]));
            }
        }
    }
}
