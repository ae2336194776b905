// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// view FILE.pmesh: streams a mesh and refines it only where a camera that comes closer looks; then paints
// half of it, which gets most of a budget of triangles.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <span>
#include <utility>
#include <vector>
#include <vsplit/stream.hpp>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    std::ifstream in(argv[1], std::ios::binary);
    const std::vector<char> chars{std::istreambuf_iterator<char>(in), {}};
    const auto file = std::as_bytes(std::span(chars));
    const auto fetch = [&](vsplit::Stream& to, const vsplit::ByteRange& range) {
        const auto bytes = file.subspan(std::min<std::size_t>(range.offset, file.size()));
        (void)to.feed(range.offset, bytes.first(std::min<std::size_t>(range.size, bytes.size())));
    };

    vsplit::Stream stream;
    if (!stream.set_selective(true)) return 1;
    for (int frame = 0; frame < 300 && !stream.broken(); ++frame) {
        vsplit::CameraView view;
        view.camera = {{0, 0, 300.0f / float(1 + frame)}, 0.8, 1080};
        view.pixels = 1;
        // view.to_world is the object's transform; view.to_clip, projection times view, gives the frustum.
        stream.set_view(view);
        for (const vsplit::ByteRange& range : stream.wants()) fetch(stream, range);
        // As much as fits into a frame; the next one goes on.
        if (!stream.update({.max_splits = 2000, .max_blocks = 1, .max_visits = 50000})) break;
        if (vsplit::ViewMesh* mesh = stream.selective()) {
            const auto dirty = mesh->take_dirty();
            // To the GPU: triangles() within dirty.triangles, positions() within dirty.vertices.
        }
    }
    if (!stream.ready()) return 1;
    std::printf("%zu of %u triangles\n", stream.selective()->triangles().size(), stream.info()->triangles);

    // Under a budget of triangles, marked places first.
    stream.clear_view();
    stream.set_target(vsplit::Target::ratio(0.5));
    std::vector<float> priority;
    for (const vsplit::Float3& place : stream.selective()->positions())
        priority.push_back(place.x > 0 ? 10.0f : 1.0f);
    if (!stream.selective()->set_priority(priority)) return 1;
    for (auto done = stream.update(); done && !done->reached && !stream.broken(); done = stream.update())
        for (const vsplit::ByteRange& range : stream.wants()) fetch(stream, range);
    std::printf("%zu triangles\n", stream.selective()->triangles().size());
}
