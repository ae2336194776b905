// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What a level is like, as numbers and as colours.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "document.hpp"

namespace vsplit::studio {

enum class Heat : std::uint8_t {
    kNone,    ///< Regions in their colours.
    kError,   ///< Distance of the full model's vertices to the triangles around their ancestor; object units.
    kWeight,  ///< Logarithm (base 2) of the weight; what is infinite counts as the largest.
    kCurvature,  ///< Largest angle between two triangles at the vertex, degrees.
    kQuality,    ///< Regularity (formula 6 of the paper) of the worst triangle at the vertex, 0 to 1.
};
std::optional<Heat> heat_of(std::string_view name);
const char* heat_name(Heat heat);

struct HeatMap {
    std::vector<float> values;  ///< One a vertex of the level.
    float low = 0, high = 1;    ///< What the ends of the ramp mean.
};
HeatMap heat_map(const Document& document, const LiveMesh& live, Heat heat);

/// Dark blue to yellow, growing lighter all the way; `t` from 0 to 1.
Rgb ramp(double t);
Rgb rgb(std::uint32_t colour);

/// `live` is the document's record at any level.
/// One colour a vertex of the level: the ramp, or for kNone the model's own colours, or a plain grey, and
/// over them the regions by their strength.
std::vector<Rgb> level_colours(const Document& document, const LiveMesh& live, Heat heat,
                               HeatMap* map = nullptr);
/// A level as it is shown, for a renderer.
struct LevelPicture {
    std::span<const Float3> positions;  ///< Of the live mesh, or of `shown`.
    std::span<const Triangle> triangles;
    std::vector<Rgb> colours;
    Shown shown;  ///< Empty where nothing is moved.
};
LevelPicture level_picture(const Document& document, const LiveMesh& live, Heat heat, HeatMap* map = nullptr);
/// The colour of one vertex for kNone.
Rgb plain_colour(const Document& document, std::uint32_t vertex);

/// Smooth normals, by area. Unit vectors; zeros where there is no area.
void smooth_normals(std::span<const Float3> positions, std::span<const Triangle> triangles,
                    std::vector<Float3>& normals);

}  // namespace vsplit::studio
