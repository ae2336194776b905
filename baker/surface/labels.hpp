// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Poles, and which Delaunay cells lie inside. (Amenta, Choi, Kolluri, "The power crust", 2001; the signed
// links are those of Kolluri, Shewchuk, O'Brien, "Spectral surface reconstruction from noisy point clouds",
// 2004, solved greedily.)
#pragma once

#include <cstdint>
#include <vector>

#include "points/tetrahedra.hpp"

namespace vsplit::bake {

/// Circumscribed ball of each cell: its Voronoi vertex and the squared distance to its four samples. A cell
/// so flat that doubles cannot say where its centre is has the squared radius 0.
struct Balls {
    std::vector<Vec3> centres;
    std::vector<double> squared_radii;
};

Balls circumscribe(const Tetrahedra& tetrahedra);

/// Two cells for each sample, kNoCell where there is none: the farthest Voronoi vertex of its Voronoi cell,
/// and the farthest on the other side of the sample.
struct Poles {
    std::vector<std::uint32_t> first, second;
};

Poles find_poles(const Tetrahedra& tetrahedra, const Balls& balls);

/// 1 for cells inside, 0 outside. Two neighbours whose balls overlap deeply want the same label, the poles of
/// a sample want different ones; the links are obeyed strongest first, as long as they contradict none
/// before. The label of the box corners' side is 0. With `open` the labels are only two sides, and 1 is the
/// side of most poles that are the smaller of their sample's two.
std::vector<std::uint8_t> label_cells(const Tetrahedra& tetrahedra, const Balls& balls, const Poles& poles,
                                      bool open);

}  // namespace vsplit::bake
