// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Cameras: what an error spans on the screen, and what of an object is seen.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "vsplit/mesh.hpp"

namespace vsplit {

/// A perspective camera, in the world's units.
struct Camera {
    Float3 eye;
    double vertical_fov = 0.8;   ///< Radians, above 0 and below pi.
    double viewport_height = 1;  ///< Pixels.
};

/// The geometric error, in the object's units, that spans at most `pixels` on the screen wherever on the
/// object it is. `bounds_min` and `bounds_max` are the object's box (FileInfo's); `to_world` is its
/// transform, column by column; its largest stretch counts. 0 if the camera is within the object's bounding
/// sphere. (Hoppe, Progressive Meshes, SIGGRAPH 1996, section 5: error over distance.)
double error_of_pixels(const Camera& camera, const Float3& bounds_min, const Float3& bounds_max,
                       std::span<const float, 16> to_world, double pixels);

/// The pixels that an error spans at most, the inverse of error_of_pixels(); infinite within the sphere.
double pixels_of_error(const Camera& camera, const Float3& bounds_min, const Float3& bounds_max,
                       std::span<const float, 16> to_world, double error);

/// Half-space x * p.x + y * p.y + z * p.z + w >= 0 with (x, y, z) of length 1.
struct ViewPlane {
    float x = 0, y = 0, z = 0, w = 0;
};

/// What a perspective camera sees of the object, all in the object's own space and units.
struct View {
    Float3 eye;
    /// Pixels that a length of 1 spans at distance 1: viewport height / (2 tan(vertical field of view / 2)).
    float pixels_at_distance_1 = 1000;
    /// The error on the screen that is not worth a split. 0 or less: every split within the planes is.
    float pixels = 1;
    /// A split is undone when its error falls below this share of `pixels`, 0 to 1.
    float hysteresis = 0.8f;
    /// How much of an error counts at least where the surface faces the camera, 0 to 1. At silhouettes all
    /// of it does, and where the surface turns away none.
    float facing = 0.3f;
    /// The frustum; empty: everything is in it. Surface outside is kept as coarse as it can be.
    std::span<const ViewPlane> planes{};
};

/// A camera and where the object is, in the world's units: what View says in the object's.
struct CameraView {
    Camera camera;
    /// The object's transform, column by column.
    std::array<float, 16> to_world{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    /// World to clip space (projection times view), column by column. What is beyond its four sides or behind
    /// the eye is out of view. None: everything is in view.
    std::optional<std::array<float, 16>> to_clip{};
    float pixels = 1, hysteresis = 0.8f, facing = 0.3f;  ///< As in View.
};

/// How many planes object_view() makes at most.
inline constexpr std::size_t kViewPlanes = 5;

/// The view in the object's space. Where the transform stretches one way more than another, errors are taken
/// for the larger and distances for the smaller, so that nothing is refined too little. `planes` hold what
/// the View refers to. An object that the transform makes flat is not seen at all.
View object_view(const CameraView& view, std::array<ViewPlane, kViewPlanes>& planes);

/// The geometric error, in the object's units, that `view` may need of an object within a box: at its nearest
/// place. Infinite if the box is out of view.
double error_of_view(const View& view, const Float3& bounds_min, const Float3& bounds_max);

}  // namespace vsplit
