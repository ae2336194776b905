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

/// log2(x) in 1/256 as if it were linear between powers of two, at most 0.09 too small; x > 0.
constexpr std::int32_t log2_linear(std::uint64_t x) {
    const int zeros = std::countl_zero(x);
    return 256 * (63 - zeros) + static_cast<std::int32_t>((x << zeros) >> 55 & 255);
}

/// The same of a whole number below 2^53.
inline std::int32_t log2_linear(double x) {
    return static_cast<std::int32_t>(std::bit_cast<std::uint64_t>(x) >> 44) - (1023 << 8);
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
