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
Bytes good_file(FileInfo& info) {
    Mesh mesh = make_sphere(8, 5);
    mesh.weights = some_weights(mesh.positions.size());
    auto bytes = write_progressive_mesh(naive_record(mesh, 3, 20), {});
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
    const Bytes good = good_file(info);
    REQUIRE(read_hostile(good).ok);
    const std::size_t fields[] = {kBlockCountAt,    kVerticesAt,   kTrianglesAt,   kBaseVerticesAt,
                                  kBaseTrianglesAt, kSplitsAt,     kCornersAt,     kMovesAt,
                                  kBaseBytesAt,     kDracoBytesAt, kDetailsBytesAt};
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
    for (const std::size_t field : {kFileBytesAt, kBaseOffsetAt, kTableOffsetAt})
        for (const std::uint64_t value :
             {std::uint64_t{0}, std::uint64_t{1}, get<std::uint64_t>(good, field) + 1,
              get<std::uint64_t>(good, field) - 1, std::uint64_t{1} << 40, ~std::uint64_t{0},
              ~std::uint64_t{0} - 100}) {
            Bytes bytes = good;
            put_at(bytes, field, value);
            reseal(bytes);
            require_refused(bytes,
                            "header field at " + std::to_string(field) + " = " + std::to_string(value));
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
    for (std::size_t field = 0; field < kTableEntryBytes; field += 4) {
        if (field == kEntryChecksumAt || field == kEntryChecksumAt + 4) continue;  // below
        const auto now = get<std::uint32_t>(good, entry_at(info, 0) + field);
        for (const std::uint32_t value :
             {0u, now - 1, now + 1, 2 * now + 1, 0x00FFFFFFu, 0x10000000u, 0x7FFFFFFFu, 0xFFFFFFFFu}) {
            if (value == now) continue;
            Bytes bytes = good;
            put_at(bytes, entry_at(info, 0) + field, value);
            reseal(bytes);
            require_refused(bytes, "table field at " + std::to_string(field) + " = " + std::to_string(value));
            // And with the header lying along.
            const std::size_t header[] = {kSplitsAt, kVerticesAt, kTrianglesAt, kCornersAt, kMovesAt};
            if (field >= kEntrySplitsAt && field < kEntrySplitsAt + 20) {
                put_at(bytes, header[(field - kEntrySplitsAt) / 4], value);
                reseal(bytes);
                require_refused(bytes, "table and header, field at " + std::to_string(field) + " = " +
                                           std::to_string(value));
            }
        }
    }
    Bytes bytes = good;
    put_at(bytes, entry_at(info, 0) + kEntryChecksumAt, std::uint64_t{0});
    reseal(bytes);
    require_refused(bytes, "checksum");
}

TEST_CASE("A block that announces a flood is refused") {
    FileInfo info;
    const Bytes good = good_file(info);
    // 64 MiB of zeros could hold what is announced here, but not within the limit of memory.
    const auto announce = [&](Bytes bytes, std::uint32_t parts) {
        const std::size_t header[] = {kSplitsAt, kVerticesAt, kTrianglesAt, kCornersAt, kMovesAt};
        for (std::size_t i = 0; i < 5; ++i) {
            put_at(bytes, header[i], parts);
            put_at(bytes, entry_at(info, 0) + kEntrySplitsAt + 4 * i, parts);
        }
        reseal(bytes);
        return bytes;
    };
    const Hostile over = read_hostile(announce(with_block(good, info, Bytes(kMiB)), 20'000'000));
    REQUIRE_FALSE(over.ok);
    REQUIRE(over.error.code == ErrorCode::kLimit);
    REQUIRE(over.peak < 2 * kSlack);
    // More than any bytes can hold.
    require_refused(announce(with_block(good, info, Bytes(100)), 100'000), "parts beyond the bytes");
    // As many as the bytes may hold and the limit allows, and nothing behind it: memory as announced, no
    // more.
    const Hostile zeros = read_hostile(announce(with_block(good, info, Bytes(5000)), 200'000));
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
    for (std::size_t size = 1; size < raw.size(); ++size) {
        const Bytes cut(raw.begin(), raw.begin() + std::ptrdiff_t(size));
        require_refused(with_block(good, info, cut), "stream cut at " + std::to_string(size));
    }
    Bytes longer = raw;
    longer.push_back(std::byte{1});
    require_refused(with_block(good, info, longer), "a byte behind the stream");
}

TEST_CASE("Garbage for a base mesh is refused without a flood") {
    FileInfo info;
    const Bytes good = good_file(info);
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
        put_at(bytes, 8, kVersion);
        put_at(bytes, 12, std::uint32_t(random() & 1));
        put_at(bytes, kBlockCountAt, std::uint32_t(random() % 4));
        if (i % 2 == 0) put_at(bytes, kDetailsBytesAt, std::uint32_t(random() % 200));
        reseal(bytes);
        require_refused(bytes, "random " + std::to_string(i));
    }
}
