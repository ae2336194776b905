// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Everything that the mouse does, without one: docs/studio.md has the script's format.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "document.hpp"

namespace vsplit::studio {

struct ScriptHost {
    /// Writes a file that a step names.
    std::function<Status(const std::string& path, std::span<const std::byte> bytes)> write;
    std::function<Result<std::vector<std::byte>>(const std::string& path)> read;
    /// Draws the document as the camera sees it; empty where there is no renderer.
    std::function<Result<std::vector<std::byte>>(const Document&, const Camera&,
                                                 const nlohmann::ordered_json& step)>
        picture;
    bake::Progress progress;
};

/// Runs the steps; what each did is appended to `report`. The first that fails ends the script: its error
/// names the step. Hostile JSON is safe.
Status run_script(Document& document, std::string_view json, const ScriptHost& host,
                  nlohmann::ordered_json& report);

}  // namespace vsplit::studio
