// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What is much for its time: the deviation that few of the last collapses exceed.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace vsplit::bake {

/// Of the latest collapses, as many as there are vertices left, the largest deviations: this share of them
/// may be larger than tail().
inline constexpr double kTailShare = 0.015;

/// Follows a sequence of deviations, first collapse first.
class Tail {
  public:
    /// `vertices` of the full mesh, some more than there are collapses.
    explicit Tail(std::size_t vertices) : vertices_(vertices) {}

    /// The deviation that kTailShare of the latest of values[0] to values[rank] exceed; never shrinks.
    double at(const std::vector<float>& values, std::size_t rank) {
        if (rank < next_) return tail_;
        const std::size_t live = vertices_ > rank ? vertices_ - rank : 1;
        const std::size_t last = std::min(values.size(), std::max<std::size_t>(rank + 1, kLeast)),
                          first = last - std::min(last, std::max<std::size_t>(live, kLeast));
        window_.assign(values.begin() + std::ptrdiff_t(first), values.begin() + std::ptrdiff_t(last));
        if (!window_.empty()) {
            const auto nth = window_.begin() +
                             std::ptrdiff_t(std::min(window_.size() - 1,
                                                     std::size_t((1 - kTailShare) * double(window_.size()))));
            std::nth_element(window_.begin(), nth, window_.end());
            tail_ = std::max(tail_, double(*nth));
        }
        next_ = rank + std::max<std::size_t>(1, live / 64);
        return tail_;
    }

  private:
    static constexpr std::size_t kLeast = 32;

    std::size_t vertices_, next_ = 0;
    double tail_ = 0;
    std::vector<float> window_;
};

}  // namespace vsplit::bake
