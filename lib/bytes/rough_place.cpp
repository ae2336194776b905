// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Encoder: which of the places that later moves replace may be told in coarser steps.
#include <cmath>

#include "split_codec.hpp"

namespace vsplit {

bool SplitCodec::may_be_rough(PlaceGuides& guides, const Lattice3& place, double tolerance, const Ring& ring,
                              const Lattice3& partner) {
    NoCoder look;
    const Lattice3 near = place_.code(look, guides, place, true);  // changes no model
    const auto offset = [&](const Lattice3& p) {
        return std::array<double, 3>{double(p[0]) - place[0], double(p[1]) - place[1],
                                     double(p[2]) - place[2]};
    };
    const auto moved = offset(near);
    auto before = offset(partner);
    for (std::uint32_t i = 0; i <= ring.size; ++i) {
        const auto now = offset(i == ring.size ? partner : live.vertices[ring.vertex[i]].at);
        const std::array<double, 3> normal = {before[1] * now[2] - before[2] * now[1],
                                              before[2] * now[0] - before[0] * now[2],
                                              before[0] * now[1] - before[1] * now[0]};
        const double length =
            std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
        const double height = moved[0] * normal[0] + moved[1] * normal[1] + moved[2] * normal[2];
        if (std::abs(height) > tolerance * length) return false;
        before = now;
    }
    // An edge of the mesh's boundary has no plane that would keep it.
    return !ring.open;
}

}  // namespace vsplit
