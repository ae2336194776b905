// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Placement at endpoints collapses in batches: long rows of splits that change different triangles.
#include <bit>
#include <catch2/catch.hpp>

#include "family.hpp"
#include "vsplit/bake/collapse.hpp"

using namespace vsplit;
using namespace vsplit::test;

namespace {

/// How many rows, each as long as it can be, in which no triangle changes twice and nothing that the row bore
/// splits.
std::size_t rows_of(const ProgressiveMesh& mesh) {
    std::vector<std::size_t> changed(mesh.triangles.size(), 0);
    std::size_t rows = 0;
    std::uint32_t bore = 0;
    Split from{mesh.base_vertices, mesh.base_triangles, 0, 0, 0};
    for (const Split& to : mesh.splits) {
        bool fits = rows > 0;
        for (std::uint32_t v = from.vertices_end; v < to.vertices_end; ++v)
            fits = fits && (mesh.parents[v] == kNoVertex || mesh.parents[v] < bore);
        for (std::uint32_t c = from.corners_end; c < to.corners_end; ++c)
            fits = fits && changed[mesh.corner_changes[c].corner / 3] != rows;
        if (!fits) {
            ++rows;
            bore = from.vertices_end;
        }
        for (std::uint32_t c = from.corners_end; c < to.corners_end; ++c)
            changed[mesh.corner_changes[c].corner / 3] = rows;
        for (std::uint32_t t = from.triangles_end; t < to.triangles_end; ++t) changed[t] = rows;
        from = to;
    }
    return rows;
}

}  // namespace

TEST_CASE("Collapse: with placement at endpoints, splits come in batches and no vertex moves") {
    std::size_t large = 0;
    for (const auto& [name, mesh] : mesh_family()) {
        for (const bool put_off : {false, true}) {
            CAPTURE(name, put_off);
            bake::CollapseOptions options;
            options.placement = bake::Placement::kEndpoint;
            options.put_off_outliers = put_off;
            const auto result = bake::collapse(mesh, options);
            REQUIRE(result.ok());
            const ProgressiveMesh& record = result->mesh;
            if (mesh.weights.empty() && mesh.attributes.empty()) CHECK(record.moves.empty());
            if (record.splits.size() < 1000) continue;
            ++large;
            const std::size_t doublings =
                std::bit_width(record.positions.size() / std::max(record.base_vertices, 1u));
            CHECK(rows_of(record) <= 8 * (doublings + 1));
        }
    }
    CHECK(large > 0);
}
