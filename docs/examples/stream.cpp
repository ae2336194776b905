// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What a renderer does each frame with a vsplit::Stream, with a file in memory for a server.
#include <cstdio>
#include <fstream>
#include <iterator>
#include <vsplit/geomorph.hpp>
#include <vsplit/stream.hpp>

namespace {

std::vector<std::byte> file;

/// Stands for an asynchronous request: its answer may come late, in pieces, or twice.
void fetch(vsplit::Stream& stream, vsplit::ByteRange range) {
    const auto bytes =
        std::span<const std::byte>(file).subspan(std::min<std::size_t>(range.offset, file.size()));
    const vsplit::Status fed =
        stream.feed(range.offset, bytes.first(std::min<std::size_t>(range.size, bytes.size())));
    if (!fed) std::fprintf(stderr, "%s\n", fed.error().describe().c_str());
}

void upload(const vsplit::LiveBuffers&, const vsplit::DirtyRanges&) {}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    std::ifstream in(argv[1], std::ios::binary);
    for (const char c : std::vector<char>{std::istreambuf_iterator<char>(in), {}})
        file.push_back(std::byte(c));

    vsplit::Stream stream;
    const float to_world[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    for (int frame = 0; frame < 1000 && !stream.broken(); ++frame) {
        if (stream.ready()) {
            // A pixel of error at most, seen by a camera that comes nearer.
            const vsplit::Camera camera{{0, 0, 500.0f / float(1 + frame)}, 0.8, 1080};
            const vsplit::FileInfo& info = *stream.info();
            stream.set_target(vsplit::Target::pixels(
                vsplit::error_of_pixels(camera, info.bounds_min, info.bounds_max, to_world, 1)));
        }
        for (const vsplit::ByteRange& range : stream.wants()) fetch(stream, range);
        const auto updated = stream.update({.max_splits = 20000, .max_blocks = 1});
        if (!updated) break;
        if (stream.ready()) upload(stream.buffers(), stream.buffers().take_dirty());
    }
    if (!stream.ready()) return 1;

    // From here to a tenth of the triangles without a jump in between.
    vsplit::Geomorph morph(stream.buffers());
    stream.set_target(vsplit::Target::ratio(0.1));
    while (!stream.update()->reached)
        for (const vsplit::ByteRange& range : stream.wants()) fetch(stream, range);
    morph.turn(stream.buffers());
    for (const double t : {0.0, 0.5, 1.0}) morph.blend(t);

    std::printf("%u triangles, error %g, %llu of %zu bytes\n", stream.buffers().triangle_count(),
                double(stream.level_error()), (unsigned long long)stream.bytes_received(), file.size());
    return 0;
}
