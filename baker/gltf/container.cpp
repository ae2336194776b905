// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "container.hpp"

#include <algorithm>
#include <limits>
#include <string>

namespace vsplit::bake {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67;  // "glTF"
constexpr std::uint32_t kJson = 0x4E4F534A;   // "JSON"
constexpr std::uint32_t kBin = 0x004E4942;    // "BIN\0"

std::uint32_t u32(std::span<const std::byte> bytes, std::uint64_t at) {
    std::uint32_t value = 0;
    for (int i = 3; i >= 0; --i)
        value = value << 8 | std::to_integer<std::uint32_t>(bytes[at + std::uint64_t(i)]);
    return value;
}

Error fault(ErrorCode code, std::string message, std::uint64_t offset) {
    return {code, "GLB: " + std::move(message), offset, 0};
}

Result<GltfContainer> open_glb(std::span<const std::byte> bytes) {
    const std::uint64_t size = bytes.size();
    if (size < 12) return fault(ErrorCode::kTruncated, "the file ends within its header of 12 bytes", size);
    if (u32(bytes, 4) != 2)
        return fault(ErrorCode::kUnsupported,
                     "container version " + std::to_string(u32(bytes, 4)) + ", only 2 is read", 4);
    const std::uint64_t declared = u32(bytes, 8);
    if (declared > size)
        return fault(
            ErrorCode::kTruncated,
            "the header announces " + std::to_string(declared) + " bytes, there are " + std::to_string(size),
            size);
    if (declared < size)
        return fault(ErrorCode::kMalformed,
                     "the header announces " + std::to_string(declared) + " bytes, more follow them", 8);
    GltfContainer container;
    container.binary = true;
    std::uint64_t at = 12;
    for (int chunk = 0; at < size; ++chunk) {
        if (size - at < 8) return fault(ErrorCode::kMalformed, "a chunk header of 8 bytes does not fit", at);
        const std::uint64_t length = u32(bytes, at);
        const std::uint32_t type = u32(bytes, at + 4);
        if (length > size - at - 8)
            return fault(ErrorCode::kMalformed,
                         "a chunk of " + std::to_string(length) + " bytes does not fit", at);
        if (length % 4 != 0) return fault(ErrorCode::kMalformed, "a chunk's length is no multiple of 4", at);
        const auto payload = bytes.subspan(at + 8, length);
        if (chunk == 0 && type != kJson)
            return fault(ErrorCode::kMalformed, "the first chunk is not JSON", at + 4);
        if (chunk > 0 && type == kJson) return fault(ErrorCode::kMalformed, "a second JSON chunk", at + 4);
        if (chunk > 1 && type == kBin)
            return fault(ErrorCode::kMalformed, "BIN is not the second chunk", at + 4);
        if (chunk == 0) {
            container.json = {reinterpret_cast<const char*>(payload.data()), payload.size()};
            container.json_offset = at + 8;
        } else if (type == kBin) {
            container.bin = payload;
        }  // Chunks of other types are extensions, to be skipped.
        at += 8 + length;
    }
    if (container.json_offset == 0) return fault(ErrorCode::kMalformed, "no JSON chunk", 12);
    return container;
}

void put_u32(std::vector<std::byte>& out, std::uint64_t value) {
    for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::byte>(value >> shift & 0xff));
}

}  // namespace

Status check_json_depth(std::string_view json, std::uint64_t offset) {
    constexpr int kMaxDepth = 200;
    int depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (quoted) {
            if (c == '\\') ++i;
            if (c == '"') quoted = false;
        } else if (c == '"') {
            quoted = true;
        } else if (c == '{' || c == '[') {
            if (++depth > kMaxDepth)
                return Error{ErrorCode::kLimit,
                             "the JSON nests more than " + std::to_string(kMaxDepth) + " deep", offset + i,
                             0};
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
    return Ok{};
}

Result<std::vector<std::byte>> seal_container(std::string json, std::span<const std::byte> bin) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::size_t padded = (bin.size() + 3) / 4 * 4;
    const std::uint64_t total = std::uint64_t{12} + 8 + json.size() + (padded > 0 ? 8 + padded : 0);
    if (total > std::numeric_limits<std::uint32_t>::max())
        return Error{ErrorCode::kLimit,
                     "a GLB cannot be longer than 4 GiB, this one needs " + std::to_string(total) + " bytes",
                     Error::kNowhere, 0};
    std::vector<std::byte> out;
    out.reserve(total);
    put_u32(out, kMagic);
    put_u32(out, 2);
    put_u32(out, total);
    put_u32(out, json.size());
    put_u32(out, kJson);
    const auto* from = reinterpret_cast<const std::byte*>(json.data());
    out.insert(out.end(), from, from + json.size());
    if (padded > 0) {
        put_u32(out, padded);
        put_u32(out, kBin);
        out.insert(out.end(), bin.begin(), bin.end());
        out.resize(total);
    }
    return out;
}

Result<GltfContainer> open_container(std::span<const std::byte> bytes) {
    if (bytes.size() >= 4 && u32(bytes, 0) == kMagic) return open_glb(bytes);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    constexpr std::string_view magic = "glTF";
    if (text.empty() || magic.starts_with(text))
        return Error{ErrorCode::kTruncated, "the file ends before it says what it is", bytes.size(), 0};
    const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
    if (first == text.npos || text[first] != '{')
        return Error{ErrorCode::kMalformed, "neither a GLB nor glTF's JSON",
                     first == text.npos ? 0 : std::uint64_t{first}, 0};
    GltfContainer container;
    container.json = text;
    return container;
}

}  // namespace vsplit::bake
