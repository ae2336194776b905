// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What the studio does in the background: bakes, and searches for weights.
#pragma once

#include <string>
#include <vector>

#include "background.hpp"
#include "vsplit/bake/collapse.hpp"
#include "vsplit/bake/weights.hpp"

namespace vsplit::studio {

struct Rebaked {
    Result<bake::CollapseResult> result;
    bool last = true;  ///< Nothing comes after it.
};
using Rebake = Background<Rebaked>;

/// Two results come, one after the other: the sequence as it is recorded, with estimated errors, in a third
/// of the time, then with outliers put off and errors measured.
void start_rebake(Rebake& rebake, Mesh mesh, bake::CollapseOptions options);

struct Search {
    bake::Keep wish;
    Result<std::vector<bake::KeepResult>> found;
};
using WeightSearch = Background<Search>;

/// As find_weights(), of one wish. Its progress says how near it is by the number of records made.
void start_search(WeightSearch& search, Mesh mesh, bake::Marks marks, bake::Keep wish,
                  bake::CollapseOptions options);

}  // namespace vsplit::studio
