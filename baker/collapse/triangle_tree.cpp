// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "triangle_tree.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "triangle_distance.hpp"
#include "vsplit/progressive_mesh.hpp"

namespace vsplit::bake {
namespace {

Double3 to_double(const Float3& p) {
    return {double(p.x), double(p.y), double(p.z)};
}

constexpr std::uint32_t kLeafTriangles = 4;
/// Smaller parts are built by one thread.
constexpr std::uint32_t kBranchTriangles = 1 << 12;
constexpr int kBins = 16;
/// Below this the heuristic may split unevenly; deeper, halves only. With 32-bit counts no path is longer
/// than 48 + 32.
constexpr std::uint32_t kUnevenDepth = 48;
constexpr int kStack = 96;

constexpr float kFar = std::numeric_limits<float>::max();

struct Bounds {
    std::array<float, 3> low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
    void add(const std::array<float, 3>& l, const std::array<float, 3>& h) {
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], l[k]);
            high[k] = std::max(high[k], h[k]);
        }
    }
    double half_area() const {
        const double a = double(high[0]) - low[0], b = double(high[1]) - low[1], c = double(high[2]) - low[2];
        return a * b + b * c + c * a;
    }
};

}  // namespace

TriangleTree::TriangleTree(const Mesh& mesh) : mesh_(mesh) {
    const std::size_t count = mesh.triangles.size();
    std::vector<Box> boxes(count);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 4096),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t i = range.begin(); i < range.end(); ++i) {
                              Bounds bounds;
                              for (const std::uint32_t v : mesh.triangles[i]) {
                                  const Float3& p = mesh.positions[v];
                                  bounds.add({p.x, p.y, p.z}, {p.x, p.y, p.z});
                              }
                              boxes[i] = {bounds.low, bounds.high, {}};
                              for (std::size_t k = 0; k < 3; ++k)
                                  boxes[i].centre[k] = 0.5f * bounds.low[k] + 0.5f * bounds.high[k];
                          }
                      });
    order_.resize(count);
    std::iota(order_.begin(), order_.end(), 0u);
    nodes_.reserve(count + 2);
    // The second is none: children come in pairs that share a cache line.
    nodes_.push_back({{}, {}, 0, std::uint32_t(count)});
    nodes_.push_back({});
    // The upper part first; what hangs below it at once, and then behind each other.
    std::vector<Range> branches;
    grow(nodes_, {0, 0}, boxes, std::max(kBranchTriangles, std::uint32_t(count / 64)), &branches);
    std::vector<std::vector<Node>> grown(branches.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, branches.size(), 1),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t i = range.begin(); i < range.end(); ++i) {
                              grown[i].push_back(nodes_[branches[i].node]);
                              grown[i].push_back({});
                              grow(grown[i], {0, branches[i].depth}, boxes, kLeafTriangles, nullptr);
                          }
                      });
    for (std::size_t i = 0; i < branches.size(); ++i) {
        const auto offset = std::uint32_t(nodes_.size()) - 2;
        for (Node& node : grown[i])
            if (node.count == 0) node.first += offset;
        nodes_[branches[i].node] = grown[i].front();
        nodes_.insert(nodes_.end(), grown[i].begin() + 2, grown[i].end());
        std::vector<Node>().swap(grown[i]);
    }
}

/// Splits a node until no part has more than `most` triangles; the parts are left at `parts`, if given.
void TriangleTree::grow(std::vector<Node>& nodes, Range root, const std::vector<Box>& boxes,
                        std::uint32_t most, std::vector<Range>* parts) {
    std::vector<Range> open{root};
    while (!open.empty()) {
        const Range range = open.back();
        open.pop_back();
        if (parts && nodes[range.node].count <= most) {
            parts->push_back(range);
            continue;
        }
        std::array<float, 3> low, high;
        fit(nodes[range.node], boxes, low, high);
        const Node node = nodes[range.node];
        if (node.count <= most) continue;
        int axis = 0;
        for (int k = 1; k < 3; ++k)
            if (high[std::size_t(k)] - low[std::size_t(k)] > high[std::size_t(axis)] - low[std::size_t(axis)])
                axis = k;
        const float extent = high[std::size_t(axis)] - low[std::size_t(axis)];
        std::uint32_t middle = node.first + node.count / 2;
        if (extent > 0 && extent <= kFar && range.depth < kUnevenDepth)
            middle = split(node, boxes, axis, low[std::size_t(axis)], extent);
        const auto child = std::uint32_t(nodes.size());
        nodes.push_back({{}, {}, node.first, middle - node.first});
        nodes.push_back({{}, {}, middle, node.first + node.count - middle});
        nodes[range.node].first = child;
        nodes[range.node].count = 0;
        open.push_back({child, range.depth + 1});
        open.push_back({child + 1, range.depth + 1});
    }
}

std::vector<std::uint32_t> TriangleTree::arrange(Mesh& mesh) {
    std::vector<std::uint32_t> number(mesh.positions.size(), kNoVertex);
    std::vector<Float3> positions;
    positions.reserve(mesh.positions.size());
    {
        std::vector<Triangle> triangles;
        triangles.reserve(order_.size());
        for (const std::uint32_t t : order_) {
            triangles.push_back(mesh.triangles[t]);
            for (std::uint32_t& v : triangles.back()) {
                if (number[v] == kNoVertex) {
                    number[v] = std::uint32_t(positions.size());
                    positions.push_back(mesh.positions[v]);
                }
                v = number[v];
            }
        }
        mesh.triangles.swap(triangles);
    }
    mesh.positions.swap(positions);
    std::vector<std::uint32_t>().swap(order_);
    return number;
}

/// Sets the node's box; returns the bounds of the centres.
void TriangleTree::fit(Node& node, const std::vector<Box>& boxes, std::array<float, 3>& low,
                       std::array<float, 3>& high) const {
    Bounds all, centres;
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const Box& box = boxes[order_[i]];
        all.add(box.low, box.high);
        centres.add(box.centre, box.centre);
    }
    node.low = all.low;
    node.high = all.high;
    low = centres.low;
    high = centres.high;
}

/// Partitions the node's part of order_ where the heuristic is least; returns the second child's first.
std::uint32_t TriangleTree::split(const Node& node, const std::vector<Box>& boxes, int axis, float low,
                                  float extent) {
    struct Bin {
        Bounds bounds;
        std::uint32_t count = 0;
    };
    std::array<Bin, kBins> bins;
    const double scale = kBins * 0.9999 / double(extent);
    const auto bin_of = [&](std::uint32_t t) {
        return std::min(kBins - 1, int((double(boxes[t].centre[std::size_t(axis)]) - double(low)) * scale));
    };
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        Bin& bin = bins[std::size_t(bin_of(order_[i]))];
        bin.bounds.add(boxes[order_[i]].low, boxes[order_[i]].high);
        ++bin.count;
    }
    std::array<double, kBins> right_cost{};
    Bin sum;
    for (std::size_t i = kBins - 1; i > 0; --i) {
        sum.bounds.add(bins[i].bounds.low, bins[i].bounds.high);
        sum.count += bins[i].count;
        right_cost[i] = sum.count ? sum.bounds.half_area() * sum.count : 0;
    }
    sum = {};
    double best = std::numeric_limits<double>::infinity();
    int best_bin = -1;
    for (std::size_t i = 1; i < kBins; ++i) {
        sum.bounds.add(bins[i - 1].bounds.low, bins[i - 1].bounds.high);
        sum.count += bins[i - 1].count;
        if (sum.count == 0 || sum.count == node.count) continue;
        const double cost = sum.bounds.half_area() * sum.count + right_cost[i];
        if (cost < best) {
            best = cost;
            best_bin = int(i);
        }
    }
    const std::uint32_t halves = node.first + node.count / 2;
    if (best_bin < 0) return halves;
    const auto begin = order_.begin() + node.first;
    const auto middle =
        std::partition(begin, begin + node.count, [&](std::uint32_t t) { return bin_of(t) < best_bin; });
    const auto at = std::uint32_t(middle - order_.begin());
    return at == node.first || at == node.first + node.count ? halves : at;
}

inline double TriangleTree::box_distance2(const Node& node, Double3 p) const {
    const std::array<double, 3> at{p.x, p.y, p.z};
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double outside = std::max({double(node.low[k]) - at[k], at[k] - double(node.high[k]), 0.0});
        sum += outside * outside;
    }
    return sum;
}

inline double TriangleTree::distance2(std::uint32_t slot, Double3 p) const {
    const Triangle& c = mesh_.triangles[triangle_at(slot)];
    const Float3 t[3] = {mesh_.positions[c[0]], mesh_.positions[c[1]], mesh_.positions[c[2]]};
    return distance2_to_triangle(p, to_double(t[0]), to_double(t[1]), to_double(t[2]));
}

TriangleTree::Hit TriangleTree::closest(Double3 point, std::uint32_t guess, double enough2, double bound2,
                                        std::uint32_t most) const {
    struct Entry {
        std::uint32_t node;
        double distance2;
    };
    Entry stack[kStack];
    int size = 0;
    std::uint32_t slot = guess < mesh_.triangles.size() ? guess : 0;
    double best = guess < mesh_.triangles.size() || !(bound2 < std::numeric_limits<double>::infinity())
                      ? std::min(bound2, distance2(slot, point))
                      : bound2;
    stack[size++] = {0, box_distance2(nodes_[0], point)};
    std::uint32_t seen = 0;
    while (size && best > enough2 && seen < most) {
        const Entry entry = stack[--size];
        if (entry.distance2 >= best) continue;
        const Node& node = nodes_[entry.node];
        if (node.count) {
            seen += node.count;
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
                if (const double d = distance2(i, point); d < best) {
                    best = d;
                    slot = i;
                }
            continue;
        }
        Entry near{node.first, box_distance2(nodes_[node.first], point)};
        Entry far{node.first + 1, box_distance2(nodes_[node.first + 1], point)};
        if (far.distance2 < near.distance2) std::swap(near, far);
        if (far.distance2 < best) stack[size++] = far;
        if (near.distance2 < best) stack[size++] = near;
    }
    return {best, triangle_at(slot), slot};
}

TriangleTree::Meeting TriangleTree::first_met(Double3 from, Double3 direction) const {
    const std::array<double, 3> start{from.x, from.y, from.z},
        inverse{1 / direction.x, 1 / direction.y, 1 / direction.z};
    Meeting best;
    /// Where the ray enters the box; infinity if it does not, or beyond the best.
    const auto enters = [&](const Node& node) {
        double first = 0, last = best.distance;
        for (std::size_t k = 0; k < 3; ++k) {
            const double a = (double(node.low[k]) - start[k]) * inverse[k],
                         b = (double(node.high[k]) - start[k]) * inverse[k];
            // Along a face of the box a and b may be NaN: they then say nothing.
            first = std::max(first, std::min(a, b) == std::min(a, b) ? std::min(a, b) : first);
            last = std::min(last, std::max(a, b) == std::max(a, b) ? std::max(a, b) : last);
        }
        return first <= last * (1 + 1e-12) ? first : std::numeric_limits<double>::infinity();
    };
    struct Entry {
        std::uint32_t node;
        double distance;
    };
    Entry stack[kStack];
    int size = 0;
    if (const double d = enters(nodes_[0]); d < std::numeric_limits<double>::infinity())
        stack[size++] = {0, d};
    while (size) {
        const Entry entry = stack[--size];
        if (entry.distance > best.distance) continue;
        const Node& node = nodes_[entry.node];
        if (node.count) {
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
                const Triangle& t = mesh_.triangles[triangle_at(i)];
                const double d =
                    distance_along(from, direction, to_double(mesh_.positions[t[0]]),
                                   to_double(mesh_.positions[t[1]]), to_double(mesh_.positions[t[2]]));
                if (d < best.distance || (d == best.distance && d < std::numeric_limits<double>::infinity() &&
                                          triangle_at(i) < best.triangle))
                    best = {d, triangle_at(i)};
            }
            continue;
        }
        Entry near{node.first, enters(nodes_[node.first])};
        Entry far{node.first + 1, enters(nodes_[node.first + 1])};
        if (far.distance < near.distance) std::swap(near, far);
        if (far.distance < std::numeric_limits<double>::infinity()) stack[size++] = far;
        if (near.distance < std::numeric_limits<double>::infinity()) stack[size++] = near;
    }
    return best;
}

bool TriangleTree::overlapping(Double3 low, Double3 high, std::size_t most,
                               std::vector<std::uint32_t>& out) const {
    std::uint32_t stack[kStack];
    int size = 0;
    stack[size++] = 0;
    const auto meets = [&](const Node& node) {
        return double(node.low[0]) <= high.x && double(node.high[0]) >= low.x &&
               double(node.low[1]) <= high.y && double(node.high[1]) >= low.y &&
               double(node.low[2]) <= high.z && double(node.high[2]) >= low.z;
    };
    while (size) {
        const Node& node = nodes_[stack[--size]];
        if (!meets(node)) continue;
        if (node.count == 0) {
            stack[size++] = node.first;
            stack[size++] = node.first + 1;
            continue;
        }
        if (out.size() + node.count > most) return false;
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) out.push_back(triangle_at(i));
    }
    return true;
}

}  // namespace vsplit::bake
