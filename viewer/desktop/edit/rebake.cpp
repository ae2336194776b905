// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "rebake.hpp"

namespace vsplit::studio {

void Rebake::start(Mesh mesh, bake::CollapseOptions options) {
    cancel();
    stop_ = false;
    running_ = first_ = true;
    progress_ = 0;
    thread_ = std::thread([this, mesh = std::move(mesh), options = std::move(options)]() mutable {
        for (const bool measured : {false, true}) {
            options.calibrate = measured;
            auto result = bake::collapse(mesh, options, [&](std::string_view stage, double done) {
                progress_ = !measured             ? 0.2 * done
                            : stage == "collapse" ? 0.2 + 0.2 * done
                                                  : 0.4 + 0.6 * done;
                return !stop_;
            });
            const bool ok = result.ok();
            {
                const std::lock_guard guard(lock_);
                result_.emplace(std::move(result));
            }
            if (!ok) break;
        }
        running_ = false;
    });
}

void Rebake::cancel() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    result_.reset();
    running_ = first_ = false;
}

std::optional<Result<bake::CollapseResult>> Rebake::take() {
    const std::lock_guard guard(lock_);
    if (!result_) return std::nullopt;
    std::optional<Result<bake::CollapseResult>> result = std::move(result_);
    result_.reset();
    first_ = false;
    return result;
}

}  // namespace vsplit::studio
