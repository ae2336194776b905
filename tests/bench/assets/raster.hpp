// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Pictures of a scene, in software: textured, lit, the same for everyone.
#pragma once

#include <string>
#include <vector>

#include "scene.hpp"

namespace vsplit::bench {

/// What one view shows, pixel by pixel.
struct View {
    int size = 0;
    std::vector<Vec3> colors;   ///< 0 to 1; where nothing is, the background.
    std::vector<Vec3> normals;  ///< Unit; 0 where nothing is.
    std::vector<Vec2> uvs;
    std::vector<float> depths;  ///< Infinite where nothing is.
    std::vector<int> materials;
};

struct Sphere {
    std::array<double, 3> centre{};
    double radius = 1;
};
Sphere bounds_of(const Soup& soup);

/// From direction `number` of `count` on a Fibonacci sphere; the sphere `around` fills the picture.
View render(const Scene& scene, const Soup& soup, const Sphere& around, int number, int count, int size);

/// A binary PPM of pictures side by side, each at half size.
void write_pictures(const std::string& path, const std::vector<const View*>& views);

}  // namespace vsplit::bench
