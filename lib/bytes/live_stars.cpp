// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "live_stars.hpp"

#include <algorithm>

#include "fixed_point.hpp"

namespace vsplit {

void LiveStars::reserve(std::size_t vertex_count, std::size_t triangle_count) {
    vertices.reserve(vertex_count);
    triangles.reserve(triangle_count);
}

void LiveStars::add_vertex(const Lattice3& at) {
    LiveVertex vertex;
    vertex.at = at;
    vertex.twin = vertex_count();
    vertices.push_back(vertex);
}

void LiveStars::add_triangle(const Triangle& corners) {
    const auto first = static_cast<std::uint32_t>(3 * triangles.size());
    LiveTriangle& triangle = triangles.emplace_back(LiveTriangle{corners, {}});
    for (std::uint32_t k = 0; k < 3; ++k) {
        LiveVertex& vertex = vertices[corners[k]];
        triangle.next[k] = vertex.first_corner;
        vertex.first_corner = first + k;
        ++vertex.star;
    }
    weigh(first / 3, 1);
}

void LiveStars::relink(std::uint32_t vertex, std::span<const std::uint32_t> corners) {
    std::uint32_t next = kNoVertex;
    for (const std::uint32_t corner : corners) {
        triangles[corner / 3].next[corner % 3] = next;
        next = corner;
    }
    vertices[vertex].first_corner = next;
    vertices[vertex].star = static_cast<std::uint32_t>(corners.size());
}

void LiveStars::weigh(std::uint32_t triangle, int sign) {
    const Triangle& t = triangles[triangle];
    const Lattice3 a = vertices[t[0]].at, b = vertices[t[1]].at, c = vertices[t[2]].at;
    for (std::size_t i = 0; i < 3; ++i) {
        vertices[t[0]].ring[i] += std::int64_t{sign} * (b[i] + c[i]);
        vertices[t[1]].ring[i] += std::int64_t{sign} * (a[i] + c[i]);
        vertices[t[2]].ring[i] += std::int64_t{sign} * (a[i] + b[i]);
    }
}

void LiveStars::gather_corners(std::uint32_t vertex, std::vector<std::uint32_t>& corners) const {
    corners.clear();
    for (std::uint32_t c = vertices[vertex].first_corner; c != kNoVertex; c = triangles[c / 3].next[c % 3])
        corners.push_back(c);
}

void LiveStars::gather(std::uint32_t vertex, Star& star) const {
    star.centre = vertex;
    star.fan = false;
    gather_corners(vertex, star.corners);
    star.size = static_cast<std::uint32_t>(star.corners.size());
    const auto irregular = [&] { std::sort(star.corners.begin(), star.corners.end()); };
    if (star.size == 0 || star.size > Star::kLargestFan) return irregular();
    const std::uint32_t n = star.size;
    std::array<std::uint32_t, Star::kLargestFan> from, to;
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t corner = star.corners[i], t = corner / 3, k = corner - 3 * t;
        const Triangle& c = triangles[t];
        from[i] = c[k == 2 ? 0 : k + 1];
        to[i] = c[k == 0 ? 2 : k - 1];
        __builtin_prefetch(&vertices[from[i]]);
    }
    // Where does the fan begin: at the one edge that no other ends in, else at the least vertex of the ring.
    std::uint32_t start = n, least = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
        bool entered = false;
        for (std::uint32_t j = 0; j < n; ++j) {
            if (i != j && (from[i] == from[j] || to[i] == to[j])) return irregular();
            entered |= to[j] == from[i];
        }
        if (!entered) {
            if (start != n) return irregular();
            start = i;
        }
        if (from[i] < from[least]) least = i;
    }
    star.closed = start == n;
    std::uint32_t at = star.closed ? least : start;
    for (std::uint32_t i = 0; i < n; ++i) {
        star.ring[i] = from[at];
        star.sector[i] = star.corners[at] / 3;
        const std::uint32_t end = to[at];
        if (i + 1 == n) {
            star.ring[n] = end;
            break;
        }
        std::uint32_t j = 0;
        while (j < n && from[j] != end) ++j;
        if (j == n || j == (star.closed ? least : start)) return irregular();
        at = j;
    }
    star.fan = true;
}

void LiveStars::link_twins(std::uint32_t first) {
    const std::uint32_t count = vertex_count();
    if (count - first < 2) return;
    order_.resize(count - first);
    for (std::uint32_t i = 0; i < order_.size(); ++i) order_[i] = first + i;
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
        return vertices[a].at != vertices[b].at ? vertices[a].at < vertices[b].at : a < b;
    });
    for (std::size_t i = 0, end = 0; i < order_.size(); i = end) {
        for (end = i + 1; end < order_.size() && vertices[order_[end]].at == vertices[order_[i]].at; ++end)
            vertices[order_[end - 1]].twin = order_[end];
        vertices[order_[end - 1]].twin = order_[i];
    }
}

Lattice3 LiveStars::bump(std::uint32_t vertex) const {
    const LiveVertex& v = vertices[vertex];
    Lattice3 out{};
    if (v.star == 0 || v.star > 128) return out;
    for (std::size_t i = 0; i < 3; ++i)
        out[i] = static_cast<std::int32_t>(16 * std::int64_t{v.at[i]} - mean16(v.ring[i], 2 * v.star));
    return out;
}

}  // namespace vsplit
