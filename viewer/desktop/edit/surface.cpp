// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "surface.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <array>
#include <bit>
#include <limits>
#include <numbers>
#include <numeric>

#include "collapse/triangle_distance.hpp"

namespace vsplit::studio {
namespace {

Double3 at(const Float3& p) {
    return {double(p.x), double(p.y), double(p.z)};
}

}  // namespace

Surface::Surface(std::span<const Float3> positions, std::span<const Triangle> triangles, bool seams)
    : positions_(positions),
      triangles_(triangles),
      starts_(positions.size() + 1, 0),
      star_(3 * triangles.size()),
      seen_(positions.size(), 0) {
    for (const Triangle& t : triangles)
        for (const std::uint32_t v : t) ++starts_[v];
    std::uint32_t sum = 0;
    for (std::uint32_t& start : starts_) start = (sum += start);
    // From the back, so that each start ends where its vertex' list begins.
    for (std::size_t t = triangles.size(); t-- > 0;)
        for (const std::uint32_t v : triangles[t]) star_[--starts_[v]] = std::uint32_t(t);
    if (!seams) return;
    const auto key = [&](std::uint32_t v) {
        const Float3& p = positions_[v];
        return std::array{std::bit_cast<std::uint32_t>(p.x + 0.0f), std::bit_cast<std::uint32_t>(p.y + 0.0f),
                          std::bit_cast<std::uint32_t>(p.z + 0.0f)};
    };
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    next_twin_.resize(order.size());
    for (std::size_t i = 0, j = 0; i < order.size(); i = j) {
        while (j < order.size() && key(order[j]) == key(order[i])) ++j;
        for (std::size_t k = i; k < j; ++k) next_twin_[order[k]] = order[k + 1 < j ? k + 1 : i];
    }
}

std::vector<std::uint32_t> Surface::within(Double3 point, std::uint32_t triangle, double radius) {
    ++call_;
    std::vector<std::uint32_t> found;
    for (const std::uint32_t v : triangles_[triangle]) {
        seen_[v] = call_;
        found.push_back(v);
    }
    const double reach = radius * radius;
    const auto take = [&](std::uint32_t w) {
        if (seen_[w] == call_ || bake::length2(at(positions_[w]) - point) > reach) return;
        seen_[w] = call_;
        found.push_back(w);
    };
    for (std::size_t i = 0; i < found.size(); ++i) {
        for (const std::uint32_t t : star(found[i]))
            for (const std::uint32_t w : triangles_[t]) take(w);
        if (!next_twin_.empty()) take(next_twin_[found[i]]);
    }
    return found;
}

std::vector<std::uint32_t> Surface::component(std::uint32_t vertex) const {
    std::vector<char> seen(positions_.size(), 0);
    std::vector<std::uint32_t> found{vertex};
    seen[vertex] = 1;
    const auto take = [&](std::uint32_t w) {
        if (!seen[w]) found.push_back(w);
        seen[w] = 1;
    };
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (!next_twin_.empty()) take(next_twin_[found[i]]);
        for (const std::uint32_t t : star(found[i]))
            for (const std::uint32_t w : triangles_[t]) take(w);
    }
    return found;
}

std::vector<float> Surface::turns() const {
    std::vector<Double3> normals(triangles_.size());
    tbb::parallel_for(std::size_t{0}, triangles_.size(), [&](std::size_t i) {
        const Triangle& t = triangles_[i];
        const Double3 a = at(positions_[t[0]]), n = cross(at(positions_[t[1]]) - a, at(positions_[t[2]]) - a);
        const double size = bake::length(n);
        normals[i] = size > 0 ? n * (1 / size) : Double3{};
    });
    std::vector<float> degrees(positions_.size(), 0);
    tbb::parallel_for(std::size_t{0}, degrees.size(), [&](std::size_t v) {
        const auto around = star(std::uint32_t(v));
        if (around.size() > 64) return;
        double least = 1;
        for (std::size_t i = 0; i < around.size(); ++i)
            for (std::size_t j = i + 1; j < around.size(); ++j)
                least = std::min(least, dot(normals[around[i]], normals[around[j]]));
        degrees[v] = float(std::acos(std::clamp(least, -1.0, 1.0)) * 180 / std::numbers::pi);
    });
    return degrees;
}

std::vector<std::uint32_t> Surface::sharper_than(double degrees) const {
    const std::vector<float> all = turns();
    std::vector<std::uint32_t> found;
    for (std::uint32_t v = 0; v < all.size(); ++v)
        if (double(all[v]) > degrees) found.push_back(v);
    return found;
}

Double3 mirrored(Double3 point, const Box& box, int axis) {
    const Double3 c = box.centre();
    if (axis == 0) point.x = 2 * c.x - point.x;
    if (axis == 1) point.y = 2 * c.y - point.y;
    if (axis == 2) point.z = 2 * c.z - point.z;
    return point;
}

std::optional<Hit> nearest(std::span<const Float3> positions, std::span<const Triangle> triangles,
                           Double3 point, double reach) {
    using Found = std::pair<double, std::uint32_t>;
    const Found none{std::numeric_limits<double>::infinity(), 0};
    const Found found = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, triangles.size(), 8192), none,
        [&](const tbb::blocked_range<std::size_t>& range, Found best) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                const Triangle& t = triangles[i];
                best = std::min(
                    best, Found{bake::distance2_to_triangle(point, at(positions[t[0]]), at(positions[t[1]]),
                                                            at(positions[t[2]])),
                                std::uint32_t(i)});
            }
            return best;
        },
        [](const Found& a, const Found& b) { return std::min(a, b); });
    if (!(found.first <= reach * reach)) return std::nullopt;
    Hit hit;
    hit.triangle = found.second;
    hit.point = point;
    hit.distance = std::sqrt(found.first);
    hit.vertex = triangles[found.second][0];
    for (const std::uint32_t v : triangles[found.second])
        if (bake::length2(at(positions[v]) - point) < bake::length2(at(positions[hit.vertex]) - point))
            hit.vertex = v;
    return hit;
}

}  // namespace vsplit::studio
