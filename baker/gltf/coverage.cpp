// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "coverage.hpp"

#include <algorithm>
#include <numbers>

namespace vsplit::bake {

std::vector<double> screen_coverage(std::span<const double> errors, double radius, const Screen& screen) {
    const double area = screen.lines * screen.lines * 16 / 9;
    // Below a billionth of the screen nothing is seen; above 0 so that a level's share stays a share.
    constexpr double kLeast = 1e-9;
    // Viewers sort levels by this number, so that two must not be equal.
    constexpr double kStep = 1.0 - 1.0 / 1024;
    std::vector<double> coverage(errors.size(), 0.0);
    double error = errors.empty() ? 0 : errors[0];
    for (std::size_t k = 1; k < errors.size(); ++k) {
        error = std::max(error, errors[k]);
        const double pixels = error > 0 ? radius * screen.pixels / error
                                        : area;  // the sphere's radius when the error is all that is allowed
        double share = std::clamp(std::numbers::pi * pixels * pixels / area, kLeast, 1.0);
        if (k > 1) share = std::min(share, coverage[k - 2] * kStep);
        coverage[k - 1] = share;
    }
    return coverage;
}

}  // namespace vsplit::bake
