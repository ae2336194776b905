// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/crust.hpp"

#include <algorithm>

namespace vsplit::bake {

std::vector<std::uint32_t> pair_edges(const Crust& crust) {
    const auto edges = static_cast<std::uint32_t>(crust.triangles.size() * 3);
    // Half-edges in buckets of their smaller vertex; a bucket holds some six edges and is searched straight.
    std::vector<std::uint32_t> starts(crust.points.size() + 1, 0);
    const auto low = [&](std::uint32_t h) { return std::min(edge_from(crust, h), edge_to(crust, h)); };
    const auto high = [&](std::uint32_t h) { return std::max(edge_from(crust, h), edge_to(crust, h)); };
    for (std::uint32_t h = 0; h < edges; ++h) ++starts[low(h) + 1];
    for (std::size_t v = 1; v < starts.size(); ++v) starts[v] += starts[v - 1];
    std::vector<std::uint32_t> bucket(edges), cursor(starts.begin(), starts.end() - 1);
    for (std::uint32_t h = 0; h < edges; ++h) bucket[cursor[low(h)]++] = h;
    std::vector<std::uint32_t> opposite(edges, kNoEdge);
    for (std::size_t v = 0; v + 1 < starts.size(); ++v) {
        const auto first = bucket.begin() + starts[v], last = bucket.begin() + starts[v + 1];
        std::sort(first, last, [&](std::uint32_t a, std::uint32_t b) {
            return high(a) != high(b) ? high(a) < high(b) : a < b;
        });
        for (auto h = first; h != last;) {
            auto end = h;
            while (end != last && high(*end) == high(*h)) ++end;
            if (end - h == 2 && edge_from(crust, h[0]) == edge_to(crust, h[1])) {
                opposite[h[0]] = h[1];
                opposite[h[1]] = h[0];
            }
            h = end;
        }
    }
    return opposite;
}

std::vector<std::uint32_t> leaving_edges(const Crust& crust, std::span<const std::uint32_t> opposite) {
    std::vector<std::uint32_t> leaving(crust.points.size(), kNoEdge);
    for (std::uint32_t h = 0; h < opposite.size(); ++h) {
        std::uint32_t& slot = leaving[edge_from(crust, h)];
        if (slot == kNoEdge || opposite[h] == kNoEdge) slot = h;
    }
    return leaving;
}

Pieces divide(const std::vector<Vec3>& points, const Triangle& corner,
              const std::array<std::uint32_t, 3>& middle, std::uint32_t centre) {
    Pieces pieces;
    const int count = int(middle[0] != kNoEdge) + int(middle[1] != kNoEdge) + int(middle[2] != kNoEdge);
    if (count == 0) {
        pieces.add(corner[0], corner[1], corner[2]);
    } else if (count == 1) {
        const std::size_t k = middle[0] != kNoEdge ? 0 : middle[1] != kNoEdge ? 1 : 2;
        const std::uint32_t a = corner[k], b = corner[(k + 1) % 3], c = corner[(k + 2) % 3];
        pieces.add(a, middle[k], c);
        pieces.add(middle[k], b, c);
    } else if (count == 2) {
        // a is the corner between the two divided edges.
        const std::size_t k = middle[1] == kNoEdge ? 0 : middle[2] == kNoEdge ? 1 : 2;
        const std::uint32_t a = corner[k], b = corner[(k + 1) % 3], c = corner[(k + 2) % 3];
        const std::uint32_t ab = middle[k], ca = middle[(k + 2) % 3];
        pieces.add(a, ab, ca);
        if (squared_length(points[ab] - points[c]) < squared_length(points[ca] - points[b])) {
            pieces.add(ab, b, c);
            pieces.add(ab, c, ca);
        } else {
            pieces.add(ab, b, ca);
            pieces.add(b, c, ca);
        }
    } else if (centre == kNoEdge) {
        for (std::size_t k = 0; k < 3; ++k) pieces.add(corner[k], middle[k], middle[(k + 2) % 3]);
        pieces.add(middle[0], middle[1], middle[2]);
    } else {
        for (std::size_t k = 0; k < 3; ++k) {
            pieces.add(corner[k], middle[k], centre);
            pieces.add(corner[k], centre, middle[(k + 2) % 3]);
        }
    }
    return pieces;
}

void drop_unused(Crust& crust) {
    std::vector<std::uint32_t> place(crust.points.size(), 0);
    for (const Triangle& t : crust.triangles)
        for (const std::uint32_t v : t) place[v] = 1;
    std::uint32_t kept = 0;
    for (std::size_t v = 0; v < place.size(); ++v) {
        if (!place[v]) continue;
        crust.points[kept] = crust.points[v];
        place[v] = kept++;
    }
    crust.points.resize(kept);
    for (Triangle& t : crust.triangles)
        for (std::uint32_t& v : t) v = place[v];
}

}  // namespace vsplit::bake
