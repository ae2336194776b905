// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// How long, and in how much memory: the record of one large model, interleaved with its peers.
#pragma once

#include <string>
#include <vector>

#include "child.hpp"
#include "models.hpp"
#include "peer.hpp"

namespace vsplit::bench {

/// Several runs of one thing, each in its own process; medians.
struct Timing {
    std::string reason;  ///< Why there is none; empty if there is.
    int runs = 0;
    double cpu_seconds = 0, cpu_least = 0, cpu_most = 0, wall_seconds = 0, wall_least = 0;
    double peak_bytes = 0, start_bytes = 0;
    double collapses = 0;     ///< Vertices removed.
    double triangles = 0;     ///< Of the result.
    std::string fingerprint;  ///< Of the record, where there is one; the same for all runs, or "differs".
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Timing, reason, runs, cpu_seconds, cpu_least, cpu_most, wall_seconds,
                                   wall_least, peak_bytes, start_bytes, collapses, triangles, fingerprint)

struct Speed {
    std::string model, reason;
    std::uint64_t triangles = 0, fine_triangles = 0;
    Timing record, record_two_threads, record_calibrated;  ///< vsplit's full record.
    Timing meshoptimizer, openmesh;                        ///< To 1 %.
    Timing record_again, record_fine;                      ///< The model and its subdivision, in turns.
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Speed, model, reason, triangles, fine_triangles, record,
                                   record_two_threads, record_calibrated, meshoptimizer, openmesh,
                                   record_again, record_fine)

Speed measure_speed(const Model& model, const std::vector<Peer>& peers, bool quick);

}  // namespace vsplit::bench
