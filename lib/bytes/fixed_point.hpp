// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Whole-number arithmetic of the decoder: logarithms, powers, means. No float may decide a decoded bit, and
// every implementation must come to the same numbers.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace vsplit {

/// log2(1 + i / 1024) in 1/256, rounded down, by squaring.
inline constexpr std::array<std::uint8_t, 1024> kLogFractions = [] {
    std::array<std::uint8_t, 1024> table{};
    for (std::uint64_t i = 0; i < 1024; ++i) {
        std::uint64_t y = (1024 + i) << 20;  // in 1/2^30, 1 <= y < 2
        unsigned bits = 0;
        for (int k = 0; k < 8; ++k) {
            y = (y * y) >> 30;
            bits <<= 1;
            if (y >= std::uint64_t{2} << 30) {
                bits |= 1;
                y >>= 1;
            }
        }
        table[i] = static_cast<std::uint8_t>(bits);
    }
    return table;
}();

/// log2(x) in 1/256, rounded down after the mantissa is cut to ten bits; 0 for 0.
constexpr std::int32_t log2_fixed(std::uint64_t x) {
    if (x == 0) return 0;
    const int top = 63 - std::countl_zero(x);
    const std::uint64_t mantissa = (top >= 10 ? x >> (top - 10) : x << (10 - top)) & 1023;
    return 256 * top + kLogFractions[mantissa];
}

/// 2^(i / 256) in 1/32768, 0 <= i < 256: the product of the roots of two that i's bits name.
inline constexpr std::array<std::uint16_t, 256> kPowers = [] {
    constexpr std::uint64_t roots[8] = {1076653033, 1079572136, 1085434106, 1097253708,
                                        1121280436, 1170923762, 1276901417, 1518500250};
    std::array<std::uint16_t, 256> table{};
    for (unsigned i = 0; i < 256; ++i) {
        std::uint64_t product = std::uint64_t{1} << 30;
        for (unsigned k = 0; k < 8; ++k)
            if (i >> k & 1) product = (product * roots[k]) >> 30;
        table[i] = static_cast<std::uint16_t>(product >> 15);
    }
    return table;
}();

/// floor(65536 / n), for means of up to 256 values.
inline constexpr std::array<std::int32_t, 257> kReciprocals = [] {
    std::array<std::int32_t, 257> table{};
    for (std::int32_t n = 1; n <= 256; ++n) table[static_cast<std::size_t>(n)] = 65536 / n;
    return table;
}();

/// The mean of n numbers of this sum in 1/16, 1 <= n <= 256: rounded down, and as exact as the reciprocal.
constexpr std::int64_t mean16(std::int64_t sum, std::uint32_t n) {
    return (sum * kReciprocals[n]) >> 12;
}

/// The angle whose cosine is (i - 32) / 32, in 1/1024 of half a turn.
inline constexpr std::array<std::int16_t, 65> kArcCosines = {
    1024, 942, 908, 882, 859, 839, 821, 804, 788, 773, 759, 745, 732, 719, 707, 695, 683,
    671,  660, 648, 637, 626, 616, 605, 594, 584, 573, 563, 553, 543, 532, 522, 512, 502,
    492,  481, 471, 461, 451, 440, 430, 419, 408, 398, 387, 376, 364, 353, 341, 329, 317,
    305,  292, 279, 265, 251, 236, 220, 203, 185, 165, 142, 116, 82,  0};

/// The angle between two vectors of this product, whose squared lengths have these logarithms, in 1/1024 of
/// half a turn.
constexpr std::int32_t angle_between(std::int64_t product, std::int32_t log_a, std::int32_t log_b) {
    const std::uint64_t size = static_cast<std::uint64_t>(product < 0 ? -product : product);
    // |cosine| = 2^log
    const std::int32_t log = size == 0 ? -4096 : log2_fixed(size) - (log_a + log_b) / 2;
    const std::int32_t below = log < 0 ? -log : 0, whole = (below + 255) >> 8;
    const std::int32_t cosine =
        whole > 15 ? 0 : (kPowers[static_cast<std::size_t>(256 * whole - below)] >> whole) >> 5;
    const std::int32_t at =
        product < 0 ? 32 * 32 - cosine : 32 * 32 + cosine;  // in 1/32 of the table's steps
    const std::int32_t i = at >> 5, rest = at & 31;
    if (i >= 64) return 0;
    return kArcCosines[static_cast<std::size_t>(i)] +
           ((kArcCosines[static_cast<std::size_t>(i) + 1] - kArcCosines[static_cast<std::size_t>(i)]) *
                rest >>
            5);
}

/// 0 for 0, then two classes an octave: 1 for 1, 3 for 2, 4 for 3, 5 for 4 and 5, 6 for 6 and 7, ...
constexpr std::uint32_t half_octave(std::uint64_t x) {
    if (x < 2) return static_cast<std::uint32_t>(x);
    const int top = 63 - std::countl_zero(x);
    return static_cast<std::uint32_t>(2 * top + 1) + static_cast<std::uint32_t>((x >> (top - 1)) & 1);
}

/// floor((2 a + b) / (2 b)): the nearest whole number to a / b, halves up; b > 0.
constexpr std::int64_t rounded_quotient(std::int64_t a, std::int64_t b) {
    const std::int64_t n = 2 * a + b, d = 2 * b;
    const std::int64_t q = n / d;
    return q - (n % d < 0);
}

}  // namespace vsplit
