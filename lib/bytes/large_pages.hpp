// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Arrays of many MiB that are read all over miss the translation buffer at nearly every step; of pages of 2
// MiB there are 512 times fewer. Where the system gives them only to those that ask, this asks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace vsplit {

/// reserve(), and large pages for what lies within whole ones, before anything is written there. A hint: no
/// system needs to follow it, and nothing depends on it.
template <class T>
void reserve_large(std::vector<T>& array, std::size_t count) {
    array.reserve(count);
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    constexpr std::uintptr_t kPage = std::uintptr_t{2} << 20;
    const auto begin = reinterpret_cast<std::uintptr_t>(array.data() + array.size());
    const auto first = (begin + kPage - 1) & ~(kPage - 1);
    const auto end = reinterpret_cast<std::uintptr_t>(array.data() + array.capacity()) & ~(kPage - 1);
    if (first < end) static_cast<void>(madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE));
#endif
}

}  // namespace vsplit
