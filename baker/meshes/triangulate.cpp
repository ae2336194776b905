// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "triangulate.hpp"

#include <algorithm>
#include <cmath>

namespace vsplit::bake {
namespace {

// Point-in-triangle tests granted per corner. A polygon of n corners with r reflex ones needs about n * r;
// beyond about two thousand reflex corners the rest is fanned.
constexpr std::uint64_t kTestsPerCorner = 4096;

}  // namespace

void Triangulator::flatten(std::span<const std::uint32_t> corners, std::span<const Float3> positions) {
    const std::size_t n = corners.size();
    // Newell's normal (Sutherland et al. 1974), relative to the first corner: far from the origin the
    // products would cancel.
    const Float3 origin = positions[corners[0]];
    double nx = 0, ny = 0, nz = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Float3 p = positions[corners[i]], q = positions[corners[i + 1 == n ? 0 : i + 1]];
        const double px = double(p.x) - origin.x, py = double(p.y) - origin.y, pz = double(p.z) - origin.z;
        const double qx = double(q.x) - origin.x, qy = double(q.y) - origin.y, qz = double(q.z) - origin.z;
        nx += (py - qy) * (pz + qz);
        ny += (pz - qz) * (px + qx);
        nz += (px - qx) * (py + qy);
    }
    // Dropping the coordinate along which the normal is longest keeps exact values: collinear corners stay
    // collinear.
    const double ax = std::abs(nx), ay = std::abs(ny), az = std::abs(nz);
    points_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Float3 p = positions[corners[i]];
        if (az >= ax && az >= ay)
            points_[i] = nz >= 0 ? Point{p.x, p.y} : Point{p.y, p.x};
        else if (ax >= ay)
            points_[i] = nx >= 0 ? Point{p.y, p.z} : Point{p.z, p.y};
        else
            points_[i] = ny >= 0 ? Point{p.z, p.x} : Point{p.x, p.z};
    }
}

/// Twice the signed area of a, b, c; positive where the polygon turns left.
double Triangulator::turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const Point p = points_[a], q = points_[b], r = points_[c];
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
}

bool Triangulator::is_ear(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (!(turn(a, b, c) > 0)) return false;
    const auto same = [&](std::uint32_t i, std::uint32_t j) {
        return points_[i].x == points_[j].x && points_[i].y == points_[j].y;
    };
    // Only a corner that does not turn left can be the first to enter an ear. Those that turned left since
    // are weeded out.
    for (std::size_t k = 0; k < reflex_.size();) {
        const std::uint32_t i = reflex_[k];
        if (next_[i] == i || turn(previous_[i], i, next_[i]) > 0) {
            reflex_[k] = reflex_.back();
            reflex_.pop_back();
            continue;
        }
        ++k;
        if (i == a || i == b || i == c) continue;
        if (budget_ == 0) return false;
        --budget_;
        // A bridge to a hole passes through the same point twice: touching a corner of the ear does no harm.
        if (same(i, a) || same(i, b) || same(i, c)) continue;
        if (turn(a, b, i) >= 0 && turn(b, c, i) >= 0 && turn(c, a, i) >= 0) return false;
    }
    return true;
}

void Triangulator::add(std::span<const std::uint32_t> corners, std::span<const Float3> positions,
                       std::vector<Triangle>& out) {
    const auto n = static_cast<std::uint32_t>(corners.size());
    if (n == 3) {
        out.push_back({corners[0], corners[1], corners[2]});
        return;
    }
    flatten(corners, positions);
    if (n == 4) {
        const bool cut02 = turn(0, 1, 2) > 0 && turn(0, 2, 3) > 0,
                   cut13 = turn(0, 1, 3) > 0 && turn(1, 2, 3) > 0;
        const auto length2 = [&](std::uint32_t i, std::uint32_t j) {
            const Float3 p = positions[corners[i]], q = positions[corners[j]];
            const double x = double(p.x) - q.x, y = double(p.y) - q.y, z = double(p.z) - q.z;
            return x * x + y * y + z * z;
        };
        // Where both diagonals lie inside, the shorter one.
        const bool first = cut02 == cut13 ? length2(0, 2) <= length2(1, 3) : cut02;
        if (first) {
            out.push_back({corners[0], corners[1], corners[2]});
            out.push_back({corners[0], corners[2], corners[3]});
        } else {
            out.push_back({corners[0], corners[1], corners[3]});
            out.push_back({corners[1], corners[2], corners[3]});
        }
        return;
    }
    next_.resize(n);
    previous_.resize(n);
    for (std::uint32_t i = 0; i < n; ++i) {
        next_[i] = i + 1 == n ? 0 : i + 1;
        previous_[i] = i == 0 ? n - 1 : i - 1;
    }
    reflex_.clear();
    for (std::uint32_t i = 0; i < n; ++i)
        if (!(turn(previous_[i], i, next_[i]) > 0)) reflex_.push_back(i);
    budget_ = kTestsPerCorner * n;
    std::uint32_t left = n, at = 1, tried = 0;
    while (left > 3 && tried < left && budget_ > 0) {
        const std::uint32_t a = previous_[at], c = next_[at];
        if (!is_ear(a, at, c)) {
            ++tried;
            at = c;
            continue;
        }
        out.push_back({corners[a], corners[at], corners[c]});
        next_[a] = c;
        previous_[c] = a;
        next_[at] = at;
        --left;
        tried = 0;
        // Every other corner in turn: a disc becomes rings of ears instead of one fan of slivers.
        at = next_[c];
    }
    for (std::uint32_t b = next_[at]; left > 2; --left, b = next_[b])
        out.push_back({corners[at], corners[b], corners[next_[b]]});
}

}  // namespace vsplit::bake
