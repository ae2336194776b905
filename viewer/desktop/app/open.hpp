// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Any file as what the studio works on.
#pragma once

#include "../edit/document.hpp"
#include "collapse_flags.hpp"
#include "command.hpp"
#include "input.hpp"

namespace vsplit::app {

/// A .pmesh, a progressive GLB, a mesh, or a glTF scene with its attributes. Points: reconstruct_cloud().
/// On failure the message is said and `exit` set.
Result<studio::Source> open_source(const InputOptions& input, const Common& common, int& exit);

/// A document of a source; messages as above.
Result<std::unique_ptr<studio::Document>> document_of(studio::Source source, const CollapseFlags& flags,
                                                      const std::string& marks, const Common& common,
                                                      int& exit);

/// The same as a document: baked if need be, with these marks if any.
Result<std::unique_ptr<studio::Document>> open_document(const InputOptions& input, const CollapseFlags& flags,
                                                        const std::string& marks, const Common& common,
                                                        int& exit);

}  // namespace vsplit::app
