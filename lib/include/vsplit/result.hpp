// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// How vsplit says that something went wrong: a value or an Error, never an exception.
#pragma once

#include <cassert>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>

namespace vsplit {

/// What kind of failure an Error is. The names are stable; formats/spec/errors.md lists them with examples.
enum class ErrorCode : std::uint8_t {
    kIo,           ///< The operating system refused: the message quotes its reason.
    kUnsupported,  ///< Well-formed, but a kind of data that this version does not read.
    kTruncated,    ///< The bytes end before what they announce.
    kMalformed,    ///< The bytes contradict the format.
    kChecksum,     ///< A block's checksum does not match its bytes.
    kLimit,        ///< A count exceeds Limits, or would need more memory than they allow.
    kArgument,     ///< The caller asked for something that cannot be: a negative ratio, a missing attribute.
    kExists,       ///< The output exists and overwriting was not asked for.
    kCancelled,    ///< The caller's Progress asked to stop.
};

/// The stable lower-case name of a code, "malformed".
const char* error_code_name(ErrorCode code);

/// One failure: what, in words for a person, and where. `message` names no file; the one who knows it adds
/// it.
struct Error {
    static constexpr std::uint64_t kNowhere = ~std::uint64_t{0};

    ErrorCode code = ErrorCode::kMalformed;
    std::string message;
    std::uint64_t offset = kNowhere;  ///< Byte in the input, or kNowhere.
    std::uint64_t line = 0;           ///< Line of a text input, from 1, or 0.

    /// "message (offset 1234)" or "message (line 12)".
    std::string describe() const;
};

/// A value of T or an Error. Ask ok() first: value() of a failure is a caller's bug and asserts.
template <class T>
class [[nodiscard]] Result {
  public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    bool ok() const { return state_.index() == 0; }
    explicit operator bool() const { return ok(); }

    T& value() & {
        assert(ok());
        return *std::get_if<0>(&state_);
    }
    const T& value() const& {
        assert(ok());
        return *std::get_if<0>(&state_);
    }
    T&& value() && {
        assert(ok());
        return std::move(*std::get_if<0>(&state_));
    }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T&& operator*() && { return std::move(*this).value(); }

    const Error& error() const {
        assert(!ok());
        return *std::get_if<1>(&state_);
    }

  private:
    std::variant<T, Error> state_;
};

/// Success without a value.
struct Ok {};
using Status = Result<Ok>;

}  // namespace vsplit
