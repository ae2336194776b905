// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The order in which a record's splits are written: in sweeps over the vertices, each of which asks every
// vertex whether it splits, and again when its star has changed; so that which vertex splits next costs a few
// bits instead of a vertex's number.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "vsplit/progressive_mesh.hpp"

namespace vsplit {

/// How a sweep asks vertices whether they split.
enum class SweepKind : std::uint8_t {
    kRounds,    ///< Each in turn, and again those whose stars changed: splits may depend on each other.
    kBatch,     ///< Each in turn, until it says no: no triangle changes twice, and those that did are no part
                ///< of a cut. Only those with triangles left are asked.
    kBatchAll,  ///< The same, but all are asked.
};

/// So few vertices of those alive are marked that it tells them by their numbers.
inline bool is_sparse(std::uint32_t marked, std::uint32_t alive) {
    return std::uint64_t{marked} * 64 < alive;
}

struct Sweep {
    struct Step {
        std::uint32_t split;    ///< In the record.
        std::uint32_t primary;  ///< The written number of its first parent; kNoVertex if it has none.
    };
    std::vector<Step>
        steps;  ///< Those with parents, in the order in which they are asked; then those without.
    SweepKind kind = SweepKind::kRounds;
    float error = 0;  ///< Of the mesh before the sweep: of the first split not made yet.
    /// After it, the file is as near as the record is with a half of the triangles, a quarter, and so on.
    bool reaches_level = false;
};

/// Every split once; a sweep's error is the record's. Two splits keep their order if one acts on a vertex
/// (splits or moves it) in the star of a vertex that the other acts on; all others may change places, which
/// leaves the mesh around each as it was. A record in which long rows of splits change different triangles is
/// written in batches, else in rounds, in sweeps that each reach such a level. `traded` tells of each vertex
/// of the record whether it keeps its parent's number when it is born, and the parent gets the new one.
/// `idle` tells of each move that the file does not have it. `raised` is what the file will tell for an error
/// of the record; it never falls with it. `mesh` must be sound.
std::vector<Sweep> schedule(const ProgressiveMesh& mesh, const std::vector<bool>& traded,
                            const std::vector<bool>& idle, const std::function<float(float)>& raised);

}  // namespace vsplit
