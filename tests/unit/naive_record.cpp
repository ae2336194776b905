// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "naive_record.hpp"

#include <algorithm>
#include <cstring>
#include <random>

namespace vsplit::test {
namespace {

struct Step {
    std::uint32_t child, parent;
    Float3 parent_position;
    float parent_weight;
    std::vector<std::uint32_t> corners, removed;
};

template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

}  // namespace

ProgressiveMesh naive_record(const Mesh& mesh, std::uint32_t seed, std::size_t collapses) {
    std::mt19937 random(seed);
    Mesh m = mesh;
    const bool weighted = !m.weights.empty();
    std::vector<bool> vertex_gone(m.positions.size(), false), triangle_gone(m.triangles.size(), false);
    std::vector<std::uint32_t> alive(m.triangles.size());
    for (std::uint32_t t = 0; t < alive.size(); ++t) alive[t] = t;
    std::vector<Step> steps;
    while (!alive.empty() && steps.size() < collapses) {
        const Triangle picked = m.triangles[alive[random() % alive.size()]];
        const std::uint32_t k = random() % 3;
        Step step{picked[k], picked[(k + 1) % 3], {}, 1, {}, {}};
        step.parent_position = m.positions[step.parent];
        if (weighted) step.parent_weight = m.weights[step.parent];
        for (const std::uint32_t t : alive) {
            Triangle& c = m.triangles[t];
            const auto at = std::find(c.begin(), c.end(), step.child);
            if (at == c.end()) continue;
            if (std::find(c.begin(), c.end(), step.parent) != c.end()) {
                step.removed.push_back(t);
                triangle_gone[t] = true;
            } else {
                step.corners.push_back(3 * t + std::uint32_t(at - c.begin()));
                *at = step.parent;
            }
        }
        std::erase_if(alive, [&](std::uint32_t t) { return triangle_gone[t]; });
        vertex_gone[step.child] = true;
        Float3& p = m.positions[step.parent];
        const Float3 q = m.positions[step.child];
        p = {0.5f * p.x + 0.5f * q.x, 0.5f * p.y + 0.5f * q.y, 0.5f * p.z + 0.5f * q.z};
        if (weighted) m.weights[step.parent] = 0.5f * (m.weights[step.parent] + m.weights[step.child]);
        steps.push_back(std::move(step));
    }

    ProgressiveMesh out;
    std::vector<std::uint32_t> vertex_birth(m.positions.size()), triangle_birth(m.triangles.size());
    const auto bear = [&](std::uint32_t v, std::uint32_t parent) {
        vertex_birth[v] = std::uint32_t(out.positions.size());
        out.positions.push_back(m.positions[v]);
        out.parents.push_back(parent);
        if (weighted) out.weights.push_back(m.weights[v]);
    };
    const auto bear_triangle = [&](std::uint32_t t) {
        triangle_birth[t] = std::uint32_t(out.triangles.size());
        const Triangle& c = m.triangles[t];
        out.triangles.push_back({vertex_birth[c[0]], vertex_birth[c[1]], vertex_birth[c[2]]});
    };
    for (std::uint32_t v = 0; v < m.positions.size(); ++v)
        if (!vertex_gone[v]) bear(v, kNoVertex);
    for (const std::uint32_t t : alive) bear_triangle(t);
    out.base_vertices = std::uint32_t(out.positions.size());
    out.base_triangles = std::uint32_t(out.triangles.size());
    for (std::size_t i = steps.size(); i-- > 0;) {
        const Step& step = steps[i];
        bear(step.child, vertex_birth[step.parent]);
        out.moves.push_back({vertex_birth[step.parent], step.parent_position, step.parent_weight});
        for (const std::uint32_t corner : step.corners)
            out.corner_changes.push_back(
                {3 * triangle_birth[corner / 3] + corner % 3, vertex_birth[step.child]});
        for (const std::uint32_t t : step.removed) bear_triangle(t);
        out.splits.push_back({std::uint32_t(out.positions.size()), std::uint32_t(out.triangles.size()),
                              std::uint32_t(out.corner_changes.size()), std::uint32_t(out.moves.size()),
                              0.01f * float(i + 1)});
    }
    return out;
}

bool same_bytes(const ProgressiveMesh& a, const ProgressiveMesh& b) {
    return a.base_vertices == b.base_vertices && a.base_triangles == b.base_triangles &&
           same(a.positions, b.positions) && same(a.weights, b.weights) && same(a.parents, b.parents) &&
           same(a.triangles, b.triangles) && same(a.splits, b.splits) &&
           same(a.corner_changes, b.corner_changes) && same(a.moves, b.moves);
}

std::vector<float> some_weights(std::size_t count) {
    std::mt19937 random(7);
    std::vector<float> weights(count);
    for (float& w : weights) w = float(random() % 100000) * 1e-4f;
    return weights;
}

}  // namespace vsplit::test
