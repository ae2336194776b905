// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "vsplit/stream.hpp"

namespace vsplit {
namespace {

/// Pixels that one unit of the object spans at most; infinite within its bounding sphere.
double pixels_a_unit(const Camera& camera, const Float3& low, const Float3& high,
                     std::span<const float, 16> to_world) {
    const double middle[3] = {0.5 * (double(low.x) + double(high.x)), 0.5 * (double(low.y) + double(high.y)),
                              0.5 * (double(low.z) + double(high.z))};
    const double eye[3] = {camera.eye.x, camera.eye.y, camera.eye.z};
    double distance2 = 0, columns[3] = {0, 0, 0};
    for (std::size_t row = 0; row < 3; ++row) {
        double place = to_world[12 + row];
        for (std::size_t column = 0; column < 3; ++column) {
            const double m = to_world[4 * column + row];
            place += m * middle[column];
            columns[column] += m * m;
        }
        distance2 += (place - eye[row]) * (place - eye[row]);
    }
    // The longest column is the stretch of any rotation and scaling; shear is bounded by their root sum.
    double stretch = std::sqrt(std::max({columns[0], columns[1], columns[2]}));
    const auto product = [&](std::size_t a, std::size_t b) {
        double sum = 0;
        for (std::size_t row = 0; row < 3; ++row)
            sum += double(to_world[4 * a + row]) * double(to_world[4 * b + row]);
        return std::fabs(sum);
    };
    if (product(0, 1) + product(0, 2) + product(1, 2) > 1e-4 * stretch * stretch)
        stretch = std::sqrt(columns[0] + columns[1] + columns[2]);
    const double x = double(high.x) - double(low.x), y = double(high.y) - double(low.y),
                 z = double(high.z) - double(low.z);
    const double near = std::sqrt(distance2) - 0.5 * stretch * std::sqrt(x * x + y * y + z * z);
    if (!(near > 0)) return std::numeric_limits<double>::infinity();
    return stretch * camera.viewport_height / (2 * std::tan(camera.vertical_fov / 2) * near);
}

}  // namespace

double error_of_pixels(const Camera& camera, const Float3& bounds_min, const Float3& bounds_max,
                       std::span<const float, 16> to_world, double pixels) {
    const double unit = pixels_a_unit(camera, bounds_min, bounds_max, to_world);
    if (!(unit > 0)) return std::numeric_limits<double>::max();
    return std::isfinite(unit) ? pixels / unit : 0;
}

double pixels_of_error(const Camera& camera, const Float3& bounds_min, const Float3& bounds_max,
                       std::span<const float, 16> to_world, double error) {
    return error > 0 ? error * pixels_a_unit(camera, bounds_min, bounds_max, to_world) : 0;
}

}  // namespace vsplit
