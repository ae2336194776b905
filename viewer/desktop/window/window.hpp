// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The studio's window.
#pragma once

#include <memory>
#include <string>

#include "../edit/document.hpp"

namespace vsplit::studio {

struct WindowOptions {
    int width = 1280, height = 800;
    bool bench = false;  ///< Measure, print, and end.
    std::string marks;   ///< Where they came from, and are saved to; empty: beside the model.
};

/// Runs until the window is closed. There must be a display (check_display()).
void run_window(std::unique_ptr<Document> document, const WindowOptions& options);

}  // namespace vsplit::studio
