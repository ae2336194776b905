// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "edge_star.hpp"

namespace vsplit::bake {

VSPLIT_CLONES void EdgeStar::gather(const StarMesh& mesh, std::uint32_t first, std::uint32_t second) {
    u = first;
    v = second;
    pu = mesh.position(u);
    pv = mesh.position(v);
    a.clear();
    triangles.clear();
    opposite_triangles.clear();
    b.clear();
    opposite.clear();
    opposite_places.clear();
    forward.clear();
    for (const std::uint32_t apex : {u, v}) {
        const std::uint32_t other = u + v - apex;
        for (const std::uint32_t t : mesh.star(apex)) {
            const Triangle& c = mesh.triangle(t);
            const std::size_t k = c[0] == apex ? 0 : c[1] == apex ? 1 : 2;
            const std::uint32_t next = c[k == 2 ? 0 : k + 1], last = c[k == 0 ? 2 : k - 1];
            if (next != other && last != other) {
                a.push_back(next);
                b.push_back(last);
                if (mesh.has_wedges()) triangles.push_back(t);
            } else if (apex == u) {
                opposite.push_back(next == other ? last : next);
                opposite_places.push_back(mesh.position(opposite.back()));
                forward.push_back(next == other);
                if (mesh.has_wedges()) opposite_triangles.push_back(t);
            }
        }
        if (apex == u) first_size = a.size();
    }
    size = a.size();
    while (a.size() % 4 != 0) {
        a.push_back(a[size - 1]);
        b.push_back(b[size - 1]);
    }
    wings.resize(a.size() / 4);
    for (std::size_t i = 0; i < wings.size(); ++i) {
        wings[i].a = mesh.positions(&a[4 * i]);
        wings[i].b = mesh.positions(&b[4 * i]);
        const Lanes number = double(4 * i) + Lanes{0, 1, 2, 3};
        // Beyond the last wing comes the last once more.
        const LaneMask at_first = lesser(number, lanes(double(size) - 1)) < double(first_size);
        wings[i].apex = select(at_first, lanes(pu), lanes(pv));
    }
}

VSPLIT_CLONES void EdgeStar::place_at(Double3 place) {
    const Lanes3 to = lanes(place);
    for (Wings& w : wings) {
        w.before = cross(w.a - w.apex, w.b - w.apex);
        w.after = cross(w.a - to, w.b - to);
    }
}

}  // namespace vsplit::bake
