// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Which vertices a sweep has still to ask: in ascending order, then round again to those that changed.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "vsplit/progressive_mesh.hpp"

namespace vsplit {

class AskList {
  public:
    /// A sweep begins: the first `vertices` are to be asked.
    void begin(std::uint32_t vertices) {
        words_.assign(std::size_t{vertices} / 64 + 1, ~std::uint64_t{0});
        words_.back() = (std::uint64_t{1} << (vertices % 64)) - 1;
        cursor_ = 0;
        round_ = 0;
    }
    /// Ask this one, or ask it again.
    void add(std::uint32_t vertex) {
        if (vertex / 64 >= words_.size()) words_.resize(std::size_t{vertex} / 64 + 1, 0);
        words_[vertex / 64] |= std::uint64_t{1} << (vertex % 64);
    }
    /// The next in line from the last one on, which is the last one itself if it was added again; kNoVertex
    /// when all are asked.
    std::uint32_t next() {
        std::uint32_t v = find(cursor_);
        if (v == kNoVertex) {
            ++round_;
            v = find(0);
        }
        if (v == kNoVertex) return v;
        words_[v / 64] &= ~(std::uint64_t{1} << (v % 64));
        return cursor_ = v;
    }
    /// Which of the 64 vertices after this one are to be asked.
    std::uint64_t after(std::uint32_t vertex) const {
        const std::size_t from = std::size_t{vertex} + 1, w = from / 64, shift = from % 64;
        if (w >= words_.size()) return 0;
        const std::uint64_t low = words_[w] >> shift;
        return shift == 0 || w + 1 == words_.size() ? low : low | words_[w + 1] << (64 - shift);
    }
    /// How often the sweep went back to the beginning.
    std::uint32_t round() const { return round_; }

  private:
    std::uint32_t find(std::uint32_t from) const {
        std::size_t w = from / 64;
        if (w >= words_.size()) return kNoVertex;
        std::uint64_t word = words_[w] & (~std::uint64_t{0} << (from % 64));
        while (word == 0) {
            if (++w == words_.size()) return kNoVertex;
            word = words_[w];
        }
        return static_cast<std::uint32_t>(64 * w) + static_cast<std::uint32_t>(std::countr_zero(word));
    }

    std::vector<std::uint64_t> words_{0};
    std::uint32_t cursor_ = 0, round_ = 0;
};

}  // namespace vsplit
