// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// The power crust as published: poles, their power diagram, labels by a priority queue, faces between in and
// out.
#pragma once

#include <cstdint>
#include <vector>

#include "points/tetrahedra.hpp"
#include "surface/crust.hpp"
#include "surface/labels.hpp"
#include "surface/power.hpp"

namespace vsplit::bake {

/// Every Delaunay cell that is a pole, as a ball.
struct PoleBalls {
    std::vector<std::uint32_t> cell;  ///< Of each pole.
    std::vector<Vec3> centres;
    std::vector<double> weights;               ///< Squared radii.
    std::vector<std::uint32_t> first, second;  ///< Poles of each sample, by their index here, or kNoCell.
};

PoleBalls gather_poles(const Tetrahedra& tetrahedra, const Balls& balls, const Poles& poles);

/// 1 for inner poles. Amenta, Choi, Kolluri 2001, section 4.2: certainty spreads from the poles of the box,
/// to a sample's other pole as the opposite label, to deeply intersecting neighbours in the power diagram as
/// the same.
std::vector<std::uint8_t> label_poles(const Tetrahedra& tetrahedra, const PoleBalls& poles,
                                      const PowerDiagram& diagram);

/// The power diagram's faces between poles of different labels, one vertex for each regular cell, polygons as
/// fans. Always a closed 2-manifold: each edge of the diagram meets three cells, so none or two such faces.
Crust power_faces(const Tetrahedra& tetrahedra, const PoleBalls& poles, const PowerDiagram& diagram,
                  const std::vector<std::uint8_t>& inner);

}  // namespace vsplit::bake
