// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What the writer does to a record: places and attributes are rounded as promised, splits change places, and
// nothing else happens.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <random>

#include "decorated.hpp"
#include "family.hpp"
#include "naive_record.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/read.hpp"
#include "vsplit/write.hpp"

using namespace vsplit;
using test::decorated;
using test::returning;
using test::seam;

namespace {

WriteOptions bits(std::uint32_t position_bits) {
    WriteOptions options;
    options.position_bits = position_bits;
    return options;
}

/// Everything that a renderer reads, triangle by triangle, however vertices and triangles are numbered: the
/// bits of each corner's floats, the least corner first, and the group.
std::vector<std::vector<std::uint32_t>> soup(const Mesh& mesh) {
    std::vector<std::vector<std::uint32_t>> all;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        std::array<std::vector<std::uint32_t>, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = mesh.triangles[t][k];
            std::vector<float> floats = {mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z};
            if (!mesh.weights.empty()) floats.push_back(mesh.weights[v]);
            for (const Attribute& a : mesh.attributes)
                for (std::uint32_t c = 0; c < a.components; ++c)
                    floats.push_back(a.values[a.components * v + c]);
            corners[k].resize(floats.size());
            std::memcpy(corners[k].data(), floats.data(), 4 * floats.size());
        }
        auto least = corners;
        for (int k = 0; k < 2; ++k) {
            std::rotate(corners.begin(), corners.begin() + 1, corners.end());
            least = std::min(least, corners);
        }
        corners = least;
        std::vector<std::uint32_t> row;
        for (const auto& corner : corners) row.insert(row.end(), corner.begin(), corner.end());
        row.push_back(mesh.groups.empty() ? 0 : mesh.groups[t]);
        all.push_back(std::move(row));
    }
    std::sort(all.begin(), all.end());
    return all;
}

void require_same_file(const ProgressiveMesh& record, const WriteOptions& options) {
    REQUIRE(progressive_mesh_fault(record) == nullptr);
    const auto promised = canonical_progressive_mesh(record, options);
    REQUIRE(promised.ok());
    const auto bytes = write_progressive_mesh(record, options);
    REQUIRE(bytes.ok());
    const auto back = read_progressive_mesh(*bytes);
    if (!back.ok()) FAIL(back.error().describe());
    REQUIRE(test::same_bytes(*back, *promised));
    REQUIRE(back->attributes == promised->attributes);
    REQUIRE(back->moved_values == promised->moved_values);
    REQUIRE(back->groups == promised->groups);
    REQUIRE(back->splits.size() == record.splits.size());
}

}  // namespace

TEST_CASE("Lossless, the full mesh and the base are the input's, float for float") {
    for (auto [name, mesh] : test::mesh_family())
        for (const bool plain : {true, false}) {
            CAPTURE(name, plain);
            if (!plain) mesh.weights = test::some_weights(mesh.positions.size());
            ProgressiveMesh record = test::naive_record(mesh, 21);
            if (!plain) record = decorated(std::move(record), 22);
            require_same_file(record, bits(0));
            const auto written = canonical_progressive_mesh(record, bits(0));
            REQUIRE((soup(cut(*written, 0)) == soup(cut(record, 0))));
            REQUIRE((soup(cut(*written, written->splits.size())) == soup(cut(record, record.splits.size()))));
        }
}

TEST_CASE("Rounded, every place is within half a step") {
    for (const auto& [name, mesh] : test::mesh_family())
        for (const std::uint32_t b : {8u, 14u, 20u}) {
            CAPTURE(name, b);
            const ProgressiveMesh record = test::naive_record(mesh, 31);
            const auto bytes = write_progressive_mesh(record, bits(b));
            REQUIRE(bytes.ok());
            const auto info = read_info(*bytes);
            REQUIRE(info.ok());
            REQUIRE(info->position_bits == b);
            // Against the lossless canonical mesh, whose order is the same wherever no trade of names
            // differs: here the full meshes as sorted sets of places suffice.
            auto exact = cut(record, record.splits.size()).positions;
            const auto back = read_progressive_mesh(*bytes);
            REQUIRE(back.ok());
            const auto rounded = cut(*back, back->splits.size()).positions;
            REQUIRE(rounded.size() == exact.size());
            const double step = info->position_step;
            const auto cell = [&](const Float3& p) {
                const std::array<double, 3> v = {p.x, p.y, p.z};
                std::array<long, 3> c{};
                for (std::size_t i = 0; i < 3; ++i)
                    c[i] = step > 0 ? std::lround((v[i] - info->lattice_origin[i]) / step) : 0;
                return c;
            };
            std::map<std::array<long, 3>, int> cells;
            for (const Float3& p : exact) ++cells[cell(p)];
            for (const Float3& p : rounded) --cells[cell(p)];
            REQUIRE(std::all_of(cells.begin(), cells.end(), [](const auto& c) { return c.second == 0; }));
        }
}

TEST_CASE("Attributes of every kind come back as the writer rounded them") {
    for (const auto& [name, mesh] : test::mesh_family()) {
        CAPTURE(name);
        const ProgressiveMesh record = decorated(test::naive_record(mesh, 41), 42);
        for (const std::uint32_t b : {0u, 14u}) require_same_file(record, bits(b));
        const auto written = canonical_progressive_mesh(record, bits(14));
        const Mesh full = cut(*written, written->splits.size());
        REQUIRE(mesh_fault(full) == nullptr);
        bool right = true;
        for (std::size_t v = 0; v < full.positions.size(); ++v) {
            const float* n = full.attributes[0].values.data() + 3 * v;
            right &= std::abs(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-5f;
            const float handedness = full.attributes[1].values[4 * v + 3];
            right &= handedness == 1 || handedness == -1;
            const float* joint = full.attributes[4].values.data() + 4 * v;
            right &= joint[0] == std::floor(joint[0]) && joint[0] >= 0 && joint[0] < 60;
            const float* share = full.attributes[5].values.data() + 4 * v;
            right &= std::abs(share[0] + share[1] + share[2] + share[3] - 1) < 1e-5f;
        }
        REQUIRE(right);
    }
}

TEST_CASE("Seams and returning components survive") {
    for (const std::uint32_t b : {0u, 14u}) {
        for (const bool moving : {false, true}) {
            CAPTURE(b, moving);
            require_same_file(seam(moving), bits(b));
            const auto written = canonical_progressive_mesh(seam(moving), bits(b));
            REQUIRE(written->splits.size() == 1);
            REQUIRE(written->splits[0].vertices_end == 8);
            const Mesh full = cut(*written, 1);
            REQUIRE(full.positions[6] == full.positions[7]);
        }
        require_same_file(returning(), bits(b));
        require_same_file(decorated(returning(), 7), bits(b));
        const auto written = canonical_progressive_mesh(returning(), bits(0));
        REQUIRE((soup(cut(*written, written->splits.size())) ==
                 soup(cut(returning(), returning().splits.size()))));
    }
}

TEST_CASE("A parent that leaves its place to the child trades names with it") {
    // The child is born where the parent was, the parent moves on: nothing moves in the file.
    ProgressiveMesh m;
    m.base_vertices = 3;
    m.base_triangles = 1;
    m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}};
    m.parents = {kNoVertex, kNoVertex, kNoVertex, 1};
    m.triangles = {{0, 1, 2}, {0, 3, 1}};
    m.corner_changes = {};
    m.moves = {{1, {2, 0, 0}, 1}};
    m.splits = {{4, 2, 0, 1, 0.5f}};
    require_same_file(m, bits(0));
    const auto written = canonical_progressive_mesh(m, bits(0));
    REQUIRE(written->moves.empty());
    REQUIRE(written->positions[3] == Float3{2, 0, 0});
    REQUIRE((soup(cut(*written, 1)) == soup(cut(m, 1))));
    REQUIRE((soup(cut(*written, 0)) == soup(cut(m, 0))));
}

TEST_CASE("Places and weights that are odd come back") {
    Mesh mesh = test::make_grid(6);
    mesh.weights = test::some_weights(mesh.positions.size());
    mesh.weights[3] = std::numeric_limits<float>::infinity();
    mesh.positions[5].z = -0.0f;
    mesh.positions[6].z = std::numeric_limits<float>::denorm_min();
    mesh.positions[7].x = 3e38f;
    mesh.positions[8].x = -3e38f;
    ProgressiveMesh record = test::naive_record(mesh, 51, 20);
    require_same_file(record, bits(0));
    require_same_file(record, bits(14));
    const auto written = canonical_progressive_mesh(record, bits(0));
    REQUIRE((soup(cut(*written, written->splits.size())) == soup(cut(record, record.splits.size()))));
    REQUIRE(std::count(written->weights.begin(), written->weights.end(),
                       std::numeric_limits<float>::infinity()) > 0);
}

TEST_CASE("Errors of the written splits fall, and are never below the record's") {
    for (const auto& [name, mesh] : test::mesh_family()) {
        CAPTURE(name);
        const ProgressiveMesh record = test::naive_record(mesh, 61);
        const auto written = canonical_progressive_mesh(record);
        REQUIRE(written.ok());
        REQUIRE(written->splits.size() == record.splits.size());
        bool right = true;
        for (std::size_t i = 0; i < record.splits.size(); ++i)
            right &= written->splits[i].error >= record.splits[i].error &&
                     (i == 0 || written->splits[i].error <= written->splits[i - 1].error);
        REQUIRE(right);
    }
}
