// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "points/filters.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/bilateral_smooth_point_set.h>
#include <CGAL/jet_estimate_normals.h>
#include <CGAL/jet_smooth_point_set.h>
#include <CGAL/property_map.h>
#include <CGAL/wlop_simplify_and_regularize_point_set.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

namespace vsplit::bake {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Concurrency = CGAL::Parallel_if_available_tag;

std::vector<Point> to_cgal(std::span<const Vec3> points) {
    std::vector<Point> copies;
    copies.reserve(points.size());
    for (const Vec3& p : points) copies.emplace_back(p.x, p.y, p.z);
    return copies;
}

}  // namespace

void smooth_jet(std::vector<Vec3>& points, int neighbours) {
    std::vector<Point> copies = to_cgal(points);
    CGAL::jet_smooth_point_set<Concurrency>(copies, static_cast<unsigned>(neighbours));
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = {copies[i].x(), copies[i].y(), copies[i].z()};
}

void smooth_bilateral(std::vector<Vec3>& points, std::vector<Vec3> normals, int neighbours) {
    using Oriented = std::pair<Point, Kernel::Vector_3>;
    std::vector<Oriented> pairs;
    pairs.reserve(points.size());
    const bool given = normals.size() == points.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 n = given ? unit(normals[i]) : Vec3{};
        pairs.emplace_back(Point(points[i].x, points[i].y, points[i].z), Kernel::Vector_3(n.x, n.y, n.z));
    }
    const auto maps = CGAL::parameters::point_map(CGAL::First_of_pair_property_map<Oriented>())
                          .normal_map(CGAL::Second_of_pair_property_map<Oriented>());
    if (!given) CGAL::jet_estimate_normals<Concurrency>(pairs, static_cast<unsigned>(neighbours), maps);
    CGAL::bilateral_smooth_point_set<Concurrency>(pairs, static_cast<unsigned>(neighbours), maps);
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i] = {pairs[i].first.x(), pairs[i].first.y(), pairs[i].first.z()};
}

std::vector<std::uint32_t> thin_grid(std::span<const Vec3> points, double cell) {
    struct Place {
        std::array<std::int64_t, 3> cell;
        std::uint32_t index;
        bool operator<(const Place& other) const {
            return std::tie(cell, index) < std::tie(other.cell, other.index);
        }
    };
    // Finer than 2^-40 of the cloud there is nothing to thin.
    const double scale = 1 / std::max(cell, 0x1p-40);
    std::vector<Place> places;
    places.reserve(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        const Vec3 q = points[i] * scale;
        places.push_back(
            {{std::int64_t(std::floor(q.x)), std::int64_t(std::floor(q.y)), std::int64_t(std::floor(q.z))},
             i});
    }
    std::sort(places.begin(), places.end());
    std::vector<std::uint32_t> kept;
    for (std::size_t first = 0; first < places.size();) {
        std::size_t last = first;
        Vec3 mean;
        for (; last < places.size() && places[last].cell == places[first].cell; ++last)
            mean = mean + points[places[last].index];
        mean = mean * (1.0 / static_cast<double>(last - first));
        std::uint32_t best = places[first].index;
        for (std::size_t i = first; i < last; ++i)
            if (squared_length(points[places[i].index] - mean) < squared_length(points[best] - mean))
                best = places[i].index;
        kept.push_back(best);
        first = last;
    }
    std::sort(kept.begin(), kept.end());
    return kept;
}

std::vector<Vec3> thin_wlop(std::span<const Vec3> points, double share, double spacing) {
    std::vector<Point> copies = to_cgal(points), kept;
    CGAL::wlop_simplify_and_regularize_point_set<Concurrency>(copies, std::back_inserter(kept),
                                                              CGAL::parameters::select_percentage(share * 100)
                                                                  .neighbor_radius(spacing * 4)
                                                                  .number_of_iterations(15));
    std::vector<Vec3> result;
    result.reserve(kept.size());
    for (const Point& p : kept) result.push_back({p.x(), p.y(), p.z()});
    return result;
}

}  // namespace vsplit::bake
