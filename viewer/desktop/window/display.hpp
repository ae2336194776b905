// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#pragma once

#include "vsplit/result.hpp"

namespace vsplit::studio {

/// Whether there is an X display that answers: VTK ends the process where there is none. Error: kIo, what to
/// do about it.
Status check_display();

}  // namespace vsplit::studio
