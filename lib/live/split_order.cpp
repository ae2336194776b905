// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "split_order.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace vsplit {

void SplitOrder::build(const ProgressiveMesh& mesh, const ViewPlan& plan, std::span<const float> weights) {
    const std::size_t count = plan.nodes.size();
    // Errors first, weights where these are the same: floats that are not negative are ordered as their bits.
    std::vector<std::uint64_t> keys(count);
    for (std::size_t k = 0; k < count; ++k) {
        const float weight = weights.empty() ? 1 : std::fabs(weights[k]);
        const float weighed =
            std::min(weight * std::fabs(mesh.splits[k].error), std::numeric_limits<float>::max());
        keys[k] =
            std::uint64_t{std::bit_cast<std::uint32_t>(weighed)} << 32 | std::bit_cast<std::uint32_t>(weight);
    }
    // Needs are older than what needs them.
    for (std::size_t k = count; k-- > 0;)
        for (std::uint32_t i = plan.needs_begin[k]; i < plan.needs_begin[k + 1]; ++i)
            keys[plan.needs[i]] = std::max(keys[plan.needs[i]], keys[k]);
    splits.resize(count);
    std::iota(splits.begin(), splits.end(), 0u);
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
        return keys[a] != keys[b] ? keys[a] > keys[b] : a < b;
    };
    if (!std::is_sorted(splits.begin(), splits.end(), before))
        std::sort(splits.begin(), splits.end(), before);

    vertices_end.resize(count);
    triangles_end.resize(count);
    error.resize(count);
    std::uint32_t vertices = mesh.base_vertices, triangles = mesh.base_triangles;
    for (std::size_t rank = 0; rank < count; ++rank) {
        const std::uint32_t k = splits[rank];
        vertices +=
            mesh.splits[k].vertices_end - (k == 0 ? mesh.base_vertices : mesh.splits[k - 1].vertices_end);
        triangles +=
            mesh.splits[k].triangles_end - (k == 0 ? mesh.base_triangles : mesh.splits[k - 1].triangles_end);
        vertices_end[rank] = vertices;
        triangles_end[rank] = triangles;
        error[rank] = std::bit_cast<float>(std::uint32_t(keys[k] >> 32));
    }
}

std::size_t SplitOrder::memory() const {
    return sizeof(std::uint32_t) * (splits.capacity() + vertices_end.capacity() + triangles_end.capacity()) +
           sizeof(float) * error.capacity();
}

}  // namespace vsplit
