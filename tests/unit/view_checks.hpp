// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What tests of ViewMesh compare: triangles with the places of their corners, and views of all kinds.
#pragma once

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "decorated.hpp"
#include "family.hpp"
#include "naive_record.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/view_mesh.hpp"

namespace vsplit::test {

/// A triangle with its number, corners, and the bits of their places.
using Drawn = std::array<std::uint32_t, 13>;

inline Drawn drawn(std::uint32_t number, const Triangle& t, std::span<const Float3> places) {
    Drawn out{number, t[0], t[1], t[2]};
    for (std::size_t i = 0; i < 3; ++i) std::memcpy(&out[4 + 3 * i], &places[t[i]], sizeof(Float3));
    return out;
}

inline std::set<Drawn> all_levels(const ProgressiveMesh& mesh) {
    std::set<Drawn> all;
    LiveMesh live(mesh);
    for (std::size_t level = 0; level <= live.max_level(); ++level) {
        live.go_to(level);
        for (std::uint32_t t = 0; t < live.triangles().size(); ++t)
            all.insert(drawn(t, live.triangles()[t], live.positions()));
    }
    return all;
}

inline std::vector<Drawn> of_level(const ProgressiveMesh& mesh, std::size_t level) {
    LiveMesh live(mesh);
    live.go_to(level);
    std::vector<Drawn> out;
    for (std::uint32_t t = 0; t < live.triangles().size(); ++t)
        out.push_back(drawn(t, live.triangles()[t], live.positions()));
    return out;
}

inline std::vector<Drawn> of_view(const ViewMesh& view) {
    std::vector<Drawn> out;
    for (std::size_t i = 0; i < view.triangles().size(); ++i)
        out.push_back(drawn(view.triangle_number(i), view.triangles()[i], view.positions()));
    std::sort(out.begin(), out.end());
    return out;
}

inline std::vector<std::pair<std::string, ProgressiveMesh>> samples() {
    std::vector<std::pair<std::string, ProgressiveMesh>> out;
    for (const NamedMesh& named : mesh_family())
        if (named.mesh.triangles.size() <= 1500) out.emplace_back(named.name, naive_record(named.mesh, 5));
    out.emplace_back("decorated", decorated(naive_record(make_torus(14, 10), 9), 4));
    out.emplace_back("seam", seam(false));
    out.emplace_back("moving seam", seam(true));
    out.emplace_back("returning", returning());
    return out;
}

inline const ViewPlane kNothing[] = {{1, 0, 0, -1e9f}};

inline View everything() {
    View view;
    view.pixels = 0;
    return view;
}

inline void settle(ViewMesh& mesh, const View& view) {
    for (int call = 0; call < 10'000; ++call)
        if (mesh.update(view).settled) return;
    FAIL("does not settle");
}

/// Planes through the middle of a box, eyes around it.
struct RandomView {
    std::mt19937 random;
    std::vector<ViewPlane> planes;

    float unit() { return float(random() % 20001) / 10000.0f - 1; }
    View next(float size) {
        View view;
        view.eye = {3 * size * unit(), 3 * size * unit(), 3 * size * unit()};
        view.pixels = random() % 5 == 0 ? 0.0f : 0.1f + float(random() % 100) / 10;
        view.pixels_at_distance_1 = 500;
        planes.clear();
        for (std::size_t i = random() % 3; i > 0; --i) {
            const float x = unit(), y = unit(), z = unit(), l = std::sqrt(x * x + y * y + z * z);
            if (l > 0) planes.push_back({x / l, y / l, z / l, size * unit() / 2});
        }
        view.planes = planes;
        return view;
    }
};

inline float extent(const ProgressiveMesh& mesh) {
    float most = 1e-3f;
    for (const Float3& p : mesh.positions)
        most = std::max({most, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return most;
}

}  // namespace vsplit::test
