// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "vsplit/camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

/// The smallest and the largest stretch of a linear map given by its columns.
std::pair<double, double> stretches(const double (&c)[3][3]) {
    // Jacobi's rotations of its square; a few sweeps are enough for a matrix of three.
    double a[3][3];
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            a[i][j] = c[i][0] * c[j][0] + c[i][1] * c[j][1] + c[i][2] * c[j][2];
    for (int sweep = 0; sweep < 8; ++sweep)
        for (const auto& [p, q] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}}) {
            if (a[p][q] == 0) continue;
            const double angle = 0.5 * std::atan2(2 * a[p][q], a[q][q] - a[p][p]);
            const double cosine = std::cos(angle), sine = std::sin(angle);
            for (std::size_t k = 0; k < 3; ++k) {
                const double x = a[k][p], y = a[k][q];
                a[k][p] = cosine * x - sine * y;
                a[k][q] = sine * x + cosine * y;
            }
            for (std::size_t k = 0; k < 3; ++k) {
                const double x = a[p][k], y = a[q][k];
                a[p][k] = cosine * x - sine * y;
                a[q][k] = sine * x + cosine * y;
            }
        }
    const auto [least, most] = std::minmax({a[0][0], a[1][1], a[2][2]});
    return {std::sqrt(std::max(least, 0.0)), std::sqrt(std::max(most, 0.0))};
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

View object_view(const CameraView& view, std::array<ViewPlane, kViewPlanes>& planes) {
    View out;
    out.pixels = view.pixels;
    out.hysteresis = view.hysteresis;
    out.facing = view.facing;
    const std::span<const float, 16> m(view.to_world);
    // The eye, by Cramer's rule.
    double c[3][3], eye[3];
    for (std::size_t column = 0; column < 3; ++column)
        for (std::size_t row = 0; row < 3; ++row) c[column][row] = m[4 * column + row];
    const double to[3] = {double(view.camera.eye.x) - double(m[12]),
                          double(view.camera.eye.y) - double(m[13]),
                          double(view.camera.eye.z) - double(m[14])};
    const auto det = [](const double(&a)[3], const double(&b)[3], const double(&d)[3]) {
        return a[0] * (b[1] * d[2] - b[2] * d[1]) - a[1] * (b[0] * d[2] - b[2] * d[0]) +
               a[2] * (b[0] * d[1] - b[1] * d[0]);
    };
    const double volume = det(c[0], c[1], c[2]);
    const auto nothing = [&] {
        planes[0] = {1, 0, 0, -std::numeric_limits<float>::max()};
        out.planes = std::span(planes).first(1);
        return out;
    };
    if (!(std::fabs(volume) > 0) || !std::isfinite(volume)) return nothing();
    eye[0] = det(to, c[1], c[2]) / volume;
    eye[1] = det(c[0], to, c[2]) / volume;
    eye[2] = det(c[0], c[1], to) / volume;
    out.eye = {float(eye[0]), float(eye[1]), float(eye[2])};
    if (!std::isfinite(out.eye.x) || !std::isfinite(out.eye.y) || !std::isfinite(out.eye.z)) return nothing();

    // Stretches of the transform: the roots of the eigenvalues of its square.
    const auto [least, most] = stretches(c);
    out.pixels_at_distance_1 =
        float(view.camera.viewport_height / (2 * std::tan(view.camera.vertical_fov / 2)) *
              (least > 0 ? most / least : 1));
    if (!view.to_clip) return out;
    // Sides of the clip space (Gribb and Hartmann 2001), in the object's space.
    double rows[4][4];
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 4; ++column) {
            double sum = 0;
            for (std::size_t k = 0; k < 4; ++k)
                sum += double((*view.to_clip)[4 * k + row]) * double(m[4 * column + k]);
            rows[row][column] = sum;
        }
    std::size_t count = 0;
    const auto add = [&](std::size_t axis, double sign) {
        double p[4];
        for (std::size_t i = 0; i < 4; ++i) p[i] = rows[3][i] + (sign == 0 ? 0 : sign * rows[axis][i]);
        const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        if (!(length > 0) || !std::isfinite(length)) return;  // no side, as w of a parallel projection
        planes[count++] = {float(p[0] / length), float(p[1] / length), float(p[2] / length),
                           float(p[3] / length)};
    };
    for (const std::size_t axis : {0, 1})
        for (const double sign : {1.0, -1.0}) add(axis, sign);
    add(0, 0);
    out.planes = std::span(planes).first(count);
    return out;
}

double error_of_view(const View& view, const Float3& low, const Float3& high) {
    for (const ViewPlane& plane : view.planes) {
        const double far = double(plane.x) * double(plane.x > 0 ? high.x : low.x) +
                           double(plane.y) * double(plane.y > 0 ? high.y : low.y) +
                           double(plane.z) * double(plane.z > 0 ? high.z : low.z) + double(plane.w);
        if (far < 0) return std::numeric_limits<double>::infinity();
    }
    if (!(view.pixels > 0)) return 0;
    const double x = std::max({double(low.x) - double(view.eye.x), 0.0, double(view.eye.x) - double(high.x)});
    const double y = std::max({double(low.y) - double(view.eye.y), 0.0, double(view.eye.y) - double(high.y)});
    const double z = std::max({double(low.z) - double(view.eye.z), 0.0, double(view.eye.z) - double(high.z)});
    return double(view.pixels) * std::sqrt(x * x + y * y + z * z) / double(view.pixels_at_distance_1);
}

}  // namespace vsplit
