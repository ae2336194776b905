// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "live_stars.hpp"

#include <algorithm>
#include <bit>

#include "fixed_point.hpp"

namespace vsplit {

void LiveStars::reserve(std::size_t vertex_count, std::size_t triangle_count) {
    vertices.reserve(vertex_count);
    triangles.reserve(triangle_count);
    slots_.reserve(8 * vertex_count);
}

void LiveStars::make_room(LiveVertex& vertex, std::uint32_t corners) {
    constexpr std::uint32_t kLeastRoom = 8;
    if (corners <= vertex.room) return;
    const std::uint32_t room = std::max(kLeastRoom, std::bit_ceil(corners));
    auto& list = free_[static_cast<std::size_t>(std::countr_zero(room))];
    std::uint32_t slots = static_cast<std::uint32_t>(slots_.size());
    if (!list.empty()) {
        slots = list.back();
        list.pop_back();
    } else {
        slots_.resize(slots_.size() + room);
    }
    if (vertex.room > 0) {
        std::copy_n(slots_.begin() + vertex.slots, vertex.star, slots_.begin() + slots);
        free_[static_cast<std::size_t>(std::countr_zero(vertex.room))].push_back(vertex.slots);
    }
    vertex.slots = slots;
    vertex.room = room;
}

void LiveStars::add_vertex(const Lattice3& at) {
    LiveVertex vertex;
    vertex.at = at;
    vertex.twin = vertex_count();
    vertices.push_back(vertex);
}

void LiveStars::add_triangle(const Triangle& corners) {
    const auto first = static_cast<std::uint32_t>(3 * triangles.size());
    triangles.push_back(corners);
    for (std::uint32_t k = 0; k < 3; ++k) {
        LiveVertex& vertex = vertices[corners[k]];
        make_room(vertex, vertex.star + 1);
        slots_[vertex.slots + vertex.star++] = first + k;
    }
    weigh(first / 3, 1);
}

void LiveStars::relink(std::uint32_t vertex, std::span<const std::uint32_t> corners) {
    LiveVertex& v = vertices[vertex];
    const auto count = static_cast<std::uint32_t>(corners.size());
    v.star = std::min(v.star, count);
    make_room(v, count);
    std::copy_n(corners.begin(), count, slots_.begin() + v.slots);
    v.star = count;
}

void LiveStars::weigh(std::uint32_t triangle, int sign) {
    const Triangle& t = triangles[triangle];
    LiveVertex &a = vertices[t[0]], &b = vertices[t[1]], &c = vertices[t[2]];
    for (std::size_t i = 0; i < 3; ++i) {
        a.ring[i] += static_cast<std::uint32_t>(sign * (b.at[i] + c.at[i]));
        b.ring[i] += static_cast<std::uint32_t>(sign * (a.at[i] + c.at[i]));
        c.ring[i] += static_cast<std::uint32_t>(sign * (a.at[i] + b.at[i]));
    }
}

void LiveStars::gather_corners(std::uint32_t vertex, std::vector<std::uint32_t>& out) const {
    const auto list = corners(vertex);
    out.assign(list.begin(), list.end());
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
    // Forward from any triangle to the end, or round. Lists are mostly in the fan's order, so look next door
    // first.
    std::array<std::uint32_t, Star::kLargestFan> order;
    const auto successor = [&](std::uint32_t i) {
        const std::uint32_t end = to[i], next = i + 1 == n ? 0 : i + 1;
        if (from[next] == end) return next;
        std::uint32_t j = 0;
        while (j < n && from[j] != end) ++j;
        return j;
    };
    std::uint32_t start = 0, count = 1;
    for (std::uint32_t at = 0; count <= n; ++count) {
        at = successor(at);
        if (at == 0 || at == n) {
            star.closed = at == 0;
            break;
        }
    }
    if (count > n || (star.closed && count != n)) return irregular();
    if (star.closed) {
        for (std::uint32_t i = 1; i < n; ++i)
            if (from[i] < from[start]) start = i;
    } else {
        // And back to where it begins.
        for (std::uint32_t steps = 0; steps < n; ++steps) {
            std::uint32_t j = 0;
            while (j < n && to[j] != from[start]) ++j;
            if (j == n) break;
            start = j;
        }
    }
    std::uint32_t at = start;
    for (std::uint32_t i = 0; i < n; ++i) {
        order[i] = at;
        star.ring[i] = from[at];
        star.sector[i] = star.corners[at] / 3;
        if (i + 1 == n) break;
        at = successor(at);
        if (at == n || at == start) return irregular();
    }
    star.ring[n] = to[at];
    // Every triangle once, and every vertex of the ring once.
    std::uint64_t seen = 0, filter = 0;
    std::uint32_t meets = 0;
    const std::uint32_t edge = star.ring[n];
    for (std::uint32_t i = 0; i < n; ++i) {
        seen |= std::uint64_t{1} << order[i];
        filter |= std::uint64_t{1} << (from[i] % 64);
        meets += from[i] == edge;
    }
    if (std::popcount(seen) != static_cast<int>(n) || meets != (star.closed ? 1u : 0u)) return irregular();
    if (std::popcount(filter) != static_cast<int>(n))
        for (std::uint32_t i = 0; i < n; ++i)
            for (std::uint32_t j = 0; j < i; ++j)
                if (from[i] == from[j]) return irregular();
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
        out[i] = static_cast<std::int32_t>(16 * std::int64_t{v.at[i]} -
                                           mean16(static_cast<std::int32_t>(v.ring[i]), 2 * v.star));
    return out;
}

}  // namespace vsplit
