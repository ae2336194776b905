// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Whole numbers as adaptive bits: how many binary digits, then the digits.
#pragma once

#include <algorithm>
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

/// Signed differences whose size is expected to be about `scale`, 0 to 55 in half octaves: one set of digit
/// counts a scale below `Rows`, the first digits by how the count departs from the scale. Greater scales
/// leave so many digits aside that one of the last two rows tells the others.
template <std::size_t Rows, std::size_t Kinds = 1>
struct ResidualModel {
    static constexpr std::uint32_t kNoSide = 64, kMostScale = 55;
    std::array<SymbolModel<5>, Rows * Kinds> digits;
    std::array<std::array<BitModel, 3>, 64> second;
    std::array<BitModel, kNoSide> sign;

    /// Digit counts that a prior of `rising` expects at each scale: see digit_prior().
    ResidualModel();

    /// `side`: what tells the sign, 0 to 63; kNoSide: nothing does.
    template <class Coder>
    std::int32_t code(Coder& coder, std::uint32_t scale, std::uint32_t kind, std::int32_t value,
                      std::uint32_t side = kNoSide) {
        scale = std::min(scale, kMostScale);
        const std::uint32_t aside = scale < Rows ? 0 : (scale + 2 - static_cast<std::uint32_t>(Rows)) / 2,
                            row = scale - 2 * aside;
        const std::uint32_t magnitude = static_cast<std::uint32_t>(value < 0 ? -value : value),
                            head = magnitude >> aside;
        std::uint32_t count =
            digits[row * Kinds + kind].code(coder, static_cast<std::uint32_t>(std::bit_width(head)));
        count = std::min(count, 31 - aside);  // only a forged stream has more
        const std::int32_t departs =
            2 * static_cast<std::int32_t>(count) - static_cast<std::int32_t>(row) + 24;
        const std::size_t relative = static_cast<std::size_t>(departs < 0 ? 0 : departs > 63 ? 63 : departs);
        std::uint32_t read = count > 0;
        if (count > 1) read = 2 * read + coder.bit(second[relative][0], head >> (count - 2) & 1);
        if (count > 2) read = 2 * read + coder.bit(second[relative][read - 1], head >> (count - 3) & 1);
        // The other digits, and the sign with them unless something tells it.
        const std::uint32_t rest = (count > 3 ? count - 3 : 0) + aside, low = magnitude & ((1u << rest) - 1);
        if (count > 0 && side == kNoSide) {
            const std::uint32_t raw = coder.raw(rest + 1, low << 1 | std::uint32_t{value < 0});
            read = read << rest | raw >> 1;
            return (raw & 1) != 0 ? -static_cast<std::int32_t>(read) : static_cast<std::int32_t>(read);
        }
        read = read << rest | coder.raw(rest, low);
        if (read == 0) return 0;
        const bool negative =
            side == kNoSide ? coder.raw(1, value < 0) != 0 : coder.bit(sign[side], value < 0);
        return negative ? -static_cast<std::int32_t>(read) : static_cast<std::int32_t>(read);
    }
};

/// How likely a difference has d digits, in 1/65536, where 2 d departs from its scale (in half octaves) by i
/// - 24: measured over the first meshes of the benchmark, so that small files need not learn it.
inline constexpr std::array<std::uint16_t, 49> kDigitPrior = {
    40,  40,   40,   40,   40,   40,   40,   40,    40,    60,    80,    120,   170,   240,  340,  480,  680,
    960, 1360, 1920, 2700, 3900, 5500, 7800, 11000, 14000, 16500, 17500, 16500, 12500, 7600, 3500, 1300, 500,
    250, 150,  100,  60,   40,   40,   40,   40,    40,    40,    40,    40,    40,    40,   40};

template <std::size_t Rows, std::size_t Kinds>
ResidualModel<Rows, Kinds>::ResidualModel() {
    static_assert(Rows <= 24);
    for (std::size_t scale = 0; scale < Rows; ++scale) {
        std::array<std::uint32_t, 64> weight{};  // of the nodes; leaf d at 32 + d
        for (std::size_t d = 0; d < 32; ++d) {
            const std::int64_t at = 2 * std::int64_t(d) - std::int64_t(scale) + 24;
            weight[32 + d] = d > 26 ? 1
                                    : kDigitPrior[static_cast<std::size_t>(at < 0    ? 0
                                                                           : at > 48 ? 48
                                                                                     : at)];
        }
        // A difference of no digits stands for all that would be smaller still.
        for (std::size_t at = 24 - scale; at >= 2;) weight[32] += kDigitPrior[at -= 2];
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
