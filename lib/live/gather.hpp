// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A stretch of a file that comes in pieces. Private to this room.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

namespace vsplit {

/// Bytes [begin, begin + size) of a file, and which of them are there.
class Gather {
  public:
    Gather(std::uint64_t begin, std::size_t size) : begin_(begin), bytes_(size) {}

    std::uint64_t begin() const { return begin_; }
    std::uint64_t end() const { return begin_ + bytes_.size(); }
    bool complete() const { return have_.size() == 1 && have_[0] == Interval{0, bytes_.size()}; }
    std::span<const std::byte> bytes() const { return bytes_; }
    std::vector<std::byte> release() { return std::move(bytes_); }

    /// Takes what of [offset, offset + bytes.size()) falls within and is not there yet. Returns how many
    /// bytes.
    std::size_t add(std::uint64_t offset, std::span<const std::byte> bytes) {
        const std::uint64_t first = std::max(offset, begin_),
                            last = std::min<std::uint64_t>(offset + bytes.size(), end());
        if (first >= last) return 0;
        const Interval piece{std::size_t(first - begin_), std::size_t(last - begin_)};
        std::size_t taken = 0, at = piece.first;
        const std::byte* const from = bytes.data() + (first - offset);
        const auto copy = [&](std::size_t to) {
            if (at >= to) return;
            std::memcpy(bytes_.data() + at, from + (at - piece.first), to - at);
            taken += to - at;
        };
        // What came first stays.
        for (const Interval& there : have_) {
            if (there.second <= at) continue;
            if (there.first >= piece.second) break;
            copy(std::min(there.first, piece.second));
            at = std::max(at, there.second);
        }
        copy(piece.second);
        merge(piece);
        return taken;
    }
    /// The first bytes that are missing, as an interval from the start; empty if complete.
    std::pair<std::size_t, std::size_t> gap() const {
        const std::size_t from = have_.empty() || have_[0].first > 0 ? 0 : have_[0].second;
        for (const Interval& there : have_)
            if (there.first > from) return {from, there.first};
        return {from, bytes_.size()};
    }
    /// How many bytes from the start are there without a gap.
    std::size_t prefix() const { return have_.empty() || have_[0].first > 0 ? 0 : have_[0].second; }
    /// More room at the end; what is there stays.
    void grow(std::size_t size) {
        if (size > bytes_.size()) bytes_.resize(size);
    }
    void clear() { have_.clear(); }

  private:
    using Interval = std::pair<std::size_t, std::size_t>;
    void merge(Interval piece) {
        auto at = std::lower_bound(have_.begin(), have_.end(), piece,
                                   [](const Interval& a, const Interval& b) { return a.second < b.first; });
        auto last = at;
        for (; last != have_.end() && last->first <= piece.second; ++last)
            piece = {std::min(piece.first, last->first), std::max(piece.second, last->second)};
        have_.insert(have_.erase(at, last), piece);
    }

    std::uint64_t begin_;
    std::vector<std::byte> bytes_;
    std::vector<Interval> have_;  // sorted, apart from each other
};

}  // namespace vsplit
