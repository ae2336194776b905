// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What the WebAssembly module exports: one stream, its arrays as patches. A module is instantiated for each
// stream, so that streams are independent and a closed one leaves no memory behind. stream.ts is the other
// side of each function here.
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include "live_arrays.hpp"
#include "vsplit/read.hpp"

#define VSPLIT_EXPORT extern "C" __attribute__((used, visibility("default")))

namespace {

using namespace vsplit;

// A group has an index of its own; a file may name any number.
constexpr std::uint32_t kMostGroups = 4096;

std::optional<BlockDecoder> decoder;
std::unique_ptr<web::LiveArrays> arrays;
Error failure;
std::vector<std::uint32_t> ranges;
std::vector<std::byte> data;

/// -1, or the error's code.
int fail(const Error& error) {
    failure = error;
    return static_cast<int>(error.code);
}

std::size_t level_of(int kind, double value) {
    const ProgressiveMesh& mesh = decoder->mesh();
    const double none = 0, most = 4294967295.0;
    const auto count = static_cast<std::uint64_t>(std::clamp(value, none, most));
    if (kind == 0) return level_for_triangles(mesh, count);
    if (kind == 1) return level_for_vertices(mesh, count);
    // While splits are missing, the error of the last level is the table's, not 0.
    const auto found = std::find_if(mesh.splits.begin(), mesh.splits.end(),
                                    [&](const Split& s) { return double(s.error) <= value; });
    return static_cast<std::size_t>(found - mesh.splits.begin());
}

void begin_pack() {
    ranges.clear();
    data.clear();
}

template <class Value>
void pack(const Value* values, std::size_t size, web::Changes& changes) {
    changes.take(size, [&](std::size_t begin, std::size_t end) {
        ranges.push_back(static_cast<std::uint32_t>(begin));
        ranges.push_back(static_cast<std::uint32_t>(end - begin));
        const auto* bytes = reinterpret_cast<const std::byte*>(values + begin);
        data.insert(data.end(), bytes, bytes + (end - begin) * sizeof(Value));
    });
}

std::size_t vertices() {
    return vertices_at(decoder->mesh(), arrays->level());
}

void pack_vertices(web::VertexArray& array) {
    pack(array.values.data(), array.components * vertices(), array.changes);
}

}  // namespace

VSPLIT_EXPORT void* vsplit_allocate(std::uint32_t bytes) {
    return std::malloc(bytes);
}
VSPLIT_EXPORT void vsplit_free(void* bytes) {
    std::free(bytes);
}

/// The front of the file, as much as there is. -1, or the error's code: kTruncated asks for more.
VSPLIT_EXPORT int vsplit_begin(const std::byte* bytes, std::uint32_t size, double max_bytes, int normals) {
    Limits limits;
    // Half is the decoder's, half ours.
    limits.max_bytes = static_cast<std::uint64_t>(std::clamp(max_bytes / 2, 0.0, 1.6e9));
    auto began = BlockDecoder::begin({bytes, size}, limits);
    if (!began) return fail(began.error());
    if (began->info().largest_group >= kMostGroups)
        return fail({ErrorCode::kLimit, "the mesh has more than " + std::to_string(kMostGroups) + " groups",
                     Error::kNowhere, 0});
    decoder.emplace(std::move(*began));
    arrays = std::make_unique<web::LiveArrays>(decoder->info(), decoder->mesh(), normals != 0);
    return -1;
}

VSPLIT_EXPORT const char* vsplit_failure() {
    return failure.message.c_str();
}
VSPLIT_EXPORT double vsplit_failure_offset() {
    return failure.offset == Error::kNowhere ? -1 : static_cast<double>(failure.offset);
}

VSPLIT_EXPORT double vsplit_info(int what) {
    const FileInfo& info = decoder->info();
    const Float3 &low = info.bounds_min, &high = info.bounds_max;
    const double values[] = {double(info.vertices),
                             double(info.triangles),
                             double(info.base_vertices),
                             double(info.base_triangles),
                             double(info.file_bytes),
                             low.x,
                             low.y,
                             low.z,
                             high.x,
                             high.y,
                             high.z,
                             double(info.lossless),
                             double(info.has_weights),
                             double(info.largest_group) + 1,
                             info.base_error,
                             double(info.attributes.size()),
                             double(info.blocks.size()),
                             double(info.data_offset)};
    return values[what];
}
VSPLIT_EXPORT double vsplit_block(std::uint32_t block, int what) {
    const BlockInfo& info = decoder->info().blocks[block];
    const double values[] = {double(info.offset), double(info.bytes), double(info.vertices_end),
                             double(info.triangles_end), info.error};
    return values[what];
}
VSPLIT_EXPORT const char* vsplit_attribute_name(std::uint32_t attribute) {
    return decoder->info().attributes[attribute].name.c_str();
}
VSPLIT_EXPORT std::uint32_t vsplit_attribute_components(std::uint32_t attribute) {
    return decoder->info().attributes[attribute].components;
}

/// The stored bytes of the next block. -1, or the error's code; after kChecksum the same block may come
/// again.
VSPLIT_EXPORT int vsplit_decode(const std::byte* bytes, std::uint32_t size) {
    const Status status = decoder->decode({bytes, size});
    return status ? -1 : fail(status.error());
}
VSPLIT_EXPORT std::uint32_t vsplit_blocks() {
    return static_cast<std::uint32_t>(decoder->blocks());
}

VSPLIT_EXPORT void vsplit_set_scale(std::uint32_t group, float scale) {
    arrays->set_scale(group, scale);
}

/// Towards at most `value` triangles (kind 0), vertices (1), or an error of at most it (2), by at most `most`
/// splits. 1 if that is not all, of what has arrived.
VSPLIT_EXPORT int vsplit_advance(int kind, double value, std::uint32_t most) {
    const std::size_t level = level_of(kind, value);
    arrays->go_towards(level, most);
    return arrays->level() != level;
}
VSPLIT_EXPORT std::uint32_t vsplit_level_vertices() {
    return static_cast<std::uint32_t>(vertices());
}
VSPLIT_EXPORT std::uint32_t vsplit_level_triangles() {
    return triangles_at(decoder->mesh(), arrays->level());
}
VSPLIT_EXPORT double vsplit_level_error() {
    const ProgressiveMesh& mesh = decoder->mesh();
    if (arrays->level() < mesh.splits.size()) return double(mesh.splits[arrays->level()].error);
    const std::size_t blocks = decoder->blocks();
    return blocks > 0 ? double(decoder->info().blocks[blocks - 1].error) : double(decoder->info().base_error);
}

/// What changed of an array since it was packed last: its bytes, in vsplit_data(). 0 positions, 1 weights, 2
/// normals, 3 + i attribute i.
VSPLIT_EXPORT std::uint32_t vsplit_pack_vertices(std::uint32_t array) {
    begin_pack();
    if (array == 0) {
        pack_vertices(arrays->positions);
        if (!arrays->scale_of_vertex.empty()) {
            auto* value = reinterpret_cast<float*>(data.data());
            for (std::size_t r = 0; r < ranges.size(); r += 2)
                for (std::uint32_t i = 0; i < ranges[r + 1]; ++i)
                    *value++ *= arrays->scale_of_vertex[(ranges[r] + i) / 3];
        }
    } else if (array == 1) {
        pack_vertices(arrays->weights);
    } else if (array == 2) {
        arrays->update_normals();
        ranges = {0, static_cast<std::uint32_t>(4 * vertices())};
        const auto* bytes = reinterpret_cast<const std::byte*>(arrays->normals.data());
        data.assign(bytes, bytes + 8 * vertices());
    } else {
        pack_vertices(arrays->attributes[array - 3]);
    }
    return static_cast<std::uint32_t>(data.size());
}
VSPLIT_EXPORT std::uint32_t vsplit_pack_group(std::uint32_t group) {
    begin_pack();
    web::GroupIndex& index = arrays->groups[group];
    pack(index.corners.data(), std::size_t{3} * index.triangles, index.changes);
    return static_cast<std::uint32_t>(data.size());
}
VSPLIT_EXPORT std::uint32_t vsplit_group_triangles(std::uint32_t group) {
    return arrays->groups[group].triangles;
}
VSPLIT_EXPORT const std::byte* vsplit_data() {
    return data.data();
}
VSPLIT_EXPORT const std::uint32_t* vsplit_ranges() {
    return ranges.data();
}
VSPLIT_EXPORT std::uint32_t vsplit_range_count() {
    return static_cast<std::uint32_t>(ranges.size());
}
