// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#pragma once

namespace vsplit {

/// "0.1.0": of the library that is linked.
const char* version();

}  // namespace vsplit
