// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The shape of a glTF document: that every property we read has its type and range, and that every index has
// its object.
#pragma once

#include <nlohmann/json.hpp>

#include "vsplit/result.hpp"

namespace vsplit::bake {

/// Moves the geometric part of `document` (scenes, nodes, meshes, accessors, buffer views, buffers; what a
/// reader of triangles needs, and nothing else) into a new document in which every property is of the right
/// type, every index in range and every number finite. tinygltf, which drops what it cannot read and narrows
/// integers without a word, is then given only this. Errors (kMalformed) name the object:
/// "meshes[3].primitives[0].indices". May throw std::bad_alloc only.
Result<nlohmann::json> shape_document(nlohmann::json&& document);

}  // namespace vsplit::bake
