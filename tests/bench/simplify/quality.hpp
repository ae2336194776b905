// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What each simplifier makes of each model: distances, normals, defects.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "child.hpp"
#include "models.hpp"
#include "peer.hpp"
#include "ruler.hpp"

namespace vsplit::bench {

inline constexpr std::array<double, 4> kRatios{0.6, 0.4, 0.1, 0.01};

/// One mesh at one ratio. Lengths in 1e-4 of the model's diagonal.
struct Level {
    double ratio = 0;
    std::uint64_t target = 0, triangles = 0;
    std::string reason;  ///< Why there is nothing to compare; empty if there is.
    double mean = 0, rms = 0, max = 0, normal_degrees = 0, quality_mean = 0, quality_min = 0;
    std::uint64_t new_flipped = 0, new_folded = 0, new_degenerate = 0;  ///< That the input did not have.
    std::uint64_t non_manifold_edges = 0, boundary_edges = 0, components = 0;

    std::uint64_t defects() const { return new_flipped + new_folded + new_degenerate; }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Level, ratio, target, triangles, reason, mean, rms, max, normal_degrees,
                                   quality_mean, quality_min, new_flipped, new_folded, new_degenerate,
                                   non_manifold_edges, boundary_edges, components)

/// One simplifier on one model.
struct Run {
    std::string peer;
    std::string reason;      ///< Why there are no levels; empty if there are.
    double cpu_seconds = 0;  ///< For all ratios, one thread; median of three where short.
    std::vector<Level> levels;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Run, peer, reason, cpu_seconds, levels)

struct ModelQuality {
    std::string model;
    std::string reason;  ///< Why it could not be measured; empty if it was.
    std::uint64_t vertices = 0, triangles = 0;
    std::uint64_t degenerate = 0, folded = 0;  ///< The input's own.
    std::vector<Run> runs;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ModelQuality, model, reason, vertices, triangles, degenerate, folded, runs)

ModelQuality measure_quality(const Model& model, const std::vector<Peer>& peers,
                             const ruler::RulerOptions& options, bool quick);

/// How `--error E` holds: E asked for, the level chosen, the distance that it really has.
struct ErrorCheck {
    double error = 0, measured = 0;  ///< 1e-4 of the diagonal.
    std::uint64_t triangles = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ErrorCheck, error, measured, triangles)

struct Calibration {
    std::string model, reason;
    std::vector<ErrorCheck> checks;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Calibration, model, reason, checks)

/// Twenty errors, evenly in their logarithm from the one that drops a twentieth of the triangles to the one
/// that leaves a hundredth.
Calibration measure_calibration(const Model& model, const ruler::RulerOptions& options);

}  // namespace vsplit::bench
