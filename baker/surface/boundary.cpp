// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/boundary.hpp"

#include <algorithm>
#include <bit>
#include <unordered_map>

namespace vsplit::bake {
namespace {

struct Facet {
    std::uint32_t cell;
    std::uint8_t slot;
};

std::uint32_t slot_of(const Corners& corners, std::uint32_t value) {
    return static_cast<std::uint32_t>(std::find(corners.begin(), corners.end(), value) - corners.begin());
}

/// The boundary's facets, seen from their inside cells, each half-edge paired through the inside cells around
/// it.
struct Facets {
    std::vector<Facet> facets;
    std::vector<std::uint32_t> starts;    ///< First facet of each cell.
    std::vector<std::uint8_t> masks;      ///< Bit k: facet k of the cell belongs to the boundary.
    std::vector<std::uint32_t> opposite;  ///< Of half-edge 3f+e.
    std::vector<std::uint32_t> vertex;    ///< Fan that the corner of half-edge 3f+e belongs to.
    std::vector<std::uint32_t> sample;    ///< Sample of each fan.
};

bool has_corner_of_box(const Tetrahedra& t, std::uint32_t cell, int but_slot) {
    for (int i = 0; i < 4; ++i)
        if (i != but_slot && t.cells[cell][static_cast<std::size_t>(i)] >= t.samples) return true;
    return false;
}

std::uint32_t facet_corner(const Tetrahedra& t, Facet f, std::uint32_t i) {
    return t.cells[f.cell][static_cast<std::size_t>(kFacetCorner[f.slot][i % 3])];
}

/// Turns about edge e of a facet through cells of one label until the label changes. `visit` sees every cell
/// passed.
template <class Visit>
Facet turn(const Tetrahedra& t, const std::vector<std::uint8_t>& inside, Facet start, std::uint32_t e,
           Visit visit) {
    const std::uint8_t label = inside[start.cell];
    std::uint32_t cell = start.cell, from = start.slot;
    auto pivot = static_cast<std::uint32_t>(kFacetCorner[start.slot][(e + 2) % 3]);
    for (;;) {
        visit(cell);
        const std::uint32_t next = t.neighbours[cell][pivot];
        if (next == kNoCell || inside[next] != label) return {cell, static_cast<std::uint8_t>(pivot)};
        const std::uint32_t opened = t.cells[cell][from];
        from = slot_of(t.neighbours[next], cell);
        pivot = slot_of(t.cells[next], opened);
        cell = next;
    }
}

Facets collect(const Tetrahedra& t, const std::vector<std::uint8_t>& inside) {
    Facets out;
    const auto count = static_cast<std::uint32_t>(t.cells.size());
    out.starts.resize(count);
    out.masks.assign(count, 0);
    for (std::uint32_t c = 0; c < count; ++c) {
        out.starts[c] = static_cast<std::uint32_t>(out.facets.size());
        if (!inside[c]) continue;
        for (std::uint8_t k = 0; k < 4; ++k) {
            const std::uint32_t other = t.neighbours[c][k];
            if ((other != kNoCell && inside[other]) || has_corner_of_box(t, c, k)) continue;
            out.masks[c] = static_cast<std::uint8_t>(out.masks[c] | 1u << k);
            out.facets.push_back({c, k});
        }
    }
    const auto edges = static_cast<std::uint32_t>(out.facets.size() * 3);
    out.opposite.assign(edges, kNoEdge);
    for (std::uint32_t h = 0; h < edges; ++h) {
        if (out.opposite[h] != kNoEdge) continue;
        const Facet f = out.facets[h / 3];
        const Facet other = turn(t, inside, f, h % 3, [](std::uint32_t) {});
        if (!(out.masks[other.cell] >> other.slot & 1)) continue;
        const auto before =
            std::popcount(static_cast<std::uint8_t>(out.masks[other.cell] & ((1u << other.slot) - 1)));
        const std::uint32_t g = out.starts[other.cell] + static_cast<std::uint32_t>(before);
        const std::uint32_t to = facet_corner(t, f, h % 3 + 1);
        std::uint32_t e = 0;
        while (facet_corner(t, other, e) != to) ++e;
        out.opposite[h] = 3 * g + e;
        out.opposite[3 * g + e] = h;
    }
    out.vertex.assign(edges, kNoCell);
    for (std::uint32_t h = 0; h < edges; ++h) {
        if (out.vertex[h] != kNoCell) continue;
        const auto fan = static_cast<std::uint32_t>(out.sample.size());
        out.sample.push_back(facet_corner(t, out.facets[h / 3], h % 3));
        std::uint32_t first = h;
        while (out.opposite[first] != kNoEdge) {
            first = next_edge(out.opposite[first]);
            if (first == h) break;
        }
        for (std::uint32_t g = first;;) {
            out.vertex[g] = fan;
            g = out.opposite[previous_edge(g)];
            if (g == kNoEdge || g == first) break;
        }
    }
    return out;
}

/// Half-edges whose edge, between the same two fans, is also that of another pair: one of each pair.
std::vector<std::uint32_t> doubled_edges(const Facets& f) {
    // Fans in order of appearance make a counting sort by the smaller one possible; the buckets are tiny.
    std::vector<std::uint32_t> starts(f.sample.size() + 1, 0), bucket(f.vertex.size());
    const auto from = [&](std::uint32_t h) { return f.vertex[h]; };
    const auto to = [&](std::uint32_t h) { return f.vertex[next_edge(h)]; };
    std::size_t kept = 0;
    const auto chosen = [&](std::uint32_t h) { return f.opposite[h] == kNoEdge || h < f.opposite[h]; };
    for (std::uint32_t h = 0; h < f.vertex.size(); ++h)
        if (chosen(h)) ++starts[std::min(from(h), to(h)) + 1], ++kept;
    for (std::size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
    std::vector<std::uint32_t> cursor(starts.begin(), starts.end() - 1);
    for (std::uint32_t h = 0; h < f.vertex.size(); ++h)
        if (chosen(h)) bucket[cursor[std::min(from(h), to(h))]++] = h;
    std::vector<std::uint32_t> doubled;
    for (std::size_t v = 0; v + 1 < starts.size(); ++v)
        for (std::uint32_t i = starts[v]; i < starts[v + 1]; ++i)
            for (std::uint32_t j = starts[v]; j < starts[v + 1]; ++j) {
                if (i == j ||
                    std::max(from(bucket[i]), to(bucket[i])) != std::max(from(bucket[j]), to(bucket[j])))
                    continue;
                doubled.push_back(bucket[i]);
                break;
            }
    return doubled;
}

/// Cells around a sample that hang together, through facets at the sample, and have one label.
struct Fans {
    std::vector<std::vector<std::uint32_t>> groups;
};

Fans groups_around(const Tetrahedra& t, const std::vector<std::uint8_t>& inside, std::uint32_t sample,
                   std::uint32_t start) {
    std::vector<std::uint32_t> cells{start};
    for (std::size_t i = 0; i < cells.size(); ++i)
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t other = t.neighbours[cells[i]][k];
            if (t.cells[cells[i]][k] == sample || other == kNoCell) continue;
            if (std::find(cells.begin(), cells.end(), other) == cells.end()) cells.push_back(other);
        }
    std::sort(cells.begin(), cells.end());
    std::vector<std::uint8_t> seen(cells.size(), 0);
    const auto place = [&](std::uint32_t c) {
        return static_cast<std::size_t>(std::lower_bound(cells.begin(), cells.end(), c) - cells.begin());
    };
    Fans fans;
    for (std::size_t first = 0; first < cells.size(); ++first) {
        if (seen[first]) continue;
        seen[first] = 1;
        std::vector<std::uint32_t> group{cells[first]};
        for (std::size_t i = 0; i < group.size(); ++i)
            for (std::size_t k = 0; k < 4; ++k) {
                const std::uint32_t other = t.neighbours[group[i]][k];
                if (t.cells[group[i]][k] == sample || other == kNoCell || inside[other] != inside[group[i]])
                    continue;
                const std::size_t at = place(other);
                if (seen[at]) continue;
                seen[at] = 1;
                group.push_back(other);
            }
        fans.groups.push_back(std::move(group));
    }
    return fans;
}

}  // namespace

void untangle(const Tetrahedra& t, std::vector<std::uint8_t>& inside, BoundaryReport& report) {
    constexpr int kRounds = 5;
    constexpr std::size_t kFewCells = 4;
    const auto may_flip = [&](const std::vector<std::uint32_t>& cells) {
        return cells.size() <= kFewCells && std::none_of(cells.begin(), cells.end(), [&](std::uint32_t c) {
                   return has_corner_of_box(t, c, -1);
               });
    };
    for (int round = 0; round < kRounds; ++round) {
        const Facets f = collect(t, inside);
        std::vector<std::uint32_t> fans(t.samples, 0);
        for (const std::uint32_t s : f.sample) ++fans[s];
        std::vector<std::vector<std::uint32_t>> flips;
        for (const std::uint32_t h : doubled_edges(f)) {
            // The wedge on either side of this sheet.
            const Facet in = f.facets[h / 3];
            std::vector<std::uint32_t> wedge;
            turn(t, inside, in, h % 3, [&](std::uint32_t c) { wedge.push_back(c); });
            if (may_flip(wedge)) flips.push_back(wedge);
            const std::uint32_t out_cell = t.neighbours[in.cell][in.slot];
            if (out_cell == kNoCell) continue;
            const Facet out{out_cell, static_cast<std::uint8_t>(slot_of(t.neighbours[out_cell], in.cell))};
            const std::uint32_t third = facet_corner(t, in, h % 3 + 2);
            std::uint32_t e = 0;
            while (facet_corner(t, out, e + 2) != third) ++e;
            wedge.clear();
            turn(t, inside, out, e, [&](std::uint32_t c) { wedge.push_back(c); });
            if (may_flip(wedge)) flips.push_back(wedge);
        }
        std::vector<std::uint8_t> done(t.samples, 0);
        for (std::uint32_t h = 0; h < f.vertex.size(); ++h) {
            const std::uint32_t s = f.sample[f.vertex[h]];
            if (fans[s] < 2 || done[s]) continue;
            done[s] = 1;
            Fans around = groups_around(t, inside, s, f.facets[h / 3].cell);
            auto& groups = around.groups;
            for (const std::uint8_t label : {0, 1}) {
                const auto same = [&](const auto& g) { return inside[g[0]] == label; };
                if (std::count_if(groups.begin(), groups.end(), same) < 2) continue;
                const std::vector<std::uint32_t>* least = nullptr;
                for (const auto& g : groups)
                    if (same(g) && (!least || g.size() < least->size())) least = &g;
                if (may_flip(*least)) flips.push_back(*least);
            }
        }
        if (flips.empty()) return;
        // The smallest first; a cell moves once a round.
        std::stable_sort(flips.begin(), flips.end(),
                         [](const auto& a, const auto& b) { return a.size() < b.size(); });
        // What is near a cell that moved has changed, and waits for the next round.
        std::vector<std::uint8_t> touched(inside.size(), 0);
        for (const auto& group : flips) {
            if (std::any_of(group.begin(), group.end(), [&](std::uint32_t c) { return touched[c] != 0; }))
                continue;
            for (const std::uint32_t c : group) {
                inside[c] ^= 1;
                touched[c] = 1;
                for (const std::uint32_t n : t.neighbours[c])
                    if (n != kNoCell) touched[n] = 1;
            }
            report.cells_flipped += group.size();
        }
    }
}

Crust extract_boundary(const Tetrahedra& t, const std::vector<std::uint8_t>& inside, BoundaryReport& report) {
    const Facets f = collect(t, inside);
    std::vector<std::uint32_t> fans(t.samples, 0);
    for (const std::uint32_t s : f.sample) ++fans[s];
    Crust crust;
    crust.points.reserve(f.sample.size());
    for (const std::uint32_t s : f.sample) crust.points.push_back(t.points[s]);
    crust.triangles.reserve(f.facets.size());
    for (std::uint32_t i = 0; i < f.facets.size(); ++i)
        crust.triangles.push_back({f.vertex[3 * i], f.vertex[3 * i + 1], f.vertex[3 * i + 2]});

    // Sheets that touch are drawn apart by a little of their own size, each towards its inside.
    constexpr double kDraw = 0.02;
    std::vector<Vec3> inward(f.sample.size());
    std::vector<double> shortest(f.sample.size(), 0);
    bool apart = false;
    for (std::uint32_t i = 0; i < f.facets.size(); ++i)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t v = f.vertex[3 * i + k];
            if (fans[f.sample[v]] < 2) continue;
            apart = true;
            const Vec3 n = unit(area_normal(crust, crust.triangles[i]));
            inward[v] = inward[v] - n;
            const double size = length(crust.points[crust.triangles[i][(k + 1) % 3]] - crust.points[v]);
            if (shortest[v] == 0 || size < shortest[v]) shortest[v] = size;
        }
    const std::vector<std::uint32_t> doubled = doubled_edges(f);
    std::vector<std::uint32_t> added(doubled.empty() ? 0 : f.opposite.size(), kNoEdge);
    for (const std::uint32_t h : doubled) {
        const Vec3 p = crust.points[edge_from(crust, h)], q = crust.points[edge_to(crust, h)];
        Vec3 n = unit(area_normal(crust, crust.triangles[h / 3]));
        added[h] = static_cast<std::uint32_t>(crust.points.size());
        if (f.opposite[h] != kNoEdge) {
            n = n + unit(area_normal(crust, crust.triangles[f.opposite[h] / 3]));
            added[f.opposite[h]] = added[h];
        }
        crust.points.push_back((p + q) * 0.5 - unit(n) * (kDraw * length(q - p)));
        ++report.edges_split;
    }
    if (apart)
        for (std::size_t v = 0; v < f.sample.size(); ++v) {
            if (fans[f.sample[v]] < 2) continue;
            crust.points[v] = crust.points[v] + unit(inward[v]) * (kDraw * shortest[v]);
            ++report.vertices_split;
        }
    if (!doubled.empty()) {
        std::vector<Triangle> triangles;
        triangles.reserve(crust.triangles.size() + 4 * doubled.size());
        for (std::uint32_t i = 0; i < crust.triangles.size(); ++i) {
            const Pieces pieces = divide(crust.points, crust.triangles[i],
                                         {added[3 * i], added[3 * i + 1], added[3 * i + 2]}, kNoEdge);
            for (std::size_t k = 0; k < pieces.count; ++k) triangles.push_back(pieces.triangles[k]);
        }
        crust.triangles = std::move(triangles);
    }
    return crust;
}

}  // namespace vsplit::bake
