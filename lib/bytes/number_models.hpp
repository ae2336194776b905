// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Whole numbers as adaptive bits: how many binary digits, then the digits.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "fixed_point.hpp"
#include "range_coder.hpp"

namespace vsplit {

/// A number below 2^Bits, each value with a likelihood of its own.
template <unsigned Bits>
struct SymbolModel {
    std::array<BitModel, std::size_t{1} << Bits> nodes;

    template <class Coder>
    std::uint32_t code(Coder& coder, std::uint32_t value) {
        std::uint32_t node = 1;
        for (unsigned i = Bits; i-- > 0;) node = 2 * node + coder.bit(nodes[node], value >> i & 1);
        return node - (1u << Bits);
    }
};

/// Any 32-bit number; small ones cost little once they have been seen.
struct NumberModel {
    SymbolModel<6> digits;
    std::array<BitModel, 33> second;

    template <class Coder>
    std::uint32_t code(Coder& coder, std::uint32_t value) {
        const std::uint32_t count = digits.code(coder, static_cast<std::uint32_t>(std::bit_width(value)));
        if (count < 2) return count;
        if (count > 32) return 0xFFFFFFFFu;  // only a forged stream comes here
        const std::uint32_t high = 2u + coder.bit(second[count], value >> (count - 2) & 1);
        return (high << (count - 2)) | coder.raw(count - 2, value & ((1u << (count - 2)) - 1));
    }
};

/// Signed differences whose size is expected to be about `scale`: one set of digit counts a scale, the first
/// digits by how the count departs from the scale.
template <std::size_t Scales, std::size_t Kinds = 1>
struct ResidualModel {
    static constexpr std::uint32_t kNoSide = 64;
    static constexpr std::int32_t kFurthest = 24;  ///< Digits of the largest difference.
    std::array<SymbolModel<5>, Scales * Kinds> digits;
    std::array<std::array<BitModel, 4>, 64> second;
    std::array<BitModel, kNoSide> sign;

    /// Digit counts that a prior of `rising` expects at each scale: see digit_prior().
    ResidualModel();

    /// `side`: what tells the sign, 0 to 63; kNoSide: nothing does.
    template <class Coder>
    std::int32_t code(Coder& coder, std::uint32_t scale, std::uint32_t kind, std::int32_t value,
                      std::uint32_t side = kNoSide) {
        if (scale >= Scales) scale = Scales - 1;
        const std::uint32_t magnitude = static_cast<std::uint32_t>(value < 0 ? -value : value);
        const std::uint32_t count =
            digits[scale * Kinds + kind].code(coder, static_cast<std::uint32_t>(std::bit_width(magnitude)));
        if (count == 0) return 0;
        const std::int32_t departs =
            2 * static_cast<std::int32_t>(count) - static_cast<std::int32_t>(scale) + 24;
        const std::size_t relative = static_cast<std::size_t>(departs < 0 ? 0 : departs > 63 ? 63 : departs);
        std::uint32_t read = 1;
        if (count > 1) read = 2 * read + coder.bit(second[relative][0], magnitude >> (count - 2) & 1);
        if (count > 2) read = 2 * read + coder.bit(second[relative][read - 1], magnitude >> (count - 3) & 1);
        // The other digits, and the sign with them unless something tells it.
        const std::uint32_t rest = count > 3 ? count - 3 : 0;
        std::uint32_t raw = (magnitude & ((1u << rest) - 1)) << 1 | std::uint32_t{value < 0};
        if (side == kNoSide)
            raw = coder.raw(rest + 1, raw);
        else
            raw = coder.raw(rest, raw >> 1) << 1 | std::uint32_t{coder.bit(sign[side], value < 0)};
        read = read << rest | raw >> 1;
        return (raw & 1) != 0 ? -static_cast<std::int32_t>(read) : static_cast<std::int32_t>(read);
    }
};

/// How likely a difference has d digits, in 1/65536, where 2 d departs from its scale (in half octaves) by i
/// - 24: measured over the first meshes of the benchmark, so that small files need not learn it.
inline constexpr std::array<std::uint16_t, 49> kDigitPrior = {
    40,  40,   40,   40,   40,   40,   40,   40,    40,    60,    80,    120,   170,   240,  340,  480,  680,
    960, 1360, 1920, 2700, 3900, 5500, 7800, 11000, 14000, 16500, 17500, 16500, 12500, 7600, 3500, 1300, 500,
    250, 150,  100,  60,   40,   40,   40,   40,    40,    40,    40,    40,    40,    40,   40};

template <std::size_t Scales, std::size_t Kinds>
ResidualModel<Scales, Kinds>::ResidualModel() {
    for (std::size_t scale = 0; scale < Scales; ++scale) {
        std::array<std::uint32_t, 64> weight{};  // of the nodes; leaf d at 32 + d
        for (std::size_t d = 0; d < 32; ++d) {
            const std::int64_t at = 2 * std::int64_t(d) - std::int64_t(scale) + 24;
            weight[32 + d] = d > 26 ? 1
                                    : kDigitPrior[static_cast<std::size_t>(at < 0    ? 0
                                                                           : at > 48 ? 48
                                                                                     : at)];
        }
        // A difference of no digits stands for all that would be smaller still.
        for (std::size_t d = scale > 24 ? scale - 24 : 0; d > 0; --d) weight[32] += 40;
        for (std::size_t node = 32; node-- > 1;) weight[node] = weight[2 * node] + weight[2 * node + 1];
        for (std::size_t kind = 0; kind < Kinds; ++kind)
            for (std::size_t node = 1; node < 32; ++node) {
                const std::uint32_t one =
                    static_cast<std::uint32_t>(std::uint64_t{weight[2 * node + 1]} * 65536 / weight[node]);
                digits[scale * Kinds + kind].nodes[node] = BitModel(one < 64      ? 64
                                                                    : one > 65472 ? 65472
                                                                                  : one,
                                                                    4);
            }
    }
}

}  // namespace vsplit
