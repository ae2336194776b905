// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/sheet.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace vsplit::bake {

std::size_t trim_rim(Crust& crust, double reach) {
    const std::vector<std::uint32_t> opposite = pair_edges(crust);
    const std::size_t count = crust.points.size();
    // A sample's spacing: the mean of its three shortest edges.
    std::vector<std::array<double, 3>> shortest(count, {1e300, 1e300, 1e300});
    for (std::uint32_t h = 0; h < opposite.size(); ++h) {
        const double size = length(crust.points[edge_to(crust, h)] - crust.points[edge_from(crust, h)]);
        std::array<double, 3>& s = shortest[edge_from(crust, h)];
        if (size < s[2]) s[2] = size;
        if (s[2] < s[1]) std::swap(s[1], s[2]);
        if (s[1] < s[0]) std::swap(s[0], s[1]);
    }
    std::vector<double> spacing(count, 0), known;
    for (std::size_t v = 0; v < count; ++v) {
        if (shortest[v][0] >= 1e300) continue;
        const double last = shortest[v][2] < 1e300   ? shortest[v][2]
                            : shortest[v][1] < 1e300 ? shortest[v][1]
                                                     : shortest[v][0];
        const double middle = shortest[v][1] < 1e300 ? shortest[v][1] : shortest[v][0];
        spacing[v] = (shortest[v][0] + middle + last) / 3;
        known.push_back(spacing[v]);
    }
    if (known.empty()) return 0;
    const auto median = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
    std::nth_element(known.begin(), median, known.end());
    // Samples that sit closer than usual by chance are no reason to trim.
    for (double& s : spacing) s = std::max(s, *median);

    std::vector<std::uint32_t> rim(count, 0);  // boundary edges at each vertex
    std::vector<std::uint8_t> alive(crust.triangles.size(), 1);
    const auto open_edge = [&](std::uint32_t h) { return opposite[h] == kNoEdge || !alive[opposite[h] / 3]; };
    std::vector<std::uint32_t> todo;
    for (std::uint32_t h = 0; h < opposite.size(); ++h) {
        if (opposite[h] != kNoEdge) continue;
        ++rim[edge_from(crust, h)];
        ++rim[edge_to(crust, h)];
        todo.push_back(h / 3);
    }
    const auto unsupported = [&](std::uint32_t t) {
        double longest = 0, usual = 0;
        for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
            longest = std::max(longest,
                               length(crust.points[edge_to(crust, h)] - crust.points[edge_from(crust, h)]));
            usual = std::max(usual, spacing[edge_from(crust, h)]);
        }
        return longest > reach * usual;
    };
    std::size_t trimmed = 0;
    for (std::size_t i = 0; i < todo.size(); ++i) {
        const std::uint32_t t = todo[i];
        if (!alive[t] || !unsupported(t)) continue;
        int open = 0;
        for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) open += open_edge(h);
        if (open == 0) continue;
        // With one open edge the corner across from it must be inside, or the sheet would hang on by that
        // corner.
        if (open == 1) {
            std::uint32_t h = 3 * t;
            while (!open_edge(h)) ++h;
            if (rim[edge_to(crust, next_edge(h))] > 0) continue;
        }
        alive[t] = 0;
        ++trimmed;
        for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
            const bool was_open = opposite[h] == kNoEdge || !alive[opposite[h] / 3];
            for (const std::uint32_t v : {edge_from(crust, h), edge_to(crust, h)})
                rim[v] = was_open ? rim[v] - 1 : rim[v] + 1;
            if (!was_open) todo.push_back(opposite[h] / 3);
        }
        // Triangles kept only because of a corner of this one may go now.
        for (const std::uint32_t h : {3 * t, 3 * t + 1, 3 * t + 2})
            if (opposite[h] != kNoEdge && alive[opposite[h] / 3])
                for (std::uint32_t g = opposite[h] / 3 * 3, last = g + 3; g < last; ++g)
                    if (opposite[g] != kNoEdge && alive[opposite[g] / 3]) todo.push_back(opposite[g] / 3);
    }
    std::size_t kept = 0;
    for (std::size_t t = 0; t < crust.triangles.size(); ++t)
        if (alive[t]) crust.triangles[kept++] = crust.triangles[t];
    crust.triangles.resize(kept);
    drop_unused(crust);
    return trimmed;
}

}  // namespace vsplit::bake
