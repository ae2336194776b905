// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "heat.hpp"

#include <algorithm>
#include <cmath>

#include "collapse/paper_cost.hpp"
#include "collapse/triangle_distance.hpp"

namespace vsplit::studio {
namespace {

Double3 at(const Float3& p) {
    return {double(p.x), double(p.y), double(p.z)};
}

constexpr std::pair<std::string_view, Heat> kNames[] = {{"none", Heat::kNone},
                                                        {"error", Heat::kError},
                                                        {"weight", Heat::kWeight},
                                                        {"curvature", Heat::kCurvature},
                                                        {"quality", Heat::kQuality}};

std::vector<float> errors(const Document& document, const LiveMesh& live) {
    const auto positions = live.positions();
    const auto triangles = live.triangles();
    const Surface surface(positions, triangles, false);
    const std::size_t alive = positions.size(), all = live.state().positions.size();
    std::vector<std::uint32_t> ancestor(all);
    std::vector<float> distances(alive, 0);
    for (std::uint32_t v = 0; v < all; ++v) {
        const std::uint32_t parent = live.state().parents[v];
        ancestor[v] = v < alive ? v : parent == kNoVertex ? kNoVertex : ancestor[parent];
        if (ancestor[v] == kNoVertex || document.origin(v) == kNoVertex) continue;
        const Double3 p = at(document.source().mesh.positions[document.origin(v)]);
        double best = INFINITY;
        for (const std::uint32_t t : surface.star(ancestor[v])) {
            const Triangle& c = triangles[t];
            best = std::min(best, bake::distance2_to_triangle(p, at(positions[c[0]]), at(positions[c[1]]),
                                                              at(positions[c[2]])));
        }
        if (std::isfinite(best))
            distances[ancestor[v]] = std::max(distances[ancestor[v]], float(std::sqrt(best)));
    }
    return distances;
}

}  // namespace

std::optional<Heat> heat_of(std::string_view name) {
    for (const auto& [known, heat] : kNames)
        if (known == name) return heat;
    return std::nullopt;
}

const char* heat_name(Heat heat) {
    return kNames[std::size_t(heat)].first.data();
}

HeatMap heat_map(const Document& document, const LiveMesh& live, Heat heat) {
    const auto positions = live.positions();
    const auto triangles = live.triangles();
    HeatMap map;
    map.values.assign(positions.size(), 0);
    const auto up_to = [&](double share) {
        std::vector<float> sorted = map.values;
        if (sorted.empty()) return 1.0f;
        const auto it = sorted.begin() + std::ptrdiff_t(share * double(sorted.size() - 1));
        std::nth_element(sorted.begin(), it, sorted.end());
        return *it;
    };
    switch (heat) {
        case Heat::kNone:
            break;
        case Heat::kError:
            map.values = errors(document, live);
            map.high = up_to(0.99);
            if (!(map.high > 0))
                map.high = up_to(1) > 0 ? up_to(1) : float(1e-6 * document.box().diagonal() + 1e-30);
            break;
        case Heat::kWeight: {
            const std::vector<float> weights = document.weights();
            float most = 1;
            for (const float w : weights) most = std::isfinite(w) ? std::max(most, w) : most;
            for (std::size_t v = 0; v < map.values.size(); ++v) {
                const std::uint32_t origin = document.origin(std::uint32_t(v));
                const float w = origin == kNoVertex ? 1 : weights[origin];
                map.values[v] = std::isinf(w) ? std::log2(2 * most) : std::log2(std::max(w, 1e-6f));
            }
            map.low = std::min(0.0f, *std::min_element(map.values.begin(), map.values.end()));
            map.high = std::max(1.0f, *std::max_element(map.values.begin(), map.values.end()));
            break;
        }
        case Heat::kCurvature:
            map.values = Surface(positions, triangles, false).turns();
            map.high = std::max(1.0f, up_to(0.98));
            break;
        case Heat::kQuality:
            std::fill(map.values.begin(), map.values.end(), 1.0f);
            for (const Triangle& t : triangles) {
                const auto q =
                    float(bake::regularity(at(positions[t[0]]), at(positions[t[1]]), at(positions[t[2]])));
                for (const std::uint32_t v : t) map.values[v] = std::min(map.values[v], q);
            }
            break;
    }
    return map;
}

Rgb rgb(std::uint32_t colour) {
    return {std::uint8_t(colour >> 16), std::uint8_t(colour >> 8), std::uint8_t(colour)};
}

Rgb ramp(double t) {
    // Anchors of the map "viridis" (van der Walt and Smith 2015, CC0).
    constexpr std::uint32_t kAnchors[] = {0x440154, 0x472D7B, 0x3B528B, 0x2C728E, 0x21918C,
                                          0x28AE80, 0x5EC962, 0xADDC30, 0xFDE725};
    constexpr std::size_t kSteps = std::size(kAnchors) - 1;
    t = std::isfinite(t) ? std::clamp(t, 0.0, 1.0) * double(kSteps) : 0;
    const std::size_t i = std::min(std::size_t(t), kSteps - 1);
    const Rgb a = rgb(kAnchors[i]), b = rgb(kAnchors[i + 1]);
    Rgb mixed;
    for (std::size_t k = 0; k < 3; ++k)
        mixed[k] = std::uint8_t(std::lround(double(a[k]) + (t - double(i)) * (double(b[k]) - double(a[k]))));
    return mixed;
}

Rgb plain_colour(const Document& document, std::uint32_t vertex) {
    constexpr Rgb kPlain{205, 208, 212};
    const std::uint32_t origin = document.origin(vertex);
    const bake::Marks& marks = document.painting().marks();
    const std::vector<Rgb>& own = document.source().colours;
    const Rgb plain = origin == kNoVertex || own.empty() ? kPlain : own[origin];
    if (origin == kNoVertex || marks.region[origin] == 0) return plain;
    const Rgb full = rgb(marks.regions[marks.region[origin] - 1].colour);
    const double s = 0.25 + 0.75 * double(marks.strength[origin]);
    Rgb mixed;
    for (std::size_t k = 0; k < 3; ++k)
        mixed[k] = std::uint8_t(std::lround(double(plain[k]) * (1 - s) + s * double(full[k])));
    return mixed;
}

std::vector<Rgb> level_colours(const Document& document, const LiveMesh& live, Heat heat, HeatMap* map) {
    std::vector<Rgb> colours(live.positions().size());
    if (heat == Heat::kNone) {
        for (std::uint32_t v = 0; v < colours.size(); ++v) colours[v] = plain_colour(document, v);
        return colours;
    }
    HeatMap made = heat_map(document, live, heat);
    const double span = std::max(1e-30, double(made.high) - double(made.low));
    for (std::size_t v = 0; v < colours.size(); ++v)
        colours[v] = ramp((double(made.values[v]) - double(made.low)) / span);
    if (map) *map = std::move(made);
    return colours;
}

LevelPicture level_picture(const Document& document, const LiveMesh& live, Heat heat, HeatMap* map) {
    LevelPicture picture;
    picture.positions = live.positions();
    picture.triangles = live.triangles();
    picture.colours = level_colours(document, live, heat, map);
    if (!document.placed()) return picture;
    const std::vector<std::uint32_t>& groups = live.state().groups;
    picture.shown = document.show(live.positions(), live.triangles(),
                                  {groups.data(), std::min(groups.size(), live.triangles().size())});
    std::vector<Rgb> colours;
    colours.reserve(picture.shown.vertex_of.size());
    for (const std::uint32_t v : picture.shown.vertex_of) colours.push_back(picture.colours[v]);
    picture.colours = std::move(colours);
    // Moving a vector keeps where its elements are.
    picture.positions = picture.shown.positions;
    picture.triangles = picture.shown.triangles;
    return picture;
}

void smooth_normals(std::span<const Float3> positions, std::span<const Triangle> triangles,
                    std::vector<Float3>& normals) {
    normals.assign(positions.size(), {});
    for (const Triangle& t : triangles) {
        const Float3 &a = positions[t[0]], &b = positions[t[1]], &c = positions[t[2]];
        const float ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, vx = c.x - a.x, vy = c.y - a.y,
                    vz = c.z - a.z;
        const Float3 n{uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx};
        for (const std::uint32_t v : t) {
            normals[v].x += n.x;
            normals[v].y += n.y;
            normals[v].z += n.z;
        }
    }
    for (Float3& n : normals) {
        const float size = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
        if (!(size > 0)) continue;
        n = {n.x / size, n.y / size, n.z / size};
    }
}

}  // namespace vsplit::studio
