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
#include <span>
#include <vector>

#include "fixed_point.hpp"
#include "live_stars.hpp"
#include "range_coder.hpp"

namespace vsplit {

/// A run of sectors begin .. begin + length of the fan, and the new triangles at its ends.
struct Cut {
    std::uint32_t begin = 0, length = 0;
    bool first_wing = true;  ///< There is a new triangle (child, parent, ring[begin]).
    bool last_wing = true;   ///< There is a new triangle (child, ring[begin + length], parent).
};

/// log2 of small numbers, in 1/256.
inline constexpr std::array<std::int16_t, Star::kLargestFan + 1> kSmallLogs = [] {
    std::array<std::int16_t, Star::kLargestFan + 1> table{};
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = static_cast<std::int16_t>(log2_fixed(i));
    return table;
}();

class CutModel {
  public:
    CutModel();

    /// In a closed fan every run of 1 to size - 1 sectors, both wings. In an open one runs of 1 and more with
    /// both wings; or a run from the first sector on, none to all, with the last wing alone; or one up to the
    /// last sector with the first wing alone.
    template <class Coder>
    Cut code(Coder& coder, const LiveStars& mesh, const Star& star, const Cut& cut);

  private:
    /// Of a ring vertex in one kind of surroundings: how often it was the parent's, a wing, the child's.
    struct Role {
        std::array<std::uint16_t, 3> count{2, 2, 2};
        std::int32_t wing = 0, child = 0;  ///< log2 of their odds against the parent's, in 1/256.
        void saw(unsigned role);
    };
    static constexpr std::size_t kLongest = 16, kShares = 32;
    /// What each hint counts, in 1/16: they overlap, so all of each would be too much.
    static constexpr std::int32_t kWeighLength = 16, kWeighEdge = 9, kWeighChord = 4, kWeighShare = 4;
    struct Lengths {
        std::array<std::array<std::uint16_t, kLongest + 1>, kLongest + 1> count;
        Lengths() {
            for (auto& row : count) row.fill(1);
        }
    };

    static std::int32_t share_scale(std::int32_t whole) {
        return static_cast<std::int32_t>(kShares << 16) / std::max(whole, 1);
    }
    static std::uint8_t share_class(std::int32_t part, std::int32_t scale) {
        return static_cast<std::uint8_t>(
            std::min<std::int64_t>((std::int64_t{part} * scale) >> 16, kShares - 1));
    }
    void classify(const LiveStars& mesh, const Star& star);
    void learn(const Star& star, const Cut& cut);

    std::array<Role, 8 * 9> by_edge_;  // valence, length against the ring's
    std::array<Role, 10> by_chord_;    // the edge that would replace it
    std::array<Lengths, 3> lengths_;   // closed, open with both wings, open with one
    /// How often a run of each length had each share of the fan's angle.
    struct Shares {
        std::array<std::uint16_t, kShares> count;
        std::array<std::int16_t, kShares> log{};  ///< log2 of the counts, in 1/256.
        std::uint32_t sum = kShares;
        Shares() { count.fill(1); }
    };
    std::array<std::array<Shares, kLongest + 1>, 2> shares_;  // closed, open
    std::array<BitModel, 8> both_;
    BitModel last_;
    std::array<std::uint32_t, Star::kLargestFan + 1> edge_kind_, chord_kind_;
    std::array<std::int32_t, 2 * Star::kLargestFan + 1>
        angle_;  // sums along the fan, twice round it if closed
    static constexpr std::size_t kMostRuns = Star::kLargestFan * Star::kLargestFan;
    std::array<std::uint32_t, kMostRuns> weights_;
    std::array<std::int32_t, kMostRuns> scores_;
    std::array<std::pair<std::uint8_t, std::uint8_t>, kMostRuns> runs_;
};

template <class Coder>
Cut CutModel::code(Coder& coder, const LiveStars& mesh, const Star& star, const Cut& cut) {
    classify(mesh, star);
    const std::uint32_t n = star.size, last = star.ring_size() - 1;
    Cut out;
    if (!star.closed) {
        const bool both = coder.bit(both_[std::min<std::uint32_t>(n, 7)], cut.first_wing && cut.last_wing);
        if (!both) {
            out.last_wing = coder.bit(last_, cut.last_wing);
            out.first_wing = !out.last_wing;
        }
    }
    // Sums of the roles' likelihoods along the ring; what the child alone has lies strictly inside the run.
    const std::uint32_t ring = star.ring_size(), span = star.closed ? 2 * n : n + 1;
    std::array<std::int32_t, 2 * Star::kLargestFan + 2> inside, wing;
    inside[0] = 0;
    for (std::uint32_t i = 0; i < span; ++i) {
        if (i >= ring) {
            wing[i] = wing[i - ring];
            inside[i + 1] = inside[i] + (inside[i - ring + 1] - inside[i - ring]);
            continue;
        }
        const Role &edge = by_edge_[edge_kind_[i]], &chord = by_chord_[chord_kind_[i]];
        wing[i] = kWeighEdge * edge.wing + kWeighChord * chord.wing;
        inside[i + 1] = inside[i] + kWeighEdge * edge.child + kWeighChord * chord.child;
    }
    const std::size_t family = star.closed ? 0 : out.first_wing && out.last_wing ? 1 : 2;
    const auto& lengths = lengths_[family].count[std::min<std::size_t>(n, kLongest)];
    const std::int32_t to_share = share_scale(angle_[n]);
    std::size_t count = 0, wanted = 0;
    const std::uint32_t shortest = family == 2 ? 0 : 1, longest = star.closed ? n - 1 : n;
    std::int32_t best = INT32_MIN;
    for (std::uint32_t length = shortest; length <= longest; ++length) {
        const std::uint32_t first = family == 2 && out.first_wing ? last - length : 0,
                            runs = family == 2   ? 1
                                   : star.closed ? n
                                                 : n + 1 - length;
        const std::size_t scaled = n <= kLongest ? length : std::size_t{length} * kLongest / n;
        // Runs of one length and share divide among them what that share has.
        const Shares& shares = shares_[!star.closed][std::min<std::size_t>(length, kLongest)];
        std::array<std::uint8_t, kShares> rivals{};
        std::array<std::uint8_t, Star::kLargestFan> mine;
        for (std::uint32_t i = 0; i < runs; ++i)
            ++rivals[mine[i] = share_class(angle_[first + i + length] - angle_[first + i], to_share)];
        const std::int32_t all =
            kWeighLength * log2_fixed(lengths[scaled]) - kWeighShare * log2_fixed(shares.sum);
        for (std::uint32_t i = 0; i < runs; ++i, ++count) {
            const std::uint32_t begin = first + i, end = begin + length;
            std::int32_t s = all + kWeighShare * (shares.log[mine[i]] - kSmallLogs[rivals[mine[i]]]);
            if (out.first_wing) s += wing[begin];
            if (out.last_wing) s += wing[end];
            // The ends of an open fan are the child's alone where there is no wing.
            const std::uint32_t from = out.first_wing ? begin + 1 : begin, to = out.last_wing ? end : end + 1;
            if (to > from) s += inside[to] - inside[from];
            if (!Coder::kDecodes && begin == cut.begin && length == cut.length) wanted = count;
            runs_[count] = {static_cast<std::uint8_t>(begin), static_cast<std::uint8_t>(length)};
            scores_[count] = s;
            best = std::max(best, s);
        }
    }
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::int32_t below = (best - scores_[i]) >> 4, whole = (below + 255) >> 8;
        const std::uint32_t weight =
            whole > 12 ? 1
                       : std::max(1u, std::uint32_t{kPowers[static_cast<std::size_t>(256 * whole - below)]} >>
                                          (3 + whole));
        weights_[i] = weight;
        sum += weight;
    }
    const std::size_t chosen = coder.pick(std::span(weights_).first(count), sum, wanted);
    out.begin = runs_[chosen].first;
    out.length = runs_[chosen].second;
    learn(star, out);
    return out;
}

}  // namespace vsplit
