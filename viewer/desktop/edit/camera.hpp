// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Where one looks from, and what a pixel of that picture meets.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "collapse/vec.hpp"
#include "vsplit/mesh.hpp"

namespace vsplit::studio {

using bake::Double3;

/// A pinhole camera, in the object's units.
struct Camera {
    Double3 eye{0, 0, 1}, target{}, up{0, 1, 0};
    double fov_degrees = 30;         ///< Of the picture's height.
    int width = 1280, height = 800;  ///< Pixels.
};

struct Ray {
    Double3 from, direction;  ///< A unit vector.
};

/// Through the centre of a pixel; x from the left, y from the top.
Ray ray_through(const Camera& camera, double x, double y);
/// Object units that a pixel spans at `distance` along the view.
double pixel_size(const Camera& camera, double distance);

struct Box {
    Double3 low, high;
    Double3 centre() const { return (low + high) * 0.5; }
    double diagonal() const { return bake::length(high - low); }
};
Box box_of(std::span<const Float3> positions);

/// Looks at the whole box: "front", "back", "left", "right", "top", "bottom", "iso", or "AZIMUTH,ELEVATION"
/// in degrees (0,0 is the front, which looks along -z; azimuth turns to the object's left). Nothing if it is
/// none of these.
std::optional<Camera> camera_for(const Box& box, std::string_view view, int width, int height);

struct Hit {
    std::uint32_t triangle = 0;
    std::uint32_t vertex = 0;  ///< The triangle's corner next to the point.
    Double3 point;
    double distance = 0;
};

/// A hit on a triangle that is known; its nearest corner is found.
Hit hit_on(std::span<const Float3> positions, std::span<const Triangle> triangles, std::uint32_t triangle,
           Double3 point, double distance);

/// The first triangle that the ray meets, from either side. All cores; linear: of more than a few rays,
/// Surface::pick() is faster.
std::optional<Hit> pick(std::span<const Float3> positions, std::span<const Triangle> triangles,
                        const Ray& ray);

}  // namespace vsplit::studio
