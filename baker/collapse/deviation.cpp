// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "deviation.hpp"

#include <algorithm>

#include "distance.hpp"

namespace vsplit::bake {

VSPLIT_CLONES Deviation deviation_of(const EdgeStar& star, Double3 place,
                                     const std::vector<VertexHistory>& histories) {
    const VertexHistory &hu = histories[star.u], &hv = histories[star.v];
    const auto widened = [](const Float3& p) { return Double3{p.x, p.y, p.z}; };
    const Double3 points[4] = {star.pu, star.pv, widened(hu.witness), widened(hv.witness)};
    const double infinity = std::numeric_limits<double>::infinity();
    alignas(32) Lanes to_new[4] = {lanes(infinity), lanes(infinity), lanes(infinity), lanes(infinity)},
                      to_old = lanes(infinity);
    const Lanes3 to = lanes(place);
    for (const EdgeStar::Wings& wing : star.wings) {
        const TriangleDistance<Lanes> after(to, wing.a, wing.b), before(wing.apex, wing.a, wing.b);
        for (std::size_t i = 0; i < 4; ++i) to_new[i] = lesser(to_new[i], after.squared(lanes(points[i])));
        to_old = lesser(to_old, before.squared(to));
    }
    double nearest_old = least(to_old);
    for (const Double3 opposite : star.opposite_places)
        nearest_old =
            std::min(nearest_old, TriangleDistance<double>(star.pu, star.pv, opposite).squared(place));

    Deviation result;
    const double du = length(place - star.pu), dv = length(place - star.pv);
    const double t = du + dv > 0 ? du / (du + dv) : 0;
    result.at_place =
        float(std::sqrt(nearest_old) + (1 - t) * double(hu.deviation) + t * double(hv.deviation));
    const double first = least(to_new[2]), second = least(to_new[3]);
    result.witness = second > first ? hv.witness : hu.witness;
    const double farthest = std::max({least(to_new[0]), least(to_new[1]), first, second});
    result.largest = std::max(std::sqrt(farthest), double(result.at_place));
    return result;
}

}  // namespace vsplit::bake
