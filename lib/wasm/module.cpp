// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What the WebAssembly module exports: one vsplit::Stream, its buffers as patches. A module is instantiated
// for each stream, so that streams are independent and a closed one leaves no memory behind. stream.ts is the
// other side of each function here. Offsets in the file are doubles: whole up to 2^53.
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>

#include "patch.hpp"
#include "vsplit/stream.hpp"

#define VSPLIT_EXPORT extern "C" __attribute__((used, visibility("default")))

namespace {

using namespace vsplit;

// A group has an index of its own; a file may name any number.
constexpr std::uint32_t kMostGroups = 4096;

std::optional<Stream> stream;
std::optional<web::Patcher> patcher;
bool makes_normals = true;
Error failure;
std::vector<double> wanted;
std::span<const std::byte> packed;
std::span<const std::uint32_t> packed_ranges;

constexpr int kReached = 1, kWantsBytes = 2, kChanged = 4, kMore = 8;

int fail(const Error& error) {
    failure = error;
    return static_cast<int>(error.code);
}

/// -1, or the error's code.
int status_of(const Status& status) {
    return status ? -1 : fail(status.error());
}

std::uint64_t whole(double value, double most) {
    return value > 0 ? static_cast<std::uint64_t>(std::min(value, most)) : 0;
}

template <class Value>
std::uint32_t give(const web::Stretches<Value>& stretches) {
    packed = std::as_bytes(std::span(stretches.values));
    packed_ranges = stretches.ranges;
    return static_cast<std::uint32_t>(packed.size());
}

}  // namespace

VSPLIT_EXPORT void* vsplit_allocate(std::uint32_t bytes) {
    return std::malloc(bytes);
}
VSPLIT_EXPORT void vsplit_free(void* bytes) {
    std::free(bytes);
}

VSPLIT_EXPORT void vsplit_open(double max_bytes, int normals) {
    StreamOptions options;
    // Half is the decoder's, half that of the buffers.
    options.limits.max_bytes = whole(max_bytes / 2, 1.6e9);
    // How often a damaged block is fetched again, and past which caches, is the worker's to say.
    options.tries = std::numeric_limits<int>::max();
    // A server without ranges sends all of it, wanted or not, and would have to do so again.
    options.max_pending_bytes = std::max(options.max_pending_bytes, options.limits.max_bytes / 4);
    makes_normals = normals != 0;
    stream.emplace(options);
    stream->buffers().track_runs(true);
}

/// Bytes from anywhere in the file. -1, or the error's code; after kChecksum the bytes are wanted again.
VSPLIT_EXPORT int vsplit_feed(double offset, const std::byte* bytes, std::uint32_t size) {
    const Status status = stream->feed(whole(offset, 9e15), {bytes, size});
    if (stream->ready() && !patcher) {
        const FileInfo& info = *stream->info();
        if (info.largest_group >= kMostGroups)
            return fail({ErrorCode::kLimit,
                         "the mesh has more than " + std::to_string(kMostGroups) + " groups", Error::kNowhere,
                         0});
        patcher.emplace(info.largest_group + 1, makes_normals);
    }
    return status_of(status);
}
VSPLIT_EXPORT int vsplit_set_file_size(double bytes) {
    return status_of(stream->set_file_size(whole(bytes, 9e15)));
}

VSPLIT_EXPORT const char* vsplit_failure() {
    return failure.message.c_str();
}
VSPLIT_EXPORT double vsplit_failure_offset() {
    return failure.offset == Error::kNowhere ? -1 : static_cast<double>(failure.offset);
}

/// The kinds are those of Target::Kind.
VSPLIT_EXPORT void vsplit_set_target(int kind, double value, double max_triangles) {
    stream->set_target(
        {static_cast<Target::Kind>(std::clamp(kind, 0, 4)), value, whole(max_triangles, 9e15)});
}
/// How many ranges are in vsplit_wanted(): offset and size of each.
VSPLIT_EXPORT std::uint32_t vsplit_wants(double most_bytes, std::uint32_t ahead) {
    wanted.clear();
    for (const ByteRange& range : stream->wants(whole(most_bytes, 9e15), ahead)) {
        wanted.push_back(static_cast<double>(range.offset));
        wanted.push_back(static_cast<double>(range.size));
    }
    return static_cast<std::uint32_t>(wanted.size() / 2);
}
VSPLIT_EXPORT const double* vsplit_wanted() {
    return wanted.data();
}
VSPLIT_EXPORT int vsplit_ready() {
    return stream->ready() && patcher;
}
VSPLIT_EXPORT int vsplit_broken() {
    return stream->broken();
}
VSPLIT_EXPORT double vsplit_received() {
    return static_cast<double>(stream->bytes_received());
}

VSPLIT_EXPORT double vsplit_info(int what) {
    const FileInfo& info = *stream->info();
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
    const BlockInfo& info = stream->info()->blocks[block];
    const double values[] = {double(info.offset), double(info.bytes), double(info.vertices_end),
                             double(info.triangles_end), info.error};
    return values[what];
}
VSPLIT_EXPORT const char* vsplit_attribute_name(std::uint32_t attribute) {
    return stream->info()->attributes[attribute].name.c_str();
}
VSPLIT_EXPORT std::uint32_t vsplit_attribute_components(std::uint32_t attribute) {
    return stream->info()->attributes[attribute].components;
}
VSPLIT_EXPORT std::uint32_t vsplit_blocks() {
    return static_cast<std::uint32_t>(stream->blocks_decoded());
}

VSPLIT_EXPORT void vsplit_set_scale(std::uint32_t group, float scale) {
    patcher->set_scale(group, scale);
}

/// Decodes and refines or coarsens within these bounds: flags, or -2 less an error's code.
VSPLIT_EXPORT int vsplit_update(std::uint32_t most_splits, std::uint32_t most_blocks) {
    const std::size_t blocks = stream->blocks_decoded();
    const Result<Updated> updated = stream->update({most_splits, most_blocks});
    if (!updated) return -2 - fail(updated.error());
    const bool worked = updated->splits > 0 || stream->blocks_decoded() > blocks;
    return (updated->reached ? kReached : 0) | (updated->wants_bytes ? kWantsBytes : 0) |
           (updated->splits > 0 ? kChanged : 0) | (worked && !updated->reached ? kMore : 0);
}
VSPLIT_EXPORT std::uint32_t vsplit_level_vertices() {
    return stream->buffers().vertex_count();
}
VSPLIT_EXPORT std::uint32_t vsplit_level_triangles() {
    return stream->buffers().triangle_count();
}
VSPLIT_EXPORT double vsplit_level_error() {
    return double(stream->level_error());
}

/// Begins a patch: what changed since the one before. The others of this name belong to it.
VSPLIT_EXPORT void vsplit_patch() {
    patcher->take(stream->buffers());
}
/// Bytes of an array's new contents, in vsplit_data(); where they go is in vsplit_ranges(). 0 positions, 1
/// weights, 2 normals, 3 + i attribute i.
VSPLIT_EXPORT std::uint32_t vsplit_patch_vertices(std::uint32_t array) {
    const LiveBuffers& buffers = stream->buffers();
    if (array == 0) return give(patcher->positions(buffers));
    if (array == 1) return give(patcher->vertex_values(buffers.weights(), 1));
    if (array == 2) return give(patcher->normals(buffers));
    return give(patcher->vertex_values(buffers.attribute(array - 3), vsplit_attribute_components(array - 3)));
}
VSPLIT_EXPORT std::uint32_t vsplit_patch_group(std::uint32_t group) {
    return give(patcher->group(group));
}
VSPLIT_EXPORT std::uint32_t vsplit_group_triangles(std::uint32_t group) {
    return patcher->group_triangles(group);
}
VSPLIT_EXPORT const std::byte* vsplit_data() {
    return packed.data();
}
VSPLIT_EXPORT const std::uint32_t* vsplit_ranges() {
    return packed_ranges.data();
}
VSPLIT_EXPORT std::uint32_t vsplit_range_count() {
    return static_cast<std::uint32_t>(packed_ranges.size());
}
