// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Random samples of shapes whose truth is known.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace vsplit::test {

using Position = std::array<double, 3>;

inline std::vector<Position> sphere_points(int count, Position centre, double radius, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::vector<Position> points;
    for (int i = 0; i < count; ++i) {
        const Position p{normal(random), normal(random), normal(random)};
        const double r = radius / std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        points.push_back({centre[0] + p[0] * r, centre[1] + p[1] * r, centre[2] + p[2] * r});
    }
    return points;
}

/// Around the z axis, or around the y axis if `upright`. Even by area.
inline std::vector<Position> torus_points(int count, Position centre, double major, double minor,
                                          bool upright, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> u(0, 1);
    std::vector<Position> points;
    while (int(points.size()) < count) {
        const double a = 2 * std::numbers::pi * u(random), b = 2 * std::numbers::pi * u(random);
        if (u(random) * (major + minor) > major + minor * std::cos(b)) continue;
        const double r = major + minor * std::cos(b);
        const Position p{r * std::cos(a), r * std::sin(a), minor * std::sin(b)};
        points.push_back(
            {centre[0] + p[0], centre[1] + (upright ? p[2] : p[1]), centre[2] + (upright ? p[1] : p[2])});
    }
    return points;
}

inline std::vector<Position> box_points(int count, Position size, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> u(0, 1);
    const double areas[3] = {size[1] * size[2], size[2] * size[0], size[0] * size[1]};
    std::vector<Position> points;
    for (int i = 0; i < count; ++i) {
        double pick = u(random) * (areas[0] + areas[1] + areas[2]);
        std::size_t axis = 0;
        while (axis < 2 && pick > areas[axis]) pick -= areas[axis++];
        Position p{u(random) * size[0], u(random) * size[1], u(random) * size[2]};
        p[axis] = u(random) < 0.5 ? 0 : size[axis];
        points.push_back(p);
    }
    return points;
}

/// A height field over a square of side 10.
inline std::vector<Position> terrain_points(int count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> u(0, 10);
    std::vector<Position> points;
    for (int i = 0; i < count; ++i) {
        const double x = u(random), y = u(random);
        points.push_back({x, y, 0.8 * std::sin(x) * std::cos(0.7 * y) + 0.1 * std::sin(5 * x + 3 * y)});
    }
    return points;
}

inline void jitter(std::vector<Position>& points, double deviation, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0, deviation);
    for (Position& p : points)
        for (double& x : p) x += normal(random);
}

inline void scatter(std::vector<Position>& points, int count, double half, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> u(-half, half);
    for (int i = 0; i < count; ++i) points.push_back({u(random), u(random), u(random)});
}

}  // namespace vsplit::test
