// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "copies.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <numeric>

namespace vsplit::bake {
namespace {

/// A copy's corner k is the original's corner kOrders[order][k]; from 3 on they run the other way round.
constexpr std::array<std::array<std::uint8_t, 3>, 6> kOrders{
    {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};

/// Up to so many triangles are compared pair by pair.
constexpr std::size_t kFew = 12;

/// Stacks higher than this stay as they are: all of one would change corners with each collapse beside it.
constexpr std::uint32_t kHighest = 64;

/// The two larger vertices: what tells triangles of one least vertex apart.
std::uint64_t key_of(const Triangle& t) {
    const std::uint32_t most = std::max({t[0], t[1], t[2]}), least = std::min({t[0], t[1], t[2]}),
                        middle = t[0] ^ t[1] ^ t[2] ^ most ^ least;
    return std::uint64_t{most} << 32 | middle;
}

bool has_copies(std::span<const Triangle> triangles) {
    if (triangles.size() <= kFew) {
        for (std::size_t i = 1; i < triangles.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (key_of(triangles[i]) == key_of(triangles[j])) return true;
        return false;
    }
    std::vector<std::uint64_t> keys;
    for (const Triangle& t : triangles) keys.push_back(key_of(t));
    std::sort(keys.begin(), keys.end());
    return std::adjacent_find(keys.begin(), keys.end()) != keys.end();
}

/// Across an edge: the other triangle, and whether it runs the same way along it.
struct Beside {
    static constexpr std::uint32_t kNone = 0x7FFFFFFF;
    std::uint32_t triangle : 31 = kNone, same : 1 = 0;
};

std::size_t order_of(const Triangle& copy, const Triangle& original) {
    for (std::size_t order = 0; order < kOrders.size(); ++order)
        if (copy[0] == original[kOrders[order][0]] && copy[1] == original[kOrders[order][1]]) return order;
    return 0;
}

}  // namespace

std::uint32_t TriangleCopies::tag_of(const Counts& counts) {
    const auto [at, added] = known_.try_emplace(counts, std::uint32_t(counts_.size()));
    if (added) counts_.push_back(counts);
    return at->second;
}

void TriangleCopies::merge(std::vector<Triangle>& triangles, std::span<const std::uint32_t> ends) {
    const auto of = [&](std::size_t v) {
        const std::uint32_t begin = v == 0 ? 0 : ends[v - 1];
        return std::span<Triangle>(triangles).subspan(begin, ends[v] - begin);
    };
    const bool found = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, ends.size(), 4096), false,
        [&](const tbb::blocked_range<std::size_t>& range, bool some) {
            for (std::size_t v = range.begin(); v < range.end() && !some; ++v) some = has_copies(of(v));
            return some;
        },
        [](bool a, bool b) { return a || b; });
    if (!found) return;

    const std::size_t before = triangles.size();
    std::uint32_t kept = 0;
    std::vector<std::uint32_t> order;
    std::vector<Triangle> group;
    std::vector<std::pair<std::uint32_t, Counts>> firsts;
    for (std::size_t v = 0; v < ends.size(); ++v) {
        const auto all = of(v);
        group.assign(all.begin(), all.end());
        // Copies beside each other, the first of them first.
        order.resize(group.size());
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return key_of(group[a]) < key_of(group[b]);
        });
        firsts.clear();
        for (std::size_t i = 0, end; i < order.size(); i = end) {
            for (end = i; end < order.size() && key_of(group[order[end]]) == key_of(group[order[i]]);) ++end;
            Counts counts{};
            for (std::size_t j = i; j < end; ++j) {
                if (end - i > kHighest)
                    firsts.push_back({order[j], {1}});
                else
                    ++counts[order_of(group[order[j]], group[order[i]])];
            }
            if (end - i <= kHighest) firsts.push_back({order[i], counts});
        }
        std::sort(firsts.begin(), firsts.end());
        for (const auto& [first, counts] : firsts) {
            triangles[kept++] = group[first];
            tags_.push_back(tag_of(counts));
        }
    }
    count_ = before - kept;
    triangles.resize(kept);
}

bool TriangleCopies::orient(std::vector<Triangle>& triangles) {
    // The triangle beside each, across edges that two have, and whether it runs the same way along it.
    struct Side {
        std::uint64_t edge;
        std::uint32_t corner;  // 3 * triangle + k, from k to the next
        bool up;
    };
    std::vector<Side> sides;
    sides.reserve(3 * triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t a = triangles[t][k], b = triangles[t][(k + 1) % 3];
            sides.push_back({std::uint64_t{std::min(a, b)} << 32 | std::max(a, b), 3 * t + k, a < b});
        }
    tbb::parallel_sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return a.edge != b.edge ? a.edge < b.edge : a.corner < b.corner;
    });
    std::vector<Beside> beside(sides.size());
    for (std::size_t i = 0, j; i < sides.size(); i = j) {
        for (j = i; j < sides.size() && sides[j].edge == sides[i].edge;) ++j;
        if (j != i + 2) continue;
        const bool same = sides[i].up == sides[i + 1].up;
        beside[sides[i].corner] = {sides[i + 1].corner / 3, same};
        beside[sides[i + 1].corner] = {sides[i].corner / 3, same};
    }
    std::vector<Side>().swap(sides);

    // Sheet by sheet: which triangles turn so that all agree with the first.
    enum class Way : std::uint8_t { kUnknown, kStays, kTurns };
    std::vector<Way> ways(triangles.size(), Way::kUnknown);
    std::vector<std::uint32_t> sheet;
    bool turned = false;
    for (std::uint32_t first = 0; first < triangles.size(); ++first) {
        if (ways[first] != Way::kUnknown) continue;
        ways[first] = Way::kStays;
        sheet.assign(1, first);
        std::size_t turns = 0;
        bool has_sides = true;
        for (std::size_t i = 0; i < sheet.size(); ++i)
            for (std::uint32_t k = 0; k < 3; ++k) {
                const Beside other = beside[3 * std::size_t{sheet[i]} + k];
                if (other.triangle == Beside::kNone) continue;
                const Way way =
                    (ways[sheet[i]] == Way::kTurns) != (other.same == 1) ? Way::kTurns : Way::kStays;
                if (ways[other.triangle] == Way::kUnknown) {
                    ways[other.triangle] = way;
                    turns += way == Way::kTurns;
                    sheet.push_back(other.triangle);
                }
                has_sides &= ways[other.triangle] == way;
            }
        // A sheet with one side stays as it is; else the fewer turn.
        if (!has_sides || turns == 0) continue;
        const Way fewer = 2 * turns > sheet.size() ? Way::kStays : Way::kTurns;
        for (const std::uint32_t t : sheet) {
            if (ways[t] != fewer) continue;
            if (tags_.empty()) tags_.assign(triangles.size(), tag_of({1}));
            std::swap(triangles[t][1], triangles[t][2]);
            Counts counts = counts_[tags_[t]];
            std::rotate(counts.begin(), counts.begin() + 3, counts.end());
            tags_[t] = tag_of(counts);
            turned = true;
        }
    }
    return turned;
}

void TriangleCopies::expand(ProgressiveMesh& mesh) const {
    // Where the copies of each triangle end.
    std::vector<std::uint32_t> ends(mesh.triangles.size());
    std::uint32_t end = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Counts& counts = counts_[mesh.groups[t]];
        ends[t] = end = std::accumulate(counts.begin(), counts.end(), end);
    }
    const auto end_of = [&](std::uint32_t count) { return count == 0 ? 0 : ends[count - 1]; };
    const auto visit = [&](std::uint32_t t, const auto& of_copy) {
        const Counts& counts = counts_[mesh.groups[t]];
        std::uint32_t copy = end_of(t);
        for (std::size_t order = 0; order < counts.size(); ++order)
            for (std::uint32_t i = 0; i < counts[order]; ++i) of_copy(copy++, kOrders[order]);
    };
    std::vector<CornerChange> changes;
    std::uint32_t from = 0;
    for (Split& split : mesh.splits) {
        const std::size_t first = changes.size();
        for (; from < split.corners_end; ++from) {
            const CornerChange change = mesh.corner_changes[from];
            visit(change.corner / 3, [&](std::uint32_t copy, const std::array<std::uint8_t, 3>& order) {
                for (std::uint32_t k = 0; k < 3; ++k)
                    if (order[k] == change.corner % 3) changes.push_back({3 * copy + k, change.vertex});
            });
        }
        std::sort(changes.begin() + std::ptrdiff_t(first), changes.end(),
                  [](const CornerChange& a, const CornerChange& b) { return a.corner < b.corner; });
        split.corners_end = std::uint32_t(changes.size());
        split.triangles_end = end_of(split.triangles_end);
    }
    mesh.corner_changes = std::move(changes);
    mesh.base_triangles = end_of(mesh.base_triangles);
    std::vector<Triangle> triangles(end);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        visit(t, [&](std::uint32_t copy, const std::array<std::uint8_t, 3>& order) {
            for (std::size_t k = 0; k < 3; ++k) triangles[copy][k] = mesh.triangles[t][order[k]];
        });
    mesh.triangles = std::move(triangles);
    mesh.groups.clear();
}

}  // namespace vsplit::bake
