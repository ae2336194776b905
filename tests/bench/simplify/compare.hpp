// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// vsplit against each peer: geometric means of the ratios, level by level.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "quality.hpp"

namespace vsplit::bench {

/// A measured figure of a level.
using Figure = double Level::*;

/// A figure below this counts as this: of distances (in 1e-4 of the diagonal) it is 1e-7 of the diagonal,
/// about what 32-bit positions resolve. Planes simplified exactly would otherwise compare one rounding with
/// another.
inline constexpr double kFloor = 1e-3;

/// vsplit's figure over the peer's, where both reached the ratio.
struct Comparison {
    std::string peer;
    double ratio = std::numeric_limits<double>::quiet_NaN();  ///< Geometric mean; below 1 vsplit is better.
    double unfloored =
        std::numeric_limits<double>::quiet_NaN();  ///< The same without kFloor, where both are above 0.
    int levels = 0;                                ///< That could be compared.
    int wanted = 0;                                ///< That vsplit has.
};

/// Over all models, or the one named; over the ratios given.
Comparison compare(const std::vector<ModelQuality>& quality, const std::string& peer, Figure figure,
                   const std::vector<double>& ratios, const std::string& model = {});

/// The peer that is hardest to beat: the greatest ratio of those that reached at least three quarters of
/// vsplit's levels. Its name is empty if there is none.
Comparison best_peer(const std::vector<ModelQuality>& quality, Figure figure,
                     const std::vector<double>& ratios, const std::string& model = {});

/// Names of the peers that ran anywhere, vsplit left out, in order.
std::vector<std::string> peers_that_ran(const std::vector<ModelQuality>& quality);

}  // namespace vsplit::bench
