// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The bytes behind a buffer's uri.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "vsplit/result.hpp"

namespace vsplit::bake {

/// A data: URI in base64, or a regular file below `folder` ("" refuses files). A path that leaves the folder,
/// by "..", by a root, by a scheme or by a symbolic link, is refused (kUnsupported).
Result<std::vector<std::byte>> load_uri(std::string_view uri, const std::string& folder);

}  // namespace vsplit::bake
