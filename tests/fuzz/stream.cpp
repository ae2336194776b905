// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// libFuzzer target: a file that arrives in pieces of any size from anywhere, shown at any target in between,
// forward and back, or refined where a view or priorities say. The last bytes of the input say how; the rest
// is the file, its checksums made to fit. What the dirty ranges name is all that a renderer copies, and must
// be all that changed.
#include "vsplit/stream.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <span>

#include "reseal_all.hpp"
#include "vsplit/live_mesh.hpp"

using namespace vsplit;

namespace {

void require(bool good) {
    if (!good) std::abort();
}

/// Bit for bit: places of a lossless file may be no numbers.
bool same_places(std::span<const Float3> a, std::span<const Float3> b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Float3)) == 0);
}

/// What a renderer has, made of dirty ranges alone.
struct Renderer {
    std::vector<Float3> positions;
    std::vector<Triangle> triangles;

    void take(LiveBuffers& live) {
        const DirtyRanges dirty = live.take_dirty();
        positions.resize(live.vertex_count());
        triangles.resize(live.triangle_count());
        for (std::uint32_t v = dirty.vertices_begin; v < dirty.vertices_end; ++v)
            positions.at(v) = live.positions()[v];
        for (std::uint32_t t = dirty.triangles_begin; t < dirty.triangles_end; ++t)
            triangles.at(t) = live.triangles()[t];
        require(
            std::equal(triangles.begin(), triangles.end(), live.triangles().begin(), live.triangles().end()));
        require(same_places(positions, live.positions()));
        for (const Triangle& triangle : triangles)
            for (const std::uint32_t corner : triangle) require(corner < positions.size());
    }
};

/// The same of a selective mesh, whose triangles are packed.
struct SelectiveRenderer {
    std::vector<Float3> positions;
    std::vector<Triangle> triangles;

    void take(ViewMesh& mesh) {
        const ViewMesh::Dirty dirty = mesh.take_dirty();
        positions.resize(mesh.positions().size());
        triangles.resize(mesh.triangles().size());
        for (const auto& [begin, end] : dirty.vertices)
            for (std::uint32_t v = begin; v < end; ++v) positions.at(v) = mesh.positions()[v];
        for (const auto& [begin, end] : dirty.triangles)
            for (std::uint32_t t = begin; t < end; ++t) triangles.at(t) = mesh.triangles()[t];
        require(
            std::equal(triangles.begin(), triangles.end(), mesh.triangles().begin(), mesh.triangles().end()));
        require(same_places(positions, mesh.positions()));
        for (const Triangle& t : triangles) {
            for (const std::uint32_t corner : t) require(corner < positions.size());
            require(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
        }
        require(mesh.groups().empty() || mesh.groups().size() == triangles.size());
    }
};

/// The numbers that the input's end holds, over and over.
struct Script {
    static constexpr std::size_t kBytes = 32;
    const std::uint8_t* bytes;
    std::size_t at = 0;
    std::size_t next() { return bytes[at++ % kBytes]; }

    Target target() {
        const double share = double(next()) / 255;
        switch (next() % 5) {
            case 0:
                return Target::ratio(share);
            case 1:
                return Target::triangles(std::uint64_t(share * 2000));
            case 2:
                return Target::vertices(std::uint64_t(share * 1000));
            case 3:
                return Target::error(share * share);
            default:
                return Target::pixels(share);
        }
    }

    CameraView view() {
        CameraView out;
        const auto place = [&] { return (float(next()) - 128) / 16; };
        out.camera = {{place(), place(), place()}, 0.8, 1000};
        out.pixels = float(next()) / 8;
        if (next() % 2) {
            out.to_clip.emplace();
            for (float& value : *out.to_clip) value = place();
        }
        if (next() % 8 == 0) out.to_world[next() % 16] = place();
        return out;
    }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < Script::kBytes) return 0;
    const auto* first = reinterpret_cast<const std::byte*>(data);
    test::Bytes file(first, first + size - Script::kBytes);
    Script script{data + size - Script::kBytes};
    if (script.next() % 4 != 0) test::reseal_all(file);
    StreamOptions options;
    options.limits.max_bytes = 64 << 20;
    options.max_pending_bytes = 64 + 256 * script.next();
    Stream stream(options);
    Renderer renderer;
    std::optional<SelectiveRenderer> selective;
    for (int step = 0; step < 96 && !stream.broken(); ++step) {
        if (script.next() % 4 == 0) stream.set_target(script.target());
        // What is wanted, less of it, or anything.
        for (const ByteRange& range : stream.wants(64 + 64 * script.next(), script.next() % 3)) {
            require(range.size > 0);
            std::uint64_t offset = range.offset, length = range.size;
            if (script.next() % 8 == 0) offset = file.size() * script.next() / 256;
            if (script.next() % 4 == 0) length = length * script.next() / 255;
            if (offset >= file.size()) continue;
            length = std::min<std::uint64_t>(length, file.size() - offset);
            if (!stream.feed(offset, std::span(file).subspan(offset, length)).ok() && stream.broken()) break;
        }
        if (stream.broken()) break;
        if (script.next() % 4 == 0)
            if (auto job = stream.take_job()) {
                job->run();
                static_cast<void>(stream.finish_job(*std::move(job)));
            }
        if (script.next() % 8 == 0) {
            if (!stream.set_selective(script.next() % 4 != 0).ok()) require(!stream.selective());
            selective.reset();
        }
        if (script.next() % 4 == 0)
            script.next() % 4 == 0 ? stream.clear_view() : stream.set_view(script.view());
        if (ViewMesh* const mesh = stream.selective(); mesh && script.next() % 8 == 0) {
            std::vector<float> priority(script.next() % (mesh->positions().size() + 1));
            for (float& p : priority) p = float(script.next());
            script.next() % 4 == 0 ? mesh->use_weights() : require(mesh->set_priority(priority).ok());
        }
        const std::size_t most = script.next() % 2 ? ~std::size_t{0} : 1 + script.next();
        const std::size_t visits = script.next() % 2 ? ~std::size_t{0} : 1 + script.next();
        const auto updated = stream.update({most, 1 + script.next() % 4, {}, visits});
        if (updated) require(updated->splits <= most);
        if (script.next() % 8 == 0) stream.jump_to_target();
        if (stream.ready()) renderer.take(stream.buffers());
        if (ViewMesh* const mesh = stream.selective()) {
            if (!selective)
                mesh->take_dirty(),
                    selective = SelectiveRenderer{{mesh->positions().begin(), mesh->positions().end()},
                                                  {mesh->triangles().begin(), mesh->triangles().end()}};
            selective->take(*mesh);
        } else {
            selective.reset();
        }
    }
    require(!stream.broken() || stream.error().has_value());
    if (stream.ready()) renderer.take(stream.buffers());
    static_cast<void>(stream.set_selective(false));
    // What arrived whole is what the reader reads.
    if (stream.complete() && !stream.broken()) {
        stream.set_target(Target::ratio(1));
        for (int i = 0; i < 1000 && !stream.broken() && stream.wants().empty(); ++i)
            if (const auto updated = stream.update(); !updated || updated->reached) break;
        const auto whole = read_progressive_mesh(file, options.limits);
        if (whole && stream.buffers().level() == whole->splits.size()) {
            const Mesh full = cut(*whole, whole->splits.size());
            require(std::equal(full.triangles.begin(), full.triangles.end(),
                               stream.buffers().triangles().begin(), stream.buffers().triangles().end()));
        }
    }
    return 0;
}
