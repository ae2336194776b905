// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "vsplit/version.hpp"

namespace vsplit {

const char* version() {
    return VSPLIT_VERSION;
}

}  // namespace vsplit
