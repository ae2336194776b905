// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "buffers.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "vsplit/bake/files.hpp"

namespace vsplit::bake {
namespace {

Error fault(ErrorCode code, std::string message) {
    return {code, std::move(message), Error::kNowhere, 0};
}

int sextet(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+') return 62;
    return c == '/' ? 63 : -1;
}

/// tinygltf has a decoder too, but it stops at the first stranger without a word, and knows a few media types
/// only.
Result<std::vector<std::byte>> decode_base64(std::string_view text) {
    for (int pad = 0; pad < 2 && text.ends_with('='); ++pad) text.remove_suffix(1);
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int held = 0;
    for (const char c : text) {
        const int value = sextet(c);
        if (value < 0)
            return fault(ErrorCode::kMalformed, "its data: URI holds a character that is not base64");
        bits = bits << 6 | static_cast<std::uint32_t>(value);
        held += 6;
        if (held < 8) continue;
        held -= 8;
        bytes.push_back(static_cast<std::byte>(bits >> held & 0xff));
    }
    return bytes;
}

int hex(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

std::string percent_decoded(std::string_view uri) {
    std::string path;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] == '%' && i + 2 < uri.size() && hex(uri[i + 1]) >= 0 && hex(uri[i + 2]) >= 0) {
            path += static_cast<char>(hex(uri[i + 1]) * 16 + hex(uri[i + 2]));
            i += 2;
        } else {
            path += uri[i];
        }
    }
    return path;
}

}  // namespace

Result<std::vector<std::byte>> load_uri(std::string_view uri, const std::string& folder) {
    if (uri.starts_with("data:")) {
        const std::size_t comma = uri.find(',');
        if (comma == uri.npos || !uri.substr(0, comma).ends_with(";base64"))
            return fault(ErrorCode::kUnsupported, "its data: URI is not in base64");
        return decode_base64(uri.substr(comma + 1));
    }
    namespace fs = std::filesystem;
    const std::string text = percent_decoded(uri);
    std::string shown = "'";
    shown.append(text, 0, 200) += '\'';
    if (folder.empty())
        return fault(ErrorCode::kUnsupported,
                     "it is in another file, " + shown + ", which was not to be opened");
    const fs::path relative(text);
    const bool inside = !text.empty() && text.find_first_of(std::string_view("\\:\0", 3)) == text.npos &&
                        relative.is_relative() &&
                        std::find(relative.begin(), relative.end(), "..") == relative.end();
    const auto leaves = [&] {
        return fault(ErrorCode::kUnsupported, "its file " + shown + " is not inside the scene's folder");
    };
    if (!inside) return leaves();
    // Symbolic links may still lead out.
    std::error_code error;
    const fs::path base = fs::canonical(folder, error);
    if (error) return fault(ErrorCode::kIo, "cannot open the folder: " + error.message());
    const fs::path path = fs::canonical(base / relative, error);
    if (error) return fault(ErrorCode::kIo, "cannot open its file " + shown + ": " + error.message());
    if (std::mismatch(base.begin(), base.end(), path.begin(), path.end()).first != base.end())
        return leaves();
    if (!fs::is_regular_file(path, error))
        return fault(ErrorCode::kIo, "its file " + shown + " is no regular file");
    auto bytes = read_file(path.string());
    if (!bytes.ok()) return fault(bytes.error().code, "its file " + shown + ": " + bytes.error().message);
    return bytes;
}

}  // namespace vsplit::bake
