// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "vsplit/bake/weights.hpp"

namespace vsplit::bake {
namespace {

template <class T>
bool number(std::string_view text, T& value) {
    const auto [last, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    return problem == std::errc() && last == text.data() + text.size();
}

std::string_view next_word(std::string_view& line) {
    const std::size_t first = std::min(line.find_first_not_of(" \t\r"), line.size());
    const std::size_t last = std::min(line.find_first_of(" \t\r", first), line.size());
    const std::string_view word = line.substr(first, last - first);
    line.remove_prefix(last);
    return word;
}

template <class T>
void append(std::string& text, T value) {
    char buffer[48];
    const auto end = std::to_chars(buffer, buffer + sizeof(buffer), value).ptr;
    text.append(buffer, end);
}

std::vector<std::byte> bytes_of(const std::string& text) {
    const auto* data = reinterpret_cast<const std::byte*>(text.data());
    return {data, data + text.size()};
}

/// nullptr, or what is wrong with the line.
const char* parse_region(std::string_view line, Marks& marks) {
    Region region;
    region.name = std::string(next_word(line));
    if (region.name.empty() || region.name.find('=') != std::string::npos)
        return "a region wants a name without blanks or '='";
    for (const Region& other : marks.regions)
        if (other.name == region.name) return "two regions of one name";
    const std::string_view weight = next_word(line);
    if (weight != "auto") {
        double value = 0;
        if (!number(weight, value) || !(value >= 0))
            return "a region's weight is a number of 0 or more, inf, or auto";
        region.weight = value;
    }
    const std::string_view colour = next_word(line);
    if (!colour.empty()) {
        const auto* first = colour.data() + 1;
        if (colour.size() != 7 || colour[0] != '#' ||
            std::from_chars(first, first + 6, region.colour, 16).ptr != first + 6)
            return "a region's colour is #RRGGBB";
    }
    if (!next_word(line).empty()) return "a region has name, weight and colour, no more";
    if (marks.regions.size() == Marks::kMaxRegions) return "more than 255 regions";
    marks.regions.push_back(std::move(region));
    return nullptr;
}

const char* parse_mark(std::string_view word, std::string_view line, Marks& marks) {
    std::uint32_t region = 0;
    if (!number(word, region)) return "expected the number of a region";
    if (region > marks.regions.size()) return "a region that was not told";
    float strength = 1;
    const std::string_view second = next_word(line);
    if (!second.empty() && (!number(second, strength) || !(strength >= 0 && strength <= 1)))
        return "a strength is 0 to 1";
    if (!next_word(line).empty()) return "a vertex has region and strength, no more";
    marks.region.push_back(std::uint8_t(region));
    marks.strength.push_back(strength);
    return nullptr;
}

}  // namespace

Result<Marks> parse_marks(std::span<const std::byte> bytes, std::size_t count) {
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    Marks marks;
    marks.region.reserve(std::min(count, bytes.size() / 2 + 1));
    marks.strength.reserve(std::min(count, bytes.size() / 2 + 1));
    for (std::uint64_t number_of_line = 1; !text.empty(); ++number_of_line) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        const auto fault = [&](std::string message) {
            return Error{ErrorCode::kMalformed, std::move(message), Error::kNowhere, number_of_line};
        };
        // A colour begins with the sign that begins a comment: comments are lines of their own.
        const std::string_view word = next_word(line);
        if (word.empty() || word[0] == '#') continue;
        const char* wrong = nullptr;
        if (word == "region")
            wrong = parse_region(line, marks);
        else if (marks.region.size() == count)
            return fault("more marks than the mesh's " + std::to_string(count) + " vertices");
        else
            wrong = parse_mark(word, line, marks);
        if (wrong) return fault(wrong);
    }
    if (marks.region.size() < count)
        return Error{ErrorCode::kTruncated,
                     std::to_string(marks.region.size()) + " marks for a mesh of " + std::to_string(count) +
                         " vertices",
                     bytes.size(), 0};
    return marks;
}

std::vector<std::byte> encode_marks(const Marks& marks) {
    std::string text = "# vsplit marks: regions, then for each vertex its region and strength\n";
    text.reserve(text.size() + 2 * marks.region.size() + 64 * marks.regions.size());
    for (const Region& region : marks.regions) {
        text += "region " + region.name + ' ';
        if (region.weight)
            append(text, *region.weight);
        else
            text += "auto";
        char colour[8] = " #";
        text += colour;
        for (int shift = 20; shift >= 0; shift -= 4)
            text += "0123456789abcdef"[(region.colour >> shift) & 15];
        text += '\n';
    }
    for (std::size_t v = 0; v < marks.region.size(); ++v) {
        append(text, std::uint32_t(marks.region[v]));
        if (marks.region[v] != 0 && marks.strength[v] != 1) {
            text += ' ';
            append(text, marks.strength[v]);
        }
        text += '\n';
    }
    return bytes_of(text);
}

std::vector<std::byte> encode_weights(std::span<const float> weights) {
    std::string text;
    text.reserve(4 * weights.size());
    for (const float weight : weights) {
        append(text, weight);
        text += '\n';
    }
    return bytes_of(text);
}

std::optional<double> parse_share(std::string_view text) {
    double scale = 1;
    if (text.ends_with('%')) {
        text.remove_suffix(1);
        scale = 0.01;
    }
    double value = 0;
    if (!number(text, value)) return std::nullopt;
    value *= scale;
    if (!(value >= 0 && value <= 1)) return std::nullopt;
    return value;
}

std::optional<Keep> parse_keep(std::string_view text) {
    const std::size_t equals = text.rfind('='), at = text.rfind('@');
    if (equals == std::string_view::npos || at == std::string_view::npos || at < equals || equals == 0)
        return std::nullopt;
    const auto share = parse_share(text.substr(equals + 1, at - equals - 1)),
               ratio = parse_share(text.substr(at + 1));
    if (!share || !ratio) return std::nullopt;
    return Keep{std::string(text.substr(0, equals)), *share, *ratio};
}

}  // namespace vsplit::bake
