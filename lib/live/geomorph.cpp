// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "vsplit/geomorph.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

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

void Geomorph::turn(const LiveBuffers& to) {
    const auto places = to.positions();
    if (to.level() >= level_) {
        to_.assign(places.begin(), places.end());
        descend(from_, to.parents(), to_.size(), to_);
        triangles_.assign(to.triangles().begin(), to.triangles().end());
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

std::vector<double> share_triangles(std::span<const BudgetItem> items, std::uint64_t triangles) {
    const auto error_for = [](const BudgetItem& item, double pixels) {
        return item.pixels_a_unit > 0 ? pixels / item.pixels_a_unit : std::numeric_limits<double>::max();
    };
    // Triangles after the block that brings a mesh within its error.
    const auto count = [&](double pixels) {
        std::uint64_t sum = 0;
        for (const BudgetItem& item : items) {
            const double error = error_for(item, pixels);
            const auto& blocks = item.info->blocks;
            if (double(item.info->base_error) <= error) {
                sum += item.info->base_triangles;
                continue;
            }
            const auto at = std::partition_point(blocks.begin(), blocks.end(),
                                                 [&](const BlockInfo& b) { return double(b.error) > error; });
            sum += at == blocks.end() ? item.info->triangles : at->triangles_end;
        }
        return sum;
    };
    double fine = 0, coarse = 1;
    for (const BudgetItem& item : items)
        coarse = std::max(coarse, double(item.info->base_error) * std::max(item.pixels_a_unit, 0.0));
    if (std::isinf(coarse)) coarse = std::numeric_limits<double>::max() / 4;
    if (count(0) <= triangles)
        coarse = 0;
    else
        for (int i = 0; i < 60; ++i) {
            const double middle = fine + (coarse - fine) / 2;
            (count(middle) <= triangles ? coarse : fine) = middle;
        }
    std::vector<double> out;
    for (const BudgetItem& item : items) out.push_back(error_for(item, coarse));
    return out;
}

}  // namespace vsplit
