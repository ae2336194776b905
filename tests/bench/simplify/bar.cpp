// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "bar.hpp"

#include <fmt/format.h>

#include <cmath>

namespace vsplit::bench {

SummaryRow row_of(std::string figure, double value, const std::string& measured, const Limits& limits) {
    const char* comparison = limits.sign > 0 ? "<=" : ">=";
    SummaryRow row{std::move(figure), measured, fmt::format("{} {:g}{}", comparison, limits.bar, limits.unit),
                   limits.has_goal ? fmt::format("{} {:g}{}", comparison, limits.goal, limits.unit) : "",
                   "short"};
    if (std::isnan(value))
        row.verdict = "n/a";
    else if (limits.sign * value <= limits.sign * limits.goal)
        row.verdict = limits.has_goal ? "goal" : "bar";
    else if (limits.sign * value <= limits.sign * limits.bar)
        row.verdict = "bar";
    return row;
}

}  // namespace vsplit::bench
