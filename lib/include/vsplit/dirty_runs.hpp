// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Which elements of an array changed, in runs of a few: finer than one hull, and cheap to mark.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vsplit {

/// Half-open.
struct ElementRange {
    std::uint32_t begin = 0, end = 0;
    friend bool operator==(const ElementRange&, const ElementRange&) = default;
};

/// A bit for each run of kRun elements.
class DirtyRuns {
  public:
    static constexpr std::uint32_t kRun = 16;

    /// Room for marks of elements below this. What is marked stays.
    void resize(std::size_t elements) { words_.resize(elements / (64 * kRun) + 1); }
    void mark(std::uint32_t element) {
        words_[element / (64 * kRun)] |= std::uint64_t{1} << (element / kRun % 64);
    }
    void mark(std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t at = begin / kRun; at < (end + kRun - 1) / kRun; ++at)
            words_[at / 64] |= std::uint64_t{1} << (at % 64);
    }
    /// Appends the stretches of runs that were marked, cut off at `size`, in order and apart from each other;
    /// forgets all marks.
    void take(std::uint32_t size, std::vector<ElementRange>& out) {
        const std::size_t first = out.size();
        for (std::size_t w = 0; w < words_.size(); ++w) {
            for (std::uint64_t word = words_[w]; word != 0; word &= word - 1) {
                const auto begin = std::uint32_t((w * 64 + std::size_t(std::countr_zero(word))) * kRun);
                if (begin >= size) break;
                const std::uint32_t end = std::min(size, begin + kRun);
                if (out.size() > first && out.back().end == begin)
                    out.back().end = end;
                else
                    out.push_back({begin, end});
            }
            words_[w] = 0;
        }
    }
    std::size_t memory() const { return words_.capacity() * sizeof(std::uint64_t); }

  private:
    std::vector<std::uint64_t> words_;
};

}  // namespace vsplit
