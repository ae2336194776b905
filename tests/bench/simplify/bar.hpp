// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A figure next to what it is held to.
#pragma once

#include <string>

namespace vsplit::bench {

struct SummaryRow {
    std::string figure, measured, bar, goal;
    std::string verdict;  ///< "goal", "bar", "short", or "n/a".
};

/// Limits on one figure; `sign` is -1 where more is better.
struct Limits {
    double bar, goal;
    int sign = 1;
    const char* unit = "";
    bool has_goal = true;
};

/// `value` is what is judged, `measured` how it is told; not a number is "n/a".
SummaryRow row_of(std::string figure, double value, const std::string& measured, const Limits& limits);

}  // namespace vsplit::bench
