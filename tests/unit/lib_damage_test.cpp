// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Damaged files, thousands of them: cut anywhere, bits flipped with and without their checksums made to fit.
// Each is an error within it, or a sound mesh; a flip under the old checksums is never a mesh of another
// kind.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <random>
#include <string>

#include "decorated.hpp"
#include "family.hpp"
#include "naive_record.hpp"
#include "pmesh_bytes.hpp"
#include "vsplit/read.hpp"
#include "vsplit/write.hpp"

using namespace vsplit;
using namespace vsplit::test;

namespace {

/// All that is done is done so many times more often: `VSPLIT_DAMAGE=50` makes 100,000 damaged files.
int effort() {
    const char* asked = std::getenv("VSPLIT_DAMAGE");
    return asked ? std::max(1, std::atoi(asked)) : 1;
}

const Limits kLimits{std::uint64_t{64} << 20};

Bytes sample(std::uint32_t position_bits, bool attributes) {
    WriteOptions options;
    options.position_bits = position_bits;
    options.block_bytes = 1024;
    const ProgressiveMesh record = naive_record(make_torus(14, 9), 11);
    auto bytes = write_progressive_mesh(attributes ? decorated(record, 12) : record, options);
    REQUIRE(bytes.ok());
    return *std::move(bytes);
}

/// Sound or refused, by all three ways in.
void require_safe(const Bytes& bytes) {
    const auto whole = read_progressive_mesh(bytes, kLimits);
    if (whole && progressive_mesh_fault(*whole)) FAIL("an unsound mesh was read");
    const auto prefix = read_prefix(bytes, kLimits);
    if (prefix && progressive_mesh_fault(*prefix)) FAIL("an unsound prefix was read");
    auto decoder = BlockDecoder::begin(bytes, kLimits);
    if (!decoder) return;
    if (const char* fault = progressive_mesh_fault(decoder->mesh())) FAIL("an unsound base: " << fault);
    for (const BlockInfo& block : decoder->info().blocks) {
        if (block.offset + block.bytes > bytes.size()) return;
        if (!decoder->decode(std::span(bytes).subspan(block.offset, block.bytes))) return;
        if (const char* fault = progressive_mesh_fault(decoder->mesh()))
            FAIL("unsound after a block: " << fault);
    }
}

/// Checksums of base and blocks as the bytes are now, then those of the front.
void reseal_all(Bytes& bytes, const FileInfo& info) {
    bytes = with_true_checksums(std::move(bytes), info);
}

}  // namespace

TEST_CASE("A file cut anywhere is an error, or the mesh that its whole blocks make") {
    for (const bool attributes : {false, true}) {
        const Bytes good = sample(attributes ? 0 : 12, attributes);
        const auto whole = read_progressive_mesh(good);
        REQUIRE(whole.ok());
        const auto info = read_info(good);
        REQUIRE(info.ok());
        REQUIRE(info->blocks.size() >= 2);
        std::size_t read = 0;
        for (std::size_t size = 0; size < good.size(); size += attributes ? 29 : 3) {
            const Bytes bytes(good.begin(), good.begin() + std::ptrdiff_t(size));
            REQUIRE_FALSE(read_progressive_mesh(bytes, kLimits).ok());
            const auto prefix = read_prefix(bytes, kLimits);
            REQUIRE(prefix.ok() == (size >= info->data_offset));
            if (!prefix) {
                REQUIRE(prefix.error().offset <= good.size());
                continue;
            }
            std::size_t splits = 0;
            for (const BlockInfo& block : info->blocks)
                if (block.offset + block.bytes <= size) splits = block.splits_end;
            REQUIRE(prefix->splits.size() == splits);
            REQUIRE(std::equal(prefix->positions.begin(), prefix->positions.end(), whole->positions.begin()));
            ++read;
        }
        REQUIRE(read > 0);
    }
}

TEST_CASE("Flipped bits are noticed by the checksums") {
    const Bytes good = sample(14, true);
    std::mt19937 random(1);
    for (int i = 0; i < 1000 * effort(); ++i) {
        Bytes bytes = good;
        const int flips = 1 + int(random() % 4);
        for (int k = 0; k < flips; ++k) {
            const std::size_t bit = random() % (8 * bytes.size());
            bytes[bit / 8] ^= std::byte(1u << bit % 8);
        }
        if (bytes != good && read_progressive_mesh(bytes, kLimits).ok()) FAIL("damage went unnoticed");
    }
}

TEST_CASE("Flipped bits under checksums that fit are an error or a sound mesh") {
    std::mt19937 random(2);
    for (const std::uint32_t bits : {14u, 0u}) {
        const Bytes good = sample(bits, bits == 0);
        const auto info = read_info(good);
        REQUIRE(info.ok());
        for (int i = 0; i < 500 * effort(); ++i) {
            Bytes bytes = good;
            const int flips = 1 + int(random() % 4);
            for (int k = 0; k < flips; ++k) {
                const std::size_t bit = random() % (8 * bytes.size());
                bytes[bit / 8] ^= std::byte(1u << bit % 8);
            }
            reseal_all(bytes, *info);
            require_safe(bytes);
        }
    }
}

TEST_CASE("Values that are no numbers are refused as they arrive") {
    const ProgressiveMesh record = naive_record(make_torus(14, 9), 11);
    WriteOptions options;
    options.position_bits = 0;
    options.block_bytes = 1024;
    auto written = write_progressive_mesh(record, options);
    REQUIRE(written.ok());
    REQUIRE(BlockDecoder::begin(*written, kLimits).ok());
    // From a lattice beyond the floats, some places are a step more: infinite.
    Bytes bytes = *written;
    for (std::size_t axis = 0; axis < 3; ++axis) put_at(bytes, kLatticeAt + 8 * axis, 1e39);
    reseal(bytes);
    REQUIRE_FALSE(read_progressive_mesh(bytes, kLimits).ok());
    // The base may do without, its blocks not all.
    auto decoder = BlockDecoder::begin(bytes, kLimits);
    bool refused = !decoder;
    if (decoder)
        for (const BlockInfo& block : decoder->info().blocks)
            if (!decoder->decode(std::span(bytes).subspan(block.offset, block.bytes))) {
                refused = true;
                break;
            }
    REQUIRE(refused);
}
