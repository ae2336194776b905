// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The attribute that painted weights come from.
#pragma once

#include <string>

#include "primitive.hpp"
#include "vsplit/result.hpp"

namespace vsplit::bake {

/// "COLOR_0.r", or _WEIGHT, which is what encode_glb writes, if nothing was asked for.
Result<WeightChannel> weight_channel(const std::string& text);

/// The names of all attributes in the document, for a message.
std::string attributes_there(const tinygltf::Model& model);

}  // namespace vsplit::bake
