// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Pictures without a window on the screen (an X server is still needed, as xvfb-run gives one).
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "view.hpp"

namespace vsplit::studio {

/// "1280x800"; false if it is not that, or out of 16 to 8192.
bool parse_size(const std::string& text, int& width, int& height);

/// The document's level as PNG. Errors: kIo if there is no display.
Result<std::vector<std::byte>> picture(const Document& document, const Camera& camera, const Look& look);
/// A cloud of points.
Result<std::vector<std::byte>> picture_of_points(std::span<const Float3> positions, const Camera& camera);
/// A GLB as it is, with its materials and textures; `view` as for camera_for(), about the scene's own box.
Result<std::vector<std::byte>> picture_of_glb(const std::string& path, const std::string& view, int width,
                                              int height, bool wireframe);
/// A script's step "picture": its "heat", "wireframe" and "flat".
Result<std::vector<std::byte>> script_picture(const Document& document, const Camera& camera,
                                              const nlohmann::ordered_json& step);

}  // namespace vsplit::studio
