// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "fan_distance.hpp"

#include <algorithm>
#include <limits>

#include "distance.hpp"

namespace vsplit::bake {
namespace {

VSPLIT_CLONES void nearest_of(const Double3* corners, std::size_t triangles, const Double3* points,
                              std::size_t count, FanDistance::Nearest* nearest) {
    for (std::size_t i = 0; i < triangles; i += 4) {
        Lanes3 place[3];
        Lanes number;
        for (std::size_t lane = 0; lane < 4; ++lane) {
            const std::size_t index = std::min(i + lane, triangles - 1);
            const Double3* t = corners + 3 * index;
            for (std::size_t k = 0; k < 3; ++k) {
                place[k].x[lane] = t[k].x;
                place[k].y[lane] = t[k].y;
                place[k].z[lane] = t[k].z;
            }
            number[lane] = double(index);
        }
        const TriangleDistance<Lanes> four(place[0], place[1], place[2]);
        for (std::size_t p = 0; p < count; ++p) {
            const Lanes found = four.squared(lanes(points[p]));
            const auto nearer = found < nearest[p].distance2;
            nearest[p].distance2 = select(nearer, found, nearest[p].distance2);
            nearest[p].index = select(nearer, number, nearest[p].index);
        }
    }
}

VSPLIT_CLONES std::size_t keep_far(const Mesh& mesh, const std::uint32_t* triangles,
                                   std::size_t triangle_count, Double3* points, double* distance2,
                                   std::size_t count, double enough2) {
    for (std::size_t i = 0; i < triangle_count && count > 0; i += 4) {
        Lanes3 place[3];
        for (std::size_t lane = 0; lane < 4; ++lane) {
            const Triangle& t = mesh.triangles[triangles[std::min(i + lane, triangle_count - 1)]];
            for (std::size_t k = 0; k < 3; ++k) {
                const Float3& p = mesh.positions[t[k]];
                place[k].x[lane] = double(p.x);
                place[k].y[lane] = double(p.y);
                place[k].z[lane] = double(p.z);
            }
        }
        const TriangleDistance<Lanes> four(place[0], place[1], place[2]);
        std::size_t kept = 0;
        for (std::size_t p = 0; p < count; ++p) {
            const double found = std::min(distance2[p], least(four.squared(lanes(points[p]))));
            points[kept] = points[p];
            distance2[kept] = found;
            kept += !(found <= enough2);
        }
        count = kept;
    }
    return count;
}

}  // namespace

void FarPoints::drop_near(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, double enough2) {
    distance2.assign(points.size(), std::numeric_limits<double>::infinity());
    const std::size_t left = keep_far(mesh, triangles.data(), triangles.size(), points.data(),
                                      distance2.data(), points.size(), enough2);
    points.resize(left);
    distance2.resize(left);
}

void FanDistance::find() {
    found_.assign(points.size(), {lanes(std::numeric_limits<double>::infinity()), lanes(0)});
    nearest_of(corners.data(), corners.size() / 3, points.data(), points.size(), found_.data());
    distance2.resize(points.size());
    nearest.resize(points.size());
    for (std::size_t p = 0; p < points.size(); ++p) {
        std::size_t lane = 0;
        for (std::size_t other = 1; other < 4; ++other)
            if (found_[p].distance2[other] < found_[p].distance2[lane]) lane = other;
        distance2[p] = found_[p].distance2[lane];
        nearest[p] = std::uint32_t(found_[p].index[lane]);
    }
}

}  // namespace vsplit::bake
