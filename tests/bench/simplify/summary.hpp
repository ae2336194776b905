// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What the engine is held to, and where it stands.
#pragma once

#include <vector>

#include "bar.hpp"

namespace vsplit::bench {

struct Report;

/// One row for each bar that this report has figures for.
std::vector<SummaryRow> summarise(const Report& report);

}  // namespace vsplit::bench
