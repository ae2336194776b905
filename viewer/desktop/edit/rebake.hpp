// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A bake in the background.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <thread>

#include "vsplit/bake/collapse.hpp"

namespace vsplit::studio {

/// One bake at a time on a thread of its own; its owner polls. Not for use from several threads.
class Rebake {
  public:
    Rebake() = default;
    ~Rebake() { cancel(); }
    Rebake(const Rebake&) = delete;
    Rebake& operator=(const Rebake&) = delete;

    /// Cancels what is running. Two results come, one after the other: the record with estimated errors, in a
    /// fraction of the time, then the same with measured ones.
    void start(Mesh mesh, bake::CollapseOptions options);
    bool running() const { return running_; }
    /// 0 to 1.
    double progress() const { return progress_; }
    /// Stops and waits.
    void cancel();
    /// A result that is there, once.
    std::optional<Result<bake::CollapseResult>> take();
    /// The first of the two is still to come or to be taken.
    bool first_pending() const { return first_; }

  private:
    std::thread thread_;
    std::atomic<bool> running_{false}, stop_{false}, first_{false};
    std::mutex lock_;  // of result_
    std::atomic<double> progress_{0};
    std::optional<Result<bake::CollapseResult>> result_;
};

}  // namespace vsplit::studio
