// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "stitch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "unsplit.hpp"
#include "vec.hpp"

namespace vsplit::bake {
namespace {

/// Of the shortest boundary edge at a point, how far another one may be from it.
constexpr double kOfEdge = 0.15;
/// Points looked at in one cell of the grid; points that become one.
constexpr std::size_t kMostAsked = 64, kMostMet = 16;
/// Vertices that one split puts back.
constexpr std::size_t kOfSplit = 64;

Double3 to_double(const Float3& p) {
    return {p.x, p.y, p.z};
}

double apart(const Float3& a, const Float3& b) {
    return length(to_double(a) - to_double(b));
}

/// 0 for vertices where as many triangles come in along each edge as go out. For others a number that is
/// hardly ever 0.
std::vector<std::uint32_t> edge_balances(const Mesh& mesh) {
    std::vector<std::uint32_t> balances(mesh.positions.size(), 0);
    const auto mixed = [](std::uint32_t v) {
        v = (v ^ (v >> 16)) * 0x7FEB352Du;
        return (v ^ (v >> 15)) * 0x846CA68Bu;
    };
    for (const Triangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t h = mixed(t[k] + 1);
            balances[t[(k + 2) % 3]] += h;
            balances[t[(k + 1) % 3]] -= h;
        }
    return balances;
}

/// Edges of one triangle, by their ends; and how near to each end others may be.
struct Borders {
    std::vector<std::array<std::uint32_t, 2>> edges;
    std::vector<double> reach;  ///< Of each point; 0 if it is on no boundary edge.
};

Borders find_borders(const PointMesh& points, double share) {
    struct Side {
        std::uint32_t low, high;
        auto operator<=>(const Side&) const = default;
    };
    const std::vector<std::uint32_t> balances = edge_balances(points.mesh);
    std::vector<Side> sides;
    for (const Triangle& t : points.mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
            if (balances[low] != 0 && balances[high] != 0) sides.push_back({low, high});
        }
    std::sort(sides.begin(), sides.end());
    Borders out;
    const std::vector<Float3>& places = points.mesh.positions;
    out.reach.assign(places.size(), 0);
    for (std::size_t i = 0, j; i < sides.size(); i = j) {
        for (j = i + 1; j < sides.size() && sides[j] == sides[i];) ++j;
        if (j == i + 1) out.edges.push_back({sides[i].low, sides[i].high});
    }
    if (out.edges.empty()) return out;

    struct Box {
        Double3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    };
    std::vector<Box> boxes(1);
    const auto part = [&](std::uint32_t p) { return points.part_of.empty() ? 0u : points.part_of[p]; };
    std::unordered_map<std::uint32_t, std::size_t> known;
    const auto box_of = [&](std::uint32_t p) -> Box& {
        const auto [at, added] = known.try_emplace(part(p), known.size());
        if (at->second >= boxes.size()) boxes.resize(at->second + 1);
        return boxes[at->second];
    };
    for (const Triangle& t : points.mesh.triangles)
        for (const std::uint32_t p : t) {
            Box& box = box_of(p);
            const Double3 x = to_double(places[p]);
            box.low = {std::min(box.low.x, x.x), std::min(box.low.y, x.y), std::min(box.low.z, x.z)};
            box.high = {std::max(box.high.x, x.x), std::max(box.high.y, x.y), std::max(box.high.z, x.z)};
        }
    std::vector<double> shortest(places.size(), std::numeric_limits<double>::infinity());
    for (const auto& [a, b] : out.edges) {
        const double edge = apart(places[a], places[b]);
        shortest[a] = std::min(shortest[a], edge);
        shortest[b] = std::min(shortest[b], edge);
    }
    for (std::uint32_t p = 0; p < places.size(); ++p) {
        if (std::isinf(shortest[p])) continue;
        // What must not move meets nothing.
        if (!points.mesh.weights.empty() && std::isinf(points.mesh.weights[p])) continue;
        const Box& box = box_of(p);
        out.reach[p] = std::min(share * length(box.high - box.low), kOfEdge * shortest[p]);
    }
    return out;
}

/// Boundary points in grids, of which each has cells of a power of two, for points of about that reach.
class Grid {
  public:
    Grid(const PointMesh& points, const std::vector<double>& reach) : points_(points), reach_(reach) {
        for (std::uint32_t p = 0; p < reach.size(); ++p) {
            if (!(reach[p] > 0)) continue;
            const int size = size_of(reach[p]);
            cells_[cell_at(p, size, {})].push_back(p);
            if (std::find(sizes_.begin(), sizes_.end(), size) == sizes_.end()) sizes_.push_back(size);
        }
        std::sort(sizes_.begin(), sizes_.end());
    }

    /// Visits points of the same part that are at most their reach and that of `p` apart, each pair from
    /// the one of the less reach.
    template <class Visit>
    void near(std::uint32_t p, const Visit& visit) const {
        for (const int size : sizes_) {
            if (size < size_of(reach_[p])) continue;
            for (int k = 0; k < 27; ++k) {
                const auto cell = cells_.find(cell_at(p, size, {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1}));
                if (cell == cells_.end()) continue;
                for (std::size_t i = 0; i < std::min(cell->second.size(), kMostAsked); ++i) {
                    const std::uint32_t q = cell->second[i];
                    if (q == p || reach_[q] < reach_[p] || (reach_[q] == reach_[p] && q < p)) continue;
                    if (!points_.part_of.empty() && points_.part_of[p] != points_.part_of[q]) continue;
                    if (!points_.mesh.weights.empty() && points_.mesh.weights[p] != points_.mesh.weights[q])
                        continue;
                    const double d = apart(points_.mesh.positions[p], points_.mesh.positions[q]);
                    // What is at one place and yet not one point is kept apart for a reason.
                    if (d > 0 && d <= reach_[p]) visit(q, d);
                }
            }
        }
    }

  private:
    struct Cell {
        std::int64_t x, y, z;
        int size;
        friend bool operator==(const Cell&, const Cell&) = default;
    };
    struct Hash {
        std::size_t operator()(const Cell& c) const {
            std::uint64_t h = std::uint64_t(c.size);
            for (const std::int64_t v : {c.x, c.y, c.z}) h = (h ^ std::uint64_t(v)) * 0x9E3779B97F4A7C15u;
            return std::size_t(h ^ (h >> 29));
        }
    };
    /// Cells of 2^size are at least `reach` wide.
    static int size_of(double reach) { return std::ilogb(reach) + 1; }
    Cell cell_at(std::uint32_t p, int size, std::array<int, 3> step) const {
        const Float3& at = points_.mesh.positions[p];
        // Beyond what 64 bits hold, floats are too coarse for anything to be near.
        const auto index = [&](float x, int s) {
            const double cell = std::floor(std::ldexp(double(x), -size));
            return std::int64_t(std::clamp(cell, -4e18, 4e18)) + s;
        };
        return {index(at.x, step[0]), index(at.y, step[1]), index(at.z, step[2]), size};
    }

    const PointMesh& points_;
    const std::vector<double>& reach_;
    std::unordered_map<Cell, std::vector<std::uint32_t>, Hash> cells_;
    std::vector<int> sizes_;
};

struct Meeting {
    double distance;
    std::uint32_t a, b;
    auto operator<=>(const Meeting&) const = default;
};

/// The pairs of points at both ends of edges that lie on each other, nearest first.
std::vector<Meeting> find_meetings(const PointMesh& points, const Borders& borders) {
    const Grid grid(points, borders.reach);
    std::vector<std::vector<std::uint32_t>> beside(borders.reach.size());
    for (const auto& [a, b] : borders.edges) {
        beside[a].push_back(b);
        beside[b].push_back(a);
    }
    std::vector<Meeting> near;
    for (std::uint32_t p = 0; p < borders.reach.size(); ++p)
        if (borders.reach[p] > 0)
            grid.near(p, [&](std::uint32_t q, double d) {
                near.push_back({d, std::min(p, q), std::max(p, q)});
            });
    std::vector<std::uint64_t> keys;
    for (const Meeting& m : near) keys.push_back(std::uint64_t{m.a} << 32 | m.b);
    std::sort(keys.begin(), keys.end());
    const auto are_near = [&](std::uint32_t a, std::uint32_t b) {
        return a == b || std::binary_search(keys.begin(), keys.end(),
                                            std::uint64_t{std::min(a, b)} << 32 | std::max(a, b));
    };
    std::erase_if(near, [&](const Meeting& m) {
        for (const std::uint32_t a : beside[m.a])
            for (const std::uint32_t b : beside[m.b])
                if (are_near(a, b) && a != m.b && b != m.a) return false;
        return true;
    });
    std::sort(near.begin(), near.end());
    return near;
}

}  // namespace

bool may_have_boundary(const Mesh& mesh) {
    const std::vector<std::uint32_t> balances = edge_balances(mesh);
    return std::any_of(balances.begin(), balances.end(), [](std::uint32_t b) { return b != 0; });
}

std::vector<Stitch> stitch_borders(PointMesh& points, double share) {
    const Borders borders = find_borders(points, share);
    if (borders.edges.empty()) return {};
    const std::vector<Meeting> meetings = find_meetings(points, borders);
    if (meetings.empty()) return {};

    const std::size_t count = points.mesh.positions.size();
    std::vector<std::vector<std::uint32_t>> stars(count);
    for (std::uint32_t t = 0; t < points.mesh.triangles.size(); ++t)
        for (const std::uint32_t p : points.mesh.triangles[t])
            if (borders.reach[p] > 0) stars[p].push_back(t);
    std::vector<std::uint32_t> met(count);  // the point that each has become
    for (std::uint32_t p = 0; p < count; ++p) met[p] = p;
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> members;
    const auto members_of = [&](std::uint32_t p) -> std::vector<std::uint32_t>& {
        std::vector<std::uint32_t>& m = members[p];
        if (m.empty()) m.push_back(p);
        return m;
    };
    for (const Meeting& meeting : meetings) {
        const std::uint32_t a = std::min(met[meeting.a], met[meeting.b]),
                            b = std::max(met[meeting.a], met[meeting.b]);
        if (a == b) continue;
        const std::vector<std::uint32_t> gone = members_of(b);
        std::vector<std::uint32_t>& stay = members_of(a);
        if (gone.size() + stay.size() > kMostMet) continue;
        const bool far = std::any_of(gone.begin(), gone.end(), [&](std::uint32_t p) {
            return apart(points.mesh.positions[p], points.mesh.positions[a]) > borders.reach[p];
        });
        const bool touch = std::any_of(gone.begin(), gone.end(), [&](std::uint32_t p) {
            return std::any_of(stars[p].begin(), stars[p].end(), [&](std::uint32_t t) {
                const Triangle& c = points.mesh.triangles[t];
                return std::any_of(c.begin(), c.end(), [&](std::uint32_t q) { return met[q] == a; });
            });
        });
        if (far || touch) continue;
        for (const std::uint32_t p : gone) met[p] = a;
        stay.insert(stay.end(), gone.begin(), gone.end());
        members.erase(b);
    }

    std::vector<std::uint32_t> first(count, kNoVertex);  // a vertex of each point
    for (std::size_t t = 0; t < points.mesh.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t& vertex = first[points.mesh.triangles[t][k]];
            vertex = std::min(vertex, points.corners[t][k]);
        }
    std::vector<Stitch> stitched;
    for (std::size_t t = 0; t < points.mesh.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t& p = points.mesh.triangles[t][k];
            if (met[p] == p) continue;
            p = met[p];
            stitched.push_back({points.corners[t][k], first[p]});
        }
    const auto by_vertex = [](const Stitch& a, const Stitch& b) { return a.vertex < b.vertex; };
    std::sort(stitched.begin(), stitched.end(), by_vertex);
    stitched.erase(std::unique(stitched.begin(), stitched.end(),
                               [](const Stitch& a, const Stitch& b) { return a.vertex == b.vertex; }),
                   stitched.end());
    return stitched;
}

namespace {

/// Corners of the progressive mesh that are stitched vertices', by vertex and corner.
std::vector<CornerChange> stitched_corners(const ProgressiveMesh& mesh, const Mesh& input,
                                           std::span<const Stitch> stitched,
                                           std::span<const std::uint32_t> births) {
    std::vector<std::uint32_t> other(input.positions.size());
    std::vector<bool> touched(mesh.positions.size(), false);
    for (std::uint32_t v = 0; v < other.size(); ++v) other[v] = v;
    for (const Stitch& s : stitched) {
        other[s.vertex] = s.other;
        touched[births[s.other]] = true;
    }
    // Triangles are told by their corners, as they run.
    struct Known {
        Triangle corners;
        std::size_t triangle;
        auto operator<=>(const Known&) const = default;
    };
    const auto turned = [](Triangle t) {
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        return t;
    };
    const auto is_touched = [&](const Triangle& t) {
        return std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return touched[v]; });
    };
    std::vector<Known> theirs, ours;
    for (std::size_t t = 0; t < input.triangles.size(); ++t) {
        const Triangle& c = input.triangles[t];
        const Triangle now{births[other[c[0]]], births[other[c[1]]], births[other[c[2]]]};
        if (is_touched(now)) theirs.push_back({turned(now), t});
    }
    const Mesh full = Unsplitter::full(mesh);
    for (std::size_t t = 0; t < full.triangles.size(); ++t)
        if (is_touched(full.triangles[t])) ours.push_back({turned(full.triangles[t]), t});
    std::sort(theirs.begin(), theirs.end());
    std::sort(ours.begin(), ours.end());
    std::vector<CornerChange> found;
    for (std::size_t i = 0; i < std::min(theirs.size(), ours.size()); ++i)
        for (const std::uint32_t v : input.triangles[theirs[i].triangle]) {
            if (other[v] == v) continue;
            const Triangle& c = full.triangles[ours[i].triangle];
            const auto k = std::find(c.begin(), c.end(), births[other[v]]) - c.begin();
            if (k < 3) found.push_back({std::uint32_t(3 * ours[i].triangle + std::size_t(k)), v});
        }
    std::sort(found.begin(), found.end(), [](const CornerChange& a, const CornerChange& b) {
        return a.vertex != b.vertex ? a.vertex < b.vertex : a.corner < b.corner;
    });
    return found;
}

}  // namespace

void unstitch(ProgressiveMesh& mesh, const Mesh& input, std::span<const Stitch> stitched,
              std::span<const std::uint32_t> births, bool are_wedges) {
    if (stitched.empty()) return;
    struct Back {
        float distance;  ///< Not less than it is.
        Stitch stitch;
    };
    std::vector<Back> back;
    for (const Stitch& s : stitched) {
        const double d = apart(input.positions[s.vertex], input.positions[s.other]);
        back.push_back({std::nextafter(float(d), std::numeric_limits<float>::infinity()), s});
    }
    std::sort(back.begin(), back.end(), [](const Back& a, const Back& b) {
        return a.distance != b.distance ? a.distance > b.distance : a.stitch.vertex < b.stitch.vertex;
    });
    const std::vector<CornerChange> corners =
        are_wedges ? std::vector<CornerChange>() : stitched_corners(mesh, input, stitched, births);
    for (Split& split : mesh.splits) split.error += back.front().distance;
    for (std::size_t begin = 0; begin < back.size(); begin += kOfSplit) {
        const auto some = std::span(back).subspan(begin, std::min(kOfSplit, back.size() - begin));
        const std::size_t first_corner = mesh.corner_changes.size();
        for (const auto& [distance, stitch] : some) {
            const std::uint32_t v = stitch.vertex;
            const float weight = input.weights.empty() ? 1.0f : input.weights[v];
            if (are_wedges) {
                mesh.moves.push_back({births[v], input.positions[v], weight});
                for (std::size_t k = 0; k < mesh.attributes.size(); ++k) {
                    const Attribute& from = input.attributes[k];
                    const auto value = from.values.begin() + std::ptrdiff_t(std::size_t{v} * from.components);
                    mesh.moved_values[k].insert(mesh.moved_values[k].end(), value,
                                                value + std::ptrdiff_t(from.components));
                }
                continue;
            }
            for (auto c = std::lower_bound(
                     corners.begin(), corners.end(), v,
                     [](const CornerChange&change, std::uint32_t vertex) { return change.vertex < vertex; });
                 c != corners.end() && c->vertex == v; ++c)
                mesh.corner_changes.push_back({c->corner, std::uint32_t(mesh.positions.size())});
            mesh.positions.push_back(input.positions[v]);
            mesh.parents.push_back(births[stitch.other]);
            if (!mesh.weights.empty()) mesh.weights.push_back(weight);
        }
        std::sort(mesh.corner_changes.begin() + std::ptrdiff_t(first_corner), mesh.corner_changes.end(),
                  [](const CornerChange& a, const CornerChange& b) { return a.corner < b.corner; });
        mesh.splits.push_back({std::uint32_t(mesh.positions.size()), std::uint32_t(mesh.triangles.size()),
                               std::uint32_t(mesh.corner_changes.size()), std::uint32_t(mesh.moves.size()),
                               some.front().distance});
    }
}

}  // namespace vsplit::bake
