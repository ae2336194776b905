// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "camera.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <charconv>
#include <limits>
#include <numbers>
#include <utility>

#include "collapse/triangle_distance.hpp"

namespace vsplit::studio {
namespace {

Double3 unit(Double3 v) {
    const double n = bake::length(v);
    return n > 0 ? v * (1 / n) : Double3{0, 0, 1};
}

Double3 at(const Float3& p) {
    return {double(p.x), double(p.y), double(p.z)};
}

double tan_half(const Camera& camera) {
    return std::tan(camera.fov_degrees * std::numbers::pi / 360);
}

std::optional<std::pair<double, double>> two_numbers(std::string_view text) {
    const std::size_t comma = text.find(',');
    if (comma == std::string_view::npos) return std::nullopt;
    double a = 0, b = 0;
    const char* middle = text.data() + comma;
    const char* end = text.data() + text.size();
    if (std::from_chars(text.data(), middle, a).ptr != middle) return std::nullopt;
    if (std::from_chars(middle + 1, end, b).ptr != end || middle + 1 == end) return std::nullopt;
    if (!(std::abs(a) <= 3600 && std::abs(b) <= 90)) return std::nullopt;
    return std::pair{a, b};
}

}  // namespace

Ray ray_through(const Camera& camera, double x, double y) {
    const Double3 forward = unit(camera.target - camera.eye), right = unit(cross(forward, camera.up)),
                  up = cross(right, forward);
    const double half = tan_half(camera), h = double(camera.height);
    const double dx = (2 * (x + 0.5) - double(camera.width)) / h * half, dy = (h - 2 * (y + 0.5)) / h * half;
    return {camera.eye, unit(forward + right * dx + up * dy)};
}

double pixel_size(const Camera& camera, double distance) {
    return 2 * tan_half(camera) * distance / double(camera.height);
}

Box box_of(std::span<const Float3> positions) {
    if (positions.empty()) return {};
    Box box{at(positions[0]), at(positions[0])};
    for (const Float3& p : positions) {
        box.low = {std::min(box.low.x, double(p.x)), std::min(box.low.y, double(p.y)),
                   std::min(box.low.z, double(p.z))};
        box.high = {std::max(box.high.x, double(p.x)), std::max(box.high.y, double(p.y)),
                    std::max(box.high.z, double(p.z))};
    }
    return box;
}

std::optional<Camera> camera_for(const Box& box, std::string_view view, int width, int height) {
    constexpr std::pair<std::string_view, std::pair<double, double>> kViews[] = {
        {"front", {0, 0}}, {"back", {180, 0}},   {"right", {90, 0}}, {"left", {-90, 0}},
        {"top", {0, 90}},  {"bottom", {0, -90}}, {"iso", {35, 25}}};
    std::optional<std::pair<double, double>> angles = two_numbers(view);
    for (const auto& [name, value] : kViews)
        if (view == name) angles = value;
    if (!angles) return std::nullopt;
    Camera camera;
    camera.width = width;
    camera.height = height;
    const double az = angles->first * std::numbers::pi / 180, el = angles->second * std::numbers::pi / 180;
    const Double3 back{std::sin(az) * std::cos(el), std::sin(el), std::cos(az) * std::cos(el)};
    camera.target = box.centre();
    camera.up =
        std::abs(angles->second) > 89 ? Double3{0, 0, angles->second > 0 ? -1.0 : 1.0} : Double3{0, 1, 0};
    // Far enough for the box's corners, whose spread across and up the view is what must fit.
    const Double3 right = unit(cross(back * -1.0, camera.up)), up = cross(right, back * -1.0);
    double distance = 0;
    const double half = tan_half(camera), wide = half * width / height;
    for (int i = 0; i < 8; ++i) {
        const Double3 corner{(i & 1) ? box.high.x : box.low.x, (i & 2) ? box.high.y : box.low.y,
                             (i & 4) ? box.high.z : box.low.z};
        const Double3 d = corner - camera.target;
        distance = std::max({distance, dot(d, back) + std::abs(dot(d, right)) / wide,
                             dot(d, back) + std::abs(dot(d, up)) / half});
    }
    camera.eye = camera.target + back * (distance > 0 ? 1.06 * distance : 1);
    return camera;
}

Hit hit_on(std::span<const Float3> positions, std::span<const Triangle> triangles, std::uint32_t triangle,
           Double3 point, double distance) {
    Hit hit{triangle, triangles[triangle][0], point, distance};
    for (const std::uint32_t v : triangles[triangle])
        if (bake::length2(at(positions[v]) - point) < bake::length2(at(positions[hit.vertex]) - point))
            hit.vertex = v;
    return hit;
}

std::optional<Hit> pick(std::span<const Float3> positions, std::span<const Triangle> triangles,
                        const Ray& ray) {
    using Found = std::pair<double, std::uint32_t>;
    const Found none{std::numeric_limits<double>::infinity(), 0};
    const Found found = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, triangles.size(), 8192), none,
        [&](const tbb::blocked_range<std::size_t>& range, Found best) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                const Triangle& t = triangles[i];
                const double d = bake::distance_along(ray.from, ray.direction, at(positions[t[0]]),
                                                      at(positions[t[1]]), at(positions[t[2]]));
                best = std::min(best, Found{d, std::uint32_t(i)});
            }
            return best;
        },
        [](const Found& a, const Found& b) { return std::min(a, b); });
    if (!(found.first < none.first)) return std::nullopt;
    return hit_on(positions, triangles, found.second, ray.from + ray.direction * found.first, found.first);
}

}  // namespace vsplit::studio
