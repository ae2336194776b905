// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/classic.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

namespace vsplit::bake {
namespace {

/// Lists of 32-bit values, one list for each key.
struct Lists {
    std::vector<std::uint32_t> starts, values;
    std::span<const std::uint32_t> of(std::uint32_t key) const {
        return std::span(values).subspan(starts[key], starts[key + 1] - starts[key]);
    }
};

Lists make_lists(std::size_t keys, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& entries) {
    Lists lists;
    lists.starts.assign(keys + 1, 0);
    for (const auto& [key, value] : entries) ++lists.starts[key + 1];
    for (std::size_t k = 1; k <= keys; ++k) lists.starts[k] += lists.starts[k - 1];
    lists.values.resize(entries.size());
    std::vector<std::uint32_t> cursor(lists.starts.begin(), lists.starts.end() - 1);
    for (const auto& [key, value] : entries) lists.values[cursor[key]++] = value;
    return lists;
}

/// Poles that share a face of the power diagram.
Lists adjacent_poles(const PowerDiagram& diagram, std::size_t poles) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    edges.reserve(diagram.cells.size() * 6);
    for (const Corners& c : diagram.cells)
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = i + 1; j < 4; ++j)
                edges.emplace_back(std::min(c[i], c[j]), std::max(c[i], c[j]));
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    const std::size_t count = edges.size();
    edges.reserve(2 * count);
    for (std::size_t i = 0; i < count; ++i) edges.emplace_back(edges[i].second, edges[i].first);
    return make_lists(poles, edges);
}

struct Certainty {
    double in = 0, out = 0;
    double priority() const { return in > 0 && out > 0 ? std::abs(in - out) - 1 : std::max(in, out); }
};

/// The point of equal power to the four poles of a regular cell.
Vec3 power_centre(const PoleBalls& poles, const Corners& c, bool& known) {
    const Vec3 a = poles.centres[c[0]], u = poles.centres[c[1]] - a, v = poles.centres[c[2]] - a,
               w = poles.centres[c[3]] - a;
    const double base = poles.weights[c[0]];
    const double du = squared_length(u) + base - poles.weights[c[1]];
    const double dv = squared_length(v) + base - poles.weights[c[2]];
    const double dw = squared_length(w) + base - poles.weights[c[3]];
    const Vec3 vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
    const double six = dot(u, vw);
    // A flat cell's centre drowns in rounding; the caller has a better place for it.
    const double size = std::max({squared_length(u), squared_length(v), squared_length(w)});
    known = std::abs(six) > 1e-10 * size * std::sqrt(size);
    return known ? a + (vw * du + wu * dv + uv * dw) * (0.5 / six) : a;
}

}  // namespace

PoleBalls gather_poles(const Tetrahedra& tetrahedra, const Balls& balls, const Poles& poles) {
    PoleBalls out;
    std::vector<std::uint32_t> index(tetrahedra.cells.size(), kNoCell);
    for (const auto* list : {&poles.first, &poles.second})
        for (const std::uint32_t cell : *list)
            if (cell != kNoCell) index[cell] = 0;
    for (std::uint32_t c = 0; c < index.size(); ++c) {
        if (index[c] == kNoCell) continue;
        index[c] = static_cast<std::uint32_t>(out.cell.size());
        out.cell.push_back(c);
        out.centres.push_back(balls.centres[c]);
        out.weights.push_back(balls.squared_radii[c]);
    }
    const auto renumber = [&](const std::vector<std::uint32_t>& from) {
        std::vector<std::uint32_t> to = from;
        for (std::uint32_t& cell : to)
            if (cell != kNoCell) cell = index[cell];
        return to;
    };
    out.first = renumber(poles.first);
    out.second = renumber(poles.second);
    return out;
}

std::vector<std::uint8_t> label_poles(const Tetrahedra& tetrahedra, const PoleBalls& poles,
                                      const PowerDiagram& diagram) {
    const auto count = static_cast<std::uint32_t>(poles.cell.size());
    std::vector<std::pair<std::uint32_t, std::uint32_t>> entries;
    for (std::uint32_t s = 0; s < poles.first.size(); ++s) {
        if (poles.first[s] != kNoCell) entries.emplace_back(poles.first[s], s);
        if (poles.second[s] != kNoCell) entries.emplace_back(poles.second[s], s);
    }
    const Lists samples = make_lists(count, entries);
    const Lists adjacent = adjacent_poles(diagram, count);

    std::vector<Certainty> certainty(count);
    std::vector<std::uint8_t> inner(count, 0), done(count, 0);
    struct Entry {
        double priority;
        std::uint32_t pole;
        bool operator<(const Entry& other) const {
            return priority != other.priority ? priority < other.priority : pole > other.pole;
        }
    };
    // Priorities change: entries that no longer say the present one are passed over.
    std::priority_queue<Entry> queue;
    for (std::uint32_t p = 0; p < count; ++p) {
        const Corners& corners = tetrahedra.cells[poles.cell[p]];
        if (std::any_of(corners.begin(), corners.end(),
                        [&](std::uint32_t v) { return v >= tetrahedra.samples; }))
            certainty[p].out = 1;
        queue.push({certainty[p].priority(), p});
    }
    while (!queue.empty()) {
        const Entry top = queue.top();
        queue.pop();
        const std::uint32_t p = top.pole;
        if (done[p] || top.priority != certainty[p].priority()) continue;
        done[p] = 1;
        inner[p] = certainty[p].in > certainty[p].out;
        const double known = std::max(certainty[p].in, certainty[p].out);
        const auto tell = [&](std::uint32_t q, double weight, bool same) {
            if (done[q] || !(weight > 0)) return;
            double& told = (inner[p] != 0) == same ? certainty[q].in : certainty[q].out;
            if (!(known * weight > told)) return;
            told = known * weight;
            queue.push({certainty[q].priority(), q});
        };
        for (const std::uint32_t s : samples.of(p)) {
            const std::uint32_t q = poles.first[s] == p ? poles.second[s] : poles.first[s];
            if (q == kNoCell || q == p) continue;
            const Vec3 u = poles.centres[p] - tetrahedra.points[s],
                       v = poles.centres[q] - tetrahedra.points[s];
            tell(q, -dot(u, v) / std::sqrt(squared_length(u) * squared_length(v)), false);
        }
        for (const std::uint32_t q : adjacent.of(p)) {
            const double rp = poles.weights[p], rq = poles.weights[q];
            tell(q,
                 (rp + rq - squared_length(poles.centres[p] - poles.centres[q])) / (2 * std::sqrt(rp * rq)),
                 true);
        }
    }
    return inner;
}

Crust power_faces(const Tetrahedra& tetrahedra, const PoleBalls& poles, const PowerDiagram& diagram,
                  const std::vector<std::uint8_t>& inner) {
    Crust crust;
    std::vector<std::uint32_t> vertex(diagram.cells.size(), kNoCell);
    std::vector<std::uint32_t> shared_samples;
    const auto vertex_of = [&](std::uint32_t cell) {
        if (vertex[cell] != kNoCell) return vertex[cell];
        vertex[cell] = static_cast<std::uint32_t>(crust.points.size());
        const Corners& c = diagram.cells[cell];
        // A sample on the balls of all four poles is where their cells meet, whatever the arithmetic says.
        Vec3 mean;
        shared_samples.clear();
        for (const std::uint32_t s : tetrahedra.cells[poles.cell[c[0]]]) {
            bool all = true;
            for (std::size_t i = 1; i < 4; ++i) {
                const Corners& other = tetrahedra.cells[poles.cell[c[i]]];
                all = all && std::find(other.begin(), other.end(), s) != other.end();
            }
            if (!all) continue;
            crust.points.push_back(tetrahedra.points[s]);
            return vertex[cell];
        }
        // The samples that the balls of different labels share lie on the surface beside the vertex.
        double reach = 0;
        for (std::size_t i = 0; i < 4; ++i)
            for (const std::uint32_t s : tetrahedra.cells[poles.cell[c[i]]]) {
                bool shared = false;
                for (std::size_t j = 0; j < 4; ++j) {
                    const Corners& other = tetrahedra.cells[poles.cell[c[j]]];
                    shared = shared || (inner[c[i]] != inner[c[j]] &&
                                        std::find(other.begin(), other.end(), s) != other.end());
                }
                if (!shared || s >= tetrahedra.samples) continue;
                mean = mean + tetrahedra.points[s];
                shared_samples.push_back(s);
            }
        bool known = false;
        const Vec3 centre = power_centre(poles, c, known);
        if (shared_samples.empty()) {
            // Poles that coincide but for rounding share no sample by name. The vertex lies on or near the
            // inner ball, beside the samples of an outer one.
            std::size_t in = 0, out = 0;
            while (in < 3 && !inner[c[in]]) ++in;
            while (out < 3 && inner[c[out]]) ++out;
            Vec3 beside = centre;
            if (!known)
                for (const std::uint32_t s : tetrahedra.cells[poles.cell[c[out]]])
                    if (s < tetrahedra.samples) beside = tetrahedra.points[s];
            const Vec3 away = beside - poles.centres[c[in]];
            const double size = squared_length(away), weight = poles.weights[c[in]];
            const double scale = size > 1.25 * weight ? std::sqrt(weight / size) : 1;
            crust.points.push_back(poles.centres[c[in]] + away * scale);
            return vertex[cell];
        }
        mean = mean * (1.0 / static_cast<double>(shared_samples.size()));
        // The vertex is no farther from them than the farthest sample that any of the four balls touches.
        for (std::size_t i = 0; i < 4; ++i)
            for (const std::uint32_t s : tetrahedra.cells[poles.cell[c[i]]])
                if (s < tetrahedra.samples)
                    reach = std::max(reach, squared_length(tetrahedra.points[s] - mean));
        known = known && squared_length(centre - mean) <= reach;
        crust.points.push_back(known ? centre : mean);
        return vertex[cell];
    };
    // Permutations (p, q, a, b) of the slots that keep the orientation: crossing the facet without a turns
    // about p -> q.
    constexpr std::size_t kEven[12][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 0, 3}, {1, 2, 0}, {1, 3, 2},
                                          {2, 0, 1}, {2, 1, 3}, {2, 3, 0}, {3, 0, 2}, {3, 1, 0}, {3, 2, 1}};
    const auto slot_of = [](const Corners& c, std::uint32_t value) {
        return static_cast<std::size_t>(std::find(c.begin(), c.end(), value) - c.begin());
    };
    std::vector<std::uint32_t> ring;
    for (std::uint32_t cell = 0; cell < diagram.cells.size(); ++cell)
        for (const auto& even : kEven) {
            const std::uint32_t p = diagram.cells[cell][even[0]], q = diagram.cells[cell][even[1]];
            if (!inner[p] || inner[q]) continue;
            // Each face is made once, from its lowest cell.
            ring.clear();
            std::uint32_t at = cell;
            std::size_t cross_slot = even[2], stay_slot = 6 - even[0] - even[1] - even[2];
            do {
                ring.push_back(at);
                const std::uint32_t next = diagram.neighbours[at][cross_slot];
                if (next == kNoCell || next < cell) break;
                const std::uint32_t stay = diagram.cells[at][stay_slot];
                stay_slot = slot_of(diagram.neighbours[next], at);
                cross_slot = slot_of(diagram.cells[next], stay);
                at = next;
            } while (at != cell);
            if (at != cell || ring.size() < 3) continue;
            const std::uint32_t first = vertex_of(ring[0]);
            for (std::size_t i = 1; i + 1 < ring.size(); ++i)
                crust.triangles.push_back({first, vertex_of(ring[i]), vertex_of(ring[i + 1])});
        }
    return crust;
}

}  // namespace vsplit::bake
