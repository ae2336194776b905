// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Distances: samples stratified along the running area, then every vertex.
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <numbers>

#include "ruler.hpp"

namespace vsplit::ruler {
namespace {

/// Points are taken in blocks of this many; inside a block the last hit is the guess for the next. The
/// blocks, not the threads, decide the order of every sum.
constexpr std::size_t kBlock = 1024;

/// A number in [0, 1) that depends on the seed and the counter alone (SplitMix64: Steele, Lea and Flood,
/// OOPSLA 2014).
double random_unit(std::uint64_t seed, std::uint64_t counter) {
    std::uint64_t z = seed * 0xD1342543DE82EF95ull + counter * 0x9E3779B97F4A7C15ull + 0x9E3779B97F4A7C15ull;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return double((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

struct Sums {
    double distance = 0, squared = 0, max2 = 0, degrees = 0;
    std::uint64_t angles = 0;
};

double angle_degrees(Vec3 a, Vec3 b) {
    return std::atan2(length(cross(a, b)), dot(a, b)) * (180 / std::numbers::pi);
}

template <class Visit>
Sums over_blocks(std::size_t count, const Visit& visit) {
    std::vector<Sums> blocks((count + kBlock - 1) / kBlock);
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t block) {
        Sums sums;
        std::uint32_t guess = TriangleTree::kNoGuess;
        for (std::size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i)
            visit(i, sums, guess);
        blocks[block] = sums;
    });
    Sums total;
    for (const Sums& sums : blocks) {
        total.distance += sums.distance;
        total.squared += sums.squared;
        total.max2 = std::max(total.max2, sums.max2);
        total.degrees += sums.degrees;
        total.angles += sums.angles;
    }
    return total;
}

}  // namespace

OneWay Ruler::one_way(const Mesh& from, const Mesh& to, const TriangleTree& tree, std::uint64_t seed) const {
    std::vector<double> area_until(from.triangles.size());
    double area = 0;
    for (std::size_t i = 0; i < area_until.size(); ++i)
        area_until[i] = area += 0.5 * length(area_vector(from, from.triangles[i]));
    const std::size_t count = options_.samples;
    const Sums samples = over_blocks(count, [&](std::size_t i, Sums& sums, std::uint32_t& guess) {
        const double at = area * (double(i) + random_unit(seed, 3 * i)) / double(count);
        const auto found = std::lower_bound(area_until.begin(), area_until.end(), at);
        const auto index = std::min(std::size_t(found - area_until.begin()), area_until.size() - 1);
        const Triangle& t = from.triangles[index];
        const double u = std::sqrt(random_unit(seed, 3 * i + 1)), w = random_unit(seed, 3 * i + 2);
        const Vec3 point = to_vec(from.positions[t[0]]) * (1 - u) +
                           to_vec(from.positions[t[1]]) * (u * (1 - w)) +
                           to_vec(from.positions[t[2]]) * (u * w);
        const TriangleTree::Hit hit = tree.closest(point, guess);
        guess = hit.slot;
        sums.distance += std::sqrt(hit.distance2);
        sums.squared += hit.distance2;
        sums.max2 = std::max(sums.max2, hit.distance2);
        const Vec3 here = area_vector(from, t), there = area_vector(to, to.triangles[hit.triangle]);
        if (dot(here, here) > 0 && dot(there, there) > 0) {
            sums.degrees += angle_degrees(here, there);
            ++sums.angles;
        }
    });
    std::vector<char> used(from.positions.size(), 0);
    for (const Triangle& t : from.triangles)
        for (const std::uint32_t v : t) used[v] = 1;
    const Sums vertices =
        over_blocks(from.positions.size(), [&](std::size_t i, Sums& sums, std::uint32_t& guess) {
            if (!used[i]) return;
            const TriangleTree::Hit hit = tree.closest(to_vec(from.positions[i]), guess);
            guess = hit.slot;
            sums.max2 = std::max(sums.max2, hit.distance2);
        });
    return {samples.distance / double(count), std::sqrt(samples.squared / double(count)),
            std::sqrt(std::max(samples.max2, vertices.max2)),
            samples.angles ? samples.degrees / double(samples.angles) : 0};
}

}  // namespace vsplit::ruler
