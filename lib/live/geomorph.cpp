// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "vsplit/geomorph.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace vsplit {
namespace {

/// Places of the finer level's vertices in the coarser one, of which `coarse` are alive there.
void descend(std::vector<Float3>& places, std::span<const std::uint32_t> parents, std::size_t fine,
             std::span<const Float3> own) {
    for (std::size_t v = places.size(); v < fine; ++v) {
        const std::uint32_t parent = parents[v];
        // A component that comes back has no ancestor: it stands still.
        places.push_back(parent == kNoVertex ? own[v] : places[parent]);
    }
}

}  // namespace

Geomorph::Geomorph(const LiveBuffers& from)
    : level_(from.level()),
      from_(from.positions().begin(), from.positions().end()),
      to_(from_),
      triangles_(from.triangles().begin(), from.triangles().end()) {}

void Geomorph::turn(const LiveBuffers& to, double t) {
    const auto places = to.positions();
    blend(t);
    std::swap(from_, mixed_);
    if (to.level() >= level_) {
        to_.assign(places.begin(), places.end());
        descend(from_, to.parents(), to_.size(), to_);
        triangles_.assign(to.triangles().begin(), to.triangles().end());
        level_ = to.level();
    } else {
        to_.assign(places.begin(), places.end());
        // Parents of vertices that are not alive any more are still known.
        descend(to_, to.all_parents(), from_.size(), from_);
    }
}

std::span<const Float3> Geomorph::blend(double t) {
    t = std::clamp(t, 0.0, 1.0);
    mixed_.resize(from_.size());
    const auto mix = [t](float a, float b) { return float(double(a) + (double(b) - double(a)) * t); };
    for (std::size_t v = 0; v < mixed_.size(); ++v)
        mixed_[v] =
            t == 1 ? to_[v]
                   : Float3{mix(from_[v].x, to_[v].x), mix(from_[v].y, to_[v].y), mix(from_[v].z, to_[v].z)};
    return mixed_;
}

namespace {

/// The smallest error on the screen from `pixels` on, the same for all, at which the sum of costs is within
/// `budget`.
/// `cost` is what an item takes: after a block, or (null) for its base mesh alone.
template <class Cost>
std::vector<double> share(std::span<const BudgetItem> items, std::uint64_t budget, double pixels, Cost cost) {
    const auto error_for = [](const BudgetItem& item, double on_screen) {
        return item.pixels_a_unit > 0 ? on_screen / item.pixels_a_unit : std::numeric_limits<double>::max();
    };
    const auto sum_at = [&](double on_screen) {
        std::uint64_t sum = 0;
        for (const BudgetItem& item : items) {
            const double error = error_for(item, on_screen);
            const auto& blocks = item.info->blocks;
            if (double(item.info->base_error) <= error || blocks.empty()) {
                sum += cost(*item.info, nullptr);
                continue;
            }
            // The block that brings it within its error.
            const auto at = std::partition_point(blocks.begin(), blocks.end(),
                                                 [&](const BlockInfo& b) { return double(b.error) > error; });
            sum += cost(*item.info, at == blocks.end() ? &blocks.back() : &*at);
        }
        return sum;
    };
    double fine = pixels > 0 ? pixels : 0, coarse = std::max(fine, 1.0);
    for (const BudgetItem& item : items)
        coarse = std::max(coarse, double(item.info->base_error) * std::max(item.pixels_a_unit, 0.0));
    if (std::isinf(coarse)) coarse = std::numeric_limits<double>::max() / 4;
    if (sum_at(fine) <= budget)
        coarse = fine;
    else
        for (int i = 0; i < 60; ++i) {
            const double middle = fine + (coarse - fine) / 2;
            (sum_at(middle) <= budget ? coarse : fine) = middle;
        }
    std::vector<double> out;
    for (const BudgetItem& item : items) out.push_back(error_for(item, coarse));
    return out;
}

}  // namespace

std::vector<double> share_triangles(std::span<const BudgetItem> items, std::uint64_t triangles,
                                    double pixels) {
    return share(items, triangles, pixels, [](const FileInfo& info, const BlockInfo* block) -> std::uint64_t {
        return block ? block->triangles_end : info.base_triangles;
    });
}

std::vector<double> share_bytes(std::span<const BudgetItem> items, std::uint64_t bytes, double pixels) {
    return share(items, bytes, pixels, [](const FileInfo& info, const BlockInfo* block) {
        return block ? block->offset + block->bytes : info.data_offset;
    });
}

}  // namespace vsplit
