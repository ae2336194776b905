// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// One reader a format: bytes to polygons. Private to this room; parse_mesh chooses among them and assembles.
// All bytes are hostile. Counts are held against the bytes left before they are believed.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include "vsplit/bake/meshes.hpp"

namespace vsplit::bake {

/// A reader's yield. The report counts only what the reader itself left out.
struct SoupFile {
    PolygonSoup soup;
    MeshReport report;
    bool wide = false;  ///< The file may hold more digits than the floats in `soup`.
};

/// What a reader takes off all coordinates before it rounds them to floats.
using Origin = std::array<double, 3>;

Result<SoupFile> read_obj(std::span<const std::byte> bytes, const Origin& origin);
Result<SoupFile> read_ply(std::span<const std::byte> bytes, const std::string& weight_property,
                          const Origin& origin);
Result<SoupFile> read_off(std::span<const std::byte> bytes, const Origin& origin);
Result<SoupFile> read_stl_text(std::span<const std::byte> bytes, const Origin& origin);
Result<SoupFile> read_stl_binary(std::span<const std::byte> bytes);

/// Whether the bytes are a text STL, which says "solid" as some binary files do, too.
bool is_stl_text(std::span<const std::byte> bytes);
/// Whether the length is exactly what the count in a binary STL's head asks for.
bool is_stl_binary(std::span<const std::byte> bytes);
/// Whether an OFF keyword comes first (after comments).
bool is_off(std::span<const std::byte> bytes);
/// Whether the first line that is no comment starts with a word of the OBJ format.
bool is_obj(std::span<const std::byte> bytes);

}  // namespace vsplit::bake
