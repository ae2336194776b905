// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Marks, automatic weights, and the search for what is to be kept.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>

#include "family.hpp"
#include "vsplit/bake/weights.hpp"
#include "vsplit/live_mesh.hpp"

using namespace vsplit;
using namespace vsplit::bake;
using namespace vsplit::test;

namespace {

Result<Marks> parsed(const std::string& text, std::size_t count) {
    return parse_marks({reinterpret_cast<const std::byte*>(text.data()), text.size()}, count);
}

Mesh bumpy(int n) {
    Mesh mesh = make_grid(n);
    for (Float3& p : mesh.positions) p.z = 0.05f * std::sin(19 * p.x) * std::cos(23 * p.y);
    return mesh;
}

Marks left_third(const Mesh& mesh) {
    Marks marks = no_marks(mesh.positions.size());
    marks.regions.push_back({"left", {}, 0x123456});
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) marks.region[v] = mesh.positions[v].x < 0.34f;
    return marks;
}

}  // namespace

TEST_CASE("Marks: through text and back") {
    Marks marks = no_marks(4);
    marks.regions = {{"head", {}, 0xE6550D},
                     {"tail", 3.5, 0x000001},
                     {"eye", std::numeric_limits<double>::infinity(), 0xFFFFFF}};
    marks.region = {0, 1, 3, 2};
    marks.strength = {1, 0.25f, 1, 0.1f};
    const auto text = encode_marks(marks);
    const auto back = parse_marks(text, 4);
    REQUIRE(back.ok());
    REQUIRE(*back == marks);
    // Cut anywhere it is marks no more, or an error: never a crash.
    for (std::size_t n = 0; n < text.size() - 1; ++n) {
        const auto cut_off = parse_marks({text.data(), n}, 4);
        if (cut_off.ok()) REQUIRE(cut_off->region.size() == 4);
    }
}

TEST_CASE("Marks: what is wrong is told with its line") {
    const std::pair<const char*, std::uint64_t> wrong[] = {
        {"region a auto\n1\n2\n", 3},        {"region a auto\nregion a 2\n1\n1\n", 2},
        {"region a -1\n1\n1\n", 1},          {"region a nan\n1\n1\n", 1},
        {"region a auto #12345\n1\n1\n", 1}, {"region a auto #123456 x\n1\n1\n", 1},
        {"region a=b auto\n1\n1\n", 1},      {"region\n1\n1\n", 1},
        {"region a auto\n1 1.5\n1\n", 2},    {"region a auto\n1 0.5 3\n1\n", 2},
        {"region a auto\n1\n-1\n", 3},       {"0\n0\n0\n", 3},
    };
    for (const auto& [text, line] : wrong) {
        CAPTURE(text);
        const auto marks = parsed(text, 2);
        REQUIRE(!marks.ok());
        CHECK(marks.error().code == ErrorCode::kMalformed);
        CHECK(marks.error().line == line);
    }
    REQUIRE(parsed("0\n", 2).error().code == ErrorCode::kTruncated);
    std::string many;
    for (int r = 0; r < 256; ++r) many += "region r" + std::to_string(r) + " auto\n";
    REQUIRE(parsed(many, 0).error().line == 256);
    REQUIRE(parsed("# c\n\n  0 \r\n0", 2).ok());
}

TEST_CASE("Marks: weights, strengths, and meshes that were renumbered") {
    Marks marks = no_marks(5);
    marks.regions = {{"a", {}, 0}, {"b", 9.0, 0}};
    marks.region = {0, 1, 2, 2, 2};
    marks.strength = {1, 1, 1, 0.5f, 0};
    REQUIRE(weights_of(marks, 4) == std::vector<float>{1, 4, 9, 3, 1});
    const std::vector<std::uint32_t> vertex_of = {0, 1, 0xFFFFFFFFu, 1, 0};
    const Marks mesh = marks_of_mesh(marks, vertex_of, 2);
    REQUIRE(mesh.region == std::vector<std::uint8_t>{2, 1});
    REQUIRE(mesh.strength == std::vector<float>{0, 1});
    const Marks file = marks_of_file(mesh, vertex_of, 5);
    REQUIRE(file.region == std::vector<std::uint8_t>{2, 1, 0, 1, 2});
}

TEST_CASE("Keep: what it wants") {
    const auto keep = parse_keep("a=b=95%@40%");
    REQUIRE(keep);
    REQUIRE(keep->region == "a=b");
    REQUIRE(keep->share == Approx(0.95));
    REQUIRE(parse_keep("x=0.5@1")->ratio == 1);
    for (const char* wrong : {"", "x", "x=95%", "=95%@40%", "x=95%@", "x=@40%", "x=101%@40%", "x=95%@-1",
                              "x@40%=95%", "x=95%%@1"})
        CHECK(!parse_keep(wrong));
}

TEST_CASE("Automatic weights: the paper's rule, whatever the units") {
    Mesh mesh = bumpy(20);
    const EdgeErrors errors = edge_errors(mesh);
    REQUIRE(errors.smallest >= 0);
    REQUIRE(errors.median > errors.smallest);
    REQUIRE(errors.largest > errors.median);
    const AutomaticWeights automatic = automatic_weights(errors);
    REQUIRE(automatic.initial == (errors.smallest + errors.largest) / 2);
    REQUIRE(automatic.mark == (automatic.initial + errors.largest) / 2);
    REQUIRE(automatic.factor() > 1);
    for (Float3& p : mesh.positions) p = {p.x * 1024, p.y * 1024, p.z * 1024};
    const EdgeErrors scaled = edge_errors(mesh);
    REQUIRE(scaled.largest == Approx(1024 * errors.largest));
    REQUIRE(automatic_weights(scaled).factor() == Approx(automatic.factor()));
    for (const auto& [name, any] : mesh_family()) {
        CAPTURE(name);
        const AutomaticWeights weights = automatic_weights(edge_errors(any));
        const double factor = weights.factor();
        CHECK((factor >= 1 && factor <= 1e6));
    }
}

TEST_CASE("Record origins: every vertex of the record is one of the input's, at its place") {
    for (const auto& [name, mesh] : mesh_family()) {
        CAPTURE(name);
        const auto result = collapse(mesh);
        REQUIRE(result.ok());
        const Mesh full = cut(result->mesh, result->mesh.splits.size());
        const auto origins = record_origins(mesh, result->mesh);
        REQUIRE(origins.size() == full.positions.size());
        std::size_t wrong = 0;
        for (std::size_t v = 0; v < origins.size(); ++v)
            wrong +=
                origins[v] >= mesh.positions.size() || !(mesh.positions[origins[v]] == full.positions[v]);
        REQUIRE(wrong == 0);
    }
}

TEST_CASE("Keep: the weight found keeps what was asked, within 1 %") {
    const Mesh mesh = bumpy(30);
    for (const Cost cost : {Cost::kPaper, Cost::kQuadric})
        for (const Keep& wish : {Keep{"left", 0.9, 0.4}, Keep{"left", 0.3, 0.5}}) {
            CAPTURE(int(cost), wish.share);
            CollapseOptions options;
            options.cost = cost;
            Marks marks = left_third(mesh);
            const auto found = find_weights(mesh, marks, {&wish, 1}, options);
            REQUIRE(found.ok());
            REQUIRE(std::abs(found->front().share - wish.share) <= 0.01);
            // Counted again, from the bake that a user would make.
            Mesh painted = mesh;
            painted.weights = weights_of(marks, 1);
            const auto baked = collapse(painted, options);
            REQUIRE(baked.ok());
            const std::size_t level = level_for_triangles(
                baked->mesh, std::uint64_t(std::llround(wish.ratio * double(mesh.triangles.size()))));
            const double all = double(std::count(marks.region.begin(), marks.region.end(), 1));
            const double kept =
                double(region_vertices_at(baked->mesh, record_origins(mesh, baked->mesh), marks, 1, level));
            REQUIRE(kept / all == Approx(found->front().share));
        }
}

TEST_CASE("Keep: two regions at once, and what cannot be") {
    const Mesh mesh = bumpy(30);
    Marks marks = left_third(mesh);
    marks.regions.push_back({"right", 1.0, 0});
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        if (mesh.positions[v].x > 0.67f) marks.region[v] = 2;
    const Keep both[] = {{"left", 0.8, 0.4}, {"right", 0.5, 0.4}};
    const auto found = find_weights(mesh, marks, both);
    REQUIRE(found.ok());
    REQUIRE(std::abs((*found)[0].share - 0.8) <= 0.01);
    REQUIRE(std::abs((*found)[1].share - 0.5) <= 0.01);
    const auto refused = [&](const Keep& wish) {
        Marks copy = marks;
        const auto result = find_weights(mesh, copy, {&wish, 1});
        return !result.ok() && result.error().code == ErrorCode::kArgument;
    };
    REQUIRE(refused({"nobody", 0.5, 0.4}));
    REQUIRE(refused({"left", 1.0, 0.1}));  // more than the level has
    marks.region.assign(marks.region.size(), 2);
    REQUIRE(refused({"left", 0.5, 0.4}));  // empty
    Marks short_marks = marks;
    short_marks.region.pop_back();
    const Keep wish{"right", 0.5, 0.4};
    REQUIRE(!find_weights(mesh, short_marks, {&wish, 1}).ok());
    const auto cancelled =
        find_weights(mesh, marks, {&wish, 1}, {}, [](std::string_view, double) { return false; });
    if (!cancelled.ok()) REQUIRE(cancelled.error().code == ErrorCode::kCancelled);
}
