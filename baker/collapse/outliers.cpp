// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "outliers.hpp"

#include <algorithm>
#include <numeric>

#include "reorder.hpp"
#include "tail.hpp"
#include "unsplit.hpp"

namespace vsplit::bake {
namespace {

/// When each collapse may come, in ranks: 0 is the first.
class Keys {
  public:
    explicit Keys(const ProgressiveMesh& mesh)
        : walk_(mesh), acted_(mesh.positions.size(), 0), touched_(mesh.positions.size(), 0) {}

    /// One per split: at least its rank, that which `allowed` (per rank, growing) has for its deviation, and
    /// those of what it depends on.
    std::vector<std::uint32_t> of(const std::vector<float>& deviations, const std::vector<float>& allowed) {
        const std::size_t count = deviations.size();
        std::vector<std::uint32_t> keys(count);
        while (walk_.splits_left() != 0) {
            const std::uint32_t split = walk_.step();
            const auto rank = std::ptrdiff_t(count - 1 - split);
            const auto when =
                std::lower_bound(allowed.begin() + rank, allowed.end(), deviations[split]) - allowed.begin();
            keys[split] = spread(std::uint32_t(when));
        }
        return keys;
    }

  private:
    /// The last step's key, made no less than those of what comes before it; tells those that follow.
    std::uint32_t spread(std::uint32_t key) {
        around_.clear();
        for (const std::uint32_t v : walk_.acts()) {
            around_.push_back(v);
            walk_.star(v, [&](std::uint32_t t) { add(walk_.triangle(t)); });
            key = std::max(key, touched_[v]);
        }
        for (std::uint32_t t = walk_.removed_begin(); t < walk_.removed_end(); ++t) add(walk_.triangle(t));
        for (std::uint32_t v = walk_.gone_begin(); v < walk_.gone_end(); ++v)
            key = std::max({key, acted_[v], touched_[v]});
        for (const std::uint32_t v : around_) key = std::max(key, acted_[v]);
        for (const std::uint32_t v : around_) touched_[v] = std::max(touched_[v], key);
        for (const std::uint32_t v : walk_.acts()) acted_[v] = key;
        return key;
    }
    void add(const Triangle& t) { around_.insert(around_.end(), t.begin(), t.end()); }

    Unsplitter walk_;
    /// Per vertex: the largest key of those that acted on it, and of those in whose star it was.
    std::vector<std::uint32_t> acted_, touched_;
    std::vector<std::uint32_t> around_;
};

}  // namespace

std::vector<std::uint32_t> put_off_outliers(ProgressiveMesh& mesh, std::vector<float>& deviations) {
    const std::size_t count = mesh.splits.size();
    std::vector<std::uint32_t> keys;
    {
        std::vector<float> allowed(count);
        const std::vector<float> by_rank(deviations.rbegin(), deviations.rend());
        Tail tail(mesh.positions.size());
        for (std::size_t rank = 0; rank < count; ++rank) allowed[rank] = float(tail.at(by_rank, rank));
        keys = Keys(mesh).of(deviations, allowed);
    }
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    // Coarsest first. Equals keep their order: what depends on another has at least its key.
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return keys[a] > keys[b]; });
    std::vector<std::uint32_t>().swap(keys);
    reorder_splits(mesh, order);
    float least = 0;
    for (std::size_t i = count; i-- > 0;)
        least = mesh.splits[i].error = std::max(least, mesh.splits[i].error);
    std::vector<float> moved(count);
    for (std::size_t i = 0; i < count; ++i) moved[i] = deviations[order[i]];
    deviations.swap(moved);
    return order;
}

}  // namespace vsplit::bake
