// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "placement.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace vsplit::studio {
namespace {

constexpr std::size_t kMostTriangles = std::size_t{1} << 23;
constexpr std::uint32_t kNone = 0xFFFFFFFFu;

double determinant(const std::array<double, 16>& m) {
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[4] * (m[1] * m[10] - m[2] * m[9]) +
           m[8] * (m[1] * m[6] - m[2] * m[5]);
}

/// Numbers listed by what they have in common.
struct Lists {
    std::vector<std::uint32_t> starts, items;
    Lists(std::size_t kinds, const std::vector<std::uint32_t>& kind_of) : starts(kinds + 1, 0) {
        for (const std::uint32_t kind : kind_of)
            if (kind < kinds) ++starts[kind + 1];
        for (std::size_t k = 0; k < kinds; ++k) starts[k + 1] += starts[k];
        items.resize(starts[kinds]);
        std::vector<std::uint32_t> next(starts.begin(), starts.end() - 1);
        for (std::uint32_t i = 0; i < kind_of.size(); ++i)
            if (kind_of[i] < kinds) items[next[kind_of[i]]++] = i;
    }
    std::span<const std::uint32_t> of(std::size_t kind) const {
        return {items.data() + starts[kind], starts[kind + 1] - starts[kind]};
    }
};

double to_linear(double s) {
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

std::uint8_t to_srgb(double linear) {
    linear = std::clamp(linear, 0.0, 1.0);
    const double s = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    return std::uint8_t(std::lround(255 * s));
}

/// Half as large as often as needed: a vertex takes the colour of what is around it.
Image shrunk(Image image, int most) {
    while (image.width > most && image.height > most) {
        Image half{image.width / 2, image.height / 2, {}};
        half.pixels.resize(std::size_t(half.width) * std::size_t(half.height));
        for (int y = 0; y < half.height; ++y)
            for (int x = 0; x < half.width; ++x)
                for (std::size_t c = 0; c < 3; ++c) {
                    int sum = 2;
                    for (int k = 0; k < 4; ++k)
                        sum += image.pixels[std::size_t(2 * y + k / 2) * std::size_t(image.width) +
                                            std::size_t(2 * x + k % 2)][c];
                    half.pixels[std::size_t(y) * std::size_t(half.width) + std::size_t(x)][c] =
                        std::uint8_t(sum / 4);
                }
        image = std::move(half);
    }
    return image;
}

}  // namespace

Placement::Placement(const bake::Scene& scene) {
    parts_ = scene.parts.size();
    for (const bake::ScenePrimitive& primitive : scene.primitives) {
        const auto part = std::find_if(scene.parts.begin(), scene.parts.end(),
                                       [&](const bake::ScenePart& p) { return p.mesh == primitive.mesh; });
        part_of_group_.push_back(part == scene.parts.end() ? kNone
                                                           : std::uint32_t(part - scene.parts.begin()));
    }
    places_ = bake::scene_places(scene);
    constexpr std::array<double, 16> kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    if (places_.size() == 1 && parts_ == 1 && places_[0].matrix == kIdentity) places_.clear();
}

Shown Placement::show(std::span<const Float3> positions, std::span<const Triangle> triangles,
                      std::span<const std::uint32_t> groups) const {
    std::vector<std::uint32_t> part_of_triangle(triangles.size(), 0), part_of(positions.size(), kNone);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        part_of_triangle[t] = groups.empty() ? 0 : part_of_group(groups[t]);
        for (const std::uint32_t v : triangles[t]) part_of[v] = part_of_triangle[t];
    }
    const Lists triangle_lists(parts_, part_of_triangle), vertex_lists(parts_, part_of);
    std::size_t all = 0;
    for (const bake::ScenePlace& place : places_) all += triangle_lists.of(place.part).size();
    const bool once = all > kMostTriangles;
    std::vector<char> seen(parts_, 0);
    std::vector<std::uint32_t> number(positions.size(), 0);
    Shown shown;
    for (const bake::ScenePlace& place : places_) {
        if (once && seen[place.part]) continue;
        seen[place.part] = 1;
        const std::array<double, 16>& m = place.matrix;
        for (const std::uint32_t v : vertex_lists.of(place.part)) {
            number[v] = std::uint32_t(shown.positions.size());
            const double x = double(positions[v].x), y = double(positions[v].y), z = double(positions[v].z);
            shown.positions.push_back({float(m[0] * x + m[4] * y + m[8] * z + m[12]),
                                       float(m[1] * x + m[5] * y + m[9] * z + m[13]),
                                       float(m[2] * x + m[6] * y + m[10] * z + m[14])});
            shown.vertex_of.push_back(v);
        }
        // A mirror turns triangles inside out (glTF 2.0, section 3.7.4).
        const bool mirrored = determinant(m) < 0;
        for (const std::uint32_t t : triangle_lists.of(place.part)) {
            const Triangle& c = triangles[t];
            shown.triangles.push_back(
                {number[c[0]], number[c[mirrored ? 2 : 1]], number[c[mirrored ? 1 : 2]]});
            shown.triangle_of.push_back(t);
        }
    }
    return shown;
}

std::vector<std::array<std::uint8_t, 3>> base_colours(const bake::Scene& scene, const Mesh& mesh,
                                                      DecodeImage decode) {
    const std::vector<bake::SceneMaterial> materials = bake::scene_materials(scene);
    std::map<std::uint32_t, Image> images;
    const auto attribute = [&](const std::string& name) -> const Attribute* {
        for (const Attribute& a : mesh.attributes)
            if (a.name == name && a.values.size() >= mesh.positions.size() * a.components) return &a;
        return nullptr;
    };
    const Attribute* painted = attribute("COLOR_0");
    std::vector<std::array<std::uint8_t, 3>> colours(mesh.positions.size(), {205, 208, 212});
    std::vector<char> done(colours.size(), 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::size_t group = mesh.groups.empty() ? 0 : mesh.groups[t];
        if (group >= materials.size()) continue;
        const bake::SceneMaterial& material = materials[group];
        const Image* image = nullptr;
        const Attribute* place = attribute("TEXCOORD_" + std::to_string(material.texcoord));
        if (!material.image.empty() && decode && place && place->components >= 2) {
            const auto [it, fresh] = images.try_emplace(material.image_number);
            if (fresh) it->second = shrunk(decode(material.image), 512);
            if (!it->second.pixels.empty()) image = &it->second;
        }
        for (const std::uint32_t v : mesh.triangles[t]) {
            if (done[v]) continue;
            done[v] = 1;
            std::array<double, 3> colour;
            for (std::size_t c = 0; c < 3; ++c) {
                colour[c] = double(material.base_color[c]);
                if (painted && c < painted->components)
                    colour[c] *= double(painted->values[v * painted->components + c]);
            }
            if (image) {
                const auto at = [&](double coordinate, int size) {
                    coordinate = std::isfinite(coordinate) ? coordinate - std::floor(coordinate) : 0;
                    return std::min(std::size_t(coordinate * size), std::size_t(size - 1));
                };
                const float* uv = place->values.data() + v * place->components;
                const auto& pixel =
                    image->pixels[at(double(uv[1]), image->height) * std::size_t(image->width) +
                                  at(double(uv[0]), image->width)];
                for (std::size_t c = 0; c < 3; ++c) colour[c] *= to_linear(pixel[c] / 255.0);
            }
            for (std::size_t c = 0; c < 3; ++c) colours[v][c] = to_srgb(colour[c]);
        }
    }
    return colours;
}

}  // namespace vsplit::studio
