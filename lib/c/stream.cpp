// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// vsplit.h: the Stream behind C's handles.
#include "vsplit/stream.hpp"

#include <algorithm>
#include <cstring>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "vsplit/geomorph.hpp"
#include "vsplit/version.hpp"
#include "vsplit/vsplit.h"

struct vsplit_stream {
    explicit vsplit_stream(vsplit::StreamOptions options) : stream(std::move(options)) {}
    vsplit::Stream stream;
    std::string words;
    bool selective = false;  // of the last vsplit_stream_take_dirty()
};

struct vsplit_job {
    explicit vsplit_job(vsplit::DecodeJob given) : job(std::move(given)) {}
    vsplit::DecodeJob job;
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

const vsplit::ViewMesh* selective(const vsplit_stream* s) {
    return s->stream.selective();
}
std::span<const vsplit::Float3> places_of(const vsplit_stream* s) {
    return selective(s) ? selective(s)->positions() : s->stream.buffers().positions();
}
std::span<const vsplit::Triangle> triangles_of(const vsplit_stream* s) {
    return selective(s) ? selective(s)->triangles() : s->stream.buffers().triangles();
}

/// Ranges in place of a hull; all after turning selective refinement on or off.
vsplit::ViewMesh::Dirty take_ranges(vsplit_stream* s) {
    vsplit::ViewMesh* const view = s->stream.selective();
    vsplit::ViewMesh::Dirty out;
    const bool turned = std::exchange(s->selective, view != nullptr) != (view != nullptr);
    if (view) {
        out = view->take_dirty();
    } else {
        const vsplit::DirtyRanges dirty = s->stream.buffers().take_dirty();
        if (dirty.vertices_begin < dirty.vertices_end)
            out.vertices = {{dirty.vertices_begin, dirty.vertices_end}};
        if (dirty.triangles_begin < dirty.triangles_end)
            out.triangles = {{dirty.triangles_begin, dirty.triangles_end}};
    }
    if (turned) {
        out = {};
        if (const uint32_t n = vsplit_stream_vertex_count(s); n > 0) out.vertices = {{0, n}};
        if (const uint32_t n = vsplit_stream_triangle_count(s); n > 0) out.triangles = {{0, n}};
    }
    return out;
}

size_t write_spans(const std::vector<vsplit::ViewMesh::Range>& from, size_t capacity, vsplit_span* to) {
    size_t count = 0;
    for (const auto& range : from) {
        if (count < capacity)
            to[count++] = {range.begin, range.end};
        else
            to[count - 1].end = range.end;
    }
    return count;
}

vsplit_status update(vsplit_stream* s, const vsplit::Budget& budget, vsplit_updated* out) {
    const auto updated = s->stream.update(budget);
    if (out) *out = {0, 0, 0};
    if (updated.ok() && out) *out = {updated->splits, updated->reached, updated->wants_bytes};
    return take(s, updated);
}

vsplit_status not_selective(vsplit_stream* s) {
    s->words = "refinement is not selective yet";
    return VSPLIT_ERROR_ARGUMENT;
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
        if (const auto decode = options->decode_base)
            chosen.decode_base = [decode, user = options->user](std::span<const std::byte> bytes,
                                                                std::span<std::int32_t> places,
                                                                std::span<std::uint32_t> corners) {
                return decode(user, bytes.data(), bytes.size(), static_cast<uint32_t>(places.size() / 3),
                              static_cast<uint32_t>(corners.size() / 3), places.data(), corners.data()) != 0;
            };
        if (options->hysteresis != 0) chosen.hysteresis = options->hysteresis < 0 ? 0 : options->hysteresis;
    }
    return new (std::nothrow) vsplit_stream(std::move(chosen));
}

void vsplit_stream_free(vsplit_stream* s) {
    delete s;
}

void vsplit_stream_set_target(vsplit_stream* s, vsplit_target kind, double value) {
    vsplit_stream_set_target_within(s, kind, value, UINT64_MAX);
}
void vsplit_stream_set_target_within(vsplit_stream* s, vsplit_target kind, double value,
                                     uint64_t max_triangles) {
    const bool known = static_cast<unsigned>(kind) <= VSPLIT_TARGET_PIXELS;
    s->stream.set_target({known ? static_cast<vsplit::Target::Kind>(kind) : vsplit::Target::Kind::kRatio,
                          value, max_triangles});
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
    return update(s, {max_splits, max_blocks, {}}, out);
}

vsplit_status vsplit_stream_update_within(vsplit_stream* s, const vsplit_budget* budget,
                                          vsplit_updated* out) {
    vsplit::Budget within;
    if (budget) {
        if (budget->max_splits > 0) within.max_splits = budget->max_splits;
        if (budget->max_blocks > 0) within.max_blocks = budget->max_blocks;
        if (budget->max_visits > 0) within.max_visits = budget->max_visits;
        if (budget->out_of_time)
            within.out_of_time = [budget] { return budget->out_of_time(budget->user) != 0; };
    }
    return update(s, within, out);
}

vsplit_status vsplit_stream_set_selective(vsplit_stream* s, int on) {
    return take(s, s->stream.set_selective(on != 0));
}
int vsplit_stream_selective(const vsplit_stream* s) {
    return selective(s) != nullptr;
}

void vsplit_stream_set_view(vsplit_stream* s, const vsplit_view* view) {
    if (!view) return s->stream.clear_view();
    vsplit::CameraView to;
    to.camera = {{view->eye[0], view->eye[1], view->eye[2]}, view->vertical_fov, view->viewport_height};
    to.pixels = view->pixels;
    std::copy_n(view->to_world, 16, to.to_world.begin());
    if (view->has_clip) std::copy_n(view->to_clip, 16, to.to_clip.emplace().begin());
    if (view->hysteresis > 0) to.hysteresis = view->hysteresis;
    if (view->facing > 0) to.facing = view->facing;
    s->stream.set_view(to);
}

vsplit_status vsplit_stream_set_priority(vsplit_stream* s, const float* of_vertices, uint32_t count) {
    vsplit::ViewMesh* const view = s->stream.selective();
    if (!view) return not_selective(s);
    return take(s, view->set_priority({of_vertices, of_vertices ? count : size_t{0}}));
}

vsplit_status vsplit_stream_use_weights(vsplit_stream* s) {
    vsplit::ViewMesh* const view = s->stream.selective();
    if (!view) return not_selective(s);
    view->use_weights();
    return VSPLIT_OK;
}

vsplit_job* vsplit_stream_take_job(vsplit_stream* s) {
    // Memory first: a job that is taken must not get lost.
    void* const place = ::operator new(sizeof(vsplit_job), std::nothrow);
    if (!place) return nullptr;
    auto job = s->stream.take_job();
    if (job) return ::new (place) vsplit_job(*std::move(job));
    ::operator delete(place);
    return nullptr;
}

void vsplit_job_run(vsplit_job* job) {
    job->job.run();
}

vsplit_status vsplit_stream_finish_job(vsplit_stream* s, vsplit_job* job) {
    const auto status = take(s, s->stream.finish_job(std::move(job->job)));
    delete job;
    return status;
}

void vsplit_job_free(vsplit_job* job) {
    delete job;
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
    return static_cast<uint32_t>(places_of(s).size());
}
uint32_t vsplit_stream_triangle_count(const vsplit_stream* s) {
    return static_cast<uint32_t>(triangles_of(s).size());
}
const float* vsplit_stream_positions(const vsplit_stream* s) {
    const auto places = places_of(s);
    return places.empty() ? nullptr : &places.data()->x;
}
const uint32_t* vsplit_stream_triangles(const vsplit_stream* s) {
    const auto triangles = triangles_of(s);
    return triangles.empty() ? nullptr : triangles.data()->data();
}
const float* vsplit_stream_weights(const vsplit_stream* s) {
    return data_or_null(selective(s) ? selective(s)->weights() : s->stream.buffers().weights());
}
const uint32_t* vsplit_stream_groups(const vsplit_stream* s) {
    return data_or_null(selective(s) ? selective(s)->groups() : s->stream.buffers().groups());
}
const uint32_t* vsplit_stream_parents(const vsplit_stream* s) {
    return data_or_null(selective(s) ? selective(s)->parents() : s->stream.buffers().parents());
}

int vsplit_stream_attribute(const vsplit_stream* s, uint32_t index, vsplit_attribute* out) {
    *out = {nullptr, 0, nullptr};
    const vsplit::FileInfo* info = s->stream.info();
    if (!info || !s->stream.ready() || index >= info->attributes.size()) return 0;
    *out = {info->attributes[index].name.c_str(), info->attributes[index].components,
            data_or_null(selective(s) ? std::span<const float>(selective(s)->attributes()[index].values)
                                      : s->stream.buffers().attribute(index))};
    return 1;
}

float vsplit_stream_level_error(const vsplit_stream* s) {
    return s->stream.level_error();
}

vsplit_dirty vsplit_stream_take_dirty(vsplit_stream* s) {
    const auto dirty = take_ranges(s);
    vsplit_dirty out{0, 0, 0, 0};
    if (!dirty.vertices.empty())
        out.vertices_begin = dirty.vertices.front().begin, out.vertices_end = dirty.vertices.back().end;
    if (!dirty.triangles.empty())
        out.triangles_begin = dirty.triangles.front().begin, out.triangles_end = dirty.triangles.back().end;
    return out;
}

void vsplit_stream_take_dirty_spans(vsplit_stream* s, size_t capacity, vsplit_span* vertices,
                                    size_t* vertex_spans, vsplit_span* triangles, size_t* triangle_spans) {
    const auto dirty = take_ranges(s);
    *vertex_spans = write_spans(dirty.vertices, capacity, vertices);
    *triangle_spans = write_spans(dirty.triangles, capacity, triangles);
}

vsplit_status vsplit_stream_copy_indices(const vsplit_stream* s, uint32_t first, uint32_t count, void* out,
                                         size_t bytes_per_index) {
    const auto triangles = triangles_of(s);
    if (first > triangles.size() || count > triangles.size() - first) return VSPLIT_ERROR_ARGUMENT;
    if (bytes_per_index == 4) {
        if (count > 0) std::memcpy(out, triangles.data() + first, size_t{12} * count);
        return VSPLIT_OK;
    }
    if (bytes_per_index != 2 || places_of(s).size() > 65535) return VSPLIT_ERROR_ARGUMENT;
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
    const uint32_t vertices = vsplit_stream_vertex_count(s);
    if (first > vertices || count > vertices - first) return VSPLIT_ERROR_ARGUMENT;
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

void vsplit_share_triangles(const vsplit_stream* const* streams, const double* error_of_a_pixel, size_t count,
                            uint64_t triangles, double pixels, double* errors) {
    std::vector<vsplit::BudgetItem> items;
    for (size_t i = 0; i < count; ++i) {
        const double error = error_of_a_pixel[i];
        if (streams[i]->stream.ready())
            items.push_back({streams[i]->stream.info(), error >= 0 ? 1 / error : 0});
    }
    const std::vector<double> shares = vsplit::share_triangles(items, triangles, pixels);
    for (size_t i = 0, taken = 0; i < count; ++i)
        errors[i] = streams[i]->stream.ready() ? shares[taken++] : 0;
}

}  // extern "C"
