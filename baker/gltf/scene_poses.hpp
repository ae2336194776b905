// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Moments of a scene's animations, as poses of its meshes.
#pragma once

#include <cstddef>

#include "document.hpp"
#include "scene_document.hpp"
#include "scene_nodes.hpp"
#include "vsplit/bake/scene.hpp"

namespace vsplit::bake {

/// Fills `scene.poses` and the poses of its places, whose vertices, parts and places are there, with `count`
/// (at least 1) moments spread evenly over all animations that move the joints or morph weights of a place,
/// one animation after the other, each alone; and with the morph weights that a place has by default, if that
/// is not the bind pose. `instances` are what `scene.places` were made of. What cannot be read of an
/// animation is left out, with a note.
void sample_poses(Document& document, const OrderedJson& root, std::span<const Instance> instances,
                  const SceneUse& use, std::size_t count, Scene& scene);

}  // namespace vsplit::bake
