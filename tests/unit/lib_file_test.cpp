// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// .pmesh files: round trips, and law 1 (every declared prefix is a mesh; cut anywhere else: an error with its
// offset).
#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <limits>

#include "family.hpp"
#include "naive_record.hpp"
#include "pmesh_bytes.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/read.hpp"
#include "vsplit/write.hpp"

using namespace vsplit;
using test::Bytes;

namespace {

Bytes written(const ProgressiveMesh& mesh, const WriteOptions& options = {}) {
    auto bytes = write_progressive_mesh(mesh, options);
    REQUIRE(bytes.ok());
    return *std::move(bytes);
}

/// A few hundred bytes with a base, weights and two blocks at least.
ProgressiveMesh small_record(bool weighted) {
    Mesh mesh = test::make_sphere(8, 6);
    if (weighted) mesh.weights = test::some_weights(mesh.positions.size());
    return test::naive_record(mesh, 4, 30);
}

/// An error within the bytes that were given.
void require_error(const Bytes& bytes, const char* what, std::size_t at) {
    const auto read = read_progressive_mesh(bytes);
    const bool good = !read.ok() && !read.error().message.empty() && read.error().offset <= bytes.size();
    if (!good) {
        CAPTURE(what, at, read.ok());
        if (!read.ok()) UNSCOPED_INFO(read.error().describe());
        REQUIRE(good);
    }
}

}  // namespace

TEST_CASE("What is written is read back as the writer promised, every byte") {
    const float inf = std::numeric_limits<float>::infinity();
    for (auto [name, mesh] : test::mesh_family())
        for (const int weights : {0, 1, 2})
            for (const std::uint32_t bits : {0u, 6u, 14u, 20u}) {
                CAPTURE(name, weights, bits);
                if (weights > 0) mesh.weights = test::some_weights(mesh.positions.size());
                if (weights > 1)
                    for (std::size_t v = 0; v < mesh.weights.size(); ++v)
                        mesh.weights[v] = v % 3 == 0 ? inf : v % 3 == 1 ? 0 : mesh.weights[v];
                const ProgressiveMesh record = test::naive_record(mesh, 5);
                WriteOptions options;
                options.position_bits = bits;
                const Bytes bytes = written(record, options);
                const auto back = read_progressive_mesh(bytes);
                REQUIRE(back.ok());
                const auto promised = canonical_progressive_mesh(record, options);
                REQUIRE(promised.ok());
                REQUIRE(test::same_bytes(*back, *promised));
                // Law 3, as far as the writer goes.
                REQUIRE(written(record, options) == bytes);
            }
}

TEST_CASE("Every size of block holds the same mesh") {
    Mesh mesh = test::make_torus(40, 20);
    const ProgressiveMesh record = test::naive_record(mesh, 6);
    const auto promised = canonical_progressive_mesh(record);
    REQUIRE(promised.ok());
    std::size_t blocks = 0;
    for (const std::uint32_t size : {1024u, 5000u, 48u * 1024u, 1u << 24}) {
        WriteOptions options;
        options.block_bytes = size;
        const Bytes bytes = written(record, options);
        const auto info = read_info(bytes);
        REQUIRE(info.ok());
        if (blocks > 0) REQUIRE(info->blocks.size() <= blocks);
        blocks = info->blocks.size();
        const auto back = read_progressive_mesh(bytes);
        REQUIRE(back.ok());
        REQUIRE(test::same_bytes(*back, *promised));
    }
}

TEST_CASE("The writer refuses what is no progressive mesh, and options out of range") {
    ProgressiveMesh bad = small_record(false);
    bad.splits[3].error = -1;
    const auto code = [](const ProgressiveMesh& mesh, WriteOptions options) {
        const auto bytes = write_progressive_mesh(mesh, options);
        REQUIRE_FALSE(bytes.ok());
        return bytes.error().code;
    };
    REQUIRE(code(bad, {}) == ErrorCode::kArgument);
    const ProgressiveMesh good = small_record(false);
    const auto with = [](std::uint32_t WriteOptions::*field, std::uint32_t value) {
        WriteOptions options;
        options.*field = value;
        return options;
    };
    REQUIRE(code(good, with(&WriteOptions::block_bytes, 1023)) == ErrorCode::kArgument);
    REQUIRE(code(good, with(&WriteOptions::block_bytes, (1u << 24) + 1)) == ErrorCode::kArgument);
    REQUIRE(code(good, with(&WriteOptions::position_bits, 1)) == ErrorCode::kArgument);
    REQUIRE(code(good, with(&WriteOptions::position_bits, 21)) == ErrorCode::kArgument);
    REQUIRE(code(good, with(&WriteOptions::normal_bits, 17)) == ErrorCode::kArgument);
    REQUIRE(code(good, with(&WriteOptions::texcoord_bits, 25)) == ErrorCode::kArgument);
    REQUIRE(code(good, with(&WriteOptions::color_bits, 1)) == ErrorCode::kArgument);
}

TEST_CASE("Law 1: every declared prefix is a mesh with the counts and the error that the table announces") {
    WriteOptions options;
    options.block_bytes = 1024;
    for (auto [name, mesh] : test::mesh_family()) {
        CAPTURE(name);
        const ProgressiveMesh recorded = test::naive_record(mesh, 8);
        const Bytes bytes = written(recorded, options);
        const auto promised = canonical_progressive_mesh(recorded, options);
        REQUIRE(promised.ok());
        const ProgressiveMesh& record = *promised;
        const auto info = read_info(bytes);
        REQUIRE(info.ok());
        REQUIRE(info->file_bytes == bytes.size());
        REQUIRE(info->vertices == record.positions.size());
        REQUIRE(info->triangles == record.triangles.size());
        REQUIRE(info->splits == record.splits.size());
        REQUIRE(info->base_vertices == record.base_vertices);
        REQUIRE(info->base_triangles == record.base_triangles);
        REQUIRE(info->base_error == float(error_at(record, 0)));
        LiveMesh live(record);
        std::uint64_t end = info->data_offset;
        for (const BlockInfo& block : info->blocks) {
            REQUIRE(block.offset == end);
            end += block.bytes;
            REQUIRE(checksum32(std::span(bytes).subspan(block.offset, block.bytes)) == block.checksum);
            live.go_to(block.splits_end);
            REQUIRE(live.positions().size() == block.vertices_end);
            REQUIRE(live.triangles().size() == block.triangles_end);
            REQUIRE(float(live.error()) == block.error);
            REQUIRE(mesh_fault(live.snapshot()) == nullptr);
            // A file that ends here is that mesh: block by block, nothing later is needed.
            const auto prefix = read_prefix(std::span(bytes).first(end));
            REQUIRE(prefix.ok());
            REQUIRE(prefix->splits.size() == block.splits_end);
            const Mesh finest = cut(*prefix, prefix->splits.size());
            REQUIRE(finest.positions == live.snapshot().positions);
            REQUIRE(finest.triangles == live.snapshot().triangles);
        }
        REQUIRE(end == bytes.size());
        live.go_to(live.max_level());
        Float3 low = info->bounds_min, high = info->bounds_max;
        bool inside = true, touched = live.positions().empty();
        for (const Float3& p : live.positions()) {
            inside &= p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y &&
                      p.z <= high.z;
            touched |= p.x == low.x;
        }
        REQUIRE(inside);
        REQUIRE(touched);
    }
}

TEST_CASE("Law 1: cut at any byte, a file is an error with its offset") {
    for (const bool weighted : {false, true}) {
        const Bytes bytes = written(small_record(weighted));
        REQUIRE(bytes.size() < 8192);
        for (std::size_t size = 0; size < bytes.size(); ++size) {
            // A copy of its own, so that a read behind its end is seen by the sanitizer.
            const Bytes cut(bytes.begin(), bytes.begin() + std::ptrdiff_t(size));
            require_error(cut, "cut at", size);
        }
    }
}

TEST_CASE("Law 1: every flipped bit is an error") {
    for (const bool weighted : {false, true}) {
        Bytes bytes = written(small_record(weighted));
        for (std::size_t at = 0; at < bytes.size(); ++at)
            for (const int bit : {0, 1, 4, 7}) {
                bytes[at] ^= std::byte(1 << bit);
                require_error(bytes, "flipped in", at);
                bytes[at] ^= std::byte(1 << bit);
            }
        REQUIRE(read_progressive_mesh(bytes).ok());
    }
}

TEST_CASE("Bytes behind the end are an error, at the end") {
    Bytes bytes = written(small_record(false));
    const std::size_t size = bytes.size();
    for (const std::size_t more : {1u, 8u, 4096u}) {
        bytes.resize(size + more);
        const auto read = read_progressive_mesh(bytes);
        REQUIRE_FALSE(read.ok());
        REQUIRE(read.error().code == ErrorCode::kMalformed);
        REQUIRE(read.error().offset == size);
    }
}

TEST_CASE("The front of a file suffices for its info") {
    const Bytes bytes = written(small_record(true));
    const auto whole = read_info(bytes);
    REQUIRE(whole.ok());
    REQUIRE(whole->has_weights);
    for (std::size_t size = 0; size <= bytes.size(); ++size) {
        const Bytes front(bytes.begin(), bytes.begin() + std::ptrdiff_t(size));
        const auto info = read_info(front);
        const bool expected = size >= whole->data_offset;
        if (info.ok() != expected || (!info.ok() && info.error().offset > size)) {
            CAPTURE(size);
            REQUIRE(info.ok() == expected);
        }
        if (info.ok()) REQUIRE(info->blocks.size() == whole->blocks.size());
        // No beginning of a .pmesh is taken for another format.
        if (!info.ok() && size > 0 && size < kHeaderBytes)
            REQUIRE(info.error().code == ErrorCode::kTruncated);
    }
}

TEST_CASE("The origin of the coordinates travels in the file") {
    ProgressiveMesh record = small_record(false);
    record.origin = {500000, -4500000.125, 1e300};
    const Bytes bytes = written(record);
    const auto info = read_info(bytes);
    REQUIRE(info.ok());
    CHECK(info->origin == record.origin);
    const auto read = read_progressive_mesh(bytes);
    REQUIRE(read.ok());
    CHECK(read->origin == record.origin);
    CHECK(cut(*read, 0).origin == record.origin);
    CHECK(canonical_progressive_mesh(record)->origin == record.origin);
    Bytes broken = bytes;
    // Behind the byte that says what the details have, and the weights of some kinds.
    const auto kinds = static_cast<unsigned>(bytes[info->details_offset]) & 7;
    const std::size_t origin_at =
        info->details_offset + 1 + 42 * static_cast<std::size_t>(std::popcount(kinds));
    REQUIRE(get<double>(bytes, origin_at) == record.origin[0]);
    test::put_at(broken, origin_at, std::numeric_limits<double>::quiet_NaN());
    test::reseal(broken);
    const auto refused = read_info(broken);
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().code == ErrorCode::kMalformed);
    CHECK(refused.error().offset == origin_at);
    record.origin[1] = std::numeric_limits<double>::infinity();
    CHECK_FALSE(write_progressive_mesh(record).ok());
}

TEST_CASE("Errors say what kind they are") {
    const Bytes good = written(small_record(false));
    const auto info = read_info(good);
    REQUIRE(info.ok());
    const auto code = [](const Bytes& bytes) {
        const auto read = read_progressive_mesh(bytes);
        REQUIRE_FALSE(read.ok());
        return read.error().code;
    };
    REQUIRE(code({}) == ErrorCode::kMalformed);
    Bytes bytes = good;
    bytes[1] = std::byte{'P'};
    REQUIRE(code(bytes) == ErrorCode::kMalformed);
    bytes = good;
    test::put_at(bytes, 8, std::uint32_t{7});
    REQUIRE(code(bytes) == ErrorCode::kUnsupported);
    bytes = good;
    test::put_at(bytes, 12, std::uint32_t{0x80});
    test::reseal(bytes);
    REQUIRE(code(bytes) == ErrorCode::kUnsupported);
    bytes = good;
    bytes[info->base_offset] ^= std::byte{1};
    REQUIRE(code(bytes) == ErrorCode::kChecksum);
    bytes = good;
    bytes.back() ^= std::byte{1};
    REQUIRE(code(bytes) == ErrorCode::kChecksum);
    bytes = good;
    bytes.pop_back();
    REQUIRE(code(bytes) == ErrorCode::kTruncated);
    const auto limited = read_progressive_mesh(good, Limits{100});
    REQUIRE_FALSE(limited.ok());
    REQUIRE(limited.error().code == ErrorCode::kLimit);
}
