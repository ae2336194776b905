// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/refine.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "surface/fit.hpp"

namespace vsplit::bake {
namespace {

enum class Bend : std::uint8_t { kNone, kCurve, kCrease, kCorner };

struct Split {
    Bend bend = Bend::kNone;
    Vec3 point;
};

/// Where the tangent planes of both ends meet, nearest to where the edge crosses the plane that halves their
/// angle: edges side by side across a crease cross that plane in order, so that their points follow the
/// crease in order.
Split crease(Vec3 p, Vec3 q, Vec3 np, Vec3 nq) {
    const double p_over_q = std::abs(dot(nq, p - q)), q_over_p = std::abs(dot(np, q - p));
    if (!(p_over_q + q_over_p > 0)) return {};
    const Vec3 start = p + (q - p) * (p_over_q / (p_over_q + q_over_p));
    const double c = dot(np, nq), a = dot(np, p - start), b = dot(nq, q - start), det = 1 - c * c;
    const Vec3 move = np * ((a - b * c) / det) + nq * ((b - a * c) / det);
    // Planes that meet far away from the edge do not meet in a crease of the surface.
    if (!(squared_length(move) < 0.5 * squared_length(q - p))) return {};
    return {Bend::kCrease, start + move};
}

Split curve(Vec3 p, Vec3 q, const Patch& at_p, const Patch& at_q, double smallest_bow) {
    const Vec3 middle = (p + q) * 0.5;
    const double bow_p = at_p.height_over(middle - p), bow_q = at_q.height_over(middle - q);
    const Vec3 normal = unit(at_p.normal + at_q.normal);
    const double bow = 0.5 * (bow_p + bow_q), size = length(q - p);
    // Where the two ends disagree, neither is to be trusted.
    if (std::abs(bow_p - bow_q) > 0.1 * size || std::abs(bow) > 0.3 * size ||
        std::abs(bow) < smallest_bow * size)
        return {};
    return {Bend::kCurve, middle + normal * bow};
}

/// A piece must look the same way as the tangent plane of a sample that it touches.
bool faces_outward(const std::vector<Vec3>& points, const Triangle& t, std::span<const Patch> patches) {
    const Vec3 n = unit(cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]));
    double best = -1;
    for (const std::uint32_t v : t)
        if (v < patches.size()) best = std::max(best, dot(n, patches[v].normal));
    return best > 0.5 || (t[0] >= patches.size() && t[1] >= patches.size() && t[2] >= patches.size());
}

/// Where three tangent planes meet, if that is near the triangle.
bool meet(const Crust& crust, const Triangle& t, std::span<const Patch> patches, Vec3& point) {
    const Vec3 a = patches[t[0]].normal, b = patches[t[1]].normal, c = patches[t[2]].normal;
    const double det = dot(a, cross(b, c));
    if (std::abs(det) < 0.2) return false;
    const Vec3 origin = (crust.points[t[0]] + crust.points[t[1]] + crust.points[t[2]]) * (1.0 / 3);
    const Vec3 move = (cross(b, c) * dot(a, crust.points[t[0]] - origin) +
                       cross(c, a) * dot(b, crust.points[t[1]] - origin) +
                       cross(a, b) * dot(c, crust.points[t[2]] - origin)) *
                      (1 / det);
    point = origin + move;
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k)
        longest = std::max(longest, squared_length(crust.points[t[k]] - crust.points[t[(k + 1) % 3]]));
    return squared_length(move) < longest;
}

}  // namespace

RefineReport refine(Crust& crust, const RefineOptions& options) {
    const std::vector<std::uint32_t> opposite = pair_edges(crust);
    const std::vector<Patch> patches = fit_patches(crust, opposite);
    const std::size_t samples = crust.points.size(), count = crust.triangles.size();
    std::vector<std::uint32_t> added(opposite.size(), kNoEdge), centres(count, kNoEdge);
    std::vector<Bend> bends(samples, Bend::kNone);
    const auto add = [&](Vec3 point, Bend bend) {
        crust.points.push_back(point);
        bends.push_back(bend);
        return static_cast<std::uint32_t>(crust.points.size() - 1);
    };
    for (std::uint32_t h = 0; h < opposite.size(); ++h) {
        if (opposite[h] == kNoEdge || opposite[h] < h) continue;
        const std::uint32_t a = edge_from(crust, h), b = edge_to(crust, h);
        const Vec3 p = crust.points[a], q = crust.points[b];
        const Split split = dot(patches[a].normal, patches[b].normal) < options.crease_cosine
                                ? crease(p, q, patches[a].normal, patches[b].normal)
                                : curve(p, q, patches[a], patches[b], options.smallest_bow);
        if (split.bend != Bend::kNone) added[h] = added[opposite[h]] = add(split.point, split.bend);
    }
    for (std::uint32_t t = 0; t < count; ++t) {
        bool corner = true;
        for (std::uint32_t k = 0; k < 3; ++k)
            corner = corner && added[3 * t + k] != kNoEdge && bends[added[3 * t + k]] == Bend::kCrease;
        Vec3 point;
        if (corner && meet(crust, crust.triangles[t], patches, point)) centres[t] = add(point, Bend::kCorner);
    }

    // Points that would fold the surface over are given up, until none does.
    const auto middles = [&](std::uint32_t t) {
        return std::array{added[3 * t], added[3 * t + 1], added[3 * t + 2]};
    };
    std::vector<std::uint32_t> todo(count), next;
    for (std::uint32_t t = 0; t < count; ++t) todo[t] = t;
    while (!todo.empty()) {
        next.clear();
        for (const std::uint32_t t : todo) {
            const std::array<std::uint32_t, 3> middle = middles(t);
            if (middle[0] == kNoEdge && middle[1] == kNoEdge && middle[2] == kNoEdge) continue;
            const Pieces pieces = divide(crust.points, crust.triangles[t], middle, centres[t]);
            bool good = true;
            for (std::size_t i = 0; i < pieces.count; ++i)
                good = good && faces_outward(crust.points, pieces.triangles[i], patches);
            if (good) continue;
            if (centres[t] != kNoEdge) {
                centres[t] = kNoEdge;
                next.push_back(t);
                continue;
            }
            // The boldest point of the triangle goes first; the others may be good without it.
            std::uint32_t boldest = kNoEdge;
            double move = -1;
            for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
                if (added[h] == kNoEdge) continue;
                const Vec3 p = crust.points[edge_from(crust, h)], q = crust.points[edge_to(crust, h)];
                const double m =
                    squared_length(crust.points[added[h]] - (p + q) * 0.5) / squared_length(q - p);
                if (m > move) move = m, boldest = h;
            }
            added[boldest] = added[opposite[boldest]] = kNoEdge;
            centres[opposite[boldest] / 3] = kNoEdge;
            next.push_back(t);
            next.push_back(opposite[boldest] / 3);
        }
        todo.swap(next);
    }

    RefineReport report;
    std::vector<Triangle> triangles;
    triangles.reserve(count * 2);
    for (std::uint32_t t = 0; t < count; ++t) {
        const Pieces pieces = divide(crust.points, crust.triangles[t], middles(t), centres[t]);
        triangles.insert(triangles.end(), pieces.triangles.begin(),
                         pieces.triangles.begin() + static_cast<std::ptrdiff_t>(pieces.count));
        report.corner_points += centres[t] != kNoEdge;
    }
    for (std::uint32_t h = 0; h < opposite.size(); ++h)
        if (added[h] != kNoEdge && h < opposite[h])
            (bends[added[h]] == Bend::kCrease ? report.crease_points : report.curve_points) += 1;
    crust.triangles = std::move(triangles);
    drop_unused(crust);
    return report;
}

}  // namespace vsplit::bake
