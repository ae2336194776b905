// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// How to collapse, as the subcommands that bake are told.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "vsplit/bake/collapse.hpp"

namespace vsplit::app {

struct CollapseFlags {
    std::string cost = "quadric", placement = "optimal";
    std::vector<std::string> locks;
    double stitch = bake::CollapseOptions{}.stitch;

    void add_to(CLI::App& command);
    /// The reason if a lock is unknown.
    std::optional<std::string> set(bake::CollapseOptions& options) const;
};

}  // namespace vsplit::app
