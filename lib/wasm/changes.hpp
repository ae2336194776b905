// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Which stretches of an array have changed since the page was told.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vsplit::web {

/// A bit for each run of 32 elements.
class Changes {
  public:
    static constexpr std::size_t kRun = 32;

    /// Room for marks of elements below this. What is marked stays.
    void resize(std::size_t elements) { words_.resize(elements / (64 * kRun) + 1); }
    void mark(std::size_t element) {
        const std::size_t run = element / kRun;
        words_[run / 64] |= std::uint64_t{1} << (run % 64);
    }
    void mark(std::size_t begin, std::size_t end) {
        for (std::size_t at = begin / kRun * kRun; at < end; at += kRun) mark(at);
    }
    /// Calls stretch(begin, end) for each stretch of runs that changed, cut off at `size`, in order; forgets
    /// all.
    template <class Stretch>
    void take(std::size_t size, Stretch stretch) {
        std::size_t begin = 0, end = 0;
        for (std::size_t w = 0; w < words_.size(); ++w) {
            for (std::uint64_t word = words_[w]; word != 0; word &= word - 1) {
                const std::size_t first = (w * 64 + std::size_t(std::countr_zero(word))) * kRun;
                if (first >= size) break;
                if (first != end) {
                    if (end > begin) stretch(begin, end);
                    begin = first;
                }
                end = std::min(size, first + kRun);
            }
            words_[w] = 0;
        }
        if (end > begin) stretch(begin, end);
    }

  private:
    std::vector<std::uint64_t> words_;
};

}  // namespace vsplit::web
