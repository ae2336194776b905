// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// How a long stage tells its caller where it is. Stages never print.
#pragma once

#include <functional>
#include <string_view>

namespace vsplit::bake {

/// Called now and then, always from the thread that called the stage, with the stage's name ("collapse") and
/// the share done, 0 to 1. Returning false asks the stage to stop: it then returns ErrorCode::kCancelled. May
/// be empty.
using Progress = std::function<bool(std::string_view stage, double done)>;

}  // namespace vsplit::bake
