// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "vsplit/result.hpp"

namespace vsplit {

const char* error_code_name(ErrorCode code) {
    switch (code) {
        case ErrorCode::kIo:
            return "io";
        case ErrorCode::kUnsupported:
            return "unsupported";
        case ErrorCode::kTruncated:
            return "truncated";
        case ErrorCode::kMalformed:
            return "malformed";
        case ErrorCode::kChecksum:
            return "checksum";
        case ErrorCode::kLimit:
            return "limit";
        case ErrorCode::kArgument:
            return "argument";
        case ErrorCode::kExists:
            return "exists";
        case ErrorCode::kCancelled:
            return "cancelled";
    }
    return "unknown";
}

std::string Error::describe() const {
    std::string text = message;
    if (line > 0)
        text += " (line " + std::to_string(line) + ")";
    else if (offset != kNowhere)
        text += " (offset " + std::to_string(offset) + ")";
    return text;
}

}  // namespace vsplit
