// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// host_decoder DRACO.pmesh OTHER.pmesh: a library without Draco refuses a file with a base mesh in Draco's
// bytes, and reads it with the host's decoder, in C++ and in C; it reads the other one, whose base mesh is in
// the file's own stream, by itself.
#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>
#include <vsplit/vsplit.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>
#include <vsplit/read.hpp>
#include <vsplit/stream.hpp>
#include <vsplit/write.hpp>

namespace {

int asked = 0;

int decode(void*, const void* bytes, size_t size, uint32_t points, uint32_t faces, int32_t* positions,
           uint32_t* corners) {
    ++asked;
    draco::DecoderBuffer buffer;
    buffer.Init(static_cast<const char*>(bytes), size);
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) return 0;
    const draco::Mesh& mesh = *decoded.value();
    const draco::PointAttribute* places = mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
    if (mesh.num_points() != points || mesh.num_faces() != faces || !places ||
        places->num_components() != 3 || places->data_type() != draco::DT_INT32)
        return 0;
    for (uint32_t i = 0; i < points; ++i)
        places->GetValue(places->mapped_index(draco::PointIndex(i)), positions + 3 * size_t{i});
    for (uint32_t t = 0; t < faces; ++t)
        for (uint32_t k = 0; k < 3; ++k)
            corners[3 * size_t{t} + k] = mesh.face(draco::FaceIndex(t))[int(k)].value();
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const auto load = [](const char* path) {
        std::ifstream in(path, std::ios::binary);
        return std::vector<char>{std::istreambuf_iterator<char>(in), {}};
    };
    const std::vector<char> file = load(argv[1]), other = load(argv[2]);
    const auto bytes = std::as_bytes(std::span(file));
    if (!vsplit::read_progressive_mesh(std::as_bytes(std::span(other))).ok()) return 11;

    const auto refused = vsplit::read_progressive_mesh(bytes);
    if (refused.ok() || refused.error().code != vsplit::ErrorCode::kUnsupported) return 3;

    const vsplit::BaseMeshDecoder decoder = [](std::span<const std::byte> draco,
                                               std::span<std::int32_t> places,
                                               std::span<std::uint32_t> corners) {
        return decode(nullptr, draco.data(), draco.size(), uint32_t(places.size() / 3),
                      uint32_t(corners.size() / 3), places.data(), corners.data()) != 0;
    };
    const auto whole = vsplit::read_progressive_mesh(bytes, {}, decoder);
    if (!whole) {
        std::fprintf(stderr, "%s\n", whole.error().describe().c_str());
        return 4;
    }
    vsplit::StreamOptions options;
    options.decode_base = decoder;
    vsplit::Stream stream(options);
    if (!stream.feed(0, bytes) || !stream.update()) return 5;
    if (!stream.complete() || stream.buffers().triangle_count() != whole->triangles.size()) return 6;

    vsplit_options in_c = {};
    in_c.decode_base = decode;
    vsplit_stream* s = vsplit_stream_new(&in_c);
    if (!s || vsplit_stream_feed(s, 0, file.data(), file.size()) != VSPLIT_OK ||
        vsplit_stream_update(s, SIZE_MAX, SIZE_MAX, nullptr) != VSPLIT_OK || !vsplit_stream_complete(s) ||
        vsplit_stream_triangle_count(s) != whole->triangles.size())
        return 7;
    vsplit_stream_free(s);
    if (asked != 3) return 8;

    const auto written = vsplit::write_progressive_mesh(*whole);
    if (written.ok() || written.error().code != vsplit::ErrorCode::kUnsupported) return 9;
    std::printf("%zu triangles, the host decoded the base mesh %d times\n", whole->triangles.size(), asked);
    return 0;
}
