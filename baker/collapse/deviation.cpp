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
    // A vertex that never moved is its own witness.
    const auto is_own = [](Double3 p, const Float3& witness) {
        return float(p.x) == witness.x && float(p.y) == witness.y && float(p.z) == witness.z;
    };
    std::size_t asked[4] = {0, 1}, count = 2;
    const bool own_u = is_own(star.pu, hu.witness), own_v = is_own(star.pv, hv.witness);
    if (!own_u) asked[count++] = 2;
    if (!own_v) asked[count++] = 3;
    for (const EdgeStar::Wings& wing : star.wings) {
        const TriangleDistance<Lanes> after(to, wing.a, wing.b), before(wing.apex, wing.a, wing.b);
        for (std::size_t n = 0; n < count; ++n) {
            const std::size_t i = asked[n];
            to_new[i] = lesser(to_new[i], after.squared(lanes(points[i])));
        }
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
    const double first = least(to_new[own_u ? 0 : 2]), second = least(to_new[own_v ? 1 : 3]);
    result.witness = second > first ? hv.witness : hu.witness;
    const double farthest = std::max({least(to_new[0]), least(to_new[1]), first, second});
    result.largest = std::max(std::sqrt(farthest), double(result.at_place));
    return result;
}

}  // namespace vsplit::bake
