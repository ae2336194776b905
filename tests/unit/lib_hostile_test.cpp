// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Files whose checksums are right and whose contents lie: an error, and never more memory than Limits allow.
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>
#include <random>

#include "../../lib/bytes/range_coder.hpp"
#include "family.hpp"
#include "naive_record.hpp"
#include "pmesh_bytes.hpp"
#include "vsplit/read.hpp"
#include "vsplit/write.hpp"

// All memory of this executable is counted. Not inlined, or the compiler takes malloc() and delete for a
// mismatch.
namespace {
std::atomic<std::size_t> live_bytes{0}, peak_bytes{0};
}
[[gnu::noinline]] void* operator new(std::size_t size) {
    void* p = std::malloc(size ? size : 1);
    if (!p) throw std::bad_alloc();
    const std::size_t live = live_bytes += malloc_usable_size(p);
    if (live > peak_bytes) peak_bytes = live;
    return p;
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
    if (p) live_bytes -= malloc_usable_size(p);
    std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
    operator delete(p);
}
[[gnu::noinline]] void* operator new[](std::size_t size) {
    return operator new(size);
}
[[gnu::noinline]] void operator delete[](void* p) noexcept {
    operator delete(p);
}
void operator delete[](void* p, std::size_t) noexcept {
    operator delete(p);
}

// The sanitizer's own nothrow form would not count, and be freed by another hand.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    void* p = std::malloc(size ? size : 1);
    if (p) live_bytes += malloc_usable_size(p);
    return p;
}
void* operator new[](std::size_t size, const std::nothrow_t& tag) noexcept {
    return operator new(size, tag);
}
void operator delete(void* p, const std::nothrow_t&) noexcept {
    operator delete(p);
}
void operator delete[](void* p, const std::nothrow_t&) noexcept {
    operator delete(p);
}

using namespace vsplit;
using namespace vsplit::test;

namespace {

constexpr std::size_t kMiB = std::size_t{1} << 20;
/// Above what Limits allow: messages, the table, Draco's small change.
constexpr std::size_t kSlack = kMiB;

struct Hostile {
    bool ok;
    Error error;
    std::size_t peak;  ///< Bytes on top of what was there before.
};

Hostile read_hostile(const Bytes& bytes, std::uint64_t max_bytes = 64 * kMiB) {
    const std::size_t before = live_bytes;
    peak_bytes = before;
    Hostile result{true, {}, 0};
    {
        const auto read = read_progressive_mesh(bytes, Limits{max_bytes});
        if (!read.ok())
            result = {false, read.error(), 0};
        else if (progressive_mesh_fault(*read))
            FAIL("an unsound mesh was read: " << progressive_mesh_fault(*read));
    }
    result.peak = peak_bytes - before;
    return result;
}

/// An error whose offset is in the file, and no memory to speak of.
void require_refused(const Bytes& bytes, const std::string& what, std::size_t peak = kSlack) {
    const Hostile h = read_hostile(bytes);
    if (h.ok || h.error.offset > bytes.size() || h.peak > peak) {
        CAPTURE(what, h.ok, h.error.describe(), h.peak);
        CHECK_FALSE(h.ok);
        if (!h.ok) CHECK(h.error.offset <= bytes.size());
        CHECK(h.peak <= peak);
    }
}

/// One block, weights.
Bytes good_file(FileInfo& info, BaseCoding base_coding = BaseCoding::kLeast) {
    Mesh mesh = make_sphere(8, 5);  // small, and never at half of its triangles: a block would end there
    mesh.weights = some_weights(mesh.positions.size());
    WriteOptions options;
    options.base_coding = base_coding;
    auto bytes = write_progressive_mesh(naive_record(mesh, 3, 14), options);
    REQUIRE(bytes.ok());
    auto read = read_info(*bytes);
    REQUIRE(read.ok());
    REQUIRE(read->blocks.size() == 1);
    info = *read;
    return *std::move(bytes);
}

Bytes stored(const Bytes& file, const BlockInfo& block) {
    return {file.begin() + std::ptrdiff_t(block.offset),
            file.begin() + std::ptrdiff_t(block.offset + block.bytes)};
}

}  // namespace

TEST_CASE("A lying header is refused before memory is taken") {
    FileInfo info;
    const Bytes good = good_file(info, BaseCoding::kDraco);
    REQUIRE(read_hostile(good).ok);
    const std::size_t fields[] = {kBaseVerticesAt, kBaseTrianglesAt, kBaseBytesAt,
                                  kDracoBytesAt,   kDetailsBytesAt,  kTableBytesAt};
    for (const std::size_t field : fields) {
        const auto now = get<std::uint32_t>(good, field);
        for (const std::uint32_t value :
             {0u, now - 1, now + 1, 2 * now, 0x00FFFFFFu, 0x10000000u, 0x3FFFFFFEu, 0x3FFFFFFFu, 0x7FFFFFFFu,
              0x80000000u, 0xFFFFFFFEu, 0xFFFFFFFFu}) {
            Bytes bytes = good;
            put_at(bytes, field, value);
            reseal(bytes);
            require_refused(bytes,
                            "header field at " + std::to_string(field) + " = " + std::to_string(value));
        }
    }
    for (const std::uint32_t value : {0u, 1u, 21u, 0xFFFFFFFFu}) {
        Bytes bytes = good;
        put_at(bytes, kPositionBitsAt, value);
        reseal(bytes);
        require_refused(bytes, "position bits = " + std::to_string(value));
    }
    for (std::size_t i = 0; i < 4; ++i)
        for (const double value :
             {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
            Bytes bytes = good;
            put_at(bytes, kLatticeAt + 8 * i, value);
            reseal(bytes);
            require_refused(bytes, "lattice " + std::to_string(i) + " = " + std::to_string(value));
        }
    const float inf = std::numeric_limits<float>::infinity();
    for (const float value : {-1.0f, std::numeric_limits<float>::quiet_NaN(), inf, -inf, info.base_error * 2,
                              info.base_error / 2}) {
        Bytes bytes = good;
        put_at(bytes, kBaseErrorAt, value);
        reseal(bytes);
        require_refused(bytes, "base error = " + std::to_string(value));
    }
    for (std::size_t i = 0; i < 6; ++i)
        for (const float value : {std::numeric_limits<float>::quiet_NaN(), inf, 0.125f}) {
            Bytes bytes = good;
            put_at(bytes, kBoundsAt + 4 * i, value);
            reseal(bytes);
            require_refused(bytes, "bound " + std::to_string(i) + " = " + std::to_string(value));
        }
}

TEST_CASE("A lying table is refused before memory is taken") {
    FileInfo info;
    const Bytes good = good_file(info);
    const BlockInfo now = info.blocks[0];
    const auto lie = [&](const char* what, auto field) {
        const std::uint32_t true_value = now.*field;
        for (const std::uint32_t value : {0u, true_value - 1, true_value + 1, 2 * true_value + 1, 0x00FFFFFFu,
                                          0x10000000u, 0x7FFFFFFFu, 0xFFFFFFFFu}) {
            if (value == true_value) continue;
            BlockInfo block = now;
            block.*field = value;
            require_refused(with_table(good, info, std::span(&block, 1)),
                            std::string(what) + " = " + std::to_string(value));
        }
    };
    lie("bytes", &BlockInfo::bytes);
    lie("checksum", &BlockInfo::checksum);
    lie("splits", &BlockInfo::splits_end);
    lie("vertices", &BlockInfo::vertices_end);
    lie("triangles", &BlockInfo::triangles_end);
    lie("corners", &BlockInfo::corners_end);
    lie("moves", &BlockInfo::moves_end);
    for (const float error :
         {info.base_error, info.base_error * 2, -1.0f, -0.0f, 1e-30f, std::numeric_limits<float>::quiet_NaN(),
          std::numeric_limits<float>::infinity()}) {
        BlockInfo block = now;
        block.error = error;
        require_refused(with_table(good, info, std::span(&block, 1)), "error = " + std::to_string(error));
    }
    // Counts of blocks that are no numbers: too long, with a byte too many, without an end; and every byte of
    // the table.
    const auto with_bytes = [&](const Bytes& table) {
        Bytes bytes(good.begin(), good.begin() + std::ptrdiff_t(info.table_offset));
        bytes.insert(bytes.end(), table.begin(), table.end());
        bytes.insert(bytes.end(), good.begin() + std::ptrdiff_t(info.data_offset), good.end());
        put_at(bytes, kTableBytesAt, std::uint32_t(table.size()));
        reseal(bytes);
        return bytes;
    };
    const Bytes table = encode_table(info, info.blocks);
    REQUIRE(read_hostile(with_bytes(table)).ok);
    for (const Bytes& number : {Bytes(11, std::byte{0xFF}), Bytes{std::byte{0x80}, std::byte{0}},
                                Bytes(table.size(), std::byte{0x80}), Bytes{}}) {
        Bytes forged = number;
        forged.insert(forged.end(), table.begin() + (number.empty() ? 1 : 0), table.end());
        require_refused(with_bytes(forged), "a number of " + std::to_string(number.size()) + " bytes");
    }
    for (std::size_t size = 0; size < table.size(); ++size)
        require_refused(with_bytes(Bytes(table.begin(), table.begin() + std::ptrdiff_t(size))),
                        "a table of " + std::to_string(size) + " bytes");
    for (std::size_t at = 0; at < table.size(); ++at)
        for (int bit = 0; bit < 8; ++bit) {
            Bytes forged = table;
            forged[at] ^= std::byte(1 << bit);
            // The last bits of a stream may tell nothing.
            const Bytes bytes = with_bytes(forged);
            if (const auto read = read_info(bytes); read.ok() && encode_table(*read, read->blocks) == table)
                continue;
            require_refused(bytes, "bit " + std::to_string(bit) + " of table byte " + std::to_string(at));
        }
}

TEST_CASE("A block that announces a flood is refused") {
    FileInfo info;
    const Bytes good = good_file(info);
    // 64 MiB of zeros could hold what is announced here, but not within the limit of memory.
    const auto announce = [&](std::size_t zeros, std::uint32_t parts) {
        Bytes bytes(good.begin(), good.begin() + std::ptrdiff_t(info.data_offset));
        bytes.resize(bytes.size() + zeros);
        BlockInfo block = info.blocks[0];
        block.bytes = std::uint32_t(zeros);
        block.checksum = checksum32(std::span(bytes).last(zeros));
        block.splits_end = block.corners_end = block.moves_end = parts;
        block.vertices_end = info.base_vertices + parts;
        block.triangles_end = info.base_triangles + parts;
        return with_table(bytes, info, std::span(&block, 1));
    };
    const Hostile over = read_hostile(announce(kMiB, 20'000'000));
    REQUIRE_FALSE(over.ok);
    REQUIRE(over.error.code == ErrorCode::kLimit);
    REQUIRE(over.peak < 2 * kSlack);
    // More than any bytes can hold.
    require_refused(announce(100, 100'000), "parts beyond the bytes");
    // As many as the bytes may hold and the limit allows, and nothing behind it: memory as announced, no
    // more.
    const Hostile zeros = read_hostile(announce(5000, 200'000));
    REQUIRE_FALSE(zeros.ok);
    REQUIRE(zeros.peak < 64 * kMiB);
}

TEST_CASE("Streams that lie are refused or make a sound mesh") {
    FileInfo info;
    const Bytes good = good_file(info);
    const Bytes raw = stored(good, info.blocks[0]);
    REQUIRE(read_hostile(with_block(good, info, raw)).ok);
    std::mt19937 random(11);
    std::size_t refused = 0, tried = 0;
    const auto attempt = [&](const Bytes& forged, std::size_t at) {
        const Bytes bytes = with_block(good, info, forged);
        const Hostile h = read_hostile(bytes);
        ++tried;
        refused += !h.ok;
        if (!h.ok && h.error.offset > bytes.size()) FAIL("offset outside the file, byte " << at);
        if (h.peak > kSlack) FAIL("took " << h.peak << " bytes, byte " << at);
    };
    for (std::size_t at = 0; at < raw.size(); ++at)
        for (const int value : {0x00, 0x7F, 0x80, 0xFF, int(random() & 0xFF)}) {
            if (raw[at] == std::byte(value)) continue;
            Bytes forged = raw;
            forged[at] = std::byte(value);
            attempt(forged, at);
        }
    for (std::size_t i = 0; i < 2000; ++i) {
        Bytes forged(raw.size());
        for (std::byte& b : forged) b = std::byte(random());
        attempt(forged, i);
    }
    REQUIRE(refused * 4 > tried);
    // The last bytes of a stream need not be there, nor be what they are: then it is another stream.
    for (std::size_t size = 1; size + kStreamTail < raw.size(); ++size) {
        const Bytes cut(raw.begin(), raw.begin() + std::ptrdiff_t(size));
        require_refused(with_block(good, info, cut), "stream cut at " + std::to_string(size));
    }
    Bytes longer = raw;
    longer.resize(raw.size() + kStreamTail);
    REQUIRE(read_hostile(with_block(good, info, longer)).ok);
    longer.push_back(std::byte{1});
    require_refused(with_block(good, info, longer), "a byte behind the stream");
}

TEST_CASE("Garbage in the base mesh's own stream is harmless") {
    FileInfo info;
    const Bytes good = good_file(info);
    REQUIRE(info.base_draco_bytes == 0);
    std::mt19937 random(13);
    std::size_t refused = 0, tried = 0;
    const auto attempt = [&](const Bytes& forged) {
        const Hostile h = read_hostile(with_true_checksums(forged, info));
        ++tried;
        refused += !h.ok;
        if (!h.ok && h.error.offset > forged.size()) FAIL("offset outside the file: " << h.error.describe());
        if (h.peak > kSlack) FAIL("took " << h.peak << " bytes");
    };
    for (std::size_t at = 0; at < info.base_bytes; ++at)
        for (int bit = 0; bit < 8; ++bit) {
            Bytes forged = good;
            forged[info.base_offset + at] ^= std::byte(1 << bit);
            attempt(forged);
        }
    for (int i = 0; i < 2000; ++i) {
        Bytes forged = good;
        for (std::size_t at = 0; at < info.base_bytes; ++at)
            forged[info.base_offset + at] = std::byte(random());
        attempt(forged);
    }
    REQUIRE(refused * 2 > tried);
}

TEST_CASE("Garbage for a base mesh is refused without a flood") {
    FileInfo info;
    const Bytes good = good_file(info, BaseCoding::kDraco);
    const Bytes base(good.begin() + std::ptrdiff_t(info.base_offset),
                     good.begin() + std::ptrdiff_t(info.base_offset + info.base_draco_bytes));
    REQUIRE(read_hostile(with_draco(good, info, base)).ok);
    const auto try_base = [&](const Bytes& forged, bool must_fail, const std::string& what) {
        const Bytes bytes = with_draco(good, info, forged);
        const Hostile h = read_hostile(bytes);
        const bool good_answer =
            (!must_fail || !h.ok) && (h.ok || h.error.offset <= bytes.size()) && h.peak <= 64 * kMiB;
        if (!good_answer) {
            CAPTURE(what, h.ok, h.error.describe(), h.peak);
            CHECK(good_answer);
        }
    };
    std::mt19937 random(12);
    REQUIRE(info.base_draco_bytes > 0);
    try_base({}, true, "nothing");
    for (const std::size_t size : {1u, 10u, 11u, 100u, 5000u}) {
        Bytes garbage(size);
        for (std::byte& b : garbage) b = std::byte(random());
        try_base(garbage, true, "garbage of " + std::to_string(size));
        // Behind Draco's own head.
        std::copy_n(base.begin(), std::min<std::size_t>(size, 11), garbage.begin());
        try_base(garbage, true, "garbage behind a head, " + std::to_string(size));
    }
    for (std::size_t size = 0; size < base.size(); ++size)
        try_base(Bytes(base.begin(), base.begin() + std::ptrdiff_t(size)), true,
                 "cut at " + std::to_string(size));
    for (std::size_t at = 0; at < base.size(); ++at)
        for (const int value : {0x00, 0x01, 0x7F, 0x80, 0xFF, int(random() & 0xFF)}) {
            Bytes forged = base;
            forged[at] = std::byte(value);
            try_base(forged, false, "byte " + std::to_string(at) + " = " + std::to_string(value));
        }
    // Four bytes at once: counts of Draco's that go to the billions.
    for (std::size_t at = 5; at + 5 <= base.size(); ++at) {
        Bytes forged = base;
        for (std::size_t i = 0; i < 4; ++i) forged[at + i] = std::byte{0xFF};
        forged[at + 4] = std::byte{0x0F};
        try_base(forged, false, "run of ones at " + std::to_string(at));
    }
}

TEST_CASE("Random bytes behind the magic are refused") {
    std::mt19937 random(13);
    for (int i = 0; i < 2000; ++i) {
        Bytes bytes(kHeaderBytes + random() % 400);
        for (std::byte& b : bytes) b = std::byte(random());
        std::copy(reinterpret_cast<const std::byte*>(kMagic.data()),
                  reinterpret_cast<const std::byte*>(kMagic.data()) + kMagic.size(), bytes.begin());
        put_at(bytes, kVersionAt, kVersion);
        put_at(bytes, kFlagsAt, std::uint32_t(random() & 1));
        for (const std::size_t part : {kDetailsBytesAt, kBaseBytesAt, kTableBytesAt})
            if (random() % 4 > 0) put_at(bytes, part, std::uint32_t(random() % 100));
        reseal(bytes);
        require_refused(bytes, "random " + std::to_string(i));
    }
}
