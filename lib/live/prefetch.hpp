// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

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

/// Of what will be read once, past the caches that the rest needs. It may lie beyond the array's ends.
inline void prefetch_once(const void* from, std::ptrdiff_t bytes) {
    const auto at = reinterpret_cast<std::uintptr_t>(from) + static_cast<std::uintptr_t>(bytes);
#if defined(__GNUC__)
    __builtin_prefetch(reinterpret_cast<const void*>(at), 0, 0);
#else
    static_cast<void>(at);
#endif
}

}  // namespace vsplit
