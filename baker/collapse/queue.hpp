// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The priority queue of the collapse: items in buckets by the logarithm of their cost.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace vsplit::bake {

/// Each item is in at most one bucket; pushing it again moves it. Within a bucket (a cost range of a quarter
/// octave) items come in order of their number, which runs along a Morton curve, so that work stays in the
/// cache. Measured against a 4-ary heap: PROTOTYPES in docs/decisions/0003-collapse-engine.md.
class BucketQueue {
  public:
    using Bucket = std::uint16_t;
    static constexpr Bucket kNone = 0xFFFF;

    explicit BucketQueue(std::size_t items) : slots_(items, kNone), buckets_(kBuckets) {}

    /// Costs are >= 0; an infinite or NaN cost has the last bucket.
    static Bucket bucket_of(float cost) {
        if (!(cost > 0)) return 0;
        return static_cast<Bucket>(
            std::min<std::uint32_t>(std::bit_cast<std::uint32_t>(cost) >> 19, kBuckets - 1));
    }

    void push(std::uint32_t item, Bucket bucket) {
        if (slots_[item] == bucket) return;
        slots_[item] = bucket;
        buckets_[bucket].push_back(item);
        lowest_ = std::min(lowest_, bucket);
    }
    void remove(std::uint32_t item) { slots_[item] = kNone; }
    bool contains(std::uint32_t item) const { return slots_[item] != kNone; }

    /// Takes the cheapest bucket's items in order: false when nothing is left. An item is out of the queue
    /// once taken. `advance` is called at every step towards it, also past what has moved meanwhile.
    template <class Advance>
    bool pop(std::uint32_t& item, Bucket& bucket, const Advance& advance) {
        for (;;) {
            while (next_ < snapshot_.size()) {
                item = snapshot_[next_++];
                advance();
                if (slots_[item] != current_) continue;
                slots_[item] = kNone;
                bucket = current_;
                return true;
            }
            while (lowest_ < kBuckets && buckets_[lowest_].empty()) ++lowest_;
            if (lowest_ >= kBuckets) return false;
            current_ = lowest_;
            snapshot_.swap(buckets_[current_]);
            buckets_[current_].clear();
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
    // The upper 13 bits of a float, which has no sign: exponent and four bits of mantissa.
    static constexpr std::uint32_t kBuckets = 4096;

    std::vector<Bucket> slots_;
    std::vector<std::vector<std::uint32_t>> buckets_;
    std::vector<std::uint32_t> snapshot_;
    std::size_t next_ = 0;
    Bucket current_ = 0;
    Bucket lowest_ = 0;
};

}  // namespace vsplit::bake
