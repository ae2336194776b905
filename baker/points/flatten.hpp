// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "points/tetrahedra.hpp"

namespace vsplit::bake {

/// Vertices in the order that Tetrahedra promises.
inline Corners canonical(Corners c) {
    // Swaps come in pairs, so that the orientation stays.
    const auto bring = [&c](std::size_t to) {
        const auto from = static_cast<std::size_t>(
            std::min_element(c.begin() + static_cast<std::ptrdiff_t>(to), c.end()) - c.begin());
        if (from == to) return;
        std::swap(c[to], c[from]);
        std::swap(c[2], c[3]);
    };
    bring(0);
    bring(1);
    return c;
}

/// Cells and neighbours of a CGAL triangulation whose vertices and cells carry a 32-bit info; vertices' are
/// set.
template <class Triangulation>
void flatten(const Triangulation& triangulation, std::size_t vertices, std::vector<Corners>& cells,
             std::vector<Corners>& neighbours) {
    const std::size_t count = triangulation.dimension() == 3 ? triangulation.number_of_finite_cells() : 0;
    if (count == 0) return;

    std::vector<typename Triangulation::Cell_handle> handles;
    handles.reserve(count);
    std::vector<std::uint32_t> starts(vertices + 1, 0);
    std::vector<Corners> unsorted;
    unsorted.reserve(count);
    for (auto c = triangulation.all_cells_begin(); c != triangulation.all_cells_end(); ++c) {
        c->info() = kNoCell;
        if (triangulation.is_infinite(c)) continue;
        handles.push_back(c);
        unsorted.push_back(canonical(
            {c->vertex(0)->info(), c->vertex(1)->info(), c->vertex(2)->info(), c->vertex(3)->info()}));
        ++starts[unsorted.back()[0] + 1];
    }
    for (std::size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
    std::vector<std::uint32_t> order(count);
    std::vector<std::uint32_t> cursor(starts.begin(), starts.end() - 1);
    for (std::uint32_t i = 0; i < count; ++i) order[cursor[unsorted[i][0]]++] = i;
    for (std::size_t v = 0; v + 1 < starts.size(); ++v)
        std::sort(order.begin() + starts[v], order.begin() + starts[v + 1],
                  [&](std::uint32_t a, std::uint32_t b) { return unsorted[a] < unsorted[b]; });

    cells.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        cells[i] = unsorted[order[i]];
        handles[order[i]]->info() = i;
    }
    std::vector<Corners>().swap(unsorted);
    neighbours.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto c = handles[order[i]];
        for (int k = 0; k < 4; ++k) {
            const std::uint32_t v = c->vertex(k)->info();
            const Corners& corners = cells[i];
            const auto slot =
                static_cast<std::size_t>(std::find(corners.begin(), corners.end(), v) - corners.begin());
            neighbours[i][slot] = c->neighbor(k)->info();
        }
    }
}

}  // namespace vsplit::bake
