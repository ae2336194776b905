// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace vsplit {

/// Of what will be written soon.
inline void prefetch(const void* address) {
#if defined(__GNUC__)
    __builtin_prefetch(address, 1);
#else
    static_cast<void>(address);
#endif
}

/// Some floats, of which one in eight triples lies in two cache lines.
inline void prefetch(const float* values, std::size_t count) {
    prefetch(values);
    if (count > 1) prefetch(values + count - 1);
}

}  // namespace vsplit
