/* SPDX-FileCopyrightText: 2026 The vsplit authors
 * SPDX-License-Identifier: MIT
 *
 * vsplit in C: a .pmesh that arrives in pieces, refined and coarsened while it does. The library does no I/O,
 * starts no thread and reads no clock. The C++ header stream.hpp says the same in more words.
 *
 *     vsplit_stream* s = vsplit_stream_new(NULL);
 *     vsplit_stream_set_target(s, VSPLIT_TARGET_RATIO, 0.4);
 *     vsplit_range want[8];
 *     size_t n;
 *     while ((n = vsplit_stream_wants(s, want, 8, 1 << 18)) > 0) {
 *         for (size_t i = 0; i < n; ++i) { fetch want[i] and vsplit_stream_feed() it }
 *         vsplit_stream_update(s, SIZE_MAX, SIZE_MAX, NULL);
 *     }
 *     draw vsplit_stream_triangle_count(s) triangles of vsplit_stream_triangles(s)
 *
 * A stream is for one thread at a time; different streams are independent. All bytes fed may be hostile.
 * Pointers to a stream must not be NULL, except for vsplit_stream_free(). */
#ifndef VSPLIT_VSPLIT_H
#define VSPLIT_VSPLIT_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vsplit_stream vsplit_stream;
typedef struct vsplit_job vsplit_job;

/* What came of a call. The numbers are stable. */
typedef enum vsplit_status {
    VSPLIT_OK = 0,
    VSPLIT_ERROR_UNSUPPORTED = 1, /* well-formed, but of a kind that this version does not read */
    VSPLIT_ERROR_TRUNCATED = 2,   /* the file ends before what it announces */
    VSPLIT_ERROR_MALFORMED = 3,   /* the bytes contradict the format */
    VSPLIT_ERROR_CHECKSUM = 4,    /* a part is damaged; it is wanted again unless vsplit_stream_broken() */
    VSPLIT_ERROR_LIMIT = 5,       /* it would need more memory than allowed */
    VSPLIT_ERROR_ARGUMENT = 6     /* the caller asked for what cannot be */
} vsplit_status;

typedef enum vsplit_target {
    VSPLIT_TARGET_RATIO = 0,     /* triangles over those of the full mesh, 0 to 1 */
    VSPLIT_TARGET_TRIANGLES = 1, /* at most so many */
    VSPLIT_TARGET_VERTICES = 2,
    VSPLIT_TARGET_ERROR = 3, /* the coarsest level within this distance of the full mesh, in its units */
    VSPLIT_TARGET_PIXELS = 4 /* the same, from vsplit_error_of_pixels(); small changes are not followed */
} vsplit_target;

/* Bytes [offset, offset + size) of the file. */
typedef struct vsplit_range {
    uint64_t offset, size;
} vsplit_range;

/* vsplit_stream_new(): zeros mean the default. */
typedef struct vsplit_options {
    uint64_t max_bytes; /* memory for the decoded mesh, 1 GiB; more is refused before it is allocated */
    uint64_t max_pending_bytes; /* of blocks that have come and are not decoded, 16 MiB */
    int tries;                  /* failures of one block that end the stream, 3 */
    double hysteresis;          /* of VSPLIT_TARGET_PIXELS, 0.25; negative: none */
    /* The host's decoder of base meshes in place of Draco; needed if the library was built without
     * (VSPLIT_WITH_DRACO=OFF). Writes the position (three whole numbers) of each of `points` points and the
     * points of each of `faces` faces of the Draco mesh in `bytes`, in Draco's order; returns 0 if it cannot,
     * or the counts are others. `bytes` may be hostile; what it writes is checked. */
    int (*decode_base)(void* user, const void* bytes, size_t size, uint32_t points, uint32_t faces,
                       int32_t* positions, uint32_t* corners);
    void* user; /* the first argument of decode_base */
} vsplit_options;

typedef struct vsplit_updated {
    size_t splits;   /* applied or undone */
    int reached;     /* the target's level is there */
    int wants_bytes; /* more of the file is needed first */
} vsplit_updated;

/* Half-open, in vertices and triangles; empty where begin >= end. */
typedef struct vsplit_dirty {
    uint32_t vertices_begin, vertices_end;
    uint32_t triangles_begin, triangles_end;
} vsplit_dirty;

typedef struct vsplit_attribute {
    const char* name;    /* "NORMAL", "TEXCOORD_0", ...; lives as long as the stream */
    uint32_t components; /* floats a vertex */
    const float* values; /* of all live vertices; stays the same once ready */
} vsplit_attribute;

/* Totals of the full mesh; zeros before vsplit_stream_ready(). */
typedef struct vsplit_totals {
    uint32_t vertices, triangles, splits, base_vertices, base_triangles, blocks, attributes;
    uint64_t file_bytes;
    float bounds_min[3], bounds_max[3];
    double origin[3]; /* add it for the source's coordinates */
    float base_error; /* of the base mesh, in the object's units */
    int has_weights, has_groups;
} vsplit_totals;

/* Bounds of vsplit_stream_update_within(); zeros mean none. */
typedef struct vsplit_budget {
    size_t max_splits, max_blocks;
    size_t max_visits;         /* selective: places looked at; the next call goes on */
    int (*out_of_time)(void*); /* asked between blocks and every few thousand splits; not 0 ends the call */
    void* user;                /* its argument */
} vsplit_budget;

/* Half-open. */
typedef struct vsplit_span {
    uint32_t begin, end;
} vsplit_span;

/* What a perspective camera sees of the object, in world units; zeroed but for the matrix, it is nothing. */
typedef struct vsplit_view {
    float eye[3];
    float vertical_fov;    /* radians, above 0 and below pi */
    float viewport_height; /* pixels */
    float pixels;          /* the error on the screen that is not worth a split; 0: all in view is full */
    float to_world[16];    /* the object's transform, column by column */
    int has_clip;          /* 0: everything is in view */
    float to_clip[16];     /* world to clip space (projection times view), column by column */
    float hysteresis;      /* a split is undone below this share of `pixels`; 0: the default, 0.8 */
    float facing;          /* how much of an error counts where the surface faces the eye; 0: 0.3 */
} vsplit_view;

/* "0.1.0" */
const char* vsplit_version(void);

/* NULL: not enough memory, or options out of range. `options` may be NULL. */
vsplit_stream* vsplit_stream_new(const vsplit_options* options);
void vsplit_stream_free(vsplit_stream* stream);

void vsplit_stream_set_target(vsplit_stream* stream, vsplit_target kind, double value);
/* The same with at most `max_triangles`, whatever the kind asks for: an error on the screen and what the
 * machine can draw, in one. */
void vsplit_stream_set_target_within(vsplit_stream* stream, vsplit_target kind, double value,
                                     uint64_t max_triangles);

/* Writes at most `capacity` ranges, `most_bytes` in all, and returns how many: what the target needs next. 0:
 * all is there, or the stream is broken. */
size_t vsplit_stream_wants(const vsplit_stream* stream, vsplit_range* out, size_t capacity,
                           uint64_t most_bytes);
/* Bytes from anywhere in the file, in any sizes and order, as often as they come. */
vsplit_status vsplit_stream_feed(vsplit_stream* stream, uint64_t offset, const void* bytes, size_t size);
/* How long the server says that the file is. */
vsplit_status vsplit_stream_set_file_size(vsplit_stream* stream, uint64_t bytes);

/* Decodes at most `max_blocks` blocks and applies or undoes at most `max_splits` splits towards the target.
 * `out` may be NULL. */
vsplit_status vsplit_stream_update(vsplit_stream* stream, size_t max_splits, size_t max_blocks,
                                   vsplit_updated* out);
/* The same with more bounds; `budget` and `out` may be NULL. */
vsplit_status vsplit_stream_update_within(vsplit_stream* stream, const vsplit_budget* budget,
                                          vsplit_updated* out);
/* Decoding for a worker thread: takes the next block that is whole out of the stream, or NULL if there is
 * none to do (or no memory). Until it is given back, the stream goes on within what it has. A job shares
 * nothing with its stream: vsplit_job_run(), once, on any thread, while the stream is used on another.
 * vsplit_stream_finish_job() puts its splits in and frees it. vsplit_job_free(): for a stream that is gone.
 */
vsplit_job* vsplit_stream_take_job(vsplit_stream* stream);
void vsplit_job_run(vsplit_job* job);
vsplit_status vsplit_stream_finish_job(vsplit_stream* stream, vsplit_job* job);
void vsplit_job_free(vsplit_job* job);
/* Goes to the target's level at once, within what is decoded. */
void vsplit_stream_jump(vsplit_stream* stream);

int vsplit_stream_ready(const vsplit_stream* stream);    /* there is something to draw */
int vsplit_stream_broken(const vsplit_stream* stream);   /* nothing more will come; what is there stays */
int vsplit_stream_complete(const vsplit_stream* stream); /* all blocks are decoded */
/* The last failure in words, with its offset, or "". Lives until the next call with this stream. */
const char* vsplit_stream_error(const vsplit_stream* stream);
uint64_t vsplit_stream_bytes_received(const vsplit_stream* stream);
void vsplit_stream_totals(const vsplit_stream* stream, vsplit_totals* out);

/* Selective refinement, on (1) or off (0), at any time: finer where a view looks, or, without one, in the
 * order of priorities towards the target. What the functions below give is then the selective mesh: all
 * vertices that have come, in the file's order, whichever are in use, and a packed list of triangles, whose
 * order is its own. Pointers change when it is turned on and off, and not in between. VSPLIT_ERROR_LIMIT:
 * this mesh cannot be refined so; it stays off. */
vsplit_status vsplit_stream_set_selective(vsplit_stream* stream, int on);
int vsplit_stream_selective(const vsplit_stream* stream);
/* NULL: none any more. Copied. */
void vsplit_stream_set_view(vsplit_stream* stream, const vsplit_view* view);
/* By how much errors count more than elsewhere: one for each vertex from 0 on, finite and not negative, of as
 * many as wanted; later ones take their parent's. NULL: all alike. VSPLIT_ERROR_ARGUMENT: not selective yet,
 * more than there are vertices, or no such numbers. */
vsplit_status vsplit_stream_set_priority(vsplit_stream* stream, const float* of_vertices, uint32_t count);
/* The file's painted weights are the priorities. VSPLIT_ERROR_ARGUMENT: not selective yet. */
vsplit_status vsplit_stream_use_weights(vsplit_stream* stream);

/* What to draw now. Counts change with each update; pointers stay the same once ready, with room for the full
 * mesh behind them. */
uint32_t vsplit_stream_vertex_count(const vsplit_stream* stream);
uint32_t vsplit_stream_triangle_count(const vsplit_stream* stream);
const float* vsplit_stream_positions(const vsplit_stream* stream);    /* 3 a vertex */
const uint32_t* vsplit_stream_triangles(const vsplit_stream* stream); /* 3 a triangle */
const float* vsplit_stream_weights(const vsplit_stream* stream);      /* 1 a vertex, or NULL */
const uint32_t* vsplit_stream_groups(const vsplit_stream* stream);    /* 1 a triangle, or NULL: all 0 */
const uint32_t* vsplit_stream_parents(const vsplit_stream* stream);   /* 1 a vertex; UINT32_MAX: none */
/* Returns 0 if there is no such attribute. */
int vsplit_stream_attribute(const vsplit_stream* stream, uint32_t index, vsplit_attribute* out);
/* Geometric error of the level that is there, in the object's units; selective: of the level that it left. */
float vsplit_stream_level_error(const vsplit_stream* stream);
/* What changed since the last call, to be uploaded. Selective: everything once it is turned on or off. */
vsplit_dirty vsplit_stream_take_dirty(vsplit_stream* stream);
/* The same as several ranges: writes at most `capacity` (at least 1) of each kind, ascending, the last of
 * which holds all that are left, and how many there are. */
void vsplit_stream_take_dirty_spans(vsplit_stream* stream, size_t capacity, vsplit_span* vertices,
                                    size_t* vertex_spans, vsplit_span* triangles, size_t* triangle_spans);

/* Copies corners of `count` triangles from `first` as indices of 2 or 4 bytes. VSPLIT_ERROR_ARGUMENT: beyond
 * the triangles that are there, another size, or a vertex that 2 bytes do not name (65535 restarts a strip
 * and so does not). */
vsplit_status vsplit_stream_copy_indices(const vsplit_stream* stream, uint32_t first, uint32_t count,
                                         void* out, size_t bytes_per_index);
/* Copies `count` vertices from `first` into an interleaved buffer: floats of attribute `index`
 * (VSPLIT_POSITION: the position) go to out + stride * i. VSPLIT_ERROR_ARGUMENT: beyond the vertices that are
 * there, no such attribute, or a stride that they do not fit. */
#define VSPLIT_POSITION 0xFFFFFFFFu
vsplit_status vsplit_stream_copy_vertices(const vsplit_stream* stream, uint32_t first, uint32_t count,
                                          uint32_t index, void* out, size_t stride);

/* The error, in the object's units, that spans at most `pixels` on the screen of a perspective camera at
 * `eye` (world units), with a vertical field of view in radians and a viewport height in pixels. `to_world`
 * is the object's transform, column by column. 0 before ready, or within the object's bounding sphere. */
double vsplit_error_of_pixels(const vsplit_stream* stream, const float eye[3], double vertical_fov,
                              double viewport_height, const float to_world[16], double pixels);

/* Shares `triangles` among `count` streams so that the largest error on the screen is as small as their
 * tables allow. `error_of_a_pixel` has what vsplit_error_of_pixels(..., 1) gives for each; negative: not
 * seen, the base mesh is enough. None gets less error than spans `pixels`, however much of the budget that
 * leaves; 0: no such bound. Writes each one's error, for VSPLIT_TARGET_ERROR. Streams that are not ready take
 * no part, and theirs is 0. */
void vsplit_share_triangles(const vsplit_stream* const* streams, const double* error_of_a_pixel, size_t count,
                            uint64_t triangles, double pixels, double* errors);

#ifdef __cplusplus
}
#endif

#endif
