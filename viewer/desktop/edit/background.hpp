// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Work on a thread of its own, whose owner polls.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace vsplit::studio {

/// One job at a time, which makes results of type R. Not for use from several threads.
template <class R>
class Background {
  public:
    /// What the job has of its owner.
    class Job {
      public:
        explicit Job(Background& owner) : owner_(owner) {}
        /// 0 to 1. False: stop.
        bool progress(double done) const {
            owner_.progress_ = done;
            return !owner_.stop_;
        }
        /// A result, in place of one that was not taken.
        void give(R result) const {
            const std::lock_guard guard(owner_.lock_);
            owner_.result_.emplace(std::move(result));
        }

      private:
        Background& owner_;
    };

    Background() = default;
    ~Background() { cancel(); }
    Background(const Background&) = delete;
    Background& operator=(const Background&) = delete;

    /// Cancels what is running.
    void start(std::function<void(const Job&)> work) {
        cancel();
        stop_ = false;
        running_ = true;
        progress_ = 0;
        thread_ = std::thread([this, work = std::move(work)] {
            work(Job(*this));
            running_ = false;
        });
    }
    bool running() const { return running_; }
    /// 0 to 1.
    double progress() const { return progress_; }
    /// Stops and waits; a result that was not taken is dropped.
    void cancel() {
        stop_ = true;
        if (thread_.joinable()) thread_.join();
        result_.reset();
        running_ = false;
    }
    /// A result that is there, once.
    std::optional<R> take() {
        const std::lock_guard guard(lock_);
        return std::exchange(result_, std::nullopt);
    }

  private:
    std::thread thread_;
    std::atomic<bool> running_{false}, stop_{false};
    std::atomic<double> progress_{0};
    std::mutex lock_;  // of result_
    std::optional<R> result_;
};

}  // namespace vsplit::studio
