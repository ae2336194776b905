// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "readers.hpp"

namespace vsplit::bake {
namespace {

bool starts_with(std::span<const std::byte> bytes, std::string_view magic) {
    return bytes.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), bytes.begin(), [](char c, std::byte b) {
               return static_cast<unsigned char>(c) == std::to_integer<unsigned char>(b);
           });
}

/// What else people drop here, to name it instead of complaining about its first byte.
const char* foreign_format(std::span<const std::byte> bytes) {
    constexpr struct {
        std::string_view magic;
        const char* name;
    } formats[] = {
        {"\x8F"
         "pmesh",
         "a .pmesh, which is baked already (extract cuts a mesh out of it)"},
        {"glTF", "a glTF file"},
        {"{", "a JSON file (a glTF scene is read as a scene)"},
        {"\x89PNG", "a PNG image"},
        {"\xFF\xD8\xFF", "a JPEG image"},
        {"GIF8", "a GIF image"},
        {"PK\x03\x04", "a ZIP archive"},
        {"\x1F\x8B", "gzip-compressed: unpack it first"},
        {"\x28\xB5\x2F\xFD", "zstd-compressed: unpack it first"},
        {"%PDF", "a PDF document"},
        {"\x7F"
         "ELF",
         "a program"},
        {"DRACO", "a Draco file"},
        {"Kaydara FBX", "an FBX file"},
        {"<", "an XML or HTML file"},
        {"\xFF\xFE", "text in UTF-16"},
        {"\xFE\xFF", "text in UTF-16"},
    };
    for (const auto& format : formats)
        if (starts_with(bytes, format.magic)) return format.name;
    return nullptr;
}

bool is_ply(std::span<const std::byte> bytes) {
    return starts_with(bytes, "ply\n") || starts_with(bytes, "ply\r") || starts_with(bytes, "ply ");
}

std::string lower_case(std::string_view text) {
    std::string lower(text);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return lower;
}

Result<SoupFile> read_soup(std::span<const std::byte> bytes, std::string_view extension,
                           const ReadOptions& options, const Origin& origin) {
    const std::string ext = lower_case(extension);
    if (bytes.empty()) return Error{ErrorCode::kTruncated, "the file is empty", 0, 0};
    if (is_ply(bytes)) return read_ply(bytes, options.weight_property, origin);
    if (!options.weight_property.empty())
        return Error{ErrorCode::kArgument, "only PLY files have properties to take as weights",
                     Error::kNowhere, 0};
    // A binary STL may start with anything, and no text has its length by chance.
    if (is_stl_binary(bytes)) return read_stl_binary(bytes);
    if (const char* name = foreign_format(bytes))
        return Error{ErrorCode::kUnsupported, std::string(name) + ", not a mesh this reader knows", 0, 0};
    const std::span<const std::byte> text = starts_with(bytes, "\xEF\xBB\xBF") ? bytes.subspan(3) : bytes;
    if (is_off(text)) return read_off(text, origin);
    if (is_stl_text(text)) return read_stl_text(text, origin);
    if (starts_with(bytes, "solid")) return read_stl_binary(bytes);

    const auto zero = std::find(bytes.begin(), bytes.end(), std::byte{0});
    if (zero != bytes.end() && ext == ".stl") return read_stl_binary(bytes);
    if (zero != bytes.end())
        return Error{ErrorCode::kMalformed, "binary data, but neither PLY nor STL",
                     static_cast<std::uint64_t>(zero - bytes.begin()), 0};
    if (is_obj(text)) return read_obj(text, origin);
    if (ext == ".ply")
        return Error{ErrorCode::kMalformed, "a PLY file starts with 'ply'", Error::kNowhere, 1};
    if (ext == ".off") return read_off(text, origin);
    if (ext == ".obj") return read_obj(text, origin);
    return Error{ErrorCode::kMalformed, "not an OBJ, PLY, OFF or STL file", Error::kNowhere, 1};
}

/// local_origin() of the finite ones.
Origin origin_of(std::span<const Float3> positions) {
    constexpr double kMost = std::numeric_limits<double>::max();
    Origin low{kMost, kMost, kMost}, high{-kMost, -kMost, -kMost};
    for (const Float3& p : positions) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
        low = {std::min(low[0], double(p.x)), std::min(low[1], double(p.y)), std::min(low[2], double(p.z))};
        high = {std::max(high[0], double(p.x)), std::max(high[1], double(p.y)),
                std::max(high[2], double(p.z))};
    }
    return low[0] > high[0] ? Origin{} : local_origin(low, high);
}

}  // namespace

std::array<double, 3> local_origin(const std::array<double, 3>& low, const std::array<double, 3>& high) {
    double extent = 0, farthest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        extent = std::max(extent, high[axis] - low[axis]);
        farthest = std::max({farthest, std::fabs(low[axis]), std::fabs(high[axis])});
    }
    // Sixteen bits of the extent are left to a float there.
    constexpr double kFar = 256;
    if (!(extent > 0) || !std::isfinite(extent) || farthest <= kFar * extent) return {};
    int exponent = 0;
    std::frexp(extent, &exponent);
    const double grid = std::ldexp(1.0, exponent);
    Origin origin{};
    for (int axis = 0; axis < 3; ++axis)
        origin[axis] = std::round((low[axis] / 2 + high[axis] / 2) / grid) * grid;
    return origin;
}

Result<MeshFile> parse_mesh(std::span<const std::byte> bytes, std::string_view extension,
                            const ReadOptions& options) {
    Result<SoupFile> file = read_soup(bytes, extension, options, {});
    if (!file) return file.error();
    // Where the box lies is known after reading only.
    const Origin origin = file->wide ? origin_of(file->soup.positions) : Origin{};
    if (origin != Origin{}) {
        file = read_soup(bytes, extension, options, origin);
        if (!file) return file.error();
    }
    Weld weld = options.weld;
    if (weld == Weld::kAuto) weld = file->report.format.starts_with("STL") ? Weld::kAll : Weld::kBoundary;
    Result<MeshFile> mesh = assemble_mesh(std::move(file->soup), weld, std::move(file->report));
    if (mesh) mesh->mesh.origin = origin;
    if (mesh || mesh.error().offset != Error::kNowhere) return mesh;
    // What is missing in the whole file is missing up to its end.
    Error error = mesh.error();
    error.offset = bytes.size();
    return error;
}

}  // namespace vsplit::bake
