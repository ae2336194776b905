// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "points/parse.hpp"

namespace vsplit::bake {
namespace {

constexpr std::size_t kMostColumns = 64;
constexpr std::size_t kLinesToGuessFrom = 200;
constexpr std::string_view kSeparators = ",;";

bool is_comment(std::string_view word) {
    return word[0] == '#' || word.starts_with("//") || word[0] == '%' || word[0] == '!';
}

/// Splits a line into numbers; columns from the fourth on may be words (read as NaN). False, with the column,
/// otherwise.
bool split(std::string_view line, std::vector<double>& record, std::size_t& bad_column) {
    record.clear();
    for (std::string_view word = next_word(line, kSeparators); !word.empty() && record.size() < kMostColumns;
         word = next_word(line, kSeparators)) {
        if (is_comment(word)) break;
        const std::optional<double> value = parse_number(word);
        if (!value && record.size() < 3) {
            bad_column = record.size();
            return false;
        }
        record.push_back(value.value_or(std::nan("")));
    }
    return true;
}

/// Which of the columns beyond the coordinates are a normal, and which a colour, by the values of the first
/// lines.
Columns guess_columns(std::span<const std::vector<double>> records) {
    Columns columns;
    columns.position = {0, 1, 2};
    const int count = static_cast<int>(records[0].size());
    const auto all = [&](int first, auto&& test) {
        return std::all_of(records.begin(), records.end(), [&](const std::vector<double>& r) {
            const auto at = static_cast<std::size_t>(first);
            return test(r[at], r[at + 1], r[at + 2]);
        });
    };
    const auto is_normal = [](double x, double y, double z) {
        const double squared = x * x + y * y + z * z;
        return (squared > 0.9 && squared < 1.1) || squared == 0;
    };
    const auto is_colour = [](double r, double g, double b) {
        const auto is_byte = [](double v) { return v >= 0 && v <= 255 && v == std::floor(v); };
        return is_byte(r) && is_byte(g) && is_byte(b);
    };
    for (int first = 3; first + 3 <= count;) {
        if (!columns.has_normal() && all(first, is_normal)) {
            columns.normal = {first, first + 1, first + 2};
            first += 3;
        } else if (!columns.has_colour() && all(first, is_colour)) {
            // "intensity r g b": a whole intensity that fits a byte would shift the colour by one column.
            if ((count - first) % 3 == 1 && first + 4 <= count && all(first + 1, is_colour)) ++first;
            columns.colour = {first, first + 1, first + 2};
            first += 3;
        } else {
            ++first;
        }
    }
    return columns;
}

}  // namespace

Result<PointFile> parse_text_points(std::string_view text, const PointReadOptions& options) {
    PointFile file;
    file.report.format = "text";
    if (text.substr(0, 4096).find('\0') != std::string_view::npos)
        return error_at_offset(ErrorCode::kMalformed, "not text: it holds a zero byte", text.find('\0'));
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    Lines lines(text);
    std::string_view line;
    std::vector<double> record;
    std::vector<std::vector<double>> first_records;
    Columns columns;
    bool known = false, named = false;
    std::uint64_t announced = 0, count_line = 0;
    std::size_t width = 0;
    const auto start = [&] {
        columns = guess_columns(first_records);
        file.report.columns_ignored =
            width - 3 - (columns.has_normal() ? 3u : 0u) - (columns.has_colour() ? 3u : 0u);
        for (const auto& r : first_records) add_point(file, r, columns, 1);
        known = true;
    };
    while (lines.next(line)) {
        std::string_view rest = line;
        const std::string_view word = next_word(rest, kSeparators);
        if (word.empty() || is_comment(word)) {
            ++file.report.lines_skipped;
            continue;
        }
        std::size_t bad = 0;
        if (!split(line, record, bad)) {
            // One line of column names may stand before the points.
            if (file.report.points_in == 0 && !named && bad == 0) {
                named = true;
                ++file.report.lines_skipped;
                continue;
            }
            return error_at_line(ErrorCode::kMalformed,
                                 "column " + std::to_string(bad + 1) + " is not a number", lines.number());
        }
        if (record.size() == 1 && parse_count(word)) {
            // A count starts the file, or the next scan of a .pts file.
            announced += *parse_count(word);
            count_line = lines.number();
            ++file.report.lines_skipped;
            continue;
        }
        if (record.size() < 3)
            return error_at_line(ErrorCode::kMalformed,
                                 "a point needs three numbers, here are " + std::to_string(record.size()),
                                 lines.number());
        if (file.report.points_in == 0) width = record.size();
        if (record.size() < width)
            return error_at_line(ErrorCode::kMalformed,
                                 "the line has " + std::to_string(record.size()) +
                                     " columns, the first point has " + std::to_string(width),
                                 lines.number());
        if (++file.report.points_in > options.max_points)
            return error_at_line(ErrorCode::kLimit,
                                 "more than " + std::to_string(options.max_points) + " points",
                                 lines.number());
        if (known) {
            add_point(file, record, columns, 1);
        } else {
            first_records.push_back(record);
            if (first_records.size() == kLinesToGuessFrom) start();
        }
    }
    if (file.report.points_in == 0)
        return error_at_line(ErrorCode::kMalformed, "the file holds no point", lines.number());
    if (!known) start();
    if (file.report.points_in < announced)
        return error_at_line(ErrorCode::kTruncated,
                             std::to_string(announced) + " points are announced, " +
                                 std::to_string(file.report.points_in) + " follow",
                             count_line);
    return file;
}

}  // namespace vsplit::bake
