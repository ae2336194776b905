// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/handles.hpp"

#include <algorithm>
#include <queue>

namespace vsplit::bake {
namespace {

class Region {
  public:
    Region(const Tetrahedra& tetrahedra)
        : t_(tetrahedra), cell_(tetrahedra.cells.size(), 0), vertex_(tetrahedra.points.size(), 0) {}

    bool has(std::uint32_t c) const { return c != kNoCell && cell_[c]; }
    void add(std::uint32_t c) {
        cell_[c] = 1;
        for (const std::uint32_t v : t_.cells[c]) vertex_[v] = 1;
    }

    /// Whether the cell meets the region's closure in something contractible, so that adding it keeps the
    /// topology; or in its whole rim, so that it fills a bubble.
    bool simple(std::uint32_t c) const {
        std::array<std::size_t, 4> shared{}, other{};
        std::size_t count = 0, rest = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            if (has(t_.neighbours[c][k]))
                shared[count++] = k;
            else
                other[rest++] = k;
        }
        if (count >= 3) return true;
        // With two facets in, the edge across from the one that they share closes a loop.
        if (count == 2) return !has_edge(c, shared[0], shared[1]);
        if (count == 0) return false;
        // With one facet in, its apex may hang on by one edge, not by itself, and not by two.
        if (!vertex_[t_.cells[c][shared[0]]]) return true;
        int edges = 0;
        for (std::size_t i = 0; i < rest; ++i) edges += has_edge(c, shared[0], other[i]);
        return edges == 1;
    }

  private:
    /// Whether a cell of the region lies on the edge between two slots of cell c.
    bool has_edge(std::uint32_t c, std::size_t i, std::size_t j) const {
        const std::uint32_t a = t_.cells[c][i], b = t_.cells[c][j];
        if (!vertex_[a] || !vertex_[b]) return false;
        std::size_t others[2], n = 0;
        for (std::size_t k = 0; k < 4; ++k)
            if (k != i && k != j) others[n++] = k;
        const auto slot_of = [](const Corners& corners, std::uint32_t value) {
            return static_cast<std::size_t>(std::find(corners.begin(), corners.end(), value) -
                                            corners.begin());
        };
        // Around the edge; where the hull cuts the way short, once more the other way.
        for (std::size_t way = 0; way < 2; ++way) {
            std::uint32_t at = c;
            std::size_t cross = others[way], stay = others[1 - way];
            for (;;) {
                const std::uint32_t next = t_.neighbours[at][cross];
                if (next == c) return false;
                if (next == kNoCell) break;
                if (cell_[next]) return true;
                const std::uint32_t kept = t_.cells[at][stay];
                stay = slot_of(t_.neighbours[next], at);
                cross = slot_of(t_.cells[next], kept);
                at = next;
            }
        }
        return false;
    }

    const Tetrahedra& t_;
    std::vector<std::uint8_t> cell_, vertex_;
};

}  // namespace

std::size_t remove_handles(const Tetrahedra& tetrahedra, const Balls& balls,
                           std::vector<std::uint8_t>& inside, std::uint8_t label, double smallest) {
    const auto count = static_cast<std::uint32_t>(tetrahedra.cells.size());
    const double least = smallest * smallest;
    struct Entry {
        double squared_radius;
        std::uint32_t cell;
        bool operator<(const Entry& other) const {
            return squared_radius != other.squared_radius ? squared_radius < other.squared_radius
                                                          : cell > other.cell;
        }
    };
    std::vector<std::uint32_t> seeds, stack;
    std::vector<std::uint8_t> seen(count, 0);
    for (std::uint32_t c = 0; c < count; ++c) {
        if (seen[c] || inside[c] != label) continue;
        std::uint32_t largest = c;
        seen[c] = 1;
        stack.assign(1, c);
        while (!stack.empty()) {
            const std::uint32_t at = stack.back();
            stack.pop_back();
            if (balls.squared_radii[at] > balls.squared_radii[largest]) largest = at;
            for (const std::uint32_t n : tetrahedra.neighbours[at])
                if (n != kNoCell && !seen[n] && inside[n] == label) seen[n] = 1, stack.push_back(n);
        }
        seeds.push_back(largest);
    }
    Region region(tetrahedra);
    std::priority_queue<Entry> queue;
    const auto add = [&](std::uint32_t c) {
        region.add(c);
        for (const std::uint32_t n : tetrahedra.neighbours[c])
            if (n != kNoCell && inside[n] == label && !region.has(n)) queue.push({balls.squared_radii[n], n});
    };
    for (const std::uint32_t seed : seeds) add(seed);
    // What cannot be added simply waits until nothing else is left: only then is a loop through a large ball
    // the surface's own and not just not filled yet.
    std::priority_queue<Entry> waiting;
    for (;;) {
        while (!queue.empty()) {
            const Entry top = queue.top();
            queue.pop();
            if (region.has(top.cell)) continue;
            if (region.simple(top.cell))
                add(top.cell);
            else if (top.squared_radius > least)
                waiting.push(top);
        }
        while (!waiting.empty() && region.has(waiting.top().cell)) waiting.pop();
        if (waiting.empty()) break;
        add(waiting.top().cell);
        waiting.pop();
    }
    std::size_t changed = 0;
    for (std::uint32_t c = 0; c < count; ++c) {
        if (inside[c] != label || region.has(c)) continue;
        // The box stays outside, or there would be no closed surface.
        const Corners& corners = tetrahedra.cells[c];
        if (label == 0 && std::any_of(corners.begin(), corners.end(),
                                      [&](std::uint32_t v) { return v >= tetrahedra.samples; }))
            continue;
        inside[c] ^= 1;
        ++changed;
    }
    return changed;
}

}  // namespace vsplit::bake
