// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The web viewer's files, as the build put them into the command (assets.cmake).
#pragma once

#include <span>
#include <string_view>

namespace vsplit::app {

struct Asset {
    std::string_view name;  ///< "index.html", relative to the viewer's folder.
    std::string_view bytes;
};

/// None if the command was built without the viewer.
std::span<const Asset> viewer_assets();
/// Null if there is none of this name.
const Asset* find_asset(std::string_view name);

}  // namespace vsplit::app
