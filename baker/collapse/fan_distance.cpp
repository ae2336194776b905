// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "fan_distance.hpp"

#include <algorithm>
#include <limits>

#include "distance.hpp"

namespace vsplit::bake {
namespace {

VSPLIT_CLONES void nearest_of(const Double3* corners, std::size_t triangles, const Double3* points,
                              std::size_t count, double* distance2, std::uint32_t* nearest) {
    for (std::size_t i = 0; i < triangles; i += 4) {
        Lanes3 place[3];
        for (std::size_t lane = 0; lane < 4; ++lane) {
            const Double3* t = corners + 3 * std::min(i + lane, triangles - 1);
            for (std::size_t k = 0; k < 3; ++k) {
                place[k].x[lane] = t[k].x;
                place[k].y[lane] = t[k].y;
                place[k].z[lane] = t[k].z;
            }
        }
        const TriangleDistance<Lanes> four(place[0], place[1], place[2]);
        for (std::size_t p = 0; p < count; ++p) {
            const Lanes found = four.squared(lanes(points[p]));
            for (std::size_t lane = 0; lane < 4; ++lane)
                if (found[lane] < distance2[p]) {
                    distance2[p] = found[lane];
                    nearest[p] = std::uint32_t(std::min(i + lane, triangles - 1));
                }
        }
    }
}

}  // namespace

void FanDistance::find() {
    distance2.assign(points.size(), std::numeric_limits<double>::infinity());
    nearest.assign(points.size(), 0);
    nearest_of(corners.data(), corners.size() / 3, points.data(), points.size(), distance2.data(),
               nearest.data());
}

}  // namespace vsplit::bake
