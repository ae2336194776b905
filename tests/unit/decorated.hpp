// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Progressive meshes with all that the format has beside plain splits: attributes, groups, seams, components
// that return.
#pragma once

#include <array>
#include <cmath>
#include <random>

#include "family.hpp"
#include "naive_record.hpp"

namespace vsplit::test {

/// A record with every kind of attribute, and groups.
inline ProgressiveMesh decorated(ProgressiveMesh record, std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto unit = [&] { return float(random() % 10001) / 10000.0f; };
    const auto add = [&](const char* name, Semantic semantic, std::uint32_t components, auto&& fill) {
        record.attributes.push_back({name, semantic, components, {}});
        record.moved_values.emplace_back();
        for (auto [to, count] : {std::pair(&record.attributes.back().values, record.positions.size()),
                                 std::pair(&record.moved_values.back(), record.moves.size())})
            for (std::size_t i = 0; i < count; ++i) {
                std::array<float, 16> v{};
                fill(v);
                to->insert(to->end(), v.begin(), v.begin() + components);
            }
    };
    const auto direction = [&](std::array<float, 16>& v) {
        float length = 0;
        while (length < 0.1f) {
            for (int i = 0; i < 3; ++i) v[std::size_t(i)] = 2 * unit() - 1;
            length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        }
        for (int i = 0; i < 3; ++i) v[std::size_t(i)] /= length;
    };
    add("NORMAL", Semantic::kNormal, 3, direction);
    add("TANGENT", Semantic::kTangent, 4, [&](auto& v) {
        direction(v);
        v[3] = random() % 2 ? 1.0f : -1.0f;
    });
    add("TEXCOORD_0", Semantic::kTexcoord, 2, [&](auto& v) { v[0] = 3 * unit() - 1, v[1] = unit(); });
    add("COLOR_0", Semantic::kColor, 4, [&](auto& v) { v = {unit(), unit(), unit(), 1}; });
    add("JOINTS_0", Semantic::kJoints, 4, [&](auto& v) {
        for (int i = 0; i < 4; ++i) v[std::size_t(i)] = float(random() % 60);
    });
    add("WEIGHTS_0", Semantic::kJointWeights, 4, [&](auto& v) {
        const float a = unit();
        v = {a, 1 - a, 0, 0};
    });
    add("0/POSITION", Semantic::kMorphOffset, 3, [&](auto& v) { v = {unit(), -unit(), 0.1f * unit()}; });
    add("0/NORMAL", Semantic::kMorphNormal, 3, [&](auto& v) { v = {unit(), -unit(), 0.1f * unit()}; });
    add("_HEAT", Semantic::kOther, 1, [&](auto& v) { v[0] = 1e6f * unit() - 1e3f; });
    for (std::size_t t = 0; t < record.triangles.size(); ++t) record.groups.push_back(random() % 5);
    return record;
}

/// Two sheets that share an edge row by position only: the seam splits both sides at once.
inline ProgressiveMesh seam(bool moving) {
    ProgressiveMesh m;
    m.base_vertices = 6;
    m.base_triangles = 2;
    m.positions = {{0, 0, 0}, {1, 0, 0},  {0, 1, 0},    {0, 0, 0},
                   {1, 0, 0}, {0, -1, 0}, {0.5f, 0, 0}, {0.5f, 0, 0}};
    m.parents = {kNoVertex, kNoVertex, kNoVertex, kNoVertex, kNoVertex, kNoVertex, 1, 4};
    m.triangles = {{0, 1, 2}, {3, 5, 4}, {6, 1, 2}, {7, 5, 4}};
    m.corner_changes = {{1, 6}, {5, 7}};
    m.splits = {{8, 4, 2, 0, 0.1f}};
    if (moving) {
        m.moves = {{1, {1, 0, 0.25f}, 1}, {4, {1, 0, 0.25f}, 1}};
        m.splits[0].moves_end = 2;
    }
    return m;
}

/// A component of eight triangles that comes back in one split, between two ordinary ones.
inline ProgressiveMesh returning() {
    ProgressiveMesh m = naive_record(make_grid(4), 3, 6);
    const auto v = std::uint32_t(m.positions.size());
    for (const Float3& p : {Float3{5, 0, 0}, Float3{6, 0, 0}, Float3{5, 1, 0}, Float3{5, 0, 1}}) {
        m.positions.push_back(p);
        m.parents.push_back(kNoVertex);
    }
    for (const Triangle& t : {Triangle{0, 2, 1}, Triangle{0, 1, 3}, Triangle{0, 3, 2}, Triangle{1, 2, 3}})
        m.triangles.push_back({v + t[0], v + t[1], v + t[2]});
    Split last = m.splits.back();
    last.vertices_end += 4;
    last.triangles_end += 4;
    last.error = 0;
    m.splits.push_back(last);
    return m;
}

}  // namespace vsplit::test
