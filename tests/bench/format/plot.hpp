// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Rate and distortion as a picture.
#pragma once

#include <span>
#include <string>

#include "figures.hpp"

namespace vsplit::bench {

/// An SVG with one panel for each model, side by side: bytes received against the error, both logarithmic.
std::string plot_rate_distortion(std::span<const ModelSizes> models);

}  // namespace vsplit::bench
