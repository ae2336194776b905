// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// vsplit.h: the Stream behind C's handles.
#include "vsplit/stream.hpp"

#include <cstring>
#include <new>
#include <string>

#include "vsplit/version.hpp"
#include "vsplit/vsplit.h"

struct vsplit_stream {
    explicit vsplit_stream(vsplit::StreamOptions options) : stream(std::move(options)) {}
    vsplit::Stream stream;
    std::string words;
};

namespace {

vsplit_status status_of(vsplit::ErrorCode code) {
    switch (code) {
        case vsplit::ErrorCode::kUnsupported:
            return VSPLIT_ERROR_UNSUPPORTED;
        case vsplit::ErrorCode::kTruncated:
            return VSPLIT_ERROR_TRUNCATED;
        case vsplit::ErrorCode::kChecksum:
            return VSPLIT_ERROR_CHECKSUM;
        case vsplit::ErrorCode::kLimit:
            return VSPLIT_ERROR_LIMIT;
        case vsplit::ErrorCode::kArgument:
            return VSPLIT_ERROR_ARGUMENT;
        default:
            return VSPLIT_ERROR_MALFORMED;
    }
}

template <class T>
vsplit_status take(vsplit_stream* s, const vsplit::Result<T>& result) {
    if (result.ok()) return VSPLIT_OK;
    s->words = result.error().describe();
    return status_of(result.error().code);
}

template <class T>
const T* data_or_null(std::span<const T> values) {
    return values.empty() ? nullptr : values.data();
}

}  // namespace

extern "C" {

const char* vsplit_version(void) {
    return vsplit::version();
}

vsplit_stream* vsplit_stream_new(const vsplit_options* options) {
    vsplit::StreamOptions chosen;
    if (options) {
        if (options->tries < 0 || options->hysteresis != options->hysteresis) return nullptr;
        if (options->max_bytes > 0) chosen.limits.max_bytes = options->max_bytes;
        if (options->max_pending_bytes > 0) chosen.max_pending_bytes = options->max_pending_bytes;
        if (options->tries > 0) chosen.tries = options->tries;
        if (options->hysteresis != 0) chosen.hysteresis = options->hysteresis < 0 ? 0 : options->hysteresis;
    }
    return new (std::nothrow) vsplit_stream(std::move(chosen));
}

void vsplit_stream_free(vsplit_stream* s) {
    delete s;
}

void vsplit_stream_set_target(vsplit_stream* s, vsplit_target kind, double value) {
    switch (kind) {
        case VSPLIT_TARGET_TRIANGLES:
            return s->stream.set_target({vsplit::Target::Kind::kTriangles, value});
        case VSPLIT_TARGET_VERTICES:
            return s->stream.set_target({vsplit::Target::Kind::kVertices, value});
        case VSPLIT_TARGET_ERROR:
            return s->stream.set_target(vsplit::Target::error(value));
        case VSPLIT_TARGET_PIXELS:
            return s->stream.set_target(vsplit::Target::pixels(value));
        default:
            return s->stream.set_target(vsplit::Target::ratio(value));
    }
}

size_t vsplit_stream_wants(const vsplit_stream* s, vsplit_range* out, size_t capacity, uint64_t most_bytes) {
    const auto ranges = s->stream.wants(most_bytes);
    const size_t count = ranges.size() < capacity ? ranges.size() : capacity;
    for (size_t i = 0; i < count; ++i) out[i] = {ranges[i].offset, ranges[i].size};
    return count;
}

vsplit_status vsplit_stream_feed(vsplit_stream* s, uint64_t offset, const void* bytes, size_t size) {
    return take(s, s->stream.feed(offset, {static_cast<const std::byte*>(bytes), size}));
}

vsplit_status vsplit_stream_set_file_size(vsplit_stream* s, uint64_t bytes) {
    return take(s, s->stream.set_file_size(bytes));
}

vsplit_status vsplit_stream_update(vsplit_stream* s, size_t max_splits, size_t max_blocks,
                                   vsplit_updated* out) {
    const auto updated = s->stream.update({max_splits, max_blocks, {}});
    if (out) *out = {0, 0, 0};
    if (updated.ok() && out) *out = {updated->splits, updated->reached, updated->wants_bytes};
    return take(s, updated);
}

void vsplit_stream_jump(vsplit_stream* s) {
    s->stream.jump_to_target();
}

int vsplit_stream_ready(const vsplit_stream* s) {
    return s->stream.ready();
}
int vsplit_stream_broken(const vsplit_stream* s) {
    return s->stream.broken();
}
int vsplit_stream_complete(const vsplit_stream* s) {
    return s->stream.complete();
}
const char* vsplit_stream_error(const vsplit_stream* s) {
    return s->words.c_str();
}
uint64_t vsplit_stream_bytes_received(const vsplit_stream* s) {
    return s->stream.bytes_received();
}

void vsplit_stream_totals(const vsplit_stream* s, vsplit_totals* out) {
    *out = {};
    const vsplit::FileInfo* info = s->stream.info();
    if (!info || !s->stream.ready()) return;
    out->vertices = info->vertices;
    out->triangles = info->triangles;
    out->splits = info->splits;
    out->base_vertices = info->base_vertices;
    out->base_triangles = info->base_triangles;
    out->blocks = static_cast<uint32_t>(info->blocks.size());
    out->attributes = static_cast<uint32_t>(info->attributes.size());
    out->file_bytes = info->file_bytes;
    std::memcpy(out->bounds_min, &info->bounds_min, sizeof(out->bounds_min));
    std::memcpy(out->bounds_max, &info->bounds_max, sizeof(out->bounds_max));
    for (size_t axis = 0; axis < 3; ++axis) out->origin[axis] = info->origin[axis];
    out->base_error = info->base_error;
    out->has_weights = info->has_weights;
    out->has_groups = info->largest_group > 0;
}

uint32_t vsplit_stream_vertex_count(const vsplit_stream* s) {
    return s->stream.buffers().vertex_count();
}
uint32_t vsplit_stream_triangle_count(const vsplit_stream* s) {
    return s->stream.buffers().triangle_count();
}
const float* vsplit_stream_positions(const vsplit_stream* s) {
    const auto places = s->stream.buffers().positions();
    return places.empty() ? nullptr : &places.data()->x;
}
const uint32_t* vsplit_stream_triangles(const vsplit_stream* s) {
    const auto triangles = s->stream.buffers().triangles();
    return triangles.empty() ? nullptr : triangles.data()->data();
}
const float* vsplit_stream_weights(const vsplit_stream* s) {
    return data_or_null(s->stream.buffers().weights());
}
const uint32_t* vsplit_stream_groups(const vsplit_stream* s) {
    return data_or_null(s->stream.buffers().groups());
}
const uint32_t* vsplit_stream_parents(const vsplit_stream* s) {
    return data_or_null(s->stream.buffers().parents());
}

int vsplit_stream_attribute(const vsplit_stream* s, uint32_t index, vsplit_attribute* out) {
    *out = {nullptr, 0, nullptr};
    const vsplit::FileInfo* info = s->stream.info();
    if (!info || !s->stream.ready() || index >= info->attributes.size()) return 0;
    *out = {info->attributes[index].name.c_str(), info->attributes[index].components,
            data_or_null(s->stream.buffers().attribute(index))};
    return 1;
}

float vsplit_stream_level_error(const vsplit_stream* s) {
    return s->stream.level_error();
}

vsplit_dirty vsplit_stream_take_dirty(vsplit_stream* s) {
    const vsplit::DirtyRanges dirty = s->stream.buffers().take_dirty();
    return {dirty.vertices_begin, dirty.vertices_end, dirty.triangles_begin, dirty.triangles_end};
}

vsplit_status vsplit_stream_copy_indices(const vsplit_stream* s, uint32_t first, uint32_t count, void* out,
                                         size_t bytes_per_index) {
    const auto triangles = s->stream.buffers().triangles();
    if (first > triangles.size() || count > triangles.size() - first) return VSPLIT_ERROR_ARGUMENT;
    if (bytes_per_index == 4) {
        if (count > 0) std::memcpy(out, triangles.data() + first, size_t{12} * count);
        return VSPLIT_OK;
    }
    if (bytes_per_index != 2 || s->stream.buffers().vertex_count() > 65535) return VSPLIT_ERROR_ARGUMENT;
    auto* at = static_cast<unsigned char*>(out);
    for (const vsplit::Triangle& t : triangles.subspan(first, count))
        for (const uint32_t v : t) {
            const auto narrow = static_cast<uint16_t>(v);
            std::memcpy(at, &narrow, 2);
            at += 2;
        }
    return VSPLIT_OK;
}

vsplit_status vsplit_stream_copy_vertices(const vsplit_stream* s, uint32_t first, uint32_t count,
                                          uint32_t index, void* out, size_t stride) {
    const vsplit::LiveBuffers& live = s->stream.buffers();
    if (first > live.vertex_count() || count > live.vertex_count() - first) return VSPLIT_ERROR_ARGUMENT;
    const float* from = nullptr;
    size_t components = 3;
    if (index == VSPLIT_POSITION) {
        from = vsplit_stream_positions(s);
    } else {
        vsplit_attribute attribute;
        if (!vsplit_stream_attribute(s, index, &attribute)) return VSPLIT_ERROR_ARGUMENT;
        from = attribute.values;
        components = attribute.components;
    }
    if (stride < 4 * components) return VSPLIT_ERROR_ARGUMENT;
    auto* at = static_cast<unsigned char*>(out);
    for (uint32_t i = 0; i < count; ++i)
        std::memcpy(at + stride * i, from + components * (size_t{first} + i), 4 * components);
    return VSPLIT_OK;
}

double vsplit_error_of_pixels(const vsplit_stream* s, const float eye[3], double vertical_fov,
                              double viewport_height, const float to_world[16], double pixels) {
    const vsplit::FileInfo* info = s->stream.info();
    if (!info) return 0;
    return vsplit::error_of_pixels({{eye[0], eye[1], eye[2]}, vertical_fov, viewport_height},
                                   info->bounds_min, info->bounds_max,
                                   std::span<const float, 16>(to_world, 16), pixels);
}

}  // extern "C"
