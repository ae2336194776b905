// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// From what a person asks for to a level of a progressive mesh.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "command.hpp"
#include "vsplit/progressive_mesh.hpp"

namespace vsplit::app {

/// The triangles that a ratio means: kept over those of the input, rounded.
inline std::uint64_t triangles_for_ratio(const ProgressiveMesh& mesh, double ratio) {
    return static_cast<std::uint64_t>(std::llround(ratio * double(mesh.triangles.size())));
}

/// Why `level` has not about `wanted` triangles, if it has not.
inline std::optional<std::string> why_not(const ProgressiveMesh& mesh, std::size_t level,
                                          std::uint64_t wanted) {
    const std::uint64_t got = triangles_at(mesh, level);
    if (got > wanted)
        return fmt::format(
            "{} triangles asked for, but the base mesh has {}: no edge was left that could collapse without "
            "changing the topology",
            with_commas(wanted), with_commas(got));
    if (wanted - got > 1)
        return fmt::format(
            "{} triangles asked for, {} is the nearest level below: one split brings {} triangles at once "
            "here",
            with_commas(wanted), with_commas(got), with_commas(triangles_at(mesh, level + 1) - got));
    return std::nullopt;
}

}  // namespace vsplit::app
