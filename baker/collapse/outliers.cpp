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

/// The same for a record made in batches, by whole batches: 0 is the first.
class BatchKeys {
  public:
    explicit BatchKeys(const ProgressiveMesh& mesh)
        : mesh_(mesh),
          changed_(mesh.positions.size(), 0),
          locked_(mesh.positions.size(), 0),
          moved_(mesh.positions.size(), 0) {}

    std::vector<std::uint32_t> of(const std::vector<float>& deviations, const std::vector<float>& allowed) {
        const std::size_t count = deviations.size();
        std::vector<std::uint32_t> keys(count), batch(count);  // the second by rank
        find_batches(batch);
        Unsplitter walk(mesh_);
        while (walk.splits_left() != 0) {
            const std::uint32_t split = walk.step();
            const std::size_t rank = count - 1 - split;
            const auto when =
                std::lower_bound(allowed.begin() + std::ptrdiff_t(rank), allowed.end(), deviations[split]) -
                allowed.begin();
            keys[split] = spread(walk, std::max(batch[rank], batch[std::min(std::size_t(when), count - 1)]));
        }
        return keys;
    }

  private:
    /// A batch is as long as it can be: until a vertex goes whose star has changed in it.
    void find_batches(std::vector<std::uint32_t>& batch) {
        Unsplitter walk(mesh_);
        std::uint32_t now = 1;
        for (std::uint32_t& number : batch) {
            walk.step();
            bool fresh = true;
            each_gone(walk, [&](std::uint32_t v) { fresh &= changed_[v] != now; });
            now += !fresh;
            each_around(walk, [&](std::uint32_t v) { changed_[v] = now; });
            number = now;
        }
    }
    std::uint32_t spread(const Unsplitter& walk, std::uint32_t key) {
        const std::uint32_t split = walk.splits_left();
        const std::uint32_t first = split == 0 ? 0 : mesh_.splits[split - 1].moves_end,
                            last = mesh_.splits[split].moves_end;
        each_gone(walk, [&](std::uint32_t v) { key = std::max({key, locked_[v] + 1, moved_[v]}); });
        // What moves a vertex says where it is: that keeps its order.
        for (std::uint32_t m = first; m < last; ++m) key = std::max(key, moved_[mesh_.moves[m].vertex]);
        for (std::uint32_t m = first; m < last; ++m) moved_[mesh_.moves[m].vertex] = key;
        each_around(walk, [&](std::uint32_t v) { locked_[v] = std::max(locked_[v], key); });
        return key;
    }
    /// The vertices that went with the last step, and those of triangles that went without one, as they do
    /// where the end of a seam stays as it is.
    template <class Visit>
    static void each_gone(const Unsplitter& walk, const Visit& visit) {
        for (std::uint32_t v = walk.gone_begin(); v < walk.gone_end(); ++v) visit(v);
        for (std::uint32_t t = walk.removed_begin(); t < walk.removed_end(); ++t) {
            const Triangle& c = walk.triangle(t);
            if (std::none_of(c.begin(), c.end(), [&](std::uint32_t v) { return v >= walk.gone_begin(); }))
                for (const std::uint32_t v : c) visit(v);
        }
    }
    /// The vertices around those that went with the last step.
    template <class Visit>
    void each_around(const Unsplitter& walk, const Visit& visit) const {
        const std::uint32_t split = walk.splits_left();
        for (std::uint32_t c = split == 0 ? 0 : mesh_.splits[split - 1].corners_end;
             c < mesh_.splits[split].corners_end; ++c)
            for (const std::uint32_t v : walk.triangle(mesh_.corner_changes[c].corner / 3)) visit(v);
        for (std::uint32_t t = walk.removed_begin(); t < walk.removed_end(); ++t)
            for (const std::uint32_t v : walk.triangle(t)) visit(v);
    }

    const ProgressiveMesh& mesh_;
    std::vector<std::uint32_t> changed_;  ///< Per vertex: the last batch that changed its star.
    std::vector<std::uint32_t> locked_;   ///< The largest key of those that did.
    std::vector<std::uint32_t> moved_;    ///< The largest of those that moved it.
};

}  // namespace

std::vector<std::uint32_t> put_off_outliers(ProgressiveMesh& mesh, std::vector<float>& deviations,
                                            bool batches) {
    const std::size_t count = mesh.splits.size();
    std::vector<std::uint32_t> keys;
    {
        std::vector<float> allowed(count);
        const std::vector<float> by_rank(deviations.rbegin(), deviations.rend());
        Tail tail(mesh.positions.size());
        for (std::size_t rank = 0; rank < count; ++rank) allowed[rank] = float(tail.at(by_rank, rank));
        keys = batches ? BatchKeys(mesh).of(deviations, allowed) : Keys(mesh).of(deviations, allowed);
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
