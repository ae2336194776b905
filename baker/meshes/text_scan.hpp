// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// One pass over a text in memory: numbers, words and lines, without copies, streams or locales. Private to
// this room.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "vsplit/result.hpp"

namespace vsplit::bake {

class TextScan {
  public:
    explicit TextScan(std::span<const std::byte> bytes, std::uint64_t first_line = 1)
        : begin_(reinterpret_cast<const char*>(bytes.data())),
          p_(begin_),
          end_(begin_ + bytes.size()),
          line_(first_line) {}

    bool at_end() const { return p_ == end_; }
    std::uint64_t line() const { return line_; }
    std::uint64_t bytes_left() const { return static_cast<std::uint64_t>(end_ - p_); }
    char peek() const { return p_ == end_ ? '\0' : *p_; }

    /// Blanks within a line. OBJ: a backslash before the line's end continues the line.
    void skip_blanks(bool continued = false) {
        for (; p_ != end_; ++p_) {
            if (is_blank(*p_)) continue;
            if (!continued || *p_ != '\\' || p_ + 1 == end_ || (p_[1] != '\n' && p_[1] != '\r')) return;
            ++p_;
            end_line();
        }
    }
    /// Blanks and ends of lines.
    void skip_space() {
        for (; p_ != end_; ++p_) {
            if (is_blank(*p_)) continue;
            if (!at_newline()) return;
            end_line();
        }
    }
    /// Blanks, ends of lines and comments from # to the end of the line.
    void skip_space_and_comments() {
        for (skip_space(); p_ != end_ && *p_ == '#'; skip_space()) next_line();
    }
    bool at_line_end() const { return p_ == end_ || at_newline(); }
    bool at_line_end_or_comment() const { return at_line_end() || *p_ == '#'; }
    /// To the first character of the next line. OBJ: past continued lines.
    void next_line(bool continued = false) {
        while (p_ != end_) {
            if (!at_newline()) {
                ++p_;
                continue;
            }
            const bool carries_on = continued && p_ != begin_ && p_[-1] == '\\';
            end_line();
            ++p_;
            if (!carries_on) return;
        }
    }

    /// The characters up to a blank, a line's end or the text's end; may be empty.
    std::string_view word() {
        const char* first = p_;
        while (p_ != end_ && !is_blank(*p_) && !at_newline()) ++p_;
        return {first, static_cast<std::size_t>(p_ - first)};
    }

    /// The number here, rounded once to the nearest float (or double). Takes what C, Python and old Microsoft
    /// runtimes print:
    /// "+1", "nan", "-nan(ind)", "inf", "1.#INF", "-1.#IND". Too large is infinite, too small is zero.
    template <class T>
    bool number(T& value) {
        const char* first = p_;
        if (first != end_ && *first == '+' && first + 1 != end_ && first[1] != '-') ++first;
        const auto [last, problem] = std::from_chars(first, end_, value);
        if (problem == std::errc::invalid_argument) return false;
        if (problem == std::errc::result_out_of_range) value = out_of_range<T>(first, last);
        p_ = last;
        if (p_ != end_ && *p_ == '#' && last[-1] == '.') {
            const std::string_view rest = word();
            value = rest.starts_with("#INF") ? std::copysign(std::numeric_limits<T>::infinity(), value)
                                             : std::numeric_limits<T>::quiet_NaN();
            return rest.starts_with("#INF") || rest.starts_with("#IND") || rest.starts_with("#QNAN") ||
                   rest.starts_with("#SNAN");
        }
        return at_delimiter();
    }
    /// A number less `origin`, of which no digit is lost before.
    bool coordinate(float& value, double origin) {
        if (origin == 0) return number(value);
        double wide = 0;
        if (!number(wide)) return false;
        value = static_cast<float>(wide - origin);
        return true;
    }
    bool integer(std::int64_t& value) {
        const auto [last, problem] = from_integer(value);
        if (problem != std::errc()) return false;
        p_ = last;
        return at_delimiter();
    }
    /// As integer(), but the caller looks at what follows (OBJ: a slash).
    bool integer_prefix(std::int64_t& value) {
        const auto [last, problem] = from_integer(value);
        if (problem != std::errc()) return false;
        p_ = last;
        return true;
    }
    bool at_delimiter() const {
        return p_ == end_ || is_blank(*p_) || at_newline() || *p_ == '#' || *p_ == '\\';
    }
    void advance() { ++p_; }

    Error error(ErrorCode code, std::string message) const {
        return {code, std::move(message), Error::kNowhere, line_};
    }
    /// What stands here, for a message: cut short, and nothing a terminal would obey.
    std::string quote() const {
        if (p_ == end_) return "the end of the file";
        if (at_newline()) return "the end of the line";
        std::string text = "'";
        for (const char* q = p_; q != end_ && !is_blank(*q) && *q != '\n' && *q != '\r'; ++q) {
            if (text.size() > 24) return text + "...'";
            text += *q > ' ' && *q < 127 ? *q : '?';
        }
        return text + "'";
    }
    /// kTruncated at the end of the text, kMalformed within it.
    Error expected(const std::string& what) const {
        return error(at_end() ? ErrorCode::kTruncated : ErrorCode::kMalformed,
                     "expected " + what + ", found " + quote());
    }

  private:
    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
    bool at_newline() const { return *p_ == '\n' || *p_ == '\r'; }
    /// From the first to the last character of a line's end: "\n", "\r\n" or "\r".
    void end_line() {
        if (*p_ == '\r' && p_ + 1 != end_ && p_[1] == '\n') ++p_;
        ++line_;
    }

    std::from_chars_result from_integer(std::int64_t& value) const {
        const char* first = p_;
        if (first != end_ && *first == '+' && first + 1 != end_ && first[1] != '-') ++first;
        return std::from_chars(first, end_, value);
    }
    template <class T>
    static T out_of_range(const char* first, const char* last) {
        double wide = 0;
        if (std::from_chars(first, last, wide).ec == std::errc()) return static_cast<T>(wide);
        const std::string_view text(first, static_cast<std::size_t>(last - first));
        const bool negative = text.starts_with('-');
        const std::size_t e = text.find_first_of("eE");
        const std::string_view digits = text.substr(negative, e == text.npos ? text.npos : e - negative);
        const bool tiny = e != text.npos ? text.substr(e).find('-') != text.npos
                                         : digits.find_first_not_of('0') == digits.find('.');
        const T value = tiny ? T{0} : std::numeric_limits<T>::infinity();
        return negative ? -value : value;
    }

    const char* begin_;
    const char* p_;
    const char* end_;
    std::uint64_t line_;
};

}  // namespace vsplit::bake
