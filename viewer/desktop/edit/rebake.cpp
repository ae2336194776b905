// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "rebake.hpp"

namespace vsplit::studio {

void Rebake::start(Mesh mesh, bake::CollapseOptions options) {
    cancel();
    stop_ = ready_ = false;
    running_ = true;
    progress_ = 0;
    thread_ = std::thread([this, mesh = std::move(mesh), options = std::move(options)] {
        result_.emplace(bake::collapse(mesh, options, [this](std::string_view stage, double done) {
            progress_ = stage == "collapse" ? 0.7 * done : 0.7 + 0.3 * done;
            return !stop_;
        }));
        ready_ = true;
        running_ = false;
    });
}

void Rebake::cancel() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    result_.reset();
    ready_ = false;
}

std::optional<Result<bake::CollapseResult>> Rebake::take() {
    if (!ready_) return std::nullopt;
    thread_.join();
    ready_ = false;
    std::optional<Result<bake::CollapseResult>> result = std::move(result_);
    result_.reset();
    return result;
}

}  // namespace vsplit::studio
