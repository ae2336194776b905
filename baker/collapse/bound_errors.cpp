// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "calibrate.hpp"

namespace vsplit::bake {
namespace {

/// What samples miss between them.
constexpr double kSafety = 1.7;
/// Distances below this share of the largest coordinate are those of rounding to floats.
constexpr double kRounding = 0x1p-24;

bool vanishes(const ProgressiveMesh& mesh) {
    return std::find(mesh.parents.begin() + std::ptrdiff_t(mesh.base_vertices), mesh.parents.end(),
                     kNoVertex) != mesh.parents.end();
}

}  // namespace

bool bound_errors(ProgressiveMesh& mesh, const std::vector<float>& deviations, const Progress& progress) {
    double most = 0;
    for (const Float3& p : mesh.positions)
        most = std::max({most, std::abs(double(p.x)), std::abs(double(p.y)), std::abs(double(p.z))});
    const bool measure = vanishes(mesh);
    double error = measure ? 0 : kRounding * most;
    for (std::size_t i = mesh.splits.size(); i-- > 0;) {
        // Of a component that vanished there is but the estimate.
        const double own = measure ? std::max(double(deviations[i]), double(mesh.splits[i].error))
                                   : kSafety * double(deviations[i]);
        error = std::max(error, own);
        mesh.splits[i].error = float(std::min(error, double(std::numeric_limits<float>::max())));
    }
    return !measure || calibrate_errors(mesh, progress);
}

}  // namespace vsplit::bake
