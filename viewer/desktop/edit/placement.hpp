// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A scene's parts where its nodes have them: each in a space of its own in the record, all in one when shown.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "camera.hpp"
#include "vsplit/bake/scene.hpp"

namespace vsplit::studio {

/// A level as it is shown. A part that several nodes have is there several times.
struct Shown {
    std::vector<Float3> positions;
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> vertex_of, triangle_of;  ///< Of the level.
};

class Placement {
  public:
    /// Everything is shown where it is.
    Placement() = default;
    explicit Placement(const bake::Scene& scene);

    /// Nothing is moved: what is shown is the level itself.
    bool trivial() const { return places_.empty(); }
    /// `groups` are the level's triangles', and name the scene's primitives. Of more than 2^23 triangles with
    /// all their instances only the first instance of each part is shown.
    Shown show(std::span<const Float3> positions, std::span<const Triangle> triangles,
               std::span<const std::uint32_t> groups) const;
    std::uint32_t part_of_group(std::uint32_t group) const {
        return group < part_of_group_.size() ? part_of_group_[group] : 0;
    }

  private:
    std::vector<bake::ScenePlace> places_;
    std::vector<std::uint32_t> part_of_group_;
    std::size_t parts_ = 0;
};

/// One colour a vertex, from the scene's materials, their images and the mesh's vertex colours.
struct Image {
    int width = 0, height = 0;
    std::vector<std::array<std::uint8_t, 3>> pixels;  ///< Rows from the top, sRGB.
};
/// Decodes PNG or JPEG; an empty image if it cannot.
using DecodeImage = Image (*)(std::span<const std::byte> bytes);
std::vector<std::array<std::uint8_t, 3>> base_colours(const bake::Scene& scene, const Mesh& mesh,
                                                      DecodeImage decode);

}  // namespace vsplit::studio
