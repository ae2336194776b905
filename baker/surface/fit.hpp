// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the surface looks like near each of its vertices: a tangent plane and a quadratic height over it,
// fitted to those neighbours that lie on the same side of any crease.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "surface/crust.hpp"

namespace vsplit::bake {

/// The height bend[0] xx + bend[1] xy + bend[2] yy over the tangent plane through a vertex.
struct Patch {
    Vec3 normal, x_axis, y_axis;
    std::array<double, 3> bend{};

    /// A flat frame with this normal.
    void turn_to(Vec3 n);
    /// How far the patch lies, along its normal, over the point at `offset` from the vertex.
    double height_over(Vec3 offset) const {
        const double x = dot(offset, x_axis), y = dot(offset, y_axis);
        return bend[0] * x * x + bend[1] * x * y + bend[2] * y * y - dot(offset, normal);
    }
};

std::vector<Patch> fit_patches(const Crust& crust, std::span<const std::uint32_t> opposite);

}  // namespace vsplit::bake
