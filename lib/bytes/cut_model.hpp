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

/// log2_fixed() of the counts that models keep, all below 4096.
inline constexpr std::array<std::int16_t, 4096> kCountLogs = [] {
    std::array<std::int16_t, 4096> table{};
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = static_cast<std::int16_t>(log2_fixed(i));
    return table;
}();
inline std::int32_t log2_count(std::uint32_t count) {
    return kCountLogs[count];
}

class CutModel {
  public:
    CutModel();

    /// In a closed fan every run of 1 to size - 1 sectors, both wings. In an open one runs of 1 and more with
    /// both wings; or a run from the first sector on, none to all, with the last wing alone; or one up to the
    /// last sector with the first wing alone.
    /// Sectors that have a corner from `locked` on are no part of any. False if no run is left.
    template <class Coder>
    bool code(Coder& coder, const LiveStars& mesh, const Star& star, std::uint32_t locked, const Cut& cut,
              Cut& out);

  private:
    static constexpr std::uint16_t kMostSeen = 1000;
    /// Of a ring vertex in one kind of surroundings: how often it was the parent's, a wing, the child's.
    struct Role {
        std::array<std::uint16_t, 3> count{2, 2, 2};
        std::int32_t wing = 0, child = 0;  ///< log2 of their odds against the parent's, in 1/256.
        void saw(unsigned role);
    };
    static constexpr std::size_t kLongest = 16;
    /// What each hint counts, in 1/16: they overlap, so all of each would be too much.
    static constexpr std::int32_t kWeighLength = 16, kWeighEdge = 9, kWeighChord = 4;
    struct Lengths {
        std::array<std::array<std::uint16_t, kLongest + 1>, kLongest + 1> count;
        Lengths() {
            for (auto& row : count) row.fill(1);
        }
    };

    void classify(const LiveStars& mesh, const Star& star);
    void learn(const Star& star, const Cut& cut);

    std::array<Role, 8 * 9> by_edge_;  // valence, length against the ring's
    std::array<Role, 10> by_chord_;    // the edge that would replace it
    std::array<Lengths, 3> lengths_;   // closed, open with both wings, open with one
    std::array<BitModel, 8> both_;
    BitModel last_;
    std::array<std::uint8_t, Star::kLargestFan + 1> edge_kind_, chord_kind_;
    static constexpr std::int32_t kShut = INT32_MIN;
    static constexpr std::size_t kMostRuns = Star::kLargestFan * Star::kLargestFan;
    std::array<std::uint32_t, kMostRuns> weights_;
    std::array<std::int32_t, kMostRuns> scores_;
};

/// 2^(-i / 32) in 1/4096, at least 1: the likelihood of a run whose score is so far below the best.
inline constexpr std::array<std::uint16_t, 12 * 32 + 1> kFarBelow = [] {
    std::array<std::uint16_t, 12 * 32 + 1> table{};
    for (std::uint32_t i = 0; i < table.size(); ++i) {
        const std::uint32_t whole = (i + 31) / 32;
        table[i] = static_cast<std::uint16_t>(kPowers[8 * (32 * whole - i)] >> (3 + whole));
        if (table[i] == 0) table[i] = 1;
    }
    return table;
}();

template <class Coder>
bool CutModel::code(Coder& coder, const LiveStars& mesh, const Star& star, std::uint32_t locked,
                    const Cut& cut, Cut& out) {
    const std::uint32_t n = star.size, last = star.ring_size() - 1;
    out = {};
    if (!star.closed) {
        const bool both = coder.bit(both_[std::min<std::uint32_t>(n, 7)], cut.first_wing && cut.last_wing);
        if (!both) {
            out.last_wing = coder.bit(last_, cut.last_wing);
            out.first_wing = !out.last_wing;
        }
    }
    classify(mesh, star);
    // Sums of the roles' likelihoods along the ring; what the child alone has lies strictly inside the run.
    const std::uint32_t ring = star.ring_size(), span = star.closed ? 2 * n : n + 1;
    std::array<std::int32_t, 2 * Star::kLargestFan + 2> before, wing;
    before[0] = 0;
    for (std::uint32_t i = 0; i < ring; ++i) {
        const Role &edge = by_edge_[edge_kind_[i]], &chord = by_chord_[chord_kind_[i]];
        wing[i] = kWeighEdge * edge.wing + kWeighChord * chord.wing;
        before[i + 1] = before[i] + kWeighEdge * edge.child + kWeighChord * chord.child;
    }
    for (std::uint32_t i = ring; i < span; ++i) {
        wing[i] = wing[i - ring];
        before[i + 1] = before[i + 1 - ring] + before[ring];
    }
    // What a run has from its beginning, and what from its end. The ends of an open fan are the child's alone
    // where there is no wing.
    std::array<std::int32_t, 2 * Star::kLargestFan + 1> head, tail;
    for (std::uint32_t i = 0; i < span; ++i) {
        head[i] = out.first_wing ? wing[i] - before[i + 1] : -before[i];
        tail[i] = out.last_wing ? wing[i] + before[i] : before[i + 1];
    }
    // How many sectors before each are locked.
    std::array<std::uint32_t, 2 * Star::kLargestFan + 1> shut{};
    for (std::uint32_t i = 0; i < (star.closed ? 2 * n : n); ++i) {
        const std::uint32_t at = i >= n ? i - n : i;
        shut[i + 1] = shut[i] + (star.ring[at] >= locked || star.ring_at(at + 1) >= locked);
    }
    const std::size_t family = star.closed ? 0 : out.first_wing && out.last_wing ? 1 : 2;
    const auto& lengths = lengths_[family].count[std::min<std::size_t>(n, kLongest)];
    const std::uint32_t shortest = family == 2 ? 0 : 1, longest = star.closed ? n - 1 : n;
    const auto runs_of = [&](std::uint32_t length) {
        return family == 2 ? 1u : star.closed ? n : n + 1 - length;
    };
    std::size_t count = 0, wanted = 0;
    std::int32_t best = kShut;
    for (std::uint32_t length = shortest; length <= longest; ++length) {
        const std::uint32_t first = family == 2 && out.first_wing ? last - length : 0, runs = runs_of(length);
        const std::size_t scaled = n <= kLongest ? length : std::size_t{length} * kLongest / n;
        const std::int32_t all = kWeighLength * log2_count(lengths[scaled]);
        if (!Coder::kDecodes && length == cut.length) wanted = count + (cut.begin - first);
        const std::int32_t *from = head.data() + first, *to = tail.data() + first + length;
        std::int32_t* score = scores_.data() + count;
        for (std::uint32_t i = 0; i < runs; ++i) {
            score[i] = shut[first + i] == shut[first + i + length] ? all + from[i] + to[i] : kShut;
            best = std::max(best, score[i]);
        }
        count += runs;
    }
    if (best == kShut) return false;
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (scores_[i] == kShut) {
            weights_[i] = 0;
            continue;
        }
        const std::int32_t below = std::min((best - scores_[i]) >> 7, 12 * 32);
        sum += weights_[i] = kFarBelow[static_cast<std::size_t>(below)];
    }
    auto chosen = static_cast<std::uint32_t>(coder.pick(std::span(weights_).first(count), sum, wanted));
    out.length = shortest;
    for (std::uint32_t runs; chosen >= (runs = runs_of(out.length)); chosen -= runs) ++out.length;
    out.begin = (family == 2 && out.first_wing ? last - out.length : 0) + chosen;
    learn(star, out);
    return true;
}

}  // namespace vsplit
