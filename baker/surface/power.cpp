// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface/power.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Regular_triangulation_cell_base_3.h>
#include <CGAL/Regular_triangulation_vertex_base_3.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include "points/flatten.hpp"

namespace vsplit::bake {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase =
    CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel,
                                                CGAL::Regular_triangulation_vertex_base_3<Kernel>>;
using CellBase = CGAL::Triangulation_cell_base_with_info_3<std::uint32_t, Kernel,
                                                           CGAL::Regular_triangulation_cell_base_3<Kernel>>;
using Regular =
    CGAL::Regular_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;

PowerDiagram regular_triangulation(std::span<const Vec3> points, std::span<const double> weights) {
    std::vector<std::pair<Regular::Weighted_point, std::uint32_t>> weighted;
    weighted.reserve(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i)
        weighted.emplace_back(Regular::Weighted_point({points[i].x, points[i].y, points[i].z}, weights[i]),
                              i);
    Regular triangulation(weighted.begin(), weighted.end());
    PowerDiagram diagram;
    flatten(triangulation, points.size(), diagram.cells, diagram.neighbours);
    return diagram;
}

}  // namespace vsplit::bake
