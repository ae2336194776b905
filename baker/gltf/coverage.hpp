// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// MSFT_screencoverage from our own errors.
#pragma once

#include <span>
#include <vector>

#include "vsplit/bake/gltf.hpp"

namespace vsplit::bake {

/// One number a level: the least share of the screen that the object's bounding sphere covers at which the
/// level is to be shown. Strictly descending, in (0, 1], the last one 0. docs/lods.md derives it. `errors`
/// are finite and not negative, as is `radius`. `screen` says when a level is good enough.
std::vector<double> screen_coverage(std::span<const double> errors, double radius, const Screen& screen = {});

}  // namespace vsplit::bake
