// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "place_model.hpp"

#include <algorithm>
#include <bit>
#include <tuple>

namespace vsplit {

PlaceWeights default_place_weights() {
    PlaceWeights weights{};
    for (auto& kind : weights)
        for (auto& ring : kind)
            for (std::size_t row = 0; row < 2; ++row) ring[row] = {40, 0, 32};
    for (auto& ring : weights[2])
        for (std::size_t row = 0; row < 2; ++row) ring[row] = {-32, 24, 24};
    return weights;
}

/// Offsets from the parent's old place of the ring's vertices, then of the vertex across from it, and sums
/// over the ring.
struct PlaceModel::Around {
    std::array<std::array<std::int32_t, 3>, std::tuple_size_v<decltype(Ring::vertex)> + 1> offset;
    std::array<std::int64_t, 3> sum, bumps;
};

VSPLIT_INLINE void PlaceModel::look_around(const LiveStars& mesh, const Ring& ring, const Lattice3& from,
                                           Around& around) {
    std::int64_t sx = 0, sy = 0, sz = 0, bx = 0, by = 0, bz = 0;
    const std::int32_t fx = from[0], fy = from[1], fz = from[2];
    for (std::uint32_t i = 0; i < ring.size; ++i) {
        const LiveVertex& v = mesh.vertices[ring.vertex[i]];
        const std::int32_t x = v.at[0] - fx, y = v.at[1] - fy, z = v.at[2] - fz;
        around.offset[i] = {x, y, z};
        sx += x, sy += y, sz += z;
        if (v.star - 1 < 128) {
            const std::int64_t reciprocal = kReciprocals[2 * v.star];
            const auto share = [&](std::uint32_t sum) {
                return (static_cast<std::int32_t>(sum) * reciprocal) >> 12;
            };
            bx += 16 * v.at[0] - share(v.ring[0]);
            by += 16 * v.at[1] - share(v.ring[1]);
            bz += 16 * v.at[2] - share(v.ring[2]);
        }
    }
    around.sum = {sx, sy, sz};
    around.bumps = {bx, by, bz};
}

PlaceGuides PlaceModel::guide_birth(const LiveStars& mesh, std::uint32_t parent, const Ring& ring,
                                    bool moving) const {
    PlaceGuides g;
    g.kind = moving ? PlaceKind::kBirthMoving : PlaceKind::kBirth;
    g.ring_class = ring.open ? 6 : std::clamp<std::uint32_t>(ring.size, 2, 7) - 2;
    g.from = mesh.vertices[parent].at;
    Around around;
    look_around(mesh, ring, g.from, around);
    around.offset[ring.size] = {};
    const auto &first = around.offset[0], &last = around.offset[ring.size - 1];
    for (std::size_t a = 0; a < 3; ++a) {
        g.guide[0][a] = static_cast<std::int32_t>(mean16(around.sum[a], ring.size));
        g.guide[1][a] = 8 * (first[a] + last[a]);
        g.guide[2][a] = static_cast<std::int32_t>(mean16(around.bumps[a], ring.size) >> 4);
    }
    measure(around, ring.size + 1, g);
    return g;
}

PlaceGuides PlaceModel::guide_move(const LiveStars& mesh, std::uint32_t parent, const Ring& ring,
                                   const Lattice3& child) const {
    PlaceGuides g;
    g.kind = PlaceKind::kMove;
    g.ring_class = ring.open ? 6 : std::clamp<std::uint32_t>(ring.size, 2, 7) - 2;
    g.from = mesh.vertices[parent].at;
    Around around;
    look_around(mesh, ring, g.from, around);
    auto& to_child = around.offset[ring.size];
    for (std::size_t a = 0; a < 3; ++a) {
        to_child[a] = child[a] - g.from[a];
        around.sum[a] += to_child[a];
        g.guide[0][a] = 16 * to_child[a];
        g.guide[1][a] = static_cast<std::int32_t>(mean16(around.sum[a], ring.size + 1));
        g.guide[2][a] =
            ring.size == 0 ? 0 : static_cast<std::int32_t>(mean16(around.bumps[a], ring.size) >> 4);
    }
    measure(around, ring.size + 1, g);
    return g;
}

VSPLIT_INLINE void PlaceModel::measure(const Around& around, std::uint32_t count, PlaceGuides& g) const {
    const auto& w = weights_[static_cast<std::size_t>(g.kind)][g.ring_class];
    for (std::size_t row = 0; row < 2; ++row)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::int64_t sum = 32;
            for (std::size_t i = 0; i < kPlaceGuides; ++i) sum += std::int64_t{w[row][i]} * g.guide[i][axis];
            (row == 0 ? g.along : g.beyond)[axis] = sum >> 6;
        }

    // The polygon of the ring and the vertex across from it: twice its area as a vector.
    std::int64_t nx = 0, ny = 0, nz = 0, sx = 0, sy = 0, sz = 0;
    std::int64_t px = around.offset[count - 1][0], py = around.offset[count - 1][1],
                 pz = around.offset[count - 1][2];
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::int64_t x = around.offset[i][0], y = around.offset[i][1], z = around.offset[i][2];
        nx += py * z - pz * y;
        ny += pz * x - px * z;
        nz += px * y - py * x;
        sx += std::abs(16 * x - g.along[0]);
        sy += std::abs(16 * y - g.along[1]);
        sz += std::abs(16 * z - g.along[2]);
        px = x, py = y, pz = z;
    }
    const std::array<std::int64_t, 3> normal{nx, ny, nz}, spread{sx, sy, sz};
    // guide_move() counts the child already.
    const std::array<std::int64_t, 3>& centre = around.sum;
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
    for (std::size_t a = 0; a < 3; ++a)
        g.spread[a] = static_cast<std::uint32_t>((spread[a] / 4 * kReciprocals[count]) >> 16);
    if (g.ring_class == 3) {
        const auto& o = around.offset;
        for (std::size_t a = 0; a < 3; ++a) {
            const std::int32_t x = o[0][a] + o[3][a], y = o[1][a] + o[4][a], z = o[2][a] + o[5][a];
            g.skew[a] = static_cast<std::uint32_t>(std::abs(x - y) + std::abs(y - z) + std::abs(z - x));
        }
    }
    // How one axis follows the other, and distances of the polygon's corners, and of the point predicted,
    // from the plane through their middle.
    const auto height = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
        return x * g.normal[0] + y * g.normal[1] + z * g.normal[2];
    };
    const std::int64_t middle =
        height(mean16(centre[0], count), mean16(centre[1], count), mean16(centre[2], count));
    const std::int64_t mx = g.normal[0], my = g.normal[1], mz = g.normal[2];
    const std::size_t first = c == 0 ? 1 : 0, second = c == 2 ? 1 : 2;
    std::int64_t sum = 0, squares = 0, products = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto& d = around.offset[i];
        const std::int64_t x = d[0], y = d[1], z = d[2];
        sum += std::abs(16 * (x * mx + y * my + z * mz) - middle) >> 4;
        squares += std::int64_t{d[first]} * d[first];
        products += std::int64_t{d[first]} * d[second];
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
    g.roughness = 0;
    if (g.normal[c] == 0) return;
    const std::int64_t mean = (sum >> 8) * kReciprocals[count] >> 8;
    const std::int64_t over = height(g.beyond[0], g.beyond[1], g.beyond[2]) - middle,
                       predicted = std::abs(over) >> 4;
    g.rise = static_cast<std::int32_t>(half_octave(static_cast<std::uint64_t>(4 * predicted))) -
             static_cast<std::int32_t>(half_octave(static_cast<std::uint64_t>(std::abs(g.normal[c]))));
    g.sinks = (over < 0) != (g.normal[c] < 0);
    g.roughness = static_cast<std::uint32_t>(
        std::min<std::int64_t>(4 * (mean + predicted / 2) / std::abs(g.normal[c]), 1 << 26));
}

}  // namespace vsplit
