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

/// How likely a difference has d digits, in 1/4096, where 2 d departs from its scale (in half octaves) by i -
/// 12, measured over many meshes, so that small files need not learn it.
using DigitPrior = std::array<std::uint16_t, 16>;
/// Along the surface and across it, of each PlaceKind.
inline constexpr std::array<DigitPrior, 3> kAlongPriors = {{
    {442, 553, 702, 842, 1003, 1215, 1157, 863, 383, 117, 13, 4, 2, 1, 1, 1},
    {465, 631, 833, 1095, 1310, 1356, 985, 522, 158, 30, 5, 2, 1, 1, 1, 1},
    {654, 850, 1037, 1228, 1198, 1054, 655, 297, 67, 10, 3, 2, 1, 1, 1, 1},
}};
inline constexpr std::array<DigitPrior, 3> kAcrossPriors = {{
    {533, 652, 760, 973, 998, 1075, 911, 675, 374, 166, 74, 32, 16, 11, 6, 4},
    {770, 959, 1038, 1120, 953, 791, 484, 242, 111, 55, 36, 20, 12, 6, 4, 2},
    {1397, 1347, 872, 665, 229, 132, 44, 15, 5, 3, 2, 1, 1, 1, 1, 1},
}};
/// And that its second digit, or its third, is 1, in percent, from a departure of 14 - 24 on.
inline constexpr std::array<std::array<std::uint8_t, 2>, 10> kSecondPrior = {
    {{46, 49}, {46, 48}, {45, 48}, {41, 46}, {33, 42}, {25, 36}, {16, 30}, {13, 28}, {20, 35}, {26, 37}}};

/// Signed differences whose size is expected to be about `scale`, 0 to 55 in half octaves: one set of digit
/// counts a scale below `Rows`, the first digits by how the count departs from the scale. Greater scales
/// leave so many digits aside that one of the last two rows tells the others.
template <std::size_t Rows, std::size_t Kinds = 1>
struct ResidualModel {
    static constexpr std::uint32_t kNoSide = 64, kMostScale = 55;
    std::array<SymbolModel<5>, Rows * Kinds> digits;
    std::array<std::array<SteadyBit, 3>, 64> second;
    std::array<BitModel, kNoSide> sign;

    explicit ResidualModel(const DigitPrior& prior = kAlongPriors[0]);

    /// `side`: what tells whether the sign is the `likely` one, 0 to 63; kNoSide: nothing does.
    template <class Coder>
    std::int32_t code(Coder& coder, std::uint32_t scale, std::uint32_t kind, std::int32_t value,
                      std::uint32_t side = kNoSide, bool likely = false) {
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
        const bool negative = side == kNoSide ? coder.raw(1, value < 0) != 0
                                              : coder.bit(sign[side], (value < 0) != likely) != likely;
        return negative ? -static_cast<std::int32_t>(read) : static_cast<std::int32_t>(read);
    }
};

template <std::size_t Rows, std::size_t Kinds>
ResidualModel<Rows, Kinds>::ResidualModel(const DigitPrior& prior) {
    static_assert(Rows <= 15);
    constexpr std::uint32_t kSeen = 6;
    for (std::size_t row = 0; row < Rows; ++row) {
        std::array<std::uint32_t, 64> weight{};  // of the nodes; leaf d at 32 + d
        for (std::size_t d = 1; d < 32; ++d) {
            const std::size_t at = 2 * d + 12 - row;
            weight[32 + d] = at < prior.size() ? prior[at] : 1;
        }
        // A difference of no digits stands for all that would be smaller still.
        weight[32] = prior[row & 1];
        for (std::size_t at = 14 - row; at >= 2;) weight[32] += prior[at -= 2];
        for (std::size_t node = 32; node-- > 1;) weight[node] = weight[2 * node] + weight[2 * node + 1];
        for (std::size_t kind = 0; kind < Kinds; ++kind)
            for (std::size_t node = 1; node < 32; ++node)
                digits[row * Kinds + kind].nodes[node] =
                    BitModel(std::clamp(weight[2 * node + 1] * 65536 / weight[node], 64u, 65472u), kSeen);
    }
    for (std::size_t i = 0; i < second.size(); ++i)
        for (std::size_t j = 0; j < 3; ++j)
            second[i][j] =
                SteadyBit(kSecondPrior[std::min<std::size_t>(i < 14 ? 0 : i - 14, 9)][j > 0] * 655u, kSeen);
}

}  // namespace vsplit
