// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// The reconstruction's inner life as files for ParaView, in the caller's coordinates.
#pragma once

#include "points/frame.hpp"
#include "surface/classic.hpp"
#include "vsplit/bake/surface.hpp"

namespace vsplit::bake {

std::vector<std::byte> dump_voronoi(const Frame& frame, const Tetrahedra& tetrahedra, const Balls& balls,
                                    const std::vector<std::uint8_t>* inside);
std::vector<std::byte> dump_labels(const Frame& frame, const Tetrahedra& tetrahedra,
                                   const std::vector<std::uint8_t>& inside);
std::vector<std::byte> dump_poles(const Frame& frame, const PoleBalls& poles,
                                  const std::vector<std::uint8_t>& inner, const UniquePoints& samples);
std::vector<std::byte> dump_power(const Frame& frame, const PoleBalls& poles, const PowerDiagram& diagram,
                                  const std::vector<std::uint8_t>& inner);

/// Inner poles that have a cell in the diagram, with the regular triangulation's edges and triangles among
/// them.
MedialAxis power_shape(const Frame& frame, const PoleBalls& poles, const PowerDiagram& diagram,
                       const std::vector<std::uint8_t>& inner);

}  // namespace vsplit::bake
