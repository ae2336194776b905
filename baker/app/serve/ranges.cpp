// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "ranges.hpp"

#include <algorithm>
#include <charconv>

namespace vsplit::app {
namespace {

// A viewer asks for one, at most a few; a header of hundreds is an attempt to make the server work.
constexpr std::size_t kMostRanges = 16;

std::string_view trimmed(std::string_view text) {
    const auto begin = text.find_first_not_of(" \t");
    if (begin == text.npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// A number of digits alone; what is too long for 64 bits is as good as the greatest.
std::optional<std::uint64_t> number(std::string_view text) {
    std::uint64_t value = 0;
    if (text.empty() || text.find_first_not_of("0123456789") != text.npos) return std::nullopt;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    return fault == std::errc{} ? value : ~std::uint64_t{0};
}

bool overlap(std::vector<ByteRange> ranges) {
    std::sort(ranges.begin(), ranges.end(),
              [](const ByteRange& a, const ByteRange& b) { return a.first < b.first; });
    for (std::size_t i = 1; i < ranges.size(); ++i)
        if (ranges[i].first <= ranges[i - 1].last) return true;
    return false;
}

}  // namespace

std::optional<std::vector<ByteRange>> parse_ranges(std::string_view header, std::uint64_t size) {
    constexpr std::string_view kUnit = "bytes=";
    if (!header.starts_with(kUnit)) return std::nullopt;
    header.remove_prefix(kUnit.size());
    std::vector<ByteRange> ranges;
    for (std::size_t asked = 0, more = true; more; ++asked) {
        const std::size_t comma = header.find(',');
        const std::string_view spec = trimmed(header.substr(0, comma));
        more = comma != header.npos;
        if (more) header.remove_prefix(comma + 1);
        const std::size_t dash = spec.find('-');
        if (dash == spec.npos || asked == kMostRanges) return std::nullopt;
        const auto first = number(spec.substr(0, dash)), last = number(spec.substr(dash + 1));
        if (dash == 0) {
            if (!last) return std::nullopt;
            if (*last > 0 && size > 0) ranges.push_back({size - std::min(*last, size), size - 1});
            continue;
        }
        if (!first || (!last && dash + 1 != spec.size()) || (last && *last < *first)) return std::nullopt;
        if (*first < size) ranges.push_back({*first, std::min(last.value_or(size - 1), size - 1)});
    }
    if (overlap(ranges)) return std::nullopt;
    return ranges;
}

}  // namespace vsplit::app
