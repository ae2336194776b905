// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "points/frame.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace vsplit::bake {
namespace {

constexpr int kHilbertBits = 21;

/// Place along the Hilbert curve (Skilling, "Programming the Hilbert curve", 2004).
std::uint64_t hilbert_key(std::array<std::uint32_t, 3> x) {
    for (std::uint32_t bit = 1u << (kHilbertBits - 1); bit > 1; bit >>= 1) {
        const std::uint32_t mask = bit - 1;
        for (std::size_t i = 0; i < 3; ++i) {
            if (x[i] & bit) {
                x[0] ^= mask;
            } else {
                const std::uint32_t t = (x[0] ^ x[i]) & mask;
                x[0] ^= t;
                x[i] ^= t;
            }
        }
    }
    x[1] ^= x[0];
    x[2] ^= x[1];
    std::uint32_t t = 0;
    for (std::uint32_t bit = 1u << (kHilbertBits - 1); bit > 1; bit >>= 1)
        if (x[2] & bit) t ^= bit - 1;
    for (std::uint32_t& v : x) v ^= t;
    std::uint64_t key = 0;
    for (int b = kHilbertBits - 1; b >= 0; --b)
        for (const std::uint32_t v : x) key = key << 1 | (v >> b & 1);
    return key;
}

std::vector<std::uint64_t> hilbert_keys(std::span<const Vec3> points) {
    std::vector<std::uint64_t> keys(points.size());
    if (points.empty()) return keys;
    Vec3 low = points[0], high = points[0];
    for (const Vec3& p : points) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const double side = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    const double scale = side > 0 ? ((1 << kHilbertBits) - 1) / side : 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 q = (points[i] - low) * scale;
        keys[i] = hilbert_key({std::uint32_t(q.x), std::uint32_t(q.y), std::uint32_t(q.z)});
    }
    return keys;
}

}  // namespace

Frame::Frame(std::span<const std::array<double, 3>> positions) {
    if (positions.empty()) return;
    std::array<double, 3> low = positions[0], high = positions[0];
    for (const auto& p : positions)
        for (std::size_t k = 0; k < 3; ++k)
            low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
    double side = 0;
    for (std::size_t k = 0; k < 3; ++k) side = std::max(side, high[k] / 2 - low[k] / 2);
    origin = {low[0] / 2 + high[0] / 2, low[1] / 2 + high[1] / 2, low[2] / 2 + high[2] / 2};
    // A power of two rounds nothing. Outside this range the points differ by less, or more, than can be told
    // apart.
    if (side > 0) scale = std::ldexp(1.0, -std::clamp(std::ilogb(side), -1000, 1000));
}

std::vector<Vec3> Frame::into(std::span<const std::array<double, 3>> positions) const {
    std::vector<Vec3> points;
    points.reserve(positions.size());
    // The origin is taken off at scale, as the difference of two huge coordinates may overflow.
    const Vec3 centre = origin * scale;
    const bool huge = scale < 1e-300;
    for (const auto& p : positions) {
        const Vec3 q{p[0], p[1], p[2]};
        points.push_back(huge ? q * scale - centre : (q - origin) * scale);
    }
    return points;
}

UniquePoints unique_points(std::span<const Vec3> given) {
    UniquePoints out;
    out.place.resize(given.size());
    const std::vector<std::uint64_t> keys = hilbert_keys(given);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(given.size());
    for (std::uint32_t i = 0; i < given.size(); ++i) order[i] = {keys[i], i};
    const auto coordinates = [&](const auto& entry) {
        const Vec3& p = given[entry.second];
        return std::tie(p.x, p.y, p.z);
    };
    std::sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
        if (a.first != b.first) return a.first < b.first;
        if (coordinates(a) != coordinates(b)) return coordinates(a) < coordinates(b);
        return a.second < b.second;
    });
    for (const auto& [key, i] : order) {
        if (out.points.empty() || !(out.points.back() == given[i])) {
            out.points.push_back(given[i]);
            out.first.push_back(i);
        }
        out.place[i] = static_cast<std::uint32_t>(out.points.size() - 1);
    }
    return out;
}

}  // namespace vsplit::bake
