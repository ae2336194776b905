// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The page that lists a folder's models.
#pragma once

#include <string>

#include "folder.hpp"

namespace vsplit::app {

/// Where the built-in viewer is; no file of the folder can have this path.
inline constexpr char kViewerPath[] = "/_vsplit/";

/// HTML. `path` as Folder::find() takes it, empty or ending in a slash.
std::string listing_page(const Folder& folder, const std::string& path);

/// Percent-encoded for a URL's path; slashes stay.
std::string encoded_path(const std::string& path);

}  // namespace vsplit::app
