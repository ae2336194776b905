// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Memory grows by half, not by what is missing: each time a browser maps it anew, and may collect garbage
// first. What is not written to costs address space only. The linker puts this in place of Emscripten's.
#include <cstddef>
#include <cstdint>
#include <limits>

extern "C" void emscripten_notify_memory_growth(std::size_t);
extern "C" int __wrap_emscripten_resize_heap(std::size_t size);

namespace {

constexpr std::size_t kPage = 65536, kMostPages = 65536;

bool grow_to(std::size_t pages) {
    const std::size_t now = __builtin_wasm_memory_size(0);
    if (pages > kMostPages || pages <= now) return false;
    return __builtin_wasm_memory_grow(0, pages - now) != std::numeric_limits<std::size_t>::max();
}

}  // namespace

extern "C" int __wrap_emscripten_resize_heap(std::size_t size) {
    const std::size_t least = size / kPage + (size % kPage != 0);
    if (!grow_to(least + least / 2) && !grow_to(least)) return 0;
    emscripten_notify_memory_growth(0);
    return 1;
}
