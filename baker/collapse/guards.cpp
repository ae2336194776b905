// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "guards.hpp"

#include <algorithm>

namespace vsplit::bake {
namespace {

/// The edge's triangles do not run along it once in each direction.
bool is_special(const StarMesh& mesh, std::uint32_t u, std::uint32_t v) {
    int out = 0, in = 0;
    for (const std::uint32_t t : mesh.star(u)) {
        const Triangle& c = mesh.triangle(t);
        const int k = c[0] == u ? 0 : c[1] == u ? 1 : 2;
        out += c[(k + 1) % 3] == v;
        in += c[(k + 2) % 3] == v;
    }
    return out != 1 || in != 1;
}

}  // namespace

Fold fold_rule(const StarMesh& mesh, std::uint32_t u, std::uint32_t v) {
    const VertexKind ku = mesh.kind(u), kv = mesh.kind(v);
    if (ku == VertexKind::kFixed && kv == VertexKind::kFixed) return Fold::kNever;
    // A curve's vertices fold along it only; an inner vertex has no special edge.
    if (ku != VertexKind::kInner && kv != VertexKind::kInner && !is_special(mesh, u, v)) return Fold::kNever;
    if (ku == VertexKind::kFixed) return Fold::kIntoFirst;
    if (kv == VertexKind::kFixed) return Fold::kIntoSecond;
    return Fold::kAnywhere;
}

void EdgeStar::gather(const StarMesh& mesh, std::uint32_t first, std::uint32_t second) {
    u = first;
    v = second;
    pu = mesh.position(u);
    pv = mesh.position(v);
    wings.clear();
    opposite.clear();
    opposite_places.clear();
    forward.clear();
    const auto add = [&](std::uint32_t apex, Double3 place, std::uint32_t other, bool at_first) {
        for (const std::uint32_t t : mesh.star(apex)) {
            const Triangle& c = mesh.triangle(t);
            const int k = c[0] == apex ? 0 : c[1] == apex ? 1 : 2;
            const std::uint32_t a = c[(k + 1) % 3], b = c[(k + 2) % 3];
            if (a == other || b == other) {
                if (at_first) {
                    opposite.push_back(a == other ? b : a);
                    opposite_places.push_back(mesh.position(opposite.back()));
                    forward.push_back(a == other);
                }
            } else {
                const Double3 pa = mesh.position(a), pb = mesh.position(b);
                wings.push_back({a, b, pa, pb, cross(pa - place, pb - place), at_first});
            }
        }
    };
    add(u, pu, v, true);
    add(v, pv, u, false);
}

bool Guards::keeps_topology(const EdgeStar& star) {
    // Something must remain, also of the vertices across the edge.
    if (star.wings.empty()) return false;
    for (std::size_t i = 0; i < star.opposite.size(); ++i) {
        if (mesh_.star(star.opposite[i]).size() < 2) return false;
        for (std::size_t j = 0; j < i; ++j)
            if (star.opposite[i] == star.opposite[j]) return false;
    }
    // Link condition: the neighbours that both ends share are those across the edge, no others.
    if (stamp_ > 0xFFFFFFF0u) {
        std::fill(stamps_.begin(), stamps_.end(), 0);
        stamp_ = 0;
    }
    const std::uint32_t seen_first = ++stamp_, shared = ++stamp_;
    for (const EdgeStar::Wing& wing : star.wings)
        if (wing.at_first) stamps_[wing.a] = stamps_[wing.b] = seen_first;
    for (const std::uint32_t w : star.opposite) stamps_[w] = shared;
    for (const EdgeStar::Wing& wing : star.wings)
        if (!wing.at_first && (stamps_[wing.a] == seen_first || stamps_[wing.b] == seen_first)) return false;
    // ... nor an edge between two of them: both ends would make the same triangle of it.
    bool first_has = false, second_has = false;
    for (const EdgeStar::Wing& wing : star.wings)
        if (stamps_[wing.a] == shared && stamps_[wing.b] == shared)
            (wing.at_first ? first_has : second_has) = true;
    return !(first_has && second_has);
}

bool Guards::keeps_shape(const EdgeStar& star, Double3 place, const std::vector<VertexHistory>& histories,
                         const Strictness& strictness) const {
    if (star.wings.size() > strictness.max_valence) return false;
    const VertexHistory &su = histories[star.u], &sv = histories[star.v];
    const Double3 own{double(su.normal[0]) + double(sv.normal[0]),
                      double(su.normal[1]) + double(sv.normal[1]),
                      double(su.normal[2]) + double(sv.normal[2])};
    const auto opposes = [&](std::uint32_t v, Double3 n) {
        return double(histories[v].normal[0]) * n.x + double(histories[v].normal[1]) * n.y +
                   double(histories[v].normal[2]) * n.z <
               0;
    };
    const double cosine = strictness.min_normal_cosine, quality = strictness.min_quality;
    for (const EdgeStar::Wing& wing : star.wings) {
        const Double3 side = wing.pb - wing.pa, spoke = wing.pa - place;
        const Double3 after = cross(spoke, side);
        const double before2 = length2(wing.normal), after2 = length2(after);
        // An area below 1e-14 of the squared extent counts as none, but what was there before may stay.
        if (!(after2 > std::min(1e-26, before2))) return false;
        const double turn = dot(wing.normal, after), limit2 = cosine * cosine * before2 * after2;
        if (cosine > 0 ? turn < 0 || turn * turn < limit2 : turn < 0 && turn * turn > limit2) return false;
        // 4 sqrt(3) area / (sum of squared edges), compared without roots.
        const double edges = length2(spoke) + length2(side) + length2(wing.pb - place);
        if (12 * after2 < quality * quality * edges * edges) {
            const Double3 apex = wing.at_first ? star.pu : star.pv;
            const double edges_before = length2(wing.pa - apex) + length2(side) + length2(wing.pb - apex);
            if (after2 * edges_before * edges_before < before2 * edges * edges) return false;
        }
        if (strictness.keep_orientation &&
            (dot(own, after) < 0) + opposes(wing.a, after) + opposes(wing.b, after) >= 2)
            return false;
    }
    return true;
}

}  // namespace vsplit::bake
