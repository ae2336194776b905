// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "place_model.hpp"

#include <algorithm>

namespace vsplit {
namespace {

std::array<std::int64_t, 3> minus(const Lattice3& a, const Lattice3& b) {
    return {std::int64_t{a[0]} - b[0], std::int64_t{a[1]} - b[1], std::int64_t{a[2]} - b[2]};
}

}  // namespace

PlaceWeights default_place_weights() {
    PlaceWeights weights{};
    for (auto& kind : weights)
        for (auto& ring : kind)
            for (std::size_t row = 0; row < 2; ++row) ring[row] = {40, 0, 32};
    for (auto& ring : weights[2])
        for (std::size_t row = 0; row < 2; ++row) ring[row] = {-32, 24, 24};
    return weights;
}

std::array<std::int64_t, 3> PlaceModel::mix(const PlaceGuides& g, std::size_t row) const {
    const auto& w = weights_[static_cast<std::size_t>(g.kind)][g.ring_class][row];
    std::array<std::int64_t, 3> out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::int64_t sum = 32;
        for (std::size_t i = 0; i < kPlaceGuides; ++i) sum += std::int64_t{w[i]} * g.guide[i][axis];
        out[axis] = sum >> 6;
    }
    return out;
}

PlaceGuides PlaceModel::guide_birth(const LiveStars& mesh, std::uint32_t parent, const Ring& ring,
                                    bool moving) const {
    PlaceGuides g;
    g.kind = moving ? PlaceKind::kBirthMoving : PlaceKind::kBirth;
    g.ring_class = ring.open ? 6 : std::clamp<std::uint32_t>(ring.size, 2, 7) - 2;
    g.from = mesh.vertices[parent].at;
    std::array<std::int64_t, 3> sum{}, bumps{};
    for (std::uint32_t i = 0; i < ring.size; ++i) {
        const auto d = minus(mesh.vertices[ring.vertex[i]].at, g.from);
        const Lattice3 bump = mesh.bump(ring.vertex[i]);
        for (std::size_t a = 0; a < 3; ++a) sum[a] += d[a], bumps[a] += bump[a];
    }
    const auto first = minus(mesh.vertices[ring.vertex[0]].at, g.from),
               last = minus(mesh.vertices[ring.vertex[ring.size - 1]].at, g.from);
    for (std::size_t a = 0; a < 3; ++a) {
        g.guide[0][a] = static_cast<std::int32_t>(mean16(sum[a], ring.size));
        g.guide[1][a] = static_cast<std::int32_t>(8 * (first[a] + last[a]));
        g.guide[2][a] = static_cast<std::int32_t>(mean16(bumps[a], ring.size) >> 4);
    }
    measure(mesh, ring, g.from, g);
    return g;
}

PlaceGuides PlaceModel::guide_move(const LiveStars& mesh, std::uint32_t parent, const Ring& ring,
                                   const Lattice3& child) const {
    PlaceGuides g;
    g.kind = PlaceKind::kMove;
    g.ring_class = ring.open ? 6 : std::clamp<std::uint32_t>(ring.size, 2, 7) - 2;
    g.from = mesh.vertices[parent].at;
    const auto to_child = minus(child, g.from);
    std::array<std::int64_t, 3> sum = to_child, bumps{};
    for (std::uint32_t i = 0; i < ring.size; ++i) {
        const auto d = minus(mesh.vertices[ring.vertex[i]].at, g.from);
        const Lattice3 bump = mesh.bump(ring.vertex[i]);
        for (std::size_t a = 0; a < 3; ++a) sum[a] += d[a], bumps[a] += bump[a];
    }
    for (std::size_t a = 0; a < 3; ++a) {
        g.guide[0][a] = static_cast<std::int32_t>(16 * to_child[a]);
        g.guide[1][a] = static_cast<std::int32_t>(mean16(sum[a], ring.size + 1));
        g.guide[2][a] = ring.size == 0 ? 0 : static_cast<std::int32_t>(mean16(bumps[a], ring.size) >> 4);
    }
    measure(mesh, ring, child, g);
    return g;
}

void PlaceModel::measure(const LiveStars& mesh, const Ring& ring, const Lattice3& extra,
                         PlaceGuides& g) const {
    // The polygon of the ring and the vertex across from it: twice its area as a vector.
    const std::uint32_t count = ring.size + 1;
    const auto at = [&](std::uint32_t i) -> const Lattice3& {
        return i == ring.size ? extra : mesh.vertices[ring.vertex[i]].at;
    };
    std::array<std::int64_t, 3> normal{}, centre{};
    auto before = minus(at(count - 1), g.from);
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto now = minus(at(i), g.from);
        normal[0] += before[1] * now[2] - before[2] * now[1];
        normal[1] += before[2] * now[0] - before[0] * now[2];
        normal[2] += before[0] * now[1] - before[1] * now[0];
        for (std::size_t a = 0; a < 3; ++a) centre[a] += now[a];
        before = now;
    }
    std::size_t c = 2;
    std::uint64_t largest = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        const auto size = static_cast<std::uint64_t>(normal[a] < 0 ? -normal[a] : normal[a]);
        if (size > largest) largest = size, c = a;
    }
    // Short enough for products with differences in 1/16.
    const int excess = std::max(0, static_cast<int>(std::bit_width(largest)) - 24);
    for (std::size_t a = 0; a < 3; ++a) g.normal[a] = normal[a] >> excess;
    g.across = c;

    const auto along = mix(g, 0);
    std::array<std::int64_t, 3> spread{};
    const std::size_t first = c == 0 ? 1 : 0, second = c == 2 ? 1 : 2;
    std::int64_t squares = 0, products = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto d = minus(at(i), g.from);
        for (std::size_t a = 0; a < 3; ++a) spread[a] += std::abs(16 * d[a] - along[a]);
        squares += d[first] * d[first];
        products += d[first] * d[second];
    }
    squares = count * squares - centre[first] * centre[first];
    products = count * products - centre[first] * centre[second];
    g.lean = 0;
    if (squares > 0) {
        const int over =
            std::max(0, static_cast<int>(std::bit_width(static_cast<std::uint64_t>(squares))) - 50);
        squares >>= over;
        products >>= over;
        const std::int64_t most = 4 * squares;
        g.lean = static_cast<std::int32_t>(768 * std::clamp(products, -most, most) / squares);
    }
    for (std::size_t a = 0; a < 3; ++a)
        g.spread[a] = static_cast<std::uint32_t>((spread[a] / 4 * kReciprocals[count]) >> 16);
    g.roughness = 0;
    if (g.normal[c] != 0) {
        // Distances of the polygon's corners, and of the point predicted, from the plane through their
        // middle.
        std::array<std::int64_t, 3> middle;
        for (std::size_t a = 0; a < 3; ++a) middle[a] = mean16(centre[a], count);
        const auto height = [&](const std::array<std::int64_t, 3>& d) {
            return (d[0] - middle[0]) * g.normal[0] + (d[1] - middle[1]) * g.normal[1] +
                   (d[2] - middle[2]) * g.normal[2];
        };
        std::int64_t sum = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto d = minus(at(i), g.from);
            sum += std::abs(height({16 * d[0], 16 * d[1], 16 * d[2]})) >> 4;
        }
        const std::int64_t mean = (sum >> 8) * kReciprocals[count] >> 8;
        const std::int64_t over = height(mix(g, 1)), predicted = std::abs(over) >> 4;
        g.rise = static_cast<std::int32_t>(half_octave(static_cast<std::uint64_t>(4 * predicted))) -
                 static_cast<std::int32_t>(half_octave(static_cast<std::uint64_t>(std::abs(g.normal[c]))));
        g.sinks = (over < 0) != (g.normal[c] < 0);
        g.roughness = static_cast<std::uint32_t>(
            std::min<std::int64_t>(4 * (mean + predicted / 2) / std::abs(g.normal[c]), 1 << 26));
    }
}

}  // namespace vsplit
