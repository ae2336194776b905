// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The range coder, its models, and the whole-number arithmetic that decides decoded bits.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>

#include "../../lib/bytes/ask_list.hpp"
#include "../../lib/bytes/fixed_point.hpp"
#include "../../lib/bytes/number_models.hpp"
#include "../../lib/bytes/quantise.hpp"
#include "../../lib/bytes/range_coder.hpp"

using namespace vsplit;

namespace {

/// The same calls to an encoder and to the decoder of its bytes.
template <class Coder>
std::vector<std::uint32_t> mixed_stream(Coder& coder, std::uint32_t seed, std::size_t count) {
    std::mt19937 random(seed);
    std::vector<std::uint32_t> values;
    std::array<BitModel, 3> bits;
    NumberModel numbers;
    ResidualModel<10, 2> residuals;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t r = random();
        switch (r % 5) {
            case 0:
                values.push_back(coder.bit(bits[r / 5 % 3], r % 97 == 0));
                break;
            case 1:
                values.push_back(
                    coder.raw(r / 5 % 33, r / 5 % 33 == 32 ? r : r & ((1u << (r / 5 % 33)) - 1)));
                break;
            case 2:
                values.push_back(numbers.code(coder, r >> (random() % 32)));
                break;
            case 3:
                values.push_back(std::uint32_t(residuals.code(
                    coder, r / 5 % 12, r / 60 % 2, std::int32_t(r & 0xFFFFFF) >> (random() % 24))));
                break;
            default: {
                std::array<std::uint32_t, 7> weights{};
                std::uint32_t sum = 0;
                for (auto& w : weights) sum += w = 1 + random() % 5000;
                const std::uint32_t at = coder.point(sum);
                std::uint32_t value = 0, before = 0;
                for (; Coder::kDecodes ? at >= before + weights[value] : value < r / 5 % 7; ++value)
                    before += weights[value];
                coder.take(before, weights[value], sum);
                values.push_back(value);
            }
        }
    }
    return values;
}

}  // namespace

TEST_CASE("Whatever is coded is decoded, and exactly its bytes are taken") {
    for (const std::size_t count : {0u, 1u, 2u, 10u, 1000u, 50000u})
        for (const std::uint32_t seed : {1u, 2u, 3u}) {
            RangeEncoder encoder;
            const auto written = mixed_stream(encoder, seed, count);
            const auto bytes = encoder.finish();
            RangeDecoder decoder(bytes);
            REQUIRE(mixed_stream(decoder, seed, count) == written);
            REQUIRE(decoder.taken() >= bytes.size());
            REQUIRE(decoder.taken() <= bytes.size() + kStreamTail);
            if (count == 0) REQUIRE(bytes.empty());
            REQUIRE_FALSE(decoder.overrun());
            // The encoder is new again.
            REQUIRE(mixed_stream(encoder, seed, count) == written);
            REQUIRE(encoder.finish() == bytes);
        }
}

TEST_CASE("A carry runs through bytes of ones") {
    // Many improbable bits in a row keep the range's lower end just below a power of two.
    RangeEncoder encoder;
    std::mt19937 random(9);
    std::vector<bool> bits;
    for (int i = 0; i < 20000; ++i) bits.push_back(i % 50 == 49 ? random() % 2 : false);
    BitModel one;
    for (const bool bit : bits) encoder.bit(one, bit);
    const auto bytes = encoder.finish();
    RangeDecoder decoder(bytes);
    BitModel other;
    bool right = true;
    for (const bool bit : bits) right &= decoder.bit(other) == bit;
    REQUIRE(right);
}

TEST_CASE("A decoder survives any bytes, and says when they are not enough") {
    std::mt19937 random(10);
    for (int i = 0; i < 300; ++i) {
        std::vector<std::byte> bytes(random() % 40);
        for (auto& b : bytes) b = std::byte(random());
        RangeDecoder decoder(bytes);
        mixed_stream(decoder, std::uint32_t(i), 500);
        REQUIRE(decoder.overrun());
    }
}

TEST_CASE("Whole-number logarithms, powers and means are near the real ones") {
    for (std::uint64_t x = 1; x < (std::uint64_t{1} << 58); x = x * 9 / 8 + 1)
        REQUIRE(std::abs(log2_fixed(x) / 256.0 - std::log2(double(x))) < 1.5 / 256);
    REQUIRE(log2_fixed(0) == 0);
    for (std::size_t i = 0; i < 256; ++i)
        REQUIRE(std::abs(kPowers[i] / 32768.0 - std::exp2(double(i) / 256)) < 1e-4);
    std::uint32_t before = 0;
    for (std::uint64_t x = 1; x < 100000; ++x) {
        REQUIRE(half_octave(x) >= before);
        before = half_octave(x);
    }
    for (const std::int64_t a : {-1000001, -7, -3, -1, 0, 1, 3, 7, 1000001})
        for (const std::int64_t b : {1, 2, 3, 10, 999})
            REQUIRE(rounded_quotient(a, b) == std::int64_t(std::floor(double(a) / double(b) + 0.5)));
    REQUIRE(mean16(300, 3) / 16 == 99);  // 1599 / 16: as exact as the reciprocal
    REQUIRE(mean16(256, 4) == 1024);
}

TEST_CASE("Floats as ordered numbers come back") {
    const float inf = std::numeric_limits<float>::infinity();
    const float ascending[] = {-inf, -3e38f, -1, -1e-45f, -0.0f, 0.0f, 1e-45f, 1, 3e38f, inf};
    for (std::size_t i = 0; i < std::size(ascending); ++i) {
        const float back = ordered_float(ordered_number(ascending[i]));
        REQUIRE(std::memcmp(&back, &ascending[i], sizeof(float)) == 0);
        if (i > 0) REQUIRE(ordered_number(ascending[i - 1]) < ordered_number(ascending[i]));
    }
}

TEST_CASE("A sweep asks all, then those that changed, and ends") {
    AskList asks;
    asks.begin(130);
    for (std::uint32_t v = 0; v < 130; ++v) REQUIRE(asks.next() == v);
    REQUIRE(asks.next() == AskList::kNoPlace);
    asks.begin(64);
    REQUIRE(asks.next() == 0);
    asks.add(0);
    asks.add(64);
    REQUIRE(asks.next() == 0);
    for (std::uint32_t v = 1; v < 64; ++v) REQUIRE(asks.next() == v);
    asks.add(10);
    REQUIRE(asks.next() == 64);
    REQUIRE(!asks.again());
    REQUIRE(asks.next() == 10);
    REQUIRE(asks.again());
    REQUIRE(asks.next() == AskList::kNoPlace);
}

TEST_CASE("A sweep asks a piece, and what it bears, until nothing of it is left") {
    constexpr std::uint32_t kPiece = AskList::kPiece, kRow = 2 * kPiece + 5;
    AskList asks;
    asks.begin(kRow);
    for (std::uint32_t v = 0; v < kPiece; ++v) REQUIRE(asks.next() == v);
    asks.add(7);
    asks.add(kRow);
    REQUIRE(asks.next() == kRow);
    REQUIRE(!asks.again());
    REQUIRE(asks.next() == 7);
    REQUIRE(asks.again());
    asks.add(kPiece + 3);  // waits for its own
    for (std::uint32_t v = kPiece; v < 2 * kPiece; ++v) {
        REQUIRE(asks.next() == v);
        REQUIRE(!asks.again());
    }
    asks.add(8);  // behind: what is there and what was born before come in the next lap
    asks.add(kRow);
    for (std::uint32_t v = 2 * kPiece; v < kRow; ++v) REQUIRE(asks.next() == v);
    REQUIRE(asks.next() == 8);
    REQUIRE(asks.again());
    REQUIRE(asks.next() == kRow);
    REQUIRE(asks.next() == AskList::kNoPlace);
}
