// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "surface.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>

#include "collapse/triangle_tree.hpp"

namespace vsplit::studio {
namespace {

Double3 at(const Float3& p) {
    return {double(p.x), double(p.y), double(p.z)};
}

/// For each vertex the first one at the same place.
std::vector<std::uint32_t> by_place(std::span<const Float3> positions) {
    const auto key = [&](std::uint32_t v) {
        const Float3& p = positions[v];
        return std::array{std::bit_cast<std::uint32_t>(p.x + 0.0f), std::bit_cast<std::uint32_t>(p.y + 0.0f),
                          std::bit_cast<std::uint32_t>(p.z + 0.0f)};
    };
    std::vector<std::uint32_t> order(positions.size()), place(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto ka = key(a), kb = key(b);
        return ka != kb ? ka < kb : a < b;
    });
    for (std::size_t i = 0, first = 0; i < order.size(); ++i) {
        if (key(order[i]) != key(order[first])) first = i;
        place[order[i]] = order[first];
    }
    return place;
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
    const std::vector<std::uint32_t> place = by_place(positions);
    next_twin_.resize(positions.size());
    std::iota(next_twin_.begin(), next_twin_.end(), 0u);
    // Each is put in after the first at its place.
    for (std::uint32_t v = 0; v < place.size(); ++v)
        if (place[v] != v) std::swap(next_twin_[v], next_twin_[place[v]]);
}

Surface::~Surface() = default;

void Surface::prepare() {
    if (tree_ || triangles_.empty()) return;
    mesh_.positions.assign(positions_.begin(), positions_.end());
    mesh_.triangles.assign(triangles_.begin(), triangles_.end());
    tree_ = std::make_unique<bake::TriangleTree>(mesh_);
}

std::optional<Hit> Surface::pick(const Ray& ray) {
    prepare();
    if (!tree_) return std::nullopt;
    const bake::TriangleTree::Meeting met = tree_->first_met(ray.from, ray.direction);
    if (!std::isfinite(met.distance)) return std::nullopt;
    return hit_on(positions_, triangles_, met.triangle, ray.from + ray.direction * met.distance,
                  met.distance);
}

std::optional<Hit> Surface::nearest(Double3 point, double reach) {
    prepare();
    if (!tree_) return std::nullopt;
    const bake::TriangleTree::Hit found = tree_->closest(point);
    if (!(found.distance2 <= reach * reach)) return std::nullopt;
    return hit_on(positions_, triangles_, found.triangle, point, std::sqrt(found.distance2));
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

bool closed(std::span<const Float3> positions, std::span<const Triangle> triangles) {
    const std::vector<std::uint32_t> place = by_place(positions);
    std::vector<std::pair<std::uint64_t, int>> edges;
    edges.reserve(3 * triangles.size());
    double volume = 0;
    const Double3 origin = positions.empty() ? Double3{} : at(positions[0]);
    for (const Triangle& t : triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = place[t[k]], b = place[t[(k + 1) % 3]];
            if (a == b) continue;
            edges.push_back({std::uint64_t{std::min(a, b)} << 32 | std::max(a, b), a < b ? 1 : -1});
        }
        volume += dot(at(positions[t[0]]) - origin,
                      cross(at(positions[t[1]]) - origin, at(positions[t[2]]) - origin));
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size();) {
        int sum = 0;
        std::size_t j = i;
        for (; j < edges.size() && edges[j].first == edges[i].first; ++j) sum += edges[j].second;
        if (sum != 0) return false;
        i = j;
    }
    return volume > 0;
}

}  // namespace vsplit::studio
