// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "normal_model.hpp"

#include <algorithm>
#include <cstdlib>

namespace vsplit {

Direction NormalModel::direction(const std::int32_t* numbers) const {
    const std::int64_t x = std::clamp(numbers[0], -most_, most_), y = std::clamp(numbers[1], -most_, most_);
    const std::int64_t ax = std::abs(x), ay = std::abs(y), z = most_ - ax - ay;
    if (z >= 0) return {x, y, z};
    return {x < 0 ? ay - most_ : most_ - ay, y < 0 ? ax - most_ : most_ - ax, z};
}

/// Of this size, nearly: each component rounded towards 0.
Direction NormalModel::sized(const Direction& d) const {
    const std::int64_t whole = octahedral_size(d);
    if (whole == 0) return {0, 0, size_};
    const int over = std::max(0, static_cast<int>(std::bit_width(static_cast<std::uint64_t>(whole))) - 40);
    Direction out;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::int64_t part = (std::abs(d[i]) >> over) * size_ / std::max<std::int64_t>(whole >> over, 1);
        out[i] = d[i] < 0 ? -part : part;
    }
    return out;
}

void NormalModel::guess(const Direction& geometric, const Direction& mean) {
    geometric_ = sized(geometric);
    mean_ = sized(mean);
    const std::int64_t apart =
        octahedral_size({geometric_[0] - mean_[0], geometric_[1] - mean_[1], geometric_[2] - mean_[2]});
    class_ = std::min<std::uint32_t>(half_octave(static_cast<std::uint64_t>(apart)), 2 * kClasses - 1) / 2;
    // The shares of the two are as their errors' inverses.
    const std::int64_t g = missed_[class_][0] + 1, m = missed_[class_][1] + 1, share = 64 * m / (g + m);
    Direction both;
    for (std::size_t i = 0; i < 3; ++i) both[i] = share * geometric_[i] + (64 - share) * mean_[i];
    both = sized(both);
    std::int64_t x = both[0], y = both[1];
    if (both[2] < 0) {
        const std::int64_t fx = size_ - std::abs(y), fy = size_ - std::abs(x);
        x = both[0] < 0 ? -fx : fx;
        y = both[1] < 0 ? -fy : fy;
    }
    at_ = {static_cast<std::int32_t>((x + 8) >> 4), static_cast<std::int32_t>((y + 8) >> 4)};
    scale_ =
        std::min<std::uint32_t>(half_octave(static_cast<std::uint64_t>(std::min(g, m))) / 2, kScales - 1);
}

/// Over an edge of the square, the other half of that edge's triangle goes on.
void NormalModel::unfold(std::array<std::int32_t, 2>& n) const {
    for (std::size_t i = 0; i < 2; ++i) {
        const std::int64_t here = n[i];
        if (here >= -most_ && here <= most_) continue;
        n[i] = static_cast<std::int32_t>((here < 0 ? -2 : 2) * std::int64_t{most_} - here);
        n[1 - i] = static_cast<std::int32_t>(-std::int64_t{n[1 - i]});
    }
}

std::array<std::uint32_t, 2> NormalModel::nearest(const std::int32_t* wanted) const {
    const std::int32_t x = wanted[0], y = wanted[1], edge = 2 * most_;
    const std::array<std::int32_t, 2> ways[5] = {
        {x, y}, {edge - x, -y}, {-edge - x, -y}, {-x, edge - y}, {-x, -edge - y}};
    std::array<std::uint32_t, 2> best{};
    std::uint64_t least = ~std::uint64_t{0};
    for (const auto& way : ways) {
        std::array<std::int32_t, 2> back = way;
        unfold(back);
        if (back[0] != x || back[1] != y) continue;
        std::array<std::uint32_t, 2> code;
        for (std::size_t i = 0; i < 2; ++i) {
            const std::uint32_t d = static_cast<std::uint32_t>(way[i]) - static_cast<std::uint32_t>(at_[i]);
            code[i] = (d << 1) ^ (0u - (d >> 31));
        }
        const std::uint64_t cost = std::uint64_t{code[0]} + code[1];
        if (cost < least) least = cost, best = code;
    }
    return best;
}

void NormalModel::learn(const std::int32_t* numbers) {
    const Direction is = direction(numbers);
    std::array<std::int64_t, 2>& missed = missed_[class_];
    for (std::size_t k = 0; k < 2; ++k) {
        const Direction& guess = k == 0 ? geometric_ : mean_;
        const std::int64_t off =
            octahedral_size({16 * is[0] - guess[0], 16 * is[1] - guess[1], 16 * is[2] - guess[2]});
        missed[k] += (off * off - missed[k]) >> 5;
    }
}

}  // namespace vsplit
