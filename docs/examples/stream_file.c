/* SPDX-FileCopyrightText: 2026 The vsplit authors
 * SPDX-License-Identifier: MIT
 *
 * In C99: streams FILE to a ratio, fetching no more than that needs, as an engine would over HTTP. */
#include <stdio.h>
#include <stdlib.h>
#include <vsplit/vsplit.h>

static int fetch(FILE* file, vsplit_range range, unsigned char* into, size_t* got) {
    if (fseek(file, (long)range.offset, SEEK_SET) != 0) return 0;
    *got = fread(into, 1, (size_t)range.size, file);
    return *got > 0;
}

int main(int argc, char** argv) {
    enum { kMost = 1 << 16, kRanges = 8 };
    static unsigned char bytes[kMost];
    vsplit_range want[kRanges];
    vsplit_totals totals;
    vsplit_updated updated = {0, 0, 0};
    vsplit_stream* stream;
    FILE* file;
    size_t count, i;
    if (argc != 3) return 2;
    file = fopen(argv[1], "rb");
    stream = vsplit_stream_new(NULL);
    if (!file || !stream) return 1;
    vsplit_stream_set_target(stream, VSPLIT_TARGET_RATIO, atof(argv[2]));
    while ((count = vsplit_stream_wants(stream, want, kRanges, kMost)) > 0) {
        for (i = 0; i < count; ++i) {
            size_t got = 0;
            if (!fetch(file, want[i], bytes, &got)) {
                fprintf(stderr, "%s ends too early\n", argv[1]);
                return 1;
            }
            if (vsplit_stream_feed(stream, want[i].offset, bytes, got) != VSPLIT_OK)
                fprintf(stderr, "%s: %s\n", argv[1], vsplit_stream_error(stream));
        }
        /* A renderer would draw between two calls, and bound the splits of each. */
        while (vsplit_stream_update(stream, 10000, 1, &updated) == VSPLIT_OK && !updated.reached &&
               !updated.wants_bytes) {
        }
    }
    vsplit_stream_totals(stream, &totals);
    printf("%u of %u triangles, error %g, from %llu of %llu bytes\n",
           (unsigned)vsplit_stream_triangle_count(stream), (unsigned)totals.triangles,
           (double)vsplit_stream_level_error(stream),
           (unsigned long long)vsplit_stream_bytes_received(stream), (unsigned long long)totals.file_bytes);
    fclose(file);
    i = vsplit_stream_broken(stream) || !updated.reached;
    vsplit_stream_free(stream);
    return i ? 1 : 0;
}
