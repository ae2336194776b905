// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "quadric_cost.hpp"

namespace vsplit::bake {

VSPLIT_CLONES void price_edges(const StarMesh& mesh, std::uint32_t u, std::span<const std::uint32_t> others,
                               const CollapseOptions& options, float* prices) {
    const Shape<double> from = shape_of(mesh, u);
    Shape<Lanes> first{lanes(from.position), lanes(from.weight), {}, lanes(from.area), lanes(from.size)};
    for (std::size_t i = 0; i < 6; ++i) first.quadric[i] = lanes(from.quadric[i]);
    for (std::size_t begin = 0; begin < others.size(); begin += 4) {
        const std::size_t last = others.size() - 1;
        const float* four[4];
        for (std::size_t i = 0; i < 4; ++i)
            four[i] = &mesh.vertex(others[std::min(begin + i, last)]).position.x;
        alignas(32) Lanes rows[4][4];
        for (std::size_t row = 0; row < 4; ++row)
            transpose(four[0] + 4 * row, four[1] + 4 * row, four[2] + 4 * row, four[3] + 4 * row, rows[row]);
        const Shape<Lanes> second{mesh.work(rows[0]),
                                  rows[0][3],
                                  {{rows[1][0], rows[1][1], rows[1][2], rows[1][3], rows[2][0], rows[2][1]}},
                                  {rows[2][2], rows[2][3], rows[3][0]},
                                  rows[3][1]};
        const EdgeQuadric<Lanes> edges(first, second, options);
        const Lanes cost = edges.best().cost;
        const Lanes price = select(cost < edges.noise(), lanes(double(kUnsurePrice)), edges.price(cost));
        for (std::size_t i = 0; i < 4 && begin + i < others.size(); ++i) prices[begin + i] = float(price[i]);
    }
}

namespace {

/// The part of all triangles of a star, four at a time. `bends`: one of them departs much from their mean
/// direction; not asked of large stars.
VSPLIT_CLONES TrianglePart<double> part_of_star(const StarMesh& mesh, std::uint32_t v, bool& bends) {
    const auto star = mesh.star(v);
    const bool keeps = star.size() <= kLargeStar;
    TrianglePart<Lanes> whole;
    const Lanes3 p = lanes(mesh.position(v));
    Lanes3 normals[kLargeStar / 4];
    for (std::size_t begin = 0; begin < star.size(); begin += 4) {
        std::uint32_t a[4], b[4];
        for (std::size_t i = 0; i < 4; ++i) {
            const Triangle& c = mesh.triangle(star[std::min(begin + i, star.size() - 1)]);
            const std::size_t k = c[0] == v ? 0 : c[1] == v ? 1 : 2;
            a[i] = c[k == 2 ? 0 : k + 1];
            b[i] = c[k == 0 ? 2 : k - 1];
        }
        const Lanes3 normal = cross(mesh.positions(a) - p, mesh.positions(b) - p);
        if (keeps) normals[begin / 4] = normal;
        const LaneMask counts = double(begin) + Lanes{0, 1, 2, 3} < double(star.size());
        whole.add(TrianglePart<Lanes>(normal), select(counts, lanes(1), lanes(0)));
    }
    TrianglePart<double> part;
    for (std::size_t i = 0; i < 6; ++i) part.quadric[i] = sum(whole.quadric[i]);
    part.area = {sum(whole.area.x), sum(whole.area.y), sum(whole.area.z)};
    part.size = sum(whole.size);
    bends = false;
    if (!keeps) return part;
    const Lanes3 mean = lanes(part.area);
    const Lanes least = 0.1 * length2(mean);
    for (std::size_t i = 0; 4 * i < star.size(); ++i) {
        const Lanes along = dot(normals[i], mean);
        bends |= any((along <= 0.0) | (along * along < least * length2(normals[i])));
    }
    return part;
}

}  // namespace

Shape<double> exact_shape(const StarMesh& mesh, std::uint32_t v, double boundary_weight,
                          std::vector<Neighbour>& scratch, bool* bends) {
    bool ignored;
    TrianglePart<double> sum = part_of_star(mesh, v, bends ? *bends : ignored);
    const Double3 p = mesh.position(v);
    if (mesh.kind(v) != VertexKind::kInner) {
        neighbours_of(mesh, v, scratch);
        for (const Neighbour& n : scratch) {
            if (!n.special()) continue;
            const Double3 edge = mesh.position(n.vertex) - p;
            const double e2 = length2(edge), weight = boundary_weight * std::sqrt(e2);
            sum.quadric[0] += weight * (e2 - edge.x * edge.x);
            sum.quadric[1] -= weight * edge.x * edge.y;
            sum.quadric[2] -= weight * edge.x * edge.z;
            sum.quadric[3] += weight * (e2 - edge.y * edge.y);
            sum.quadric[4] -= weight * edge.y * edge.z;
            sum.quadric[5] += weight * (e2 - edge.z * edge.z);
        }
    }
    return {p, double(mesh.vertex(v).weight), sum.quadric, sum.area, sum.size};
}

VSPLIT_CLONES TrianglePart<double> update_ring(StarMesh& mesh, const EdgeStar& star) {
    TrianglePart<Lanes> whole;
    for (std::size_t i = 0; i < star.wings.size(); ++i) {
        const LaneMask counts = double(4 * i) + Lanes{0, 1, 2, 3} < double(star.size);
        TrianglePart<Lanes> change(star.wings[i].after);
        whole.add(change, select(counts, lanes(1), lanes(0)));
        change.add(TrianglePart<Lanes>(star.wings[i].before), lanes(-1));
        const auto& q = change.quadric;
        FourFloats rows[3][4];
        transpose(q[0], q[1], q[2], q[3], rows[0]);
        transpose(q[4], q[5], change.area.x, change.area.y, rows[1]);
        transpose(change.area.z, change.size, lanes(0), lanes(0), rows[2]);
        for (std::size_t k = 0; k < 4 && 4 * i + k < star.size; ++k)
            for (const std::uint32_t w : {star.a[4 * i + k], star.b[4 * i + k]}) {
                float* shape = mesh.vertex(w).quadric;
                FourFloats low, high;
                __builtin_memcpy(&low, shape, 16);
                __builtin_memcpy(&high, shape + 4, 16);
                low += rows[0][k];
                high += rows[1][k];
                __builtin_memcpy(shape, &low, 16);
                __builtin_memcpy(shape + 4, &high, 16);
                mesh.vertex(w).area[2] += rows[2][k][0];
                mesh.vertex(w).size += rows[2][k][1];
            }
    }
    for (std::size_t i = 0; i < star.opposite.size(); ++i) {
        TrianglePart<double> gone;
        const Double3 n = cross(star.pv - star.pu, star.opposite_places[i] - star.pu);
        gone.add(TrianglePart<double>(star.forward[i] ? n : n * -1.0), -1);
        add_part(mesh.vertex(star.opposite[i]), gone);
    }
    TrianglePart<double> total;
    for (std::size_t i = 0; i < 6; ++i) total.quadric[i] = sum(whole.quadric[i]);
    total.area = {sum(whole.area.x), sum(whole.area.y), sum(whole.area.z)};
    total.size = sum(whole.size);
    return total;
}

}  // namespace vsplit::bake
