// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "cut_model.hpp"

#include "lanes.hpp"

namespace vsplit {
namespace {

/// -4 ... 4 for a ratio of 2^(-2) ... 2^2, given as its logarithm in 1/256; as 0 ... 8.
std::int32_t ratio_class(std::int32_t log) {
    return std::clamp((log + 4 * 128 + 64) >> 7, 0, 8);
}

std::uint16_t share(std::int32_t below) {
    return kLikelihoods[static_cast<std::size_t>(std::min(below >> 7, 511))];
}

std::uint16_t product(std::uint32_t a, std::uint32_t b) {
    return static_cast<std::uint16_t>((a * b) >> 16);
}

}  // namespace

void CutModel::classify(const LiveStars& mesh, const Star& star) {
    const std::uint32_t count = star.ring_size();
    const Lattice3 centre = mesh.vertices[star.centre].at;
    // Offsets of the ring's vertices, the last once more before them, the first once more behind.
    std::array<Lattice3, Star::kLargestFan + 3> offset;
    offset[0] = offset[1] = {};
    std::array<std::uint64_t, Star::kLargestFan + 1> squared;
    std::uint64_t sum = 0;
    const auto square = [](std::int64_t x, std::int64_t y, std::int64_t z) {
        return static_cast<std::uint64_t>(1 + x * x + y * y + z * z);
    };
    for (std::uint32_t i = 0; i < count; ++i) {
        const LiveVertex& v = mesh.vertices[star.ring[i]];
        const std::int32_t x = v.at[0] - centre[0], y = v.at[1] - centre[1], z = v.at[2] - centre[2];
        offset[i + 1] = {x, y, z};
        sum += squared[i] = square(x, y, z);
        edge_kind_[i] = static_cast<std::uint8_t>(9 * (std::clamp<std::uint32_t>(v.star, 2, 9) - 2));
    }
    offset[0] = offset[count];
    offset[count + 1] = offset[1];
    // Whole numbers below 2^53 as doubles are exact, and log2_linear() are their topmost bits.
    const auto log2 = [](std::uint64_t x) {
        return log2_linear(static_cast<double>(static_cast<std::int64_t>(x)));
    };
    const std::int32_t mean = log2(sum) - log2(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const Lattice3 &before = offset[i], &after = offset[i + 2];
        const std::int32_t length = log2(squared[i]),
                           across = log2(square(std::int64_t{after[0]} - before[0],
                                                std::int64_t{after[1]} - before[1],
                                                std::int64_t{after[2]} - before[2]));
        edge_kind_[i] = static_cast<std::uint8_t>(edge_kind_[i] + ratio_class(length - mean));
        chord_kind_[i] = static_cast<std::uint8_t>(ratio_class(across - length - 256));
    }
    if (!star.closed) chord_kind_[0] = chord_kind_[count - 1] = 9;
}

template <std::uint32_t kBlocks>
std::uint32_t CutModel::weigh_rows(std::uint32_t begins, std::uint32_t longest, int shift) {
    // Each lane is a begin; the run grows by a sector from row to row.
    std::array<Lanes, kBlocks> run, may;
    std::array<std::uint16_t, 8 * kBlocks> first{};
    for (std::uint32_t i = 0; i < begins; ++i) first[i] = open_[i];
    for (std::uint32_t j = 0; j < kBlocks; ++j) {
        run[j] = Lanes::load(wing_.data() + 8 * j);
        may[j] = Lanes::load(first.data() + 8 * j);
    }
    const Lanes one = Lanes::of(1);
    std::uint32_t total = 0;
    for (std::uint32_t l = 1; l <= longest; ++l) {
        const Lanes likely = Lanes::of(length_[l]);
        std::uint32_t sum = 0;
        for (std::uint32_t j = 0; j < kBlocks; ++j) {
            const std::uint32_t at = 8 * j + l;
            const Lanes weight = run[j] * Lanes::load(wing_.data() + at) * likely;
            const Lanes out = ((weight >> shift) + one) & may[j];
            out.store(weights_[l].data() + 8 * j);
            sum += out.sum();
            run[j] = run[j] * Lanes::load(child_.data() + at);
            may[j] = may[j] & Lanes::load(open_.data() + at);
        }
        total += sums_[l] = sum;
    }
    return total;
}

std::uint32_t CutModel::weigh(const Star& star, const Cut& wings, std::size_t family, std::uint32_t locked) {
    const std::uint32_t n = star.size, ring = star.ring_size();
    std::array<std::int32_t, Star::kLargestFan + 1> wing, child;
    std::int32_t most_wing = INT32_MIN, most_child = INT32_MIN;
    for (std::uint32_t i = 0; i < ring; ++i) {
        const Role &edge = by_edge_[edge_kind_[i]], &chord = by_chord_[chord_kind_[i]];
        wing[i] = kWeighEdge * edge.wing() + kWeighChord * chord.wing();
        child[i] = kWeighEdge * edge.child() + kWeighChord * chord.child();
        most_wing = std::max(most_wing, wing[i]);
        most_child = std::max(most_child, child[i]);
    }
    const std::uint32_t round = star.closed ? n : 0;  // an open fan's copies are behind all lanes that count
    for (std::uint32_t i = 0; i < ring; ++i) {
        wing_[i] = wing_[i + round] = share(most_wing - wing[i]);
        child_[i] = child_[i + round] = share(most_child - child[i]);
    }
    // All lengths against the likeliest, the likeliest inner vertices assumed.
    const std::uint32_t shortest = family == 2 ? 0 : 1, longest = star.closed ? n - 1 : n;
    const auto& logs = lengths_[family].log[std::min<std::size_t>(n, kLongest)];
    std::array<std::int32_t, Star::kLargestFan + 1> length;
    std::int32_t most = INT32_MIN, inner = 0;
    for (std::uint32_t l = shortest; l <= longest; ++l, inner += most_child) {
        length[l] = logs[n <= kLongest ? l : std::size_t{l} * kLongest / n] + inner;
        most = std::max(most, length[l]);
    }
    for (std::uint32_t l = shortest; l <= longest; ++l) length_[l] = share(most - length[l]);

    for (std::uint32_t i = 0; i < n; ++i) {
        const bool may = std::max(star.ring[i], star.ring[i + 1]) < locked;
        open_[i] = open_[i + round] = may ? 0xFFFF : 0;
    }
    if (!star.closed) std::fill(open_.begin() + n, open_.end(), std::uint16_t{0});

    const int shift = n <= 8 ? 0 : n <= 16 ? 2 : 4;
    if (family == 2) {
        std::uint32_t total = 0;
        std::uint16_t run = 65535, may = 0xFFFF;
        for (std::uint32_t l = 0; l <= longest; ++l) {
            const std::uint32_t end = wings.last_wing ? l : n - l;  // of the wing
            const std::uint16_t weight = product(product(run, wing_[end]), length_[l]);
            weights_[l][0] = static_cast<std::uint16_t>(((weight >> shift) + 1) & may);
            total += sums_[l] = weights_[l][0];
            run = product(run, child_[end]);
            if (l < n) may &= open_[wings.last_wing ? l : n - 1 - l];
        }
        return total;
    }
    return n <= 8    ? weigh_rows<1>(n, longest, shift)
           : n <= 16 ? weigh_rows<2>(n, longest, shift)
                     : weigh_rows<4>(n, longest, shift);
}

void CutModel::learn(const Star& star, const Cut& cut) {
    const std::uint32_t n = star.size, count = star.ring_size(), round = star.closed ? n : 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        // Steps from the run's begin: beyond its end where the parent's are.
        const std::uint32_t steps = i - cut.begin + (i < cut.begin ? round : 0);
        const bool wing = ((steps == 0) & cut.first_wing) | ((steps == cut.length) & cut.last_wing);
        const std::size_t role = (2 - std::size_t{wing}) & (0 - std::size_t{steps <= cut.length});
        by_edge_[edge_kind_[i]].saw(role);
        by_chord_[chord_kind_[i]].saw(role);
    }
    const std::size_t family = star.closed ? 0 : cut.first_wing && cut.last_wing ? 1 : 2;
    const std::size_t most = std::min<std::size_t>(n, kLongest),
                      at = n <= kLongest ? cut.length : std::size_t{cut.length} * kLongest / n;
    auto& row = lengths_[family].count[most];
    auto& logs = lengths_[family].log[most];
    if ((row[at] = static_cast<std::uint16_t>(row[at] + 4)) > 4000) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            row[i] = static_cast<std::uint16_t>((row[i] >> 1) | 1);
            logs[i] = kWeighLength * log2_count(row[i]);
        }
    }
    logs[at] = kWeighLength * log2_count(row[at]);
}

}  // namespace vsplit
