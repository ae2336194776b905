// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "raster.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>

namespace vsplit::bench {
namespace {

using Point = std::array<double, 3>;

Point unit(Point v) {
    const double n = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    return n > 0 ? Point{v[0] / n, v[1] / n, v[2] / n} : v;
}
double dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A lamp at the camera's shoulder, one opposite, and some highlight: what a viewer shows without
/// surroundings.
Vec3 lit(const Vec4& albedo, const Point& normal, const Point& to_eye, const Point& lamp) {
    const Point half = unit({lamp[0] + to_eye[0], lamp[1] + to_eye[1], lamp[2] + to_eye[2]});
    const double diffuse = std::max(0.0, dot(normal, lamp)), back = std::max(0.0, -dot(normal, lamp)),
                 shine = std::pow(std::max(0.0, dot(normal, half)), 24.0);
    Vec3 out;
    for (std::size_t k = 0; k < 3; ++k)
        out[k] = float(
            std::clamp(double(albedo[k]) * (0.2 + 0.75 * diffuse + 0.15 * back) + 0.15 * shine, 0.0, 1.0));
    return out;
}

}  // namespace

Sphere bounds_of(const Soup& soup) {
    Sphere out;
    Point low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    for (const auto& v : soup.corners)
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], double(v.position[k]));
            high[k] = std::max(high[k], double(v.position[k]));
        }
    for (std::size_t k = 0; k < 3; ++k) out.centre[k] = (low[k] + high[k]) / 2;
    out.radius = 0;
    for (const auto& v : soup.corners) {
        double d = 0;
        for (std::size_t k = 0; k < 3; ++k) d += std::pow(double(v.position[k]) - out.centre[k], 2);
        out.radius = std::max(out.radius, std::sqrt(d));
    }
    return out;
}

View render(const Scene& scene, const Soup& soup, const Sphere& around, int number, int count, int size) {
    const auto pixels = std::size_t(size) * std::size_t(size);
    View view{size,
              std::vector<Vec3>(pixels, Vec3{0.5f, 0.5f, 0.5f}),
              std::vector<Vec3>(pixels, Vec3{}),
              std::vector<Vec2>(pixels),
              std::vector<float>(pixels, std::numeric_limits<float>::infinity()),
              std::vector<int>(pixels, -2)};
    const double y = 1 - 2 * (number + 0.5) / count, ring = std::sqrt(1 - y * y),
                 turn = number * std::numbers::pi * (3 - std::sqrt(5.0));
    const Point to_eye{ring * std::cos(turn), y, ring * std::sin(turn)};
    const Point right = unit(cross({0, 1, 0}, to_eye)), up = cross(to_eye, right);
    const Point lamp =
        unit({to_eye[0] + 0.5 * right[0] + 0.7 * up[0], to_eye[1] + 0.5 * right[1] + 0.7 * up[1],
              to_eye[2] + 0.5 * right[2] + 0.7 * up[2]});
    // The sphere's outline touches the picture's edge.
    const double distance = 3 * around.radius,
                 focal = std::sqrt(distance * distance - around.radius * around.radius) / around.radius;
    struct Projected {
        double x, y, inverse;  // pixels, 1 / depth
    };
    const auto project = [&](const Vec3& p) {
        Point d;
        for (std::size_t k = 0; k < 3; ++k) d[k] = double(p[k]) - around.centre[k];
        const double depth = distance - dot(d, to_eye);
        return Projected{(0.5 + 0.5 * focal * dot(d, right) / depth) * size,
                         (0.5 - 0.5 * focal * dot(d, up) / depth) * size, 1 / depth};
    };
    static const Texture white;
    static const Material plain;
    for (std::size_t t = 0; t < soup.materials.size(); ++t) {
        const Soup::Vertex* corner = &soup.corners[3 * t];
        const Projected p[3] = {project(corner[0].position), project(corner[1].position),
                                project(corner[2].position)};
        const double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
        if (area == 0 || p[0].inverse <= 0 || p[1].inverse <= 0 || p[2].inverse <= 0) continue;
        const int number_of = soup.materials[t];
        const Material& material = number_of >= 0 ? scene.materials[std::size_t(number_of)] : plain;
        const Texture& texture =
            material.texture >= 0 ? scene.textures[std::size_t(material.texture)] : white;
        float level = 0;
        if (!texture.levels.empty()) {
            const double uv_area = std::abs((double(corner[1].uv[0]) - double(corner[0].uv[0])) *
                                                (double(corner[2].uv[1]) - double(corner[0].uv[1])) -
                                            (double(corner[2].uv[0]) - double(corner[0].uv[0])) *
                                                (double(corner[1].uv[1]) - double(corner[0].uv[1])));
            const double texels =
                uv_area * double(texture.levels[0].width) * double(texture.levels[0].height);
            level = float(0.5 * std::log2(std::max(texels / std::abs(area), 1e-9)));
        }
        const int x0 = std::max(0, int(std::floor(std::min({p[0].x, p[1].x, p[2].x})))),
                  x1 = std::min(size - 1, int(std::ceil(std::max({p[0].x, p[1].x, p[2].x})))),
                  y0 = std::max(0, int(std::floor(std::min({p[0].y, p[1].y, p[2].y})))),
                  y1 = std::min(size - 1, int(std::ceil(std::max({p[0].y, p[1].y, p[2].y}))));
        for (int py = y0; py <= y1; ++py)
            for (int px = x0; px <= x1; ++px) {
                const double sx = px + 0.5, sy = py + 0.5;
                double w[3] = {((p[1].x - sx) * (p[2].y - sy) - (p[2].x - sx) * (p[1].y - sy)) / area,
                               ((p[2].x - sx) * (p[0].y - sy) - (p[0].x - sx) * (p[2].y - sy)) / area, 0};
                w[2] = 1 - w[0] - w[1];
                if (w[0] < 0 || w[1] < 0 || w[2] < 0) continue;
                double inverse = 0;
                for (std::size_t k = 0; k < 3; ++k) inverse += w[k] * p[k].inverse;
                const auto depth = float(1 / inverse);
                const auto at = std::size_t(py * size + px);
                if (depth >= view.depths[at]) continue;
                for (std::size_t k = 0; k < 3; ++k) w[k] *= p[k].inverse / inverse;
                Point normal{};
                Vec2 uv{};
                Vec4 color{};
                for (std::size_t k = 0; k < 3; ++k) {
                    for (std::size_t i = 0; i < 3; ++i)
                        normal[i] +=
                            w[k] * double(unit({double(corner[k].normal[0]), double(corner[k].normal[1]),
                                                double(corner[k].normal[2])})[i]);
                    for (std::size_t i = 0; i < 2; ++i) uv[i] += float(w[k]) * corner[k].uv[i];
                    for (std::size_t i = 0; i < 4; ++i) color[i] += float(w[k]) * corner[k].color[i];
                }
                Vec4 albedo = texture.at(uv[0], uv[1], level);
                for (std::size_t i = 0; i < 4; ++i) albedo[i] *= material.factor[i] * color[i];
                if (material.cutout && albedo[3] < material.cutoff) continue;
                normal = unit(normal);
                view.depths[at] = depth;
                view.colors[at] = lit(albedo, normal, to_eye, lamp);
                view.normals[at] = {float(normal[0]), float(normal[1]), float(normal[2])};
                view.uvs[at] = uv;
                view.materials[at] = number_of;
            }
    }
    return view;
}

void write_pictures(const std::string& path, const std::vector<const View*>& views) {
    if (views.empty()) return;
    const int half = views[0]->size / 2;
    std::ofstream file(path, std::ios::binary);
    file << "P6\n" << half * int(views.size()) << ' ' << half << "\n255\n";
    for (int y = 0; y < half; ++y)
        for (const View* view : views)
            for (int x = 0; x < half; ++x)
                for (std::size_t k = 0; k < 3; ++k) {
                    float sum = 0;
                    for (const int dy : {0, 1})
                        for (const int dx : {0, 1})
                            sum += view->colors[std::size_t((2 * y + dy) * view->size + 2 * x + dx)][k] / 4;
                    file.put(char(std::uint8_t(std::lround(255 * sum))));
                }
}

}  // namespace vsplit::bench
