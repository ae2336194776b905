// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The outermost layer of a glTF file: the two chunks of a GLB, or the text itself (glTF 2.0 specification,
// section 4.4).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vsplit/result.hpp"

namespace vsplit::bake {

/// Views into the bytes that were given.
struct GltfContainer {
    bool binary = false;                            ///< A GLB.
    std::string_view json;                          ///< The JSON text.
    std::uint64_t json_offset = 0;                  ///< Where it starts in the file.
    std::optional<std::span<const std::byte>> bin;  ///< The GLB's BIN chunk, if there is one.
};

/// Checks magic, version, declared lengths and chunk order; hostile bytes are safe. A file that does not
/// begin like a GLB is taken for JSON text.
Result<GltfContainer> open_container(std::span<const std::byte> bytes);

/// kLimit for JSON that nests more than 200 deep, which real documents are far from; whatever prints or walks
/// it recurses. `offset`: where the text is in the file.
Status check_json_depth(std::string_view json, std::uint64_t offset);

/// A GLB of this JSON text and this BIN chunk (none if it is empty). kLimit above 4 GiB.
Result<std::vector<std::byte>> seal_container(std::string json, std::span<const std::byte> bin);

}  // namespace vsplit::bake
