// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "components.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace vsplit::bake {
namespace {

struct Box {
    Double3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    void add(Double3 p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    double diagonal() const { return length(high - low); }
};

double gap(const Box& a, const Box& b) {
    const auto axis = [](double al, double ah, double bl, double bh) {
        return std::max({0.0, al - bh, bl - ah});
    };
    return length({axis(a.low.x, a.high.x, b.low.x, b.high.x), axis(a.low.y, a.high.y, b.low.y, b.high.y),
                   axis(a.low.z, a.high.z, b.low.z, b.high.z)});
}

}  // namespace

Components::Components(const StarMesh& mesh, std::span<const std::uint32_t> part_of) {
    const std::uint32_t vertices = mesh.vertex_count();
    std::vector<std::uint32_t> roots(vertices);
    std::iota(roots.begin(), roots.end(), 0u);
    const auto find = [&](std::uint32_t v) {
        while (roots[v] != v) v = roots[v] = roots[roots[v]];
        return v;
    };
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
        const Triangle& c = mesh.triangle(t);
        for (const int k : {1, 2}) {
            const std::uint32_t a = find(c[0]), b = find(c[std::size_t(k)]);
            if (a != b) roots[std::max(a, b)] = std::min(a, b);
        }
    }
    component_.assign(vertices, 0);
    for (std::uint32_t v = 0; v < vertices; ++v) {
        if (mesh.kind(v) == VertexKind::kDead) continue;
        const std::uint32_t root = find(v);
        if (root == v) {
            component_[v] = count();
            triangles_.push_back(0);
        } else {
            component_[v] = component_[root];
        }
    }
    alive_ = count();
    kept_.assign(alive_, false);
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) ++triangles_[component_[mesh.triangle(t)[0]]];
    reach_.assign(alive_, 0);
    if (alive_ < 2) {
        std::vector<std::uint32_t>().swap(component_);
        return;
    }

    first_.assign(std::size_t{alive_} + 1, 0);
    std::vector<Box> boxes(alive_);
    for (std::uint32_t v = 0; v < vertices; ++v)
        if (mesh.kind(v) != VertexKind::kDead) {
            ++first_[component_[v] + 1];
            boxes[component_[v]].add(mesh.position(v));
        }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    members_.resize(first_.back());
    auto next = first_;
    for (std::uint32_t v = 0; v < vertices; ++v)
        if (mesh.kind(v) != VertexKind::kDead) members_[next[component_[v]]++] = v;

    // The gap to the nearest of the larger parts: those go later. Among very many parts only the largest are
    // asked.
    std::vector<std::uint32_t> by_size(alive_);
    std::iota(by_size.begin(), by_size.end(), 0u);
    std::stable_sort(by_size.begin(), by_size.end(), [&](std::uint32_t a, std::uint32_t b) {
        return boxes[a].diagonal() > boxes[b].diagonal();
    });
    constexpr std::size_t kAsked = 4096;
    const auto part = [&](std::uint32_t c) {
        return part_of.empty() ? 0u : part_of[mesh.input_vertices()[members_[first_[c]]]];
    };
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> larger;  // of each part
    for (const std::uint32_t c : by_size) {
        std::vector<std::uint32_t>& asked = larger[part(c)];
        const double half = 0.5 * boxes[c].diagonal();
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t j = 0; j < asked.size() && nearest > 0; ++j)
            nearest = std::min(nearest, gap(boxes[c], boxes[asked[j]]));
        if (asked.empty()) nearest = part_of.empty() ? 2 * half : half;
        reach_[c] = half + nearest;
        if (asked.size() < kAsked) asked.push_back(c);
    }
}

std::vector<std::uint32_t> Components::live_vertices(const StarMesh& mesh, std::uint32_t component) const {
    std::vector<std::uint32_t> live;
    for (std::uint32_t i = first_[component]; i < first_[component + 1]; ++i)
        if (mesh.kind(members_[i]) != VertexKind::kDead) live.push_back(members_[i]);
    return live;
}

}  // namespace vsplit::bake
