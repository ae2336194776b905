// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// The measure of all reconstruction times: CGAL's own Delaunay_triangulation_3 of the same points, range
// insertion.
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

std::size_t triangulate_alone(std::span<const std::array<double, 3>> positions) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    std::vector<Kernel::Point_3> points;
    for (const auto& p : positions) points.emplace_back(p[0], p[1], p[2]);
    return CGAL::Delaunay_triangulation_3<Kernel>(points.begin(), points.end()).number_of_finite_cells();
}
