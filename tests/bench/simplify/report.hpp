// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The figures as a page and as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "machine.hpp"
#include "quality.hpp"
#include "speed.hpp"
#include "weights.hpp"

namespace vsplit::bench {

struct Report {
    Machine machine;
    std::string command;  ///< That repeats it; names no folder.
    std::string models;   ///< Where they are from.
    std::size_t samples = 0;
    std::vector<Peer> peers;
    std::vector<ModelQuality> quality;  ///< Empty if not asked for.
    std::optional<Speed> speed;
    std::vector<Calibration> calibration;  ///< Empty if not asked for.
    std::vector<WeightRun> weights;        ///< Empty if not asked for.
};

/// A page in Markdown.
std::string to_markdown(const Report& report);
Json to_json(const Report& report);

}  // namespace vsplit::bench
