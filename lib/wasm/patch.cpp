// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "patch.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace vsplit::web {
namespace {

/// The nearest whole number to one within 16 bits: the last bits of a float that holds no smaller ones.
std::int16_t rounded(float value) {
    return std::int16_t(std::bit_cast<std::uint32_t>(value + 12582912.0f));
}

}  // namespace

template <class Value>
Value* Stretches<Value>::add(std::size_t first, std::size_t count) {
    const std::size_t n = ranges.size();
    if (n > 0 && ranges[n - 2] + ranges[n - 1] == first) {
        ranges[n - 1] += std::uint32_t(count);
    } else {
        ranges.push_back(std::uint32_t(first));
        ranges.push_back(std::uint32_t(count));
    }
    values.resize(values.size() + count);
    return values.data() + values.size() - count;
}

Patcher::Patcher(std::uint32_t groups, bool normals)
    : indices_(groups), counts_(groups), placed_(groups), makes_normals_(normals) {}

void Patcher::set_scale(std::uint32_t group, float scale) {
    if (group >= counts_.size()) return;
    scale_of_group_.resize(counts_.size(), 1.0f);
    scale_of_group_[group] = scale;
}

/// Places of triangles and scales of vertices that are alive for the first time.
void Patcher::learn(const LiveBuffers& buffers) {
    const auto groups = buffers.all_groups();
    const std::uint32_t count = buffers.triangle_count();
    const auto old = std::uint32_t(place_.size());
    if (counts_.size() > 1) {
        for (std::uint32_t t = old; t < count; ++t) place_.push_back(placed_[groups[t]]++);
        for (; alive_ < count; ++alive_) ++counts_[groups[alive_]];
        for (; alive_ > count; --alive_) --counts_[groups[alive_ - 1]];
    } else {
        counts_[0] = alive_ = count;
    }
    if (scale_of_group_.empty()) return;
    const auto parents = buffers.parents();
    for (std::size_t v = scale_of_vertex_.size(); v < parents.size(); ++v)
        scale_of_vertex_.push_back(parents[v] == kNoVertex ? 0 : scale_of_vertex_[parents[v]]);
    // Of a triangle, or of one that a descendant is in: a vertex may have handed on all that it had.
    const auto triangles = buffers.triangles();
    for (const ElementRange& range : triangles_)
        for (std::uint32_t t = range.begin; t < range.end; ++t)
            for (std::uint32_t v : triangles[t])
                for (; v != kNoVertex && scale_of_vertex_[v] == 0; v = parents[v])
                    scale_of_vertex_[v] = scale_of_group_[groups.empty() ? 0 : groups[t]];
}

void Patcher::take(LiveBuffers& buffers) {
    vertices_.clear();
    triangles_.clear();
    buffers.take_dirty_runs(vertices_, triangles_);
    learn(buffers);
    for (auto& index : indices_) index.clear();
    const auto triangles = buffers.triangles();
    const auto groups = buffers.groups();
    for (const ElementRange& range : triangles_) {
        if (counts_.size() == 1) {
            const std::size_t corners = std::size_t{3} * (range.end - range.begin);
            std::memcpy(indices_[0].add(std::size_t{3} * range.begin, corners), triangles[range.begin].data(),
                        corners * sizeof(std::uint32_t));
            continue;
        }
        for (std::uint32_t t = range.begin; t < range.end; ++t)
            std::copy_n(triangles[t].data(), 3, indices_[groups[t]].add(std::size_t{3} * place_[t], 3));
    }
}

const Stretches<float>& Patcher::vertex_values(std::span<const float> values, std::uint32_t components) {
    values_.clear();
    for (const ElementRange& range : vertices_) {
        const std::size_t first = std::size_t{components} * range.begin,
                          count = std::size_t{components} * (range.end - range.begin);
        std::copy_n(values.data() + first, count, values_.add(first, count));
    }
    return values_;
}

const Stretches<float>& Patcher::positions(const LiveBuffers& buffers) {
    static_assert(sizeof(Float3) == 3 * sizeof(float));
    const auto places = buffers.positions();
    vertex_values({places.empty() ? nullptr : &places[0].x, 3 * places.size()}, 3);
    if (scale_of_vertex_.empty()) return values_;
    float* value = values_.values.data();
    for (const ElementRange& range : vertices_)
        for (std::uint32_t v = range.begin; v < range.end; ++v)
            for (int k = 0; k < 3; ++k) *value++ *= scale_of_vertex_[v];
    return values_;
}

const Stretches<std::int16_t>& Patcher::normals(const LiveBuffers& buffers) {
    normals_.clear();
    if (!makes_normals_) return normals_;
    const auto places = buffers.positions();
    sums_.assign(3 * places.size(), 0.0f);
    if (normal_.size() < 4 * places.size()) normal_.resize(4 * places.size());
    for (const Triangle& triangle : buffers.triangles()) {
        const Float3 &a = places[triangle[0]], &b = places[triangle[1]], &c = places[triangle[2]];
        const float ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
        const float wx = c.x - a.x, wy = c.y - a.y, wz = c.z - a.z;
        const float nx = uy * wz - uz * wy, ny = uz * wx - ux * wz, nz = ux * wy - uy * wx;
        for (const std::uint32_t v : triangle) {
            float* sum = &sums_[std::size_t{3} * v];
            sum[0] += nx, sum[1] += ny, sum[2] += nz;
        }
    }
    // Only what differs from what was given last: most of a mesh stays as it is when it is refined a little.
    std::int16_t run[4 * DirtyRuns::kRun];
    for (std::size_t begin = 0; begin < places.size(); begin += DirtyRuns::kRun) {
        const std::size_t end = std::min(places.size(), begin + DirtyRuns::kRun);
        std::int16_t* to = run;
        for (std::size_t v = begin; v < end; ++v, to += 4) {
            const float* sum = &sums_[3 * v];
            const float length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
            const bool sound = length > 0 && std::isfinite(length);
            const float scale = sound ? 32767 / length : 0;
            for (int k = 0; k < 3; ++k) to[k] = rounded(sound ? sum[k] * scale : 0);
            if (!sound) to[2] = 32767;
            to[3] = 0;
        }
        const std::size_t size = 4 * (end - begin);
        if (std::memcmp(run, &normal_[4 * begin], size * sizeof run[0]) == 0) continue;
        std::copy_n(run, size, &normal_[4 * begin]);
        std::copy_n(run, size, normals_.add(4 * begin, size));
    }
    return normals_;
}

}  // namespace vsplit::web
