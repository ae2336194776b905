// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A scene's images.
#pragma once

#include "../edit/placement.hpp"

namespace vsplit::studio {

/// PNG or JPEG, told by its first bytes, of at most 2^26 pixels. An empty image if it is another or damaged.
Image decode_image(std::span<const std::byte> bytes);

}  // namespace vsplit::studio
