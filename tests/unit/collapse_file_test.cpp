// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Real records through the file and the live mesh: laws 1 and 2 on what the collapser makes.
#include <catch2/catch.hpp>

#include "family.hpp"
#include "naive_record.hpp"
#include "pmesh_bytes.hpp"
#include "vsplit/bake/collapse.hpp"
#include "vsplit/live_mesh.hpp"

using namespace vsplit;
using namespace vsplit::test;

namespace {

/// Calls body(record) for every mesh, cost and placement, with weights and without.
template <class Body>
void for_records(const Body& body) {
    for (auto [name, mesh] : mesh_family())
        for (const bool weighted : {false, true})
            for (const bake::Cost cost : {bake::Cost::kQuadric, bake::Cost::kPaper})
                for (const bake::Placement placement :
                     {bake::Placement::kOptimal, bake::Placement::kEndpoint}) {
                    CAPTURE(name, weighted, int(cost), int(placement));
                    if (weighted)
                        mesh.weights = some_weights(mesh.positions.size());
                    else
                        mesh.weights.clear();
                    bake::CollapseOptions options;
                    options.cost = cost;
                    options.placement = placement;
                    auto result = bake::collapse(mesh, options);
                    REQUIRE(result.ok());
                    body(result->mesh);
                }
}

std::uint64_t buffers_hash(const LiveMesh& live) {
    return checksum64(std::as_bytes(live.positions())) ^ 3 * checksum64(std::as_bytes(live.triangles())) ^
           5 * checksum64(std::as_bytes(live.weights()));
}

}  // namespace

TEST_CASE("Law 2 on collapsed meshes: forward, then back restores every byte at every level") {
    for_records([](const ProgressiveMesh& record) {
        LiveMesh live(record);
        std::vector<std::uint64_t> hashes;
        for (std::size_t level = 0; level <= live.max_level(); ++level) {
            live.go_to(level);
            hashes.push_back(buffers_hash(live));
        }
        bool restored = true;
        for (std::size_t level = live.max_level() + 1; level-- > 0;) {
            live.go_to(level);
            restored &= buffers_hash(live) == hashes[level];
        }
        REQUIRE(restored);
        REQUIRE(same_bytes(live.state(), record));
    });
}

TEST_CASE("Law 1 on collapsed meshes: read back as written, every declared prefix as announced") {
    WriteOptions options;
    options.block_bytes = 1024;
    for_records([&](const ProgressiveMesh& record) {
        const auto bytes = write_progressive_mesh(record, options);
        REQUIRE(bytes.ok());
        const auto back = read_progressive_mesh(*bytes);
        REQUIRE(back.ok());
        const auto promised = canonical_progressive_mesh(record, options);
        REQUIRE(promised.ok());
        REQUIRE(same_bytes(*back, *promised));
        const auto info = read_info(*bytes);
        REQUIRE(info.ok());
        // Rounding places may add an eighth (formats/spec, Promises), and what is promised is what is read.
        REQUIRE(info->base_error == float(error_at(*promised, 0)));
        REQUIRE(double(info->base_error) >= error_at(record, 0));
        REQUIRE(double(info->base_error) <= 1.125001 * error_at(record, 0));
        LiveMesh live(*back);
        REQUIRE(live.positions().size() == info->base_vertices);
        REQUIRE(live.triangles().size() == info->base_triangles);
        for (const BlockInfo& block : info->blocks) {
            live.go_to(block.splits_end);
            REQUIRE(live.positions().size() == block.vertices_end);
            REQUIRE(live.triangles().size() == block.triangles_end);
            REQUIRE(float(live.error()) == block.error);
            REQUIRE(mesh_fault(live.snapshot()) == nullptr);
        }
        REQUIRE(live.level() == live.max_level());
    });
}
