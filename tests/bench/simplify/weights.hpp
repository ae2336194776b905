// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What a painted weight keeps, and what that costs the rest (the paper's Table III).
#pragma once

#include <string>
#include <vector>

#include "child.hpp"
#include "models.hpp"
#include "ruler.hpp"

namespace vsplit::bench {

/// One level of a mesh with a marked area.
struct WeightCheck {
    double ratio = 0;       ///< Of the vertices that the whole level has.
    double kept = 0;        ///< Share of the marked area's vertices that are still there.
    double plain_kept = 0;  ///< The same without weights.
    /// Mean distance of the rest's surface in the input to the level, over that to the unweighted level
    /// which has as many triangles there.
    double rest = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(WeightCheck, ratio, kept, plain_kept, rest)

struct WeightRun {
    std::string model, reason;
    double marked = 0;  ///< Share of the input's vertices.
    std::vector<WeightCheck> checks;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(WeightRun, model, reason, marked, checks)

/// Weight 10 on the 568 of 2,645 vertices (as many as the paper marks) that are nearest to the first one, at
/// the paper's 60 and 40 % and at 10 %.
WeightRun measure_weights(const Model& model, const ruler::RulerOptions& options);

}  // namespace vsplit::bench
