// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What the engine is held to, and where it stands.
#pragma once

#include <string>
#include <vector>

namespace vsplit::bench {

struct Report;

struct SummaryRow {
    std::string figure, measured, bar, goal;
    std::string verdict;  ///< "goal", "bar", "short", or "n/a".
};

/// One row for each bar that this report has figures for.
std::vector<SummaryRow> summarise(const Report& report);

}  // namespace vsplit::bench
