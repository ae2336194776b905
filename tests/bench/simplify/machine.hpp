// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Where and when figures were made: without it they mean nothing.
#pragma once

#include <string>

#include "child.hpp"

namespace vsplit::bench {

struct Machine {
    std::string cpu, system, compiler, date, commit;
    unsigned cores = 0;
    double memory_gib = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Machine, cpu, system, compiler, date, commit, cores, memory_gib)

Machine describe_machine();

}  // namespace vsplit::bench
