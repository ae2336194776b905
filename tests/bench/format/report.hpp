// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The page that the benchmark writes.
#pragma once

#include <string>
#include <vector>

#include "figures.hpp"

namespace vsplit::bench {

/// Markdown. `plots` are the names of the pictures next to it.
std::string to_markdown(const Figures& figures, const std::vector<std::string>& plots);

}  // namespace vsplit::bench
