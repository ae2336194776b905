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

}  // namespace

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
