/* SPDX-FileCopyrightText: 2026 The vsplit authors
 * SPDX-License-Identifier: MIT
 *
 * In C99: a camera comes closer to FILE, which streams meanwhile and is refined only where the camera looks;
 * then half of it is painted, and gets most of a budget of triangles. */
#include <stdio.h>
#include <stdlib.h>
#include <vsplit/vsplit.h>

enum { kMost = 1 << 16, kRanges = 8, kSpans = 16 };

/* Fetches what is wanted; 0 if there is nothing. */
static int fetch(vsplit_stream* stream, FILE* file) {
    static unsigned char bytes[kMost];
    vsplit_range want[kRanges];
    const size_t count = vsplit_stream_wants(stream, want, kRanges, kMost);
    size_t i;
    for (i = 0; i < count; ++i) {
        size_t got;
        if (fseek(file, (long)want[i].offset, SEEK_SET) != 0) return 0;
        got = fread(bytes, 1, (size_t)want[i].size, file);
        if (got == 0 || vsplit_stream_feed(stream, want[i].offset, bytes, got) != VSPLIT_OK) return 0;
    }
    return count > 0;
}

int main(int argc, char** argv) {
    vsplit_view view = {{0, 0, 0}, 0.8f, 1080, 1, {0}, 0, {0}, 0, 0};
    vsplit_budget frame = {2000, 1, 50000, NULL, NULL}; /* splits, blocks, places looked at */
    vsplit_updated updated = {0, 0, 0};
    vsplit_totals totals;
    vsplit_stream* stream;
    FILE* file;
    float* priority;
    uint32_t i, count;
    int step, failed = 0;
    if (argc != 2) return 2;
    file = fopen(argv[1], "rb");
    stream = vsplit_stream_new(NULL);
    if (!file || !stream) return 1;
    vsplit_stream_set_selective(stream, 1);
    for (i = 0; i < 4; ++i) view.to_world[5 * i] = 1;
    for (step = 0; step < 300; ++step) {
        vsplit_span vertices[kSpans], triangles[kSpans];
        size_t vertex_spans, triangle_spans;
        vsplit_stream_totals(stream, &totals);
        view.eye[2] = totals.bounds_max[2] + 300.0f / (float)(1 + step);
        vsplit_stream_set_view(stream, &view);
        fetch(stream, file);
        if (vsplit_stream_update_within(stream, &frame, &updated) != VSPLIT_OK) failed = 1;
        vsplit_stream_take_dirty_spans(stream, kSpans, vertices, &vertex_spans, triangles, &triangle_spans);
        /* upload these of vsplit_stream_positions() and vsplit_stream_triangles(), and draw */
    }
    printf("seen from near: %u of %u triangles\n", (unsigned)vsplit_stream_triangle_count(stream),
           (unsigned)totals.triangles);

    /* No view: half of the triangles, and what is at the right of the middle counts ten times. */
    vsplit_stream_set_view(stream, NULL);
    count = vsplit_stream_vertex_count(stream);
    priority = malloc(sizeof(float) * (count > 0 ? count : 1));
    if (!priority) return 1;
    for (i = 0; i < count; ++i)
        priority[i] = 2 * vsplit_stream_positions(stream)[3 * i] > totals.bounds_min[0] + totals.bounds_max[0]
                          ? 10.0f
                          : 1.0f;
    if (count > 0 && vsplit_stream_set_priority(stream, priority, count) != VSPLIT_OK) failed = 1;
    vsplit_stream_set_target(stream, VSPLIT_TARGET_RATIO, 0.5);
    do {
        fetch(stream, file);
        if (vsplit_stream_update_within(stream, NULL, &updated) != VSPLIT_OK) failed = 1;
    } while (!failed && !updated.reached && !vsplit_stream_broken(stream));
    printf("half of it: %u triangles\n", (unsigned)vsplit_stream_triangle_count(stream));
    failed |= vsplit_stream_broken(stream) || !vsplit_stream_selective(stream);
    free(priority);
    vsplit_stream_free(stream);
    fclose(file);
    return failed;
}
