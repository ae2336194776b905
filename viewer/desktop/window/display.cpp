// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "display.hpp"

#include <X11/Xlib.h>
#undef Status  // one of its macros

#include <cstdlib>
#include <string>

namespace vsplit::studio {

Status check_display() {
    const char* name = std::getenv("DISPLAY");
    const auto refuse = [](std::string message) {
        return Error{ErrorCode::kIo, std::move(message), Error::kNowhere, 0};
    };
    if (!name || !*name) return refuse("no display to draw with: set DISPLAY, or run under xvfb-run");
    // Kept open: a server that goes back to its beginnings when the last client leaves would do so here.
    static Display* const display = XOpenDisplay(nullptr);
    if (!display)
        return refuse("the display " + std::string(name) +
                      " does not answer: set DISPLAY to one that does, or run under xvfb-run");
    return Ok{};
}

}  // namespace vsplit::studio
