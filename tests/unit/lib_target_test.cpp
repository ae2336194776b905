// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Targets with two bounds, and several meshes that share one.
#include <catch2/catch.hpp>
#include <cmath>

#include "family.hpp"
#include "naive_record.hpp"
#include "pmesh_bytes.hpp"
#include "vsplit/geomorph.hpp"
#include "vsplit/stream.hpp"
#include "vsplit/vsplit.h"
#include "vsplit/write.hpp"

using namespace vsplit;
using test::Bytes;

namespace {

Bytes file_of(const ProgressiveMesh& record) {
    WriteOptions options;
    options.block_bytes = 1024;
    auto bytes = write_progressive_mesh(record, options);
    REQUIRE(bytes.ok());
    return *std::move(bytes);
}

const ProgressiveMesh& sphere() {
    static const ProgressiveMesh record = test::naive_record(test::make_sphere(60, 40), 5);
    return record;
}

/// Fetches what is wanted, until nothing is.
void fetch(Stream& stream, const Bytes& bytes) {
    for (auto wanted = stream.wants(700); !wanted.empty(); wanted = stream.wants(700)) {
        for (const ByteRange& r : wanted)
            REQUIRE(stream
                        .feed(r.offset, std::span(bytes).subspan(
                                            std::size_t(r.offset),
                                            std::size_t(std::min(r.size, bytes.size() - r.offset))))
                        .ok());
        REQUIRE(stream.update().ok());
    }
}

}  // namespace

TEST_CASE("An error and a number of triangles in one target: the coarser of the two") {
    const Bytes bytes = file_of(sphere());
    Stream whole;
    REQUIRE(whole.feed(0, bytes).ok());
    REQUIRE(whole.update()->reached);
    const FileInfo& info = *whole.info();
    const LiveBuffers& levels = whole.buffers();
    const double fine = double(info.blocks[info.blocks.size() / 2].error);
    const std::size_t level = levels.level_for_error(fine);
    const std::uint64_t triangles = levels.triangles_at(level);
    bool decoded_less = false;
    for (const bool selective : {false, true})
        for (const Target& asked : {Target::error(fine), Target::pixels(fine), Target::ratio(0.9)})
            for (const std::uint64_t most :
                 {triangles / 3, triangles * 2 / 3, std::uint64_t{0}, ~std::uint64_t{0}}) {
                CAPTURE(selective, int(asked.kind), most);
                Stream stream;
                REQUIRE(stream.set_selective(selective).ok());
                stream.set_target(asked.at_most(most));
                fetch(stream, bytes);
                const auto updated = stream.update();
                CHECK(updated->reached);
                CHECK_FALSE(updated->wants_bytes);
                const std::size_t drawn =
                    selective ? stream.selective()->triangles().size() : stream.buffers().triangle_count();
                CHECK(drawn <= std::max<std::uint64_t>(most, info.base_triangles));
                if (!selective) {
                    const std::size_t by_kind =
                        asked.kind == Target::Kind::kRatio
                            ? levels.level_for_triangles(std::uint64_t(std::round(0.9 * info.triangles)))
                            : level;
                    CHECK(stream.buffers().level() == std::min(by_kind, levels.level_for_triangles(most)));
                } else if (most < triangles && most > 0) {
                    CHECK(drawn + 8 > most);  // as many as there may be
                }
                decoded_less |= most < triangles && stream.blocks_decoded() < info.blocks.size() / 2;
                // What may be drawn grows: the same target goes on.
                stream.set_target(asked);
                REQUIRE(stream.feed(0, bytes).ok());
                CHECK(stream.update()->reached);
                if (!selective && asked.kind != Target::Kind::kRatio)
                    CHECK(stream.buffers().level() == level);
            }
    CHECK(decoded_less);
}

TEST_CASE("C: an error and a number of triangles, for one stream and for several") {
    const Bytes bytes = file_of(sphere());
    vsplit_stream* streams[3];
    for (vsplit_stream*& s : streams) REQUIRE((s = vsplit_stream_new(nullptr)) != nullptr);
    for (int i = 0; i < 2; ++i)
        REQUIRE(vsplit_stream_feed(streams[i], 0, bytes.data(), bytes.size()) == VSPLIT_OK);
    vsplit_stream* const s = streams[0];
    const auto draws = [&](vsplit_target kind, double value, std::uint64_t most) {
        vsplit_stream_set_target_within(s, kind, value, most);
        vsplit_updated updated;
        REQUIRE(vsplit_stream_update(s, ~std::size_t{0}, ~std::size_t{0}, &updated) == VSPLIT_OK);
        REQUIRE(updated.reached);
        return vsplit_stream_triangle_count(s);
    };
    vsplit_totals totals;
    vsplit_stream_totals(s, &totals);
    const auto info = read_info(bytes);
    const double error = double(info->blocks[info->blocks.size() / 2].error);
    const std::uint32_t by_error = draws(VSPLIT_TARGET_ERROR, error, ~0u);
    REQUIRE(by_error > 100);
    REQUIRE(by_error < totals.triangles);
    std::uint32_t most_born = 0, before = sphere().base_triangles;
    for (const Split& split : sphere().splits) {
        most_born = std::max(most_born, split.triangles_end - before);
        before = split.triangles_end;
    }
    REQUIRE(most_born < 30);
    for (const vsplit_target kind : {VSPLIT_TARGET_ERROR, VSPLIT_TARGET_PIXELS}) {
        CHECK(draws(kind, error, by_error + 50) == by_error);
        const std::uint32_t few = draws(kind, error, by_error / 2);
        CHECK(few <= by_error / 2);
        CHECK(few + most_born > by_error / 2);
    }
    CHECK(draws(VSPLIT_TARGET_RATIO, 1, UINT64_MAX) == totals.triangles);
    CHECK(draws(static_cast<vsplit_target>(77), 1, 100) <= 100);  // unknown: a ratio

    // Two of three are there; the second is seen from twice as far.
    const double pixel[3] = {0.001, 0.002, 0.001};
    double errors[3] = {-1, -1, -1};
    const auto both = [&] {
        return draws(VSPLIT_TARGET_ERROR, errors[0], UINT64_MAX) +
               draws(VSPLIT_TARGET_ERROR, errors[1], UINT64_MAX);  // the same file
    };
    vsplit_share_triangles(streams, pixel, 3, totals.triangles, 0, errors);
    CHECK(errors[0] > 0);
    CHECK(errors[1] == Approx(2 * errors[0]));
    CHECK(errors[2] == 0);
    CHECK(both() <= totals.triangles);
    // Finer than asked is not needed, whatever the budget.
    const double pixels = 4 * errors[0] / pixel[0];
    vsplit_share_triangles(streams, pixel, 3, totals.triangles, pixels, errors);
    CHECK(errors[0] == Approx(pixels * pixel[0]));
    CHECK(errors[1] == Approx(pixels * pixel[1]));
    vsplit_share_triangles(streams, pixel, 3, ~std::uint64_t{0}, 0, errors);
    CHECK((errors[0] == 0 && errors[1] == 0));
    for (vsplit_stream* each : streams) vsplit_stream_free(each);
}

TEST_CASE("A budget of bytes is shared likewise") {
    const auto one = read_info(file_of(sphere()));
    const auto two = read_info(file_of(test::naive_record(test::make_torus(40, 30), 3)));
    const BudgetItem items[] = {{&*one, 100}, {&*two, 25}};
    std::uint64_t before = 0;
    for (std::uint64_t budget = 1000; budget < 2 * (one->file_bytes + two->file_bytes); budget += 700) {
        const auto errors = share_bytes(items, budget);
        std::uint64_t sum = 0;
        for (std::size_t i = 0; i < 2; ++i) {
            const FileInfo& info = *items[i].info;
            std::uint64_t end = info.data_offset;
            if (double(info.base_error) > errors[i])
                for (const BlockInfo& b : info.blocks) {
                    end = b.offset + b.bytes;
                    if (double(b.error) <= errors[i]) break;
                }
            sum += end;
        }
        CHECK(sum <= std::max(budget, one->data_offset + two->data_offset));
        CHECK(sum >= before);
        before = sum;
    }
    CHECK(before == one->file_bytes + two->file_bytes);
}

TEST_CASE("A budget is shared so that no mesh is much worse on the screen than another") {
    const auto one = read_info(file_of(sphere()));
    const auto two = read_info(file_of(test::naive_record(test::make_torus(40, 30), 3)));
    const auto count = [](const FileInfo& info, double error) {
        if (double(info.base_error) <= error) return info.base_triangles;
        for (const BlockInfo& b : info.blocks)
            if (double(b.error) <= error) return b.triangles_end;
        return info.triangles;
    };
    for (const std::uint64_t budget : {0u, 500u, 1500u, 3000u, 100000u}) {
        const BudgetItem items[] = {{&*one, 100}, {&*two, 25}, {&*two, 0}};
        const auto errors = share_triangles(items, budget);
        REQUIRE(errors.size() == 3);
        const std::uint64_t least = one->base_triangles + 2 * two->base_triangles;
        const std::uint64_t sum = count(*one, errors[0]) + count(*two, errors[1]) + count(*two, errors[2]);
        CHECK(sum <= std::max(budget, least));
        CHECK(count(*two, errors[2]) == two->base_triangles);
        if (budget > least) CHECK(errors[0] * 100 == Approx(errors[1] * 25));
        if (budget == 100000) CHECK(errors[0] == 0);
        // No finer than asked, however much budget that leaves; and a budget that is too small for it wins.
        const double coarse = 100 * errors[0] + 2;
        for (const auto& [pixels, on_screen] :
             {std::pair{coarse, coarse}, {50 * errors[0], 100 * errors[0]}}) {
            if (budget <= least) continue;
            const auto bounded = share_triangles(items, budget, pixels);
            CHECK(bounded[0] * 100 == Approx(on_screen).margin(1e-12));
            CHECK(bounded[1] * 25 == Approx(on_screen).margin(1e-12));
        }
    }
}
