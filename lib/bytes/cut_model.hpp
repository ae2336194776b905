// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Which part of its parent's fan a child takes: a run of sectors, guessed from the shape of the fan. Each
// ring vertex is a wing (a neighbour of both), the child's alone, or the parent's alone; how likely each is
// is learnt by the vertex's valence and edges, and all runs compete by the product of these likelihoods.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "fixed_point.hpp"
#include "live_stars.hpp"
#include "range_coder.hpp"

namespace vsplit {

/// log2_fixed() of the counts that models keep, all below 4096.
inline constexpr std::array<std::int16_t, 4096> kCountLogs = [] {
    std::array<std::int16_t, 4096> table{};
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = static_cast<std::int16_t>(log2_fixed(i));
    return table;
}();
inline std::int32_t log2_count(std::uint32_t count) {
    return kCountLogs[count];
}

/// 2^(-i / 32) in 1/65536: how likely something is against the likeliest, given the logarithms' difference.
inline constexpr std::array<std::uint16_t, 512> kLikelihoods = [] {
    std::array<std::uint16_t, 512> table{};
    for (std::uint32_t i = 0; i < table.size(); ++i) {
        const std::uint32_t whole = (i + 31) / 32;
        table[i] = static_cast<std::uint16_t>(
            std::min<std::uint32_t>(2u * kPowers[8 * (32 * whole - i)] >> whole, 65535));
    }
    return table;
}();

class CutModel {
  public:
    /// In a closed fan every run of 1 to size - 1 sectors, both wings. In an open one runs of 1 and more with
    /// both wings; or a run from the first sector on, none to all, with the last wing alone; or one up to the
    /// last sector with the first wing alone.
    /// Sectors that have a corner from `locked` on are no part of any. False if no run is left.
    template <class Coder>
    bool code(Coder& coder, const LiveStars& mesh, const Star& star, std::uint32_t locked, const Cut& cut,
              Cut& out);

  private:
    static constexpr std::uint16_t kMostSeen = 1000;
    /// Of a ring vertex in one kind of surroundings: how often it was the parent's, a wing, the child's, and
    /// log2_count() of that.
    struct Role {
        std::array<std::uint16_t, 3> count{2, 2, 2};
        std::array<std::int16_t, 3> log{256, 256, 256};
        void saw(std::size_t role) {
            if ((count[role] = static_cast<std::uint16_t>(count[role] + 4)) > kMostSeen)
                for (std::size_t i = 0; i < 3; ++i) {
                    count[i] = static_cast<std::uint16_t>((count[i] >> 1) | 1);
                    log[i] = kCountLogs[count[i]];
                }
            log[role] = kCountLogs[count[role]];
        }
        /// Odds against the parent's.
        std::int32_t wing() const { return log[1] - log[0]; }
        std::int32_t child() const { return log[2] - log[0]; }
    };
    static constexpr std::size_t kLongest = 16;
    /// What each hint counts, in 1/16: they overlap, so all of each would be too much.
    static constexpr std::int32_t kWeighLength = 16, kWeighEdge = 9, kWeighChord = 4;
    struct Lengths {
        std::array<std::array<std::uint16_t, kLongest + 1>, kLongest + 1> count;
        std::array<std::array<std::int32_t, kLongest + 1>, kLongest + 1> log{};  ///< Weighed, in 1/4096.
        Lengths() {
            for (auto& row : count) row.fill(1);
        }
    };

    void classify(const LiveStars& mesh, const Star& star);
    /// Fills weights_ and sums_ for all runs of this family (closed, both wings, one wing); their sum.
    std::uint32_t weigh(const Star& star, const Cut& wings, std::size_t family, std::uint32_t locked);
    template <std::uint32_t kBlocks>
    std::uint32_t weigh_rows(std::uint32_t begins, std::uint32_t longest, int shift);
    void learn(const Star& star, const Cut& cut);

    std::array<Role, 8 * 9> by_edge_;  // valence, length against the ring's
    std::array<Role, 10> by_chord_;    // the edge that would replace it
    std::array<Lengths, 3> lengths_;
    std::array<BitModel, 8> both_;
    BitModel last_;
    std::array<std::uint8_t, Star::kLargestFan + 1> edge_kind_, chord_kind_;
    // Shares of the ring's roles, and all bits set for each sector that may be taken; twice round, if closed.
    static constexpr std::size_t kRound = 2 * Star::kLargestFan + 8;
    std::array<std::uint16_t, kRound> wing_{}, child_{}, open_{};
    std::array<std::uint16_t, Star::kLargestFan + 1> length_{};
    // A row for each length, of one weight for each begin; one weight alone where the begin is given.
    std::array<std::array<std::uint16_t, Star::kLargestFan>, Star::kLargestFan + 1> weights_;
    std::array<std::uint32_t, Star::kLargestFan + 1> sums_;
};

template <class Coder>
bool CutModel::code(Coder& coder, const LiveStars& mesh, const Star& star, std::uint32_t locked,
                    const Cut& cut, Cut& out) {
    out = {};
    if (!star.closed) {
        const bool both =
            coder.bit(both_[std::min<std::uint32_t>(star.size, 7)], cut.first_wing && cut.last_wing);
        if (!both) {
            out.last_wing = coder.bit(last_, cut.last_wing);
            out.first_wing = !out.last_wing;
        }
    }
    classify(mesh, star);
    const std::size_t family = star.closed ? 0 : out.first_wing && out.last_wing ? 1 : 2;
    const std::uint32_t sum = weigh(star, out, family, locked);
    if (sum == 0) return false;
    std::uint32_t lane = 0, before = 0;
    if constexpr (Coder::kDecodes) {
        std::uint32_t at = coder.point(sum);
        out.length = family == 2 ? 0 : 1;
        for (; at >= sums_[out.length]; ++out.length) at -= sums_[out.length], before += sums_[out.length];
        for (; at >= weights_[out.length][lane]; ++lane) {
            at -= weights_[out.length][lane];
            before += weights_[out.length][lane];
        }
        out.begin = lane;
        if (family == 2) out.begin = out.first_wing ? star.size - out.length : 0;
    } else {
        out.begin = cut.begin, out.length = cut.length;
        lane = family == 2 ? 0 : cut.begin;
        for (std::uint32_t l = family == 2 ? 0 : 1; l < cut.length; ++l) before += sums_[l];
        for (std::uint32_t i = 0; i < lane; ++i) before += weights_[cut.length][i];
    }
    if (weights_[out.length][lane] == 0) return false;  // a writer's run with a locked sector
    coder.take(before, weights_[out.length][lane], sum);
    learn(star, out);
    return true;
}

}  // namespace vsplit
