// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A point cloud, reconstructed while one watches.
#pragma once

#include "../edit/document.hpp"
#include "command.hpp"

namespace vsplit::app {

/// Nothing if the file is no point cloud, or there is no display. On failure the message is said and `exit`
/// set.
std::optional<Result<studio::Source>> watch_reconstruction(const std::string& path, int width, int height,
                                                           int threads, int& exit);

}  // namespace vsplit::app
