// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "live_stars.hpp"

#include <algorithm>
#include <bit>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "fixed_point.hpp"
#include "large_pages.hpp"

namespace vsplit {

void LiveStars::reserve(std::size_t vertex_count, std::size_t triangle_count) {
    reserve_large(vertices, vertex_count);
    reserve_large(triangles, triangle_count);
    reserve_large(lines_, vertex_count);
}

LiveStars::Slot* LiveStars::grow(std::uint32_t vertex, std::uint32_t slots) {
    LiveVertex& v = vertices[vertex];
    const auto power = static_cast<std::uint8_t>(std::countr_zero(std::bit_ceil(slots) / kLine));
    auto& list = free_[power];
    auto more = static_cast<std::uint32_t>(more_.size());
    if (!list.empty()) {
        more = list.back();
        list.pop_back();
    } else {
        more_.resize(more_.size() + (std::size_t{1} << power));
    }
    std::copy_n(this->list(vertex), v.slots(), more_[more].slot.data());
    if (v.power > 0) free_[v.power].push_back(v.more);
    v.more = more;
    v.power = power;
    return more_[more].slot.data();
}

void LiveStars::add_vertex(const Lattice3& at) {
    LiveVertex vertex;
    vertex.at = at;
    vertex.twin = vertex_count();
    vertices.push_back(vertex);
    lines_.emplace_back();
}

void LiveStars::forget(std::uint32_t vertex) {
    vertices[vertex].shape = LiveVertex::Shape::kUnknown;
}

void LiveStars::add_triangle(const Triangle& corners) {
    const auto first = static_cast<std::uint32_t>(3 * triangles.size());
    triangles.push_back(corners);
    for (std::uint32_t k = 0; k < 3; ++k) {
        forget(corners[k]);
        LiveVertex& vertex = vertices[corners[k]];
        make_room(corners[k], vertex.star + 1)[vertex.star].corner = first + k;
        ++vertex.star;
    }
    weigh(first / 3, 1);
}

void LiveStars::relink(std::uint32_t vertex, std::span<const std::uint32_t> corners) {
    LiveVertex& v = vertices[vertex];
    const auto count = static_cast<std::uint32_t>(corners.size());
    v.star = 0;
    forget(vertex);
    Slot* slot = make_room(vertex, count);
    for (const std::uint32_t corner : corners) (slot++)->corner = corner;
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
    const Slot* slot = list(vertex);
    out.resize(vertices[vertex].star);
    for (std::uint32_t& corner : out) corner = (slot++)->corner;
}

void LiveStars::gather(std::uint32_t vertex, Star& star) {
    if (vertices[vertex].shape == LiveVertex::Shape::kUnknown) order(vertex);
    const LiveVertex& v = vertices[vertex];
    star.centre = vertex;
    star.fan = v.is_fan();
    star.closed = v.shape == LiveVertex::Shape::kClosed;
    star.size = v.star;
    if (!star.fan) {
        gather_corners(vertex, star.corners);
        std::sort(star.corners.begin(), star.corners.end());
        return;
    }
    const std::uint32_t count = v.slots();
    const Slot* const slot = list(vertex);
    // A closed ring begins at its least vertex.
    std::uint32_t first = 0;
    if (star.closed) {
        std::uint32_t least = slot[0].vertex;
        for (std::uint32_t i = 1; i < count; ++i) {
            first = slot[i].vertex < least ? i : first;
            least = std::min(least, slot[i].vertex);
        }
    }
    if (v.power == 0) {
        // Whole lines, whatever is in use of them: copies of a known length need no loop.
        std::array<std::uint32_t, kLine> ring, corner;
        for (std::uint32_t i = 0; i < kLine; ++i) ring[i] = slot[i].vertex, corner[i] = slot[i].corner;
        std::array<std::uint32_t, 2 * kLine> rings{}, corners{};
        for (const std::uint32_t to : {0u, count}) {
            std::copy_n(ring.data(), kLine, rings.data() + to);
            std::copy_n(corner.data(), kLine, corners.data() + to);
        }
        for (const std::uint32_t to : {0u, count}) {
            std::copy_n(rings.data() + first, kLine, star.ring.data() + to);
            std::copy_n(corners.data() + first, kLine, star.corner.data() + to);
        }
        return;
    }
    for (std::uint32_t i = 0, from = first; i < count; ++i, from = from + 1 == count ? 0 : from + 1)
        star.ring[i] = slot[from].vertex, star.corner[i] = slot[from].corner;
    if (!star.closed) return;
    std::copy_n(star.ring.data(), count, star.ring.data() + count);
    std::copy_n(star.corner.data(), count, star.corner.data() + count);
}

void LiveStars::order(std::uint32_t vertex) {
    LiveVertex& v = vertices[vertex];
    const std::uint32_t n = v.star;
    v.shape = LiveVertex::Shape::kOther;
    if (n == 0 || n > Star::kLargestFan) return;
    Slot* const slot = list(vertex);
    std::array<std::uint32_t, Star::kLargestFan> from, to;
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t t = slot[i].corner / 3, k = slot[i].corner - 3 * t;
        const Triangle& c = triangles[t];
        from[i] = c[k == 2 ? 0 : k + 1];
        to[i] = c[k == 0 ? 2 : k - 1];
    }
    // Forward from any triangle to the end, or round.
    const auto successor = [&](std::uint32_t i) {
        std::uint32_t j = 0;
        while (j < n && from[j] != to[i]) ++j;
        return j;
    };
    std::uint32_t start = 0, count = 1;
    bool closed = false;
    for (std::uint32_t at = 0; count <= n; ++count) {
        at = successor(at);
        if (at == 0 || at == n) {
            closed = at == 0;
            break;
        }
    }
    if (count > n || (closed && count != n)) return;
    // And back to where it begins.
    for (std::uint32_t steps = 0; !closed && steps < n; ++steps) {
        std::uint32_t j = 0;
        while (j < n && to[j] != from[start]) ++j;
        if (j == n) break;
        start = j;
    }
    std::array<Slot, Star::kLargestFan + 1> row;
    std::uint32_t at = start;
    for (std::uint32_t i = 0; i < n; ++i) {
        row[i] = {from[at], slot[at].corner};
        if (i + 1 == n) break;
        at = successor(at);
        if (at == n || at == start) return;
    }
    row[n] = {to[at], kNoVertex};
    // Every triangle once, and every vertex of the ring once.
    for (std::uint32_t i = 0; i < n; ++i) {
        if (!closed && row[i].vertex == row[n].vertex) return;
        for (std::uint32_t j = 0; j < i; ++j)
            if (row[i].vertex == row[j].vertex) return;
    }
    std::copy_n(row.data(), closed ? n : n + 1, make_room(vertex, n + 1));
    set_fan(v, n, closed);
}

void LiveStars::set_fan(LiveVertex& vertex, std::uint32_t triangles, bool closed) {
    vertex.star = triangles;
    vertex.shape = triangles > Star::kLargestFan ? LiveVertex::Shape::kOther
                   : closed                      ? LiveVertex::Shape::kClosed
                                                 : LiveVertex::Shape::kOpen;
}

std::uint32_t LiveStars::find(const Slot* slot, const LiveVertex& v, std::uint32_t vertex) {
#if defined(__SSE2__)
    if (v.power == 0) {
        const auto* const line = reinterpret_cast<const float*>(slot);
        const __m128i wanted = _mm_set1_epi32(static_cast<int>(vertex));
        const auto equal = [&](std::size_t four) {
            const __m128 low = _mm_loadu_ps(line + 8 * four), high = _mm_loadu_ps(line + 8 * four + 4);
            return _mm_cmpeq_epi32(_mm_castps_si128(_mm_shuffle_ps(low, high, 0x88)), wanted);
        };
        const int found = _mm_movemask_epi8(_mm_packs_epi32(equal(0), equal(1)));
        return static_cast<std::uint32_t>(std::countr_zero(static_cast<unsigned>(found))) / 2;
    }
#endif
    std::uint32_t at = 0;
    while (slot[at].vertex != vertex) ++at;
    return at;
}

void LiveStars::shift(Slot* slot, const LiveVertex& v, std::uint32_t at) {
    if (v.power > 0) {
        std::copy_backward(slot + at, slot + v.slots(), slot + v.slots() + 1);
        return;
    }
#if defined(__SSE2__)
    // Two slots at a time: those from `at` on come from one place before.
    static_assert(sizeof(Slot) == 8 && kLine == 8);
    auto* const pair = reinterpret_cast<__m128i*>(slot);
    const auto* const before = reinterpret_cast<const char*>(slot) - sizeof(Slot);
    const __m128i place = _mm_set1_epi32(static_cast<int>(at));
    __m128i stays[4], goes[4];
    for (int i = 0; i < 4; ++i) stays[i] = _mm_load_si128(pair + i);
    goes[0] = _mm_slli_si128(stays[0], 8);
    for (int i = 1; i < 4; ++i) goes[i] = _mm_loadu_si128(reinterpret_cast<const __m128i*>(before + 16 * i));
    for (int i = 0; i < 4; ++i) {
        const __m128i later = _mm_cmpgt_epi32(_mm_set_epi32(2 * i + 1, 2 * i + 1, 2 * i, 2 * i), place);
        _mm_store_si128(pair + i,
                        _mm_or_si128(_mm_and_si128(later, goes[i]), _mm_andnot_si128(later, stays[i])));
    }
#else
    for (std::uint32_t i = kLine - 1; i > at; --i) slot[i] = slot[i - 1];
#endif
}

void LiveStars::replace(std::uint32_t vertex, std::uint32_t parent, std::uint32_t child) {
    const LiveVertex& v = vertices[vertex];
    if (!v.is_fan()) return;
    Slot* const slot = list(vertex);
    slot[find(slot, v, parent)].vertex = child;
}

void LiveStars::insert(std::uint32_t vertex, std::uint32_t parent, std::uint32_t child, std::uint32_t corner,
                       bool after) {
    LiveVertex& v = vertices[vertex];
    Slot* const slot = make_room(vertex, v.slots() + 1);
    if (!v.is_fan()) {
        v.shape = LiveVertex::Shape::kUnknown;
        slot[v.star++].corner = corner;
        return;
    }
    const std::uint32_t parents = find(slot, v, parent), at = parents + std::uint32_t{after};
    const std::uint32_t beyond = after ? slot[parents].corner : corner;
    shift(slot, v, at);
    slot[at] = {child, beyond};
    if (after) slot[parents].corner = corner;
    if (++v.star > Star::kLargestFan) v.shape = LiveVertex::Shape::kOther;
}

void LiveStars::split(const Star& star, const Cut& cut, const Lattice3& parent_at, const Lattice3& child_at,
                      std::uint32_t sweep) {
    const std::uint32_t p = star.centre, child = vertex_count(), n = star.size, ring = star.ring_size(),
                        begin = cut.begin, length = cut.length, end = begin + length;
    const std::uint32_t first_at = star.ring[begin], last_at = star.ring[end];
    // New triangles: (child, last, parent), then (child, parent, first).
    const auto last_corner = static_cast<std::uint32_t>(3 * triangles.size()),
               first_corner = last_corner + (cut.last_wing ? 3 : 0);
    const Lattice3 was = vertices[p].at;
    add_vertex(child_at);
    vertices[p].at = parent_at;
    if (cut.last_wing) triangles.push_back({child, last_at, p});
    if (cut.first_wing) triangles.push_back({child, p, first_at});
    std::uint32_t* const corners = triangles.data()->data();

    // The child's row, and what the run adds to the sums around it.
    const bool closed = cut.first_wing && cut.last_wing;
    std::array<std::uint32_t, 3> run{};
    const auto add = [](std::array<std::uint32_t, 3>& sum, const Lattice3& at) {
        for (std::size_t k = 0; k < 3; ++k) sum[k] += static_cast<std::uint32_t>(at[k]);
    };
    Slot* to = make_room(child, length + 2);
    if (cut.first_wing && !closed) *to++ = {p, first_corner};
    for (std::uint32_t i = begin; i < end; ++i) {
        corners[star.corner[i]] = child;
        *to++ = {star.ring[i], star.corner[i]};
        add(run, vertices[star.ring[i]].at);
        add(run, vertices[star.ring[i + 1]].at);
    }
    *to++ = {last_at, cut.last_wing ? last_corner : kNoVertex};
    if (cut.last_wing) *to++ = {p, cut.first_wing ? first_corner : kNoVertex};
    LiveVertex& born = vertices[child];
    set_fan(born, length + std::uint32_t{cut.first_wing} + std::uint32_t{cut.last_wing}, closed);
    born.ring = run;

    // The parent's.
    const std::uint32_t kept = n - length + std::uint32_t{cut.first_wing} + std::uint32_t{cut.last_wing};
    to = make_room(p, kept + 1);
    if (star.closed) {
        *to++ = {child, last_corner + 2};
        for (std::uint32_t i = end; i < begin + n; ++i) *to++ = {star.ring[i], star.corner[i]};
        *to++ = {first_at, first_corner + 1};
    } else {
        if (cut.first_wing) {
            for (std::uint32_t i = 0; i < begin; ++i) *to++ = {star.ring[i], star.corner[i]};
            *to++ = {first_at, first_corner + 1};
        }
        *to++ = {child, cut.last_wing ? last_corner + 2 : kNoVertex};
        if (cut.last_wing) {
            for (std::uint32_t i = end; i < n; ++i) *to++ = {star.ring[i], star.corner[i]};
            *to++ = {star.ring[n], kNoVertex};
        }
    }
    LiveVertex& parent = vertices[p];
    set_fan(parent, kept, star.closed);
    parent.touch(sweep);
    parent.locked += std::uint32_t{cut.first_wing} + std::uint32_t{cut.last_wing};
    born.touched = sweep;
    parent.acted = born.acted = sweep;
    for (std::size_t k = 0; k < 3; ++k) parent.ring[k] -= run[k];
    for (int i = 0; i < 2; ++i) {
        if (!(i == 0 ? cut.last_wing : cut.first_wing)) continue;
        const Lattice3& wing = vertices[i == 0 ? last_at : first_at].at;
        add(born.ring, wing);
        add(born.ring, parent_at);
        add(parent.ring, wing);
        add(parent.ring, child_at);
    }

    // And what their neighbours see: by how much the centre of each sector moves, and the new triangles.
    std::array<std::uint32_t, 3> stays, goes, both;
    for (std::size_t k = 0; k < 3; ++k) {
        stays[k] = static_cast<std::uint32_t>(parent_at[k] - was[k]);
        goes[k] = static_cast<std::uint32_t>(child_at[k] - parent_at[k]);
        both[k] = static_cast<std::uint32_t>(parent_at[k] + child_at[k]);
    }
    const bool moves = (stays[0] | stays[1] | stays[2]) != 0;
    for (std::uint32_t i = 0; i < ring; ++i) {
        LiveVertex& here = vertices[star.ring[i]];
        here.touch(sweep);
        if (!moves) continue;
        const std::uint32_t sectors = !star.closed && (i == 0 || i == n) ? 1 : 2;
        for (std::size_t k = 0; k < 3; ++k) here.ring[k] += sectors * stays[k];
    }
    for (std::uint32_t i = begin; i <= end; ++i) {
        const std::uint32_t w = star.ring[i];
        LiveVertex& here = vertices[w];
        const std::uint32_t sectors = std::uint32_t{i > begin} + std::uint32_t{i < end};
        for (std::size_t k = 0; k < 3; ++k) here.ring[k] += sectors * goes[k];
        const bool first = i == begin && cut.first_wing, last = i == end && cut.last_wing;
        here.locked += sectors + std::uint32_t{first} + std::uint32_t{last};
        if (first || last) {
            insert(w, p, child, first ? first_corner + 2 : last_corner + 1, last);
            for (std::size_t k = 0; k < 3; ++k) here.ring[k] += both[k];
        } else {
            replace(w, p, child);
        }
    }
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
