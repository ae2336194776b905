// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "collapse/triangle_distance.hpp"
#include "collapse/triangle_tree.hpp"

using namespace vsplit;
using namespace vsplit::bake;

namespace {

Double3 widened(const Float3& p) {
    return {double(p.x), double(p.y), double(p.z)};
}

/// Small triangles anywhere, some of them degenerate.
Mesh soup(std::uint32_t triangles) {
    std::mt19937 random(7);
    const auto between = [&](float low, float high) {
        return low + (high - low) * float(random() % 10001) / 10000;
    };
    Mesh mesh;
    for (std::uint32_t t = 0; t < triangles; ++t) {
        const Float3 at{between(-1, 1), between(-1, 1), between(-1, 1)};
        for (int k = 0; k < 3; ++k)
            mesh.positions.push_back(
                {at.x + between(-.1f, .1f), at.y + between(-.1f, .1f), at.z + between(-.1f, .1f)});
        if (t % 10 == 0) mesh.positions.back() = mesh.positions[3 * t];
        mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    return mesh;
}

}  // namespace

TEST_CASE("closest triangles are those that looking at all of them finds, whatever is known before",
          "[collapse][tree]") {
    const Mesh mesh = soup(GENERATE(1u, 5u, 700u));
    const TriangleTree tree(mesh);
    const double infinity = std::numeric_limits<double>::infinity();
    std::mt19937 random(3);
    std::uint32_t guess = TriangleTree::kNoGuess;
    for (int i = 0; i < 300; ++i) {
        const auto coordinate = [&] { return double(random() % 3001) / 1000 - 1.5; };
        const Double3 p{coordinate(), coordinate(), coordinate()};
        const auto to = [&](std::uint32_t t) {
            const Triangle& c = mesh.triangles[t];
            return distance2_to_triangle(p, widened(mesh.positions[c[0]]), widened(mesh.positions[c[1]]),
                                         widened(mesh.positions[c[2]]));
        };
        double least = infinity;
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) least = std::min(least, to(t));

        const auto hit = tree.closest(p);
        REQUIRE(hit.distance2 == least);
        REQUIRE(to(hit.triangle) == least);
        REQUIRE(tree.closest(p, guess).distance2 == least);
        guess = hit.slot;
        // A bound above, at and below the distance.
        REQUIRE(tree.closest(p, TriangleTree::kNoGuess, 0, 1.5 * least).distance2 == least);
        REQUIRE(tree.closest(p, TriangleTree::kNoGuess, 0, least).distance2 == least);
        REQUIRE(tree.closest(p, guess, 0, 0.5 * least).distance2 == 0.5 * least);
        // Near enough is neither nearer than the nearest nor farther than asked for, if there is anything.
        const double near = tree.closest(p, TriangleTree::kNoGuess, 2 * least, 100).distance2;
        REQUIRE(near >= least);
        REQUIRE(near <= 2 * least);
    }
}
