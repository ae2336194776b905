// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The priority queue of the collapse: items in buckets by the logarithm of their cost.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace vsplit::bake {

/// Which bucket each item waits in: one per cost range of a sixteenth of an octave.
using Bucket = std::uint16_t;
inline constexpr Bucket kNoBucket = 0xFFFF;
/// The upper 13 bits of a float, which has no sign: exponent and four bits of mantissa.
inline constexpr Bucket kBuckets = 4096;
inline constexpr Bucket kBucketsPerOctave = 16;

/// Costs are >= 0; an infinite or NaN cost has the last bucket.
inline Bucket bucket_of(float cost) {
    if (!(cost > 0)) return 0;
    return static_cast<Bucket>(
        std::min<std::uint32_t>(std::bit_cast<std::uint32_t>(cost) >> 19, kBuckets - 1u));
}

/// The items of a window of buckets. Where an item waits is said by `slots`, which queues of different items
/// share; pushing an item again moves it. Within a bucket items come in order of their number, which runs
/// along a Morton curve, so that work stays in the cache. Measured against a 4-ary heap: PROTOTYPES in
/// docs/decisions/0003-collapse-engine.md.
class BucketQueue {
  public:
    explicit BucketQueue(std::span<Bucket> slots) : slots_(slots) {}

    /// Empties the queue and sets its window to buckets `begin` to `end` - 1.
    void open(Bucket begin, Bucket end) {
        begin_ = begin;
        end_ = end;
        lowest_ = end;
        next_ = 0;
        snapshot_.clear();
        buckets_.resize(std::size_t(end - begin));
        for (auto& bucket : buckets_) bucket.clear();
    }
    /// Lines up an item that waits within the window.
    void line_up(std::uint32_t item) {
        const Bucket bucket = std::max(slots_[item], begin_);
        slots_[item] = bucket;
        buckets_[std::size_t(bucket - begin_)].push_back(item);
        lowest_ = std::min(lowest_, bucket);
    }
    void push(std::uint32_t item, Bucket bucket) {
        bucket = std::max(bucket, begin_);
        if (slots_[item] == bucket) return;
        slots_[item] = bucket;
        if (bucket >= end_) return;
        buckets_[std::size_t(bucket - begin_)].push_back(item);
        lowest_ = std::min(lowest_, bucket);
    }
    void remove(std::uint32_t item) { slots_[item] = kNoBucket; }
    bool contains(std::uint32_t item) const { return slots_[item] != kNoBucket; }

    /// Takes the cheapest bucket's items in order: false when the window is empty. An item waits nowhere
    /// once taken. `advance` is called at every step towards it, also past what has moved meanwhile.
    template <class Advance>
    bool pop(std::uint32_t& item, Bucket& bucket, const Advance& advance) {
        for (;;) {
            while (next_ < snapshot_.size()) {
                item = snapshot_[next_++];
                advance();
                if (slots_[item] != current_) continue;
                slots_[item] = kNoBucket;
                bucket = current_;
                return true;
            }
            while (lowest_ < end_ && buckets_[std::size_t(lowest_ - begin_)].empty()) ++lowest_;
            if (lowest_ >= end_) return false;
            current_ = lowest_;
            auto& next = buckets_[std::size_t(current_ - begin_)];
            snapshot_.swap(next);
            next.clear();
            std::erase_if(snapshot_, [&](std::uint32_t i) { return slots_[i] != current_; });
            std::sort(snapshot_.begin(), snapshot_.end());
            next_ = 0;
        }
    }

    /// The item that will come up in a while: what it needs may be fetched ahead.
    std::uint32_t peek(std::size_t ahead) const {
        return next_ + ahead < snapshot_.size() ? snapshot_[next_ + ahead] : ~0u;
    }

  private:
    std::span<Bucket> slots_;
    std::vector<std::vector<std::uint32_t>> buckets_;
    std::vector<std::uint32_t> snapshot_;
    std::size_t next_ = 0;
    Bucket begin_ = 0, end_ = 0;
    Bucket current_ = 0;
    Bucket lowest_ = 0;
};

}  // namespace vsplit::bake
