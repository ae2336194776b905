// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "collapse_flags.hpp"

#include <cstdlib>

namespace vsplit::app {

void CollapseFlags::add_to(CLI::App& command) {
    command.add_option("--cost", cost, "What a collapse costs: quadric, or paper (docs/collapse.md)")
        ->check(CLI::IsMember({"quadric", "paper"}))
        ->capture_default_str();
    command
        .add_option("--placement", placement, "Where the vertex that remains is put: optimal, or endpoint")
        ->check(CLI::IsMember({"optimal", "endpoint"}))
        ->capture_default_str();
    command
        .add_option("--lock", locks,
                    "What never changes: boundary, seams, features=ANGLE (degrees between triangles); may be "
                    "repeated")
        ->type_name("WHAT")
        ->allow_extra_args(false);
    command
        .add_option(
            "--stitch", stitch,
            "Boundaries that lie on each other, up to this share of the diagonal, collapse as one; 0: "
            "each by itself")
        ->check(CLI::Range(0.0, 0.01))
        ->capture_default_str();
}

std::optional<std::string> CollapseFlags::set(bake::CollapseOptions& options) const {
    options.cost = cost == "paper" ? bake::Cost::kPaper : bake::Cost::kQuadric;
    options.placement = placement == "endpoint" ? bake::Placement::kEndpoint : bake::Placement::kOptimal;
    options.stitch = stitch;
    for (const std::string& lock : locks) {
        if (lock == "boundary") {
            options.lock_boundary = true;
        } else if (lock == "seams") {
            options.lock_seams = true;
        } else if (lock.rfind("features=", 0) == 0) {
            char* end = nullptr;
            const double degrees = std::strtod(lock.c_str() + 9, &end);
            if (*end != 0 || end == lock.c_str() + 9 || !(degrees > 0 && degrees < 180))
                return "--lock features=ANGLE wants degrees between 0 and 180";
            options.lock_features_degrees = degrees;
        } else {
            return "--lock knows boundary, seams and features=ANGLE, not " + lock;
        }
    }
    return std::nullopt;
}

}  // namespace vsplit::app
