// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <random>

#include "collapse/triangle_distance.hpp"
#include "collapse/triangle_tree.hpp"
#include "vsplit/progressive_mesh.hpp"

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
        // Of the first few it is the nearest, which is one of the mesh's.
        const auto few = tree.closest(p, TriangleTree::kNoGuess, 0, infinity, 4);
        REQUIRE(few.distance2 >= least);
        REQUIRE(few.distance2 == to(few.triangle));
    }
}

TEST_CASE("a tree in the order of its leaves finds the same", "[collapse][tree]") {
    const Mesh mesh = soup(700);
    const TriangleTree tree(mesh);
    Mesh arranged = mesh;
    arranged.positions.push_back({9, 9, 9});  // of no triangle
    TriangleTree other(arranged);
    const std::vector<std::uint32_t> number = other.arrange(arranged);
    REQUIRE(number.size() == mesh.positions.size() + 1);
    REQUIRE(number.back() == kNoVertex);
    REQUIRE(arranged.triangles.size() == mesh.triangles.size());
    for (int i = -10; i <= 10; ++i) {
        const Double3 p{0.1 * i, 0.3, -0.07 * i};
        const auto here = tree.closest(p), there = other.closest(p);
        REQUIRE(there.distance2 == here.distance2);
        REQUIRE(there.triangle == there.slot);
        const Triangle& a = mesh.triangles[here.triangle];
        const Triangle& b = arranged.triangles[there.triangle];
        for (std::size_t k = 0; k < 3; ++k) REQUIRE(number[a[k]] == b[k]);
    }
}
