// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Which places of a row a sweep has still to ask: piece by piece, so that what is asked again is still at
// hand, then round again to those that changed behind the piece that changed them.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace vsplit {

class AskList {
  public:
    static constexpr std::uint32_t kNoPlace = 0xFFFFFFFF;
    /// So many places are asked until none of them, nor of what is born meanwhile, is left to ask.
    static constexpr std::uint32_t kPiece = 1024;

    /// A sweep begins: the first `places` are to be asked.
    void begin(std::uint32_t places) {
        words_.assign(std::size_t{places} / 64 + 1, ~std::uint64_t{0});
        words_.back() = (std::uint64_t{1} << (places % 64)) - 1;
        places_ = end_ = places;
        lap_ = 0;
        again_ = false;
        open(0);
    }
    /// Ask this one, or ask it again. What is born comes behind all others.
    void add(std::uint32_t place) {
        if (place / 64 >= words_.size()) words_.resize(std::size_t{place} / 64 + 1, 0);
        words_[place / 64] |= std::uint64_t{1} << (place % 64);
        places_ = std::max(places_, place + 1);
    }
    /// The next in line from the last one on, which is the last one itself if it was added again; kNoPlace
    /// when all are asked.
    std::uint32_t next() {
        std::uint32_t place = in_piece();
        while (place == kNoPlace) {
            if (cursor_ != piece_) {
                cursor_ = piece_;
                again_ = true;
            } else {
                std::uint32_t ahead = find(piece_, end_);
                again_ = lap_ > 0;
                if (ahead == kNoPlace) {
                    ahead = find(0, places_);
                    if (ahead == kNoPlace) return kNoPlace;
                    again_ = true;
                    ++lap_;
                    end_ = places_;
                }
                open(ahead / kPiece * kPiece);
            }
            place = in_piece();
        }
        words_[place / 64] &= ~(std::uint64_t{1} << (place % 64));
        return cursor_ = place;
    }
    /// Has the sweep been at the piece at hand before?
    bool again() const { return again_; }

  private:
    void open(std::uint32_t piece) {
        piece_ = cursor_ = piece;
        born_ = places_;
    }
    std::uint32_t in_piece() const {
        const std::uint32_t place = find(cursor_, std::min(piece_ + kPiece, end_));
        return place != kNoPlace ? place : find(std::max(cursor_, born_), places_);
    }
    /// The first to ask of places `from` to `end` - 1.
    std::uint32_t find(std::uint32_t from, std::uint32_t end) const {
        if (from >= end) return kNoPlace;
        std::size_t w = from / 64;
        std::uint64_t word = words_[w] & (~std::uint64_t{0} << (from % 64));
        while (word == 0) {
            if (++w * 64 >= end) return kNoPlace;
            word = words_[w];
        }
        const auto place =
            static_cast<std::uint32_t>(64 * w) + static_cast<std::uint32_t>(std::countr_zero(word));
        return place < end ? place : kNoPlace;
    }

    std::vector<std::uint64_t> words_{0};
    std::uint32_t places_ = 0;            // that there are
    std::uint32_t end_ = 0;               // of the lap: those that there were at its beginning
    std::uint32_t piece_ = 0, born_ = 0;  // where the piece begins, and what is born in it
    std::uint32_t cursor_ = 0, lap_ = 0;
    bool again_ = false;
};

}  // namespace vsplit
