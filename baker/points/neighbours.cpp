// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "points/neighbours.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace vsplit::bake {
namespace {

constexpr std::uint32_t kLeaf = 12;

double along(const Vec3& p, int axis) {
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

}  // namespace

Neighbours::Neighbours(std::span<const Vec3> points) : order_(points.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    if (points.empty()) return;
    nodes_.reserve(points.size() / 3 + 8);
    build(points, 0, static_cast<std::uint32_t>(points.size()));
    sorted_.reserve(points.size());
    for (const std::uint32_t i : order_) sorted_.push_back(points[i]);
}

std::uint32_t Neighbours::build(std::span<const Vec3> points, std::uint32_t first, std::uint32_t last) {
    const auto self = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({0, first, last - first, 0});
    if (last - first <= kLeaf) return self;
    Vec3 low = points[order_[first]], high = low;
    for (std::uint32_t i = first; i < last; ++i) {
        const Vec3& p = points[order_[i]];
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Vec3 side = high - low;
    const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
    const std::uint32_t middle = first + (last - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double x = along(points[a], axis), y = along(points[b], axis);
                         return x != y ? x < y : a < b;
                     });
    const double split = along(points[order_[middle]], axis);
    build(points, first, middle);
    const std::uint32_t second = build(points, middle, last);
    nodes_[self] = {split, second, 0, static_cast<std::uint8_t>(axis)};
    return self;
}

void Neighbours::nearest(Vec3 place, std::size_t k, std::vector<Found>& found, std::uint32_t skip) const {
    found.clear();
    if (nodes_.empty() || k == 0) return;
    // The k best so far, sorted: insertion beats a heap for the few dozen that are ever asked for.
    struct Visit {
        std::uint32_t node;
        double squared;
        Vec3 offset;  // to the node's box, by axis
    };
    std::array<Visit, 64> stack;
    std::size_t depth = 0;
    stack[depth++] = {0, 0, {}};
    while (depth > 0) {
        Visit visit = stack[--depth];
        if (found.size() == k && visit.squared > found.back().squared_distance) continue;
        while (nodes_[visit.node].count == 0) {
            const Node& node = nodes_[visit.node];
            const double d = along(place, node.axis) - node.split;
            const std::uint32_t near = d < 0 ? visit.node + 1 : node.first,
                                far = d < 0 ? node.first : visit.node + 1;
            Vec3 offset = visit.offset;
            (node.axis == 0 ? offset.x : node.axis == 1 ? offset.y : offset.z) = d;
            const double squared = squared_length(offset);
            if (found.size() < k || squared <= found.back().squared_distance)
                stack[depth++] = {far, squared, offset};
            visit.node = near;
        }
        const Node& leaf = nodes_[visit.node];
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
            const Found candidate{squared_length(sorted_[i] - place), order_[i]};
            if (candidate.index == skip || (found.size() == k && !(candidate < found.back()))) continue;
            if (found.size() == k) found.pop_back();
            auto at = found.end();
            while (at != found.begin() && candidate < *(at - 1)) --at;
            found.insert(at, candidate);
        }
    }
}

}  // namespace vsplit::bake
