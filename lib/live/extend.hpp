// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace vsplit {

/// Appends what `from` has from to.size() on, up to `end`.
template <class T>
void extend(std::vector<T>& to, const std::vector<T>& from, std::size_t end) {
    if (end > to.size())
        to.insert(to.end(), from.begin() + std::ptrdiff_t(to.size()), from.begin() + std::ptrdiff_t(end));
}
template <class T>
void extend(std::vector<T>& to, const std::vector<T>& from) {
    extend(to, from, from.size());
}

template <class T>
std::size_t bytes_of(const std::vector<T>& v) {
    return v.capacity() * sizeof(T);
}

}  // namespace vsplit
