// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "paper_cost.hpp"

#include <algorithm>
#include <limits>

namespace vsplit::bake {
namespace {

Double3 unit(Double3 n) {
    const double len = length(n);
    return len > 0 ? n * (1 / len) : Double3{};
}

}  // namespace

double regularity(Double3 a, Double3 b, Double3 c) {
    double l[3] = {length(b - a), length(c - b), length(a - c)};
    std::sort(l, l + 3);
    return l[1] > 0 ? (l[0] + l[1] - l[2]) / l[1] : 0;
}

double edge_curvature(std::span<const Double3> normals_at_end, std::span<const Double3> normals_on_edge) {
    double largest = 0;
    if (normals_on_edge.empty()) return 0;
    for (const Double3 n1 : normals_at_end) {
        double smallest = 1;
        for (const Double3 n2 : normals_on_edge) smallest = std::min(smallest, (1 - dot(n1, n2)) / 2);
        largest = std::max(largest, smallest);
    }
    return largest;
}

void PlaneQuadric::add_plane(Double3 p, Double3 n2) {
    const double len = length(n2);
    if (!(len > 0)) return;
    const Double3 n = n2 * (1 / len);
    const double w = 0.5 * len, d = -dot(n, p);
    a[0] += w * n.x * n.x;
    a[1] += w * n.x * n.y;
    a[2] += w * n.x * n.z;
    a[3] += w * n.y * n.y;
    a[4] += w * n.y * n.z;
    a[5] += w * n.z * n.z;
    b = b + n * (w * d);
    c += w * d * d;
    area += w;
}

void PlaneQuadric::add(const PlaneQuadric& other) {
    for (std::size_t i = 0; i < 6; ++i) a[i] += other.a[i];
    b = b + other.b;
    c += other.c;
    area += other.area;
}

double PlaneQuadric::distance(Double3 x) const {
    return area > 0 ? std::sqrt(std::max(0.0, value(x)) / area) : 0;
}

PaperCost::PaperCost(const StarMesh& mesh) : quadrics_(mesh.vertex_count()) {
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
        const Triangle& c = mesh.triangle(t);
        const Double3 n2 = mesh.normal(c);
        for (const std::uint32_t v : c) quadrics_[v].add_plane(mesh.position(c[0]), n2);
    }
}

double PaperCost::cost_at(const EdgeStar& star, Double3 place, double weight_u, double weight_v) const {
    // Re: the mean over the triangles that result.
    double regular = 0;
    thread_local std::vector<Double3> at_u, at_v, on_edge;
    at_u.clear();
    at_v.clear();
    on_edge.clear();
    for (std::size_t i = 0; i < star.size; ++i) {
        const EdgeStar::Wing wing = star.wing(i);
        regular += regularity(place, wing.pa, wing.pb);
        const Double3 apex = wing.at_first ? star.pu : star.pv;
        (wing.at_first ? at_u : at_v).push_back(unit(cross(wing.pa - apex, wing.pb - apex)));
    }
    for (std::size_t i = 0; i < star.opposite.size(); ++i) {
        Double3 n = unit(cross(star.pv - star.pu, star.opposite_places[i] - star.pu));
        if (!star.forward[i]) n = n * -1.0;
        on_edge.push_back(n);
    }
    // The edge's triangles are at both ends, too; against themselves their smallest turn is 0, so they add
    // nothing.
    constexpr double kLeastRegularity = 1e-3;
    const double re = star.size == 0 ? 1 : std::max(kLeastRegularity, regular / double(star.size));
    const double len = length(star.pv - star.pu);
    const double fu = len * edge_curvature(at_u, on_edge), fv = len * edge_curvature(at_v, on_edge);
    return weight_u * (quadrics_[star.u].distance(place) / re + fu) +
           weight_v * (quadrics_[star.v].distance(place) / re + fv);
}

Candidate PaperCost::evaluate(const StarMesh&, const EdgeStar& star, Fold fold, Placement placement,
                              double weight_u, double weight_v) const {
    const auto at = [&](Double3 place) { return Candidate{place, cost_at(star, place, weight_u, weight_v)}; };
    if (fold == Fold::kIntoFirst) return at(star.pu);
    if (fold == Fold::kIntoSecond) return at(star.pv);
    Candidate best = at(star.pu);
    const auto better = [&](const Candidate& other) {
        if (other.cost < best.cost) best = other;
    };
    better(at(star.pv));
    if (placement == Placement::kEndpoint) return best;
    const Double3 middle = (star.pu + star.pv) * 0.5;
    better(at(middle));
    // The minimum of the weighted quadrics, about the middle for accuracy.
    PlaneQuadric sum;
    const PlaneQuadric &qu = quadrics_[star.u], &qv = quadrics_[star.v];
    for (std::size_t i = 0; i < 6; ++i) sum.a[i] = weight_u * qu.a[i] + weight_v * qv.a[i];
    sum.b = qu.b * weight_u + qv.b * weight_v;
    const Double3 gradient = times(sum.a, middle) + sum.b;
    const double pull = 1e-6 * trace(sum.a) + 1e-30;
    Symmetric m = sum.a;
    m[0] += pull;
    m[3] += pull;
    m[5] += pull;
    Double3 x;
    if (solve(m, gradient * -1.0, x) && length2(x) <= 4 * length2(star.pv - star.pu)) better(at(middle + x));
    return best;
}

}  // namespace vsplit::bake
