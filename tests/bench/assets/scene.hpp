// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A glTF scene as a renderer has it: primitives with their arrays, and where nodes show them at a time of the
// animation. Read by tinygltf, not by the baker: what the baker writes is judged by other eyes.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace vsplit::bench {

using Vec2 = std::array<float, 2>;
using Vec3 = std::array<float, 3>;
using Vec4 = std::array<float, 4>;
using Matrix = std::array<double, 16>;  ///< Column by column.

/// A picture and its halves, down to one pixel.
struct Texture {
    struct Level {
        int width, height;
        std::vector<Vec4> pixels;
    };
    std::vector<Level> levels;  ///< Empty: white.
    /// Repeats; `level` between two sizes mixes both.
    Vec4 at(float u, float v, float level) const;
};

struct Material {
    Vec4 factor{1, 1, 1, 1};
    int texture = -1;
    bool cutout = false;
    float cutoff = 0.5f;
};

struct Primitive {
    std::vector<Vec3> positions, normals;
    std::vector<Vec2> uvs;
    std::vector<Vec4> colors;
    std::vector<std::array<std::uint32_t, 8>> joints;
    std::vector<std::array<float, 8>> weights;
    std::vector<std::vector<Vec3>> morphs;  ///< Offsets of positions, a target each.
    std::vector<std::uint32_t> indices;
    int material = -1;
    /// Vertices equal in every attribute become one, triangles that name one twice go.
    void weld();
};

/// Where a mesh is shown.
struct Instance {
    std::size_t first, count;     ///< Primitives.
    Matrix world;                 ///< Without a skin.
    std::vector<Matrix> joints;   ///< With one: from bind pose to world.
    std::vector<double> weights;  ///< Of morph targets.
};

struct Scene {
    std::vector<Primitive> primitives;  ///< Of each mesh once.
    std::vector<Instance> instances;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::size_t triangles() const;
};

/// Throws std::runtime_error. `time`: share of the first animation's length.
Scene load_scene(const std::string& path, double time);

/// Triangles in the world, as shown.
struct Soup {
    struct Vertex {
        Vec3 position, normal;
        Vec2 uv;
        Vec4 color;
    };
    std::vector<Vertex> corners;  ///< Three a triangle.
    std::vector<int> materials;   ///< One a triangle.
};
Soup pose(const Scene& scene);

}  // namespace vsplit::bench
