// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A piece of work in a process of its own, so that its CPU time and its memory are its own, and a crash is an
// answer.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>

#include "vsplit/result.hpp"

namespace vsplit::bench {

using Json = nlohmann::json;

/// Of one process, from Meter's start to its stop.
struct Usage {
    double cpu_seconds = 0;  ///< User and system, all threads.
    double wall_seconds = 0;
    std::uint64_t peak_bytes =
        0;  ///< Of the resident set, since the process began; the input and all code are in it.
    std::uint64_t start_bytes = 0;  ///< Resident set at the start: the input and all code.
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Usage, cpu_seconds, wall_seconds, peak_bytes, start_bytes)

/// Measures the process that it lives in.
class Meter {
  public:
    Meter();
    Usage stop() const;

  private:
    double cpu_;
    std::chrono::steady_clock::time_point wall_;
    std::uint64_t resident_;
};

/// Forks, runs `work` in the child and hands its answer over. The error's message is the child's own,
/// "crashed (signal 11)", or "stopped after 600 s". The calling process must be single-threaded: oneTBB may
/// run in children only.
Result<Json> in_child(const std::function<Result<Json>()>& work, double limit_seconds);

}  // namespace vsplit::bench
