// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "cut_model.hpp"

namespace vsplit {
namespace {

/// -4 ... 4 for a ratio of 2^(-2) ... 2^2, given as its logarithm in 1/256; as 0 ... 8.
std::uint32_t ratio_class(std::int32_t log) {
    const std::int32_t c = (log + 4 * 128 + 64) >> 7;
    return static_cast<std::uint32_t>(std::clamp(c, 0, 8));
}

}  // namespace

void CutModel::Role::saw(unsigned role) {
    if ((count[role] = static_cast<std::uint16_t>(count[role] + 4)) > kMostSeen)
        for (auto& c : count) c = static_cast<std::uint16_t>((c >> 1) | 1);
    wing = log2_count(count[1]) - log2_count(count[0]);
    child = log2_count(count[2]) - log2_count(count[0]);
}

CutModel::CutModel() = default;

void CutModel::classify(const LiveStars& mesh, const Star& star) {
    const std::uint32_t count = star.ring_size();
    const Lattice3 centre = mesh.vertices[star.centre].at;
    std::array<std::array<std::int64_t, 3>, Star::kLargestFan + 1> spoke;
    std::array<std::int32_t, Star::kLargestFan + 1> length;  // log2 of the squares, in 1/256
    std::uint64_t sum = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Lattice3& at = mesh.vertices[star.ring[i]].at;
        std::uint64_t square = 1;
        for (std::size_t k = 0; k < 3; ++k) {
            spoke[i][k] = std::int64_t{at[k]} - centre[k];
            square += static_cast<std::uint64_t>(spoke[i][k] * spoke[i][k]);
        }
        sum += square;
        length[i] = log2_fixed(square);
    }
    const std::int32_t mean = log2_fixed(sum) - log2_fixed(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t valence = std::clamp<std::uint32_t>(mesh.vertices[star.ring[i]].star, 2, 9) - 2;
        const std::int32_t log = length[i];
        edge_kind_[i] = static_cast<std::uint8_t>(9 * valence + ratio_class(log - mean));
        if (!star.closed && (i == 0 || i + 1 == count)) {
            chord_kind_[i] = 9;
        } else {
            const auto &before = spoke[i == 0 ? count - 1 : i - 1],
                       &after = spoke[i + 1 == count ? 0 : i + 1];
            std::uint64_t chord = 1;
            for (std::size_t k = 0; k < 3; ++k)
                chord += static_cast<std::uint64_t>((after[k] - before[k]) * (after[k] - before[k]));
            chord_kind_[i] = static_cast<std::uint8_t>(ratio_class(log2_fixed(chord) - log - 256));
        }
    }
}

void CutModel::learn(const Star& star, const Cut& cut) {
    const std::uint32_t n = star.size, count = star.ring_size();
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t after = i >= cut.begin ? i - cut.begin : i + n - cut.begin;
        unsigned role = after > 0 && after < cut.length ? 2 : 0;
        if (after == 0) role = cut.first_wing ? 1 : 2;
        if (after == cut.length && (star.closed || i >= cut.begin)) role = cut.last_wing ? 1 : 2;
        if (!star.closed && i < cut.begin) role = 0;
        by_edge_[edge_kind_[i]].saw(role);
        by_chord_[chord_kind_[i]].saw(role);
    }
    const std::size_t family = star.closed ? 0 : cut.first_wing && cut.last_wing ? 1 : 2;
    auto& row = lengths_[family].count[std::min<std::size_t>(n, kLongest)];
    auto& length = row[n <= kLongest ? cut.length : std::size_t{cut.length} * kLongest / n];
    if ((length = static_cast<std::uint16_t>(length + 4)) > 4000)
        for (auto& c : row) c = static_cast<std::uint16_t>((c >> 1) | 1);
}

}  // namespace vsplit
