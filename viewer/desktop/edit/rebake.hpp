// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A bake in the background.
#pragma once

#include <atomic>
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

    /// Cancels what is running.
    void start(Mesh mesh, bake::CollapseOptions options);
    bool running() const { return running_; }
    /// 0 to 1.
    double progress() const { return progress_; }
    /// Stops and waits.
    void cancel();
    /// A result that is there, once.
    std::optional<Result<bake::CollapseResult>> take();

  private:
    std::thread thread_;
    std::atomic<bool> running_{false}, stop_{false}, ready_{false};
    std::atomic<double> progress_{0};
    std::optional<Result<bake::CollapseResult>> result_;
};

}  // namespace vsplit::studio
