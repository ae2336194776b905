// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "guards.hpp"

#include <algorithm>

namespace vsplit::bake {
namespace {

/// Of as many around an edge, each is compared with each.
constexpr std::size_t kFewTriangles = 16;

enum class EdgeKind : std::uint8_t { kInner, kSpecial, kBoundary };

/// Special: its triangles do not run along it once in each direction, or differ in wedges or group.
EdgeKind kind_of_edge(const StarMesh& mesh, std::uint32_t u, std::uint32_t v) {
    int out = 0, in = 0;
    bool seam = false;
    std::uint32_t first = kNoVertex;
    for (const std::uint32_t t : mesh.star(u)) {
        const Triangle& c = mesh.triangle(t);
        const std::size_t k = c[0] == u ? 0 : c[1] == u ? 1 : 2;
        const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
        out += c[next] == v;
        in += c[last] == v;
        if (!mesh.has_wedges() || (c[next] != v && c[last] != v)) continue;
        if (first == kNoVertex) {
            first = t;
            continue;
        }
        const Triangle& other = mesh.triangle(first);
        const std::size_t other_k = other[0] == u   ? 0
                                    : other[1] == u ? 1
                                                    : 2,
                          other_v = other[0] == v   ? 0
                                    : other[1] == v ? 1
                                                    : 2;
        seam |= mesh.corners(first)[other_k] != mesh.corners(t)[k] ||
                mesh.corners(first)[other_v] != mesh.corners(t)[c[next] == v ? next : last] ||
                mesh.group(first) != mesh.group(t);
    }
    if (out + in == 1) return EdgeKind::kBoundary;
    return seam || out != 1 || in != 1 ? EdgeKind::kSpecial : EdgeKind::kInner;
}

}  // namespace

Fold fold_rule(const StarMesh& mesh, std::uint32_t u, std::uint32_t v) {
    const VertexKind ku = mesh.kind(u), kv = mesh.kind(v);
    if (ku == VertexKind::kFixed && kv == VertexKind::kFixed) return Fold::kNever;
    if (ku != VertexKind::kInner && kv != VertexKind::kInner) {
        // A curve's vertices fold along it only; an inner vertex has no special edge.
        const EdgeKind edge = kind_of_edge(mesh, u, v);
        if (edge == EdgeKind::kInner) return Fold::kNever;
        // From one boundary to another across the surface: would pinch it.
        if (edge != EdgeKind::kBoundary && mesh.vertex(u).open && mesh.vertex(v).open) return Fold::kNever;
    }
    if (ku == VertexKind::kFixed) return Fold::kIntoFirst;
    if (kv == VertexKind::kFixed) return Fold::kIntoSecond;
    if (!mesh.has_wedges()) return Fold::kAnywhere;
    const bool junction_u = mesh.vertex(u).junction, junction_v = mesh.vertex(v).junction;
    if (junction_u && junction_v) {
        // An open one stays open; else the one with the larger star stays.
        if (mesh.vertex(u).open != mesh.vertex(v).open)
            return mesh.vertex(u).open ? Fold::kIntoFirst : Fold::kIntoSecond;
        return mesh.star(u).size() >= mesh.star(v).size() ? Fold::kIntoFirst : Fold::kIntoSecond;
    }
    if (junction_u) return Fold::kIntoFirst;
    if (junction_v) return Fold::kIntoSecond;
    // Onto a seam, but not with it: the other side's attributes belong to the place where it is.
    if (mesh.vertex(u).seam && kv == VertexKind::kInner) return Fold::kIntoFirst;
    if (mesh.vertex(v).seam && ku == VertexKind::kInner) return Fold::kIntoSecond;
    return Fold::kAnywhere;
}

bool may_untie(const StarMesh& mesh, std::uint32_t u, std::uint32_t v, bool u_locked, bool v_locked) {
    if (u_locked && v_locked) return false;
    const auto is_knot = [&](std::uint32_t w, bool locked) {
        return mesh.kind(w) == VertexKind::kFixed && !locked;
    };
    if (!is_knot(u, u_locked) && !is_knot(v, v_locked)) return false;
    return !mesh.vertex(u).open || !mesh.vertex(v).open || kind_of_edge(mesh, u, v) == EdgeKind::kBoundary;
}

bool Guards::keeps_topology(const EdgeStar& star) {
    // Something must remain, also of the vertices across the edge.
    if (star.size == 0) return false;
    for (std::size_t i = 0; i < star.opposite.size(); ++i) {
        if (mesh_.star(star.opposite[i]).size() < 2) return false;
        for (std::size_t j = 0; j < i; ++j)
            if (star.opposite[i] == star.opposite[j]) return false;
    }
    // What hangs together by the edge's triangles alone would come apart.
    if (mesh_.kind(star.u) != VertexKind::kInner && mesh_.kind(star.v) != VertexKind::kInner)
        for (const std::uint32_t w : star.opposite)
            if (std::find(star.a.begin(), star.a.end(), w) == star.a.end() &&
                std::find(star.b.begin(), star.b.end(), w) == star.b.end())
                return false;
    // Link condition: the neighbours that both ends share are those across the edge, no others.
    if (star.size <= kFewTriangles && star.opposite.size() <= 2) return links_meet_across(star);
    if (stamp_ > 0xFFFFFFF0u) {
        std::fill(stamps_.begin(), stamps_.end(), 0);
        stamp_ = 0;
    }
    const std::uint32_t seen_first = ++stamp_, shared = ++stamp_;
    std::uint32_t* const stamps = stamps_.data() - low_;
    for (std::size_t i = 0; i < star.first_size; ++i) stamps[star.a[i]] = stamps[star.b[i]] = seen_first;
    for (const std::uint32_t w : star.opposite) stamps[w] = shared;
    for (std::size_t i = star.first_size; i < star.size; ++i)
        if (stamps[star.a[i]] == seen_first || stamps[star.b[i]] == seen_first) return false;
    // ... nor an edge between two of them: both ends would make the same triangle of it.
    bool first_has = false, second_has = false;
    for (std::size_t i = 0; i < star.size; ++i)
        if (stamps[star.a[i]] == shared && stamps[star.b[i]] == shared)
            (i < star.first_size ? first_has : second_has) = true;
    return !(first_has && second_has);
}

bool Guards::links_meet_across(const EdgeStar& star) {
    const std::uint32_t shared[2] = {star.opposite.empty() ? kNoVertex : star.opposite.front(),
                                     star.opposite.empty() ? kNoVertex : star.opposite.back()};
    const auto is_shared = [&](std::uint32_t w) { return w == shared[0] || w == shared[1]; };
    bool first_has = false, second_has = false;
    for (std::size_t i = 0; i < star.first_size; ++i)
        first_has |= is_shared(star.a[i]) && is_shared(star.b[i]);
    for (std::size_t i = star.first_size; i < star.size; ++i) {
        const bool a = is_shared(star.a[i]), b = is_shared(star.b[i]);
        second_has |= a && b;
        bool meets = false;
        for (std::size_t j = 0; j < star.first_size; ++j) {
            meets |= !a && (star.a[j] == star.a[i] || star.b[j] == star.a[i]);
            meets |= !b && (star.a[j] == star.b[i] || star.b[j] == star.b[i]);
        }
        if (meets) return false;
    }
    return !(first_has && second_has);
}

bool Guards::folds_back(const EdgeStar& star, std::size_t i, Double3 normal, bool keeps_folds) const {
    // Against the others of the new fan that it shares an edge with.
    for (std::size_t j = 0; j < star.size; ++j) {
        if (j == i || (star.a[j] != star.b[i] && star.b[j] != star.a[i])) continue;
        const EdgeStar::Wings& other = star.wings[j / 4];
        if (is_folded(normal, {other.after.x[j % 4], other.after.y[j % 4], other.after.z[j % 4]}))
            return true;
    }
    // Against the triangle beyond.
    for (const std::uint32_t t : mesh_.star(star.a[i])) {
        const Triangle& c = mesh_.triangle(t);
        const auto is_corner = [&](std::uint32_t v) { return c[0] == v || c[1] == v || c[2] == v; };
        if (!is_corner(star.b[i]) || is_corner(star.u) || is_corner(star.v)) continue;
        const Double3 beyond = mesh_.normal(c);
        if (!is_folded(normal, beyond)) continue;
        const EdgeStar::Wings& own = star.wings[i / 4];
        const Double3 before{own.before.x[i % 4], own.before.y[i % 4], own.before.z[i % 4]};
        if (!keeps_folds || !is_folded(before, beyond)) return true;
    }
    return false;
}

VSPLIT_CLONES bool Guards::keeps_shape(const EdgeStar& star, Double3 place,
                                       const std::vector<VertexHistory>& histories,
                                       const Strictness& strictness) const {
    if (star.size > strictness.max_valence) return false;
    const VertexHistory &su = histories[star.u], &sv = histories[star.v];
    const Lanes3 own = lanes(Double3{double(su.normal[0]) + double(sv.normal[0]),
                                     double(su.normal[1]) + double(sv.normal[1]),
                                     double(su.normal[2]) + double(sv.normal[2])});
    const double cosine = strictness.min_normal_cosine, cosine2 = cosine * cosine,
                 quality2 = strictness.min_quality * strictness.min_quality;
    const Lanes3 to = lanes(place);
    const bool near_fold = mesh_.vertex(star.u).folded || mesh_.vertex(star.v).folded;
    for (std::size_t i = 0; i < star.wings.size(); ++i) {
        const EdgeStar::Wings& wing = star.wings[i];
        const Lanes before2 = length2(wing.before), after2 = length2(wing.after);
        // An area below 1e-14 of the squared extent counts as none, but what was there before may stay.
        const LaneMask keeps_area = after2 > lesser(before2, lanes(1e-26));
        const Lanes turn = dot(wing.before, wing.after), turn2 = turn * turn,
                    limit2 = cosine2 * before2 * after2;
        const LaneMask turns = cosine > 0 ? (turn < 0.0) | (turn2 < limit2) : (turn < 0.0) & (turn2 > limit2);
        // 4 sqrt(3) area / (sum of squared edges), compared without roots.
        const Lanes side2 = length2(wing.b - wing.a);
        const Lanes edges = length2(wing.a - to) + side2 + length2(wing.b - to);
        const Lanes edges_before = length2(wing.a - wing.apex) + side2 + length2(wing.b - wing.apex);
        const LaneMask sliver = (12.0 * after2 < quality2 * edges * edges) &
                                (after2 * edges_before * edges_before < before2 * edges * edges);
        if (any(~keeps_area | turns | sliver)) return false;
        const LaneMask much = (turn < 0.0) | (turn2 < 0.8 * before2 * after2);
        if (near_fold || any(much))
            for (std::size_t k = 0; k < 4 && 4 * i + k < star.size; ++k)
                if ((near_fold || much[k]) &&
                    folds_back(star, 4 * i + k, {wing.after.x[k], wing.after.y[k], wing.after.z[k]},
                               !strictness.mend_folds))
                    return false;
        if (!strictness.keep_orientation) continue;
        const auto opposes = [&](const std::uint32_t* four) VSPLIT_INLINE_LAMBDA {
            alignas(32) Lanes normal[4];
            transpose(histories[four[0]].normal, histories[four[1]].normal, histories[four[2]].normal,
                      histories[four[3]].normal, normal);
            return dot(Lanes3{normal[0], normal[1], normal[2]}, wing.after) < 0.0;
        };
        const LaneMask at_place = dot(own, wing.after) < 0.0, at_a = opposes(&star.a[4 * i]),
                       at_b = opposes(&star.b[4 * i]);
        if (any((at_place & at_a) | (at_place & at_b) | (at_a & at_b))) return false;
    }
    return true;
}

}  // namespace vsplit::bake
