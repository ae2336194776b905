// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <catch2/catch.hpp>
#include <functional>
#include <random>

#include "family.hpp"
#include "gltf_scene.hpp"
#include "vsplit/bake/gltf.hpp"

using namespace vsplit;
using namespace vsplit::bake;
using namespace vsplit::test;

namespace {

std::vector<std::byte> as_bytes(const void* data, std::size_t size) {
    const auto* from = static_cast<const std::byte*>(data);
    return {from, from + size};
}

/// The mesh's positions (and the same again as a colour), by Draco.
std::vector<std::byte> draco_stream(const Mesh& mesh, int bits, int speed, int method, bool colored = true) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(int(mesh.triangles.size()));
    const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const int color =
        !colored ? -1 : builder.AddAttribute(draco::GeometryAttribute::GENERIC, 3, draco::DT_FLOAT32);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Float3 &a = mesh.positions[mesh.triangles[t][0]], &b = mesh.positions[mesh.triangles[t][1]],
                     &c = mesh.positions[mesh.triangles[t][2]];
        builder.SetAttributeValuesForFace(position, draco::FaceIndex(std::uint32_t(t)), &a.x, &b.x, &c.x);
        if (colored)
            builder.SetAttributeValuesForFace(color, draco::FaceIndex(std::uint32_t(t)), &a.x, &b.x, &c.x);
    }
    const auto soup = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetEncodingMethod(method);
    encoder.SetSpeedOptions(speed, speed);
    if (bits > 0) encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
    draco::EncoderBuffer buffer;
    REQUIRE(encoder.EncodeMeshToBuffer(*soup, &buffer).ok());
    return as_bytes(buffer.data(), buffer.size());
}

GltfDocument draco_document(const std::vector<std::byte>& stream, std::size_t vertices, std::size_t corners) {
    GltfDocument document;
    document.root["extensionsUsed"] = document.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    const std::size_t view = document.view(stream);
    const std::size_t positions =
        document.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", vertices}});
    const std::size_t indices =
        document.add("accessors", {{"componentType", 5125}, {"type", "SCALAR"}, {"count", corners}});
    document.scene_of({{"attributes", {{"POSITION", positions}, {"COLOR_0", positions}}},
                       {"indices", indices},
                       {"extensions",
                        {{"KHR_draco_mesh_compression",
                          {{"bufferView", view}, {"attributes", {{"POSITION", 0}, {"COLOR_0", 1}}}}}}}});
    return document;
}

void check_hostile(const std::vector<std::byte>& stream,
                   const std::function<GltfDocument(const std::vector<std::byte>&)>& wrap, unsigned seed) {
    const auto check = [&](const std::vector<std::byte>& broken) {
        const auto out = parse_gltf(wrap(broken).glb(), "");
        if (out.ok())
            REQUIRE(mesh_fault(out->mesh) == nullptr);
        else
            REQUIRE_FALSE(out.error().message.empty());
    };
    std::mt19937 random(seed);
    for (std::size_t length = 1; length < stream.size(); length += 1 + stream.size() / 200)
        check({stream.begin(), stream.begin() + std::ptrdiff_t(length)});
    for (int i = 0; i < 400; ++i) {
        auto broken = stream;
        for (unsigned n = 1 + random() % 3; n > 0; --n)
            broken[random() % broken.size()] ^= std::byte(1u << random() % 8);
        check(broken);
    }
    // Where the counts are.
    for (std::size_t at = 0; at < std::min<std::size_t>(stream.size(), 24); ++at)
        for (const int value : {0, 1, 0x7f, 0x80, 0xff}) {
            auto broken = stream;
            broken[at] = std::byte(value);
            check(broken);
        }
}

}  // namespace

TEST_CASE("KHR_draco_mesh_compression is read") {
    for (const int method : {0, 1})
        for (const int speed : {0, 5, 10}) {
            const Mesh mesh = make_torus(30, 14);
            const auto stream = draco_stream(mesh, 0, speed, method);
            const auto out =
                parse_gltf(draco_document(stream, mesh.positions.size(), mesh.triangles.size() * 3).glb(), "",
                           {Weld::kAll, "COLOR_0.r", 10000});
            INFO((out.ok() ? "" : out.error().describe()));
            REQUIRE(out.ok());
            CHECK(out->mesh.triangles.size() == mesh.triangles.size());
            CHECK(out->mesh.positions.size() == mesh.positions.size());
            CHECK(survey_mesh(out->mesh).closed());
            // Unquantised: the same positions, in Draco's order.
            for (const Float3& p : out->mesh.positions)
                REQUIRE(std::find(mesh.positions.begin(), mesh.positions.end(), p) != mesh.positions.end());
            for (std::size_t v = 0; v < out->mesh.positions.size(); ++v)
                REQUIRE(out->mesh.weights[v] == std::max(0.0f, out->mesh.positions[v].x));
        }
}

TEST_CASE("Draco streams that announce more than they hold are refused before they are decoded") {
    auto stream = draco_stream(make_torus(10, 6), 11, 5, 0);
    // Sequential: the face count follows the eleven bytes of the header, as a varint.
    const std::vector<std::byte> count = {std::byte{0xff}, std::byte{0xff}, std::byte{0xff}, std::byte{0xff},
                                          std::byte{0x07}};
    stream.erase(stream.begin() + 11);
    stream.insert(stream.begin() + 11, count.begin(), count.end());
    const auto out = parse_gltf(draco_document(stream, 60, 360).glb(), "");
    REQUIRE_FALSE(out.ok());
    CHECK(out.error().code == ErrorCode::kLimit);
    // What the guard allows is far above the best that Draco does: a flat, regular grid.
    const Mesh grid = make_grid(300);
    for (const int method : {0, 1}) {
        const auto flat = draco_stream(grid, 10, 0, method, false);
        INFO("triangles a byte: " << double(grid.triangles.size()) / double(flat.size()));
        CHECK(double(grid.triangles.size()) / double(flat.size()) < 1024 / 16);
        GltfDocument document = draco_document(flat, grid.positions.size(), grid.triangles.size() * 3);
        document.root["meshes"][0]["primitives"][0]["attributes"].erase("COLOR_0");
        CHECK(parse_gltf(document.glb(), "").ok());
    }
}

TEST_CASE("broken Draco streams are an error or a sound mesh") {
    for (const int method : {0, 1})
        check_hostile(
            draco_stream(make_torus(10, 6), 11, method == 0 ? 5 : 0, method),
            [](const auto& s) { return draco_document(s, 60, 360); }, 7u + unsigned(method));
}

namespace {

GltfDocument meshopt_document(const Mesh& mesh, const std::vector<std::byte>& vertices,
                              const std::vector<std::byte>& indices, const char* mode, const char* filter) {
    GltfDocument document;
    document.root["extensionsUsed"] = document.root["extensionsRequired"] = {"EXT_meshopt_compression"};
    const std::size_t v = document.view(vertices), i = document.view(indices);
    // The uncompressed views lie in a buffer that is not there.
    document.root["buffers"] =
        json::array({{{"byteLength", mesh.positions.size() * 12 + mesh.triangles.size() * 12},
                      {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}});
    const auto move = [&](std::size_t view, std::size_t stride, std::size_t count, const char* m,
                          const char* f) {
        json& object = document.root["bufferViews"][view];
        object["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                           {"byteOffset", object["byteOffset"]},
                                                           {"byteLength", object["byteLength"]},
                                                           {"byteStride", stride},
                                                           {"count", count},
                                                           {"mode", m},
                                                           {"filter", f}};
        object["buffer"] = 1;
        object["byteOffset"] = 0;
        object["byteLength"] = stride * count;
    };
    move(v, 12, mesh.positions.size(), "ATTRIBUTES", filter);
    document.root["bufferViews"][v]["byteStride"] = 12;
    move(i, 4, mesh.triangles.size() * 3, mode, "NONE");
    const std::size_t positions = document.add(
        "accessors",
        {{"bufferView", v}, {"componentType", 5126}, {"type", "VEC3"}, {"count", mesh.positions.size()}});
    const std::size_t corners = document.add("accessors", {{"bufferView", i},
                                                           {"componentType", 5125},
                                                           {"type", "SCALAR"},
                                                           {"count", mesh.triangles.size() * 3}});
    document.scene_of({{"attributes", {{"POSITION", positions}}}, {"indices", corners}});
    return document;
}

std::vector<std::byte> meshopt_vertices(const Mesh& mesh) {
    std::vector<unsigned char> out(meshopt_encodeVertexBufferBound(mesh.positions.size(), 12));
    return as_bytes(out.data(), meshopt_encodeVertexBuffer(out.data(), out.size(), mesh.positions.data(),
                                                           mesh.positions.size(), 12));
}

std::vector<std::byte> meshopt_indices(const Mesh& mesh, bool sequence) {
    const std::size_t count = mesh.triangles.size() * 3;
    const unsigned* from = mesh.triangles[0].data();
    std::vector<unsigned char> out(sequence ? meshopt_encodeIndexSequenceBound(count, mesh.positions.size())
                                            : meshopt_encodeIndexBufferBound(count, mesh.positions.size()));
    return as_bytes(out.data(), sequence ? meshopt_encodeIndexSequence(out.data(), out.size(), from, count)
                                         : meshopt_encodeIndexBuffer(out.data(), out.size(), from, count));
}

}  // namespace

TEST_CASE("EXT_meshopt_compression is read") {
    const Mesh mesh = make_torus(30, 14);
    for (const bool sequence : {false, true}) {
        const auto document = meshopt_document(mesh, meshopt_vertices(mesh), meshopt_indices(mesh, sequence),
                                               sequence ? "INDICES" : "TRIANGLES", "NONE");
        const auto out = parse_gltf(document.glb(), "", {Weld::kNone, "", 10000});
        INFO((out.ok() ? "" : out.error().describe()));
        REQUIRE(out.ok());
        CHECK(out->mesh.positions == mesh.positions);
        // The triangle codec may turn a triangle's corners round.
        REQUIRE(out->mesh.triangles.size() == mesh.triangles.size());
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            Triangle a = mesh.triangles[t], b = out->mesh.triangles[t];
            std::rotate(a.begin(), std::min_element(a.begin(), a.end()), a.end());
            std::rotate(b.begin(), std::min_element(b.begin(), b.end()), b.end());
            REQUIRE(a == b);
        }
    }
    // Exponents: 12 bits of mantissa are enough to tell that the filter was undone.
    Mesh coarse = mesh;
    std::vector<float> encoded(mesh.positions.size() * 3);
    meshopt_encodeFilterExp(encoded.data(), mesh.positions.size(), 12, 12, &mesh.positions[0].x);
    std::memcpy(&coarse.positions[0].x, encoded.data(), encoded.size() * 4);
    const auto out = parse_gltf(meshopt_document(mesh, meshopt_vertices(coarse), meshopt_indices(mesh, false),
                                                 "TRIANGLES", "EXPONENTIAL")
                                    .glb(),
                                "", {Weld::kNone, "", 10000});
    REQUIRE(out.ok());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        REQUIRE(out->mesh.positions[v].x == Approx(mesh.positions[v].x).margin(2e-3));
}

TEST_CASE("EXT_meshopt_compression: absurd counts, unknown modes and broken streams") {
    const Mesh mesh = make_torus(10, 6);
    const auto vertices = meshopt_vertices(mesh), indices = meshopt_indices(mesh, false);
    GltfDocument document = meshopt_document(mesh, vertices, indices, "TRIANGLES", "NONE");
    const auto refused = [&](const char* key, json value) {
        GltfDocument broken = document;
        broken.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][key] = value;
        const auto out = parse_gltf(broken.glb(), "");
        REQUIRE_FALSE(out.ok());
        return out.error();
    };
    CHECK(refused("count", 9007199254740992).message.find("cannot be in") != std::string::npos);
    CHECK(refused("count", 4000000000).message.find("cannot be in") != std::string::npos);
    CHECK(refused("byteStride", 0).code == ErrorCode::kMalformed);
    CHECK(refused("byteStride", 260).code == ErrorCode::kMalformed);
    CHECK(refused("byteLength", 100000).message.find("reaches beyond") != std::string::npos);
    CHECK(refused("mode", "TRIANGLES").code == ErrorCode::kMalformed);
    CHECK(refused("mode", "MESHLETS").message.find("mode 'MESHLETS'") != std::string::npos);
    CHECK(refused("filter", "OCTAHEDRAL").code == ErrorCode::kMalformed);
    check_hostile(
        vertices, [&](const auto& s) { return meshopt_document(mesh, s, indices, "TRIANGLES", "NONE"); }, 3);
    check_hostile(
        indices, [&](const auto& s) { return meshopt_document(mesh, vertices, s, "TRIANGLES", "NONE"); }, 4);
    // A constant array is what the vertex codec shrinks most; it must not be taken for an attack.
    Mesh flat = make_grid(200);
    for (Float3& p : flat.positions) p = {1, 1, 1};
    const auto out = parse_gltf(
        meshopt_document(flat, meshopt_vertices(flat), meshopt_indices(flat, false), "TRIANGLES", "NONE")
            .glb(),
        "", {Weld::kNone, "", 1u << 20});
    CHECK(out.ok());
}

TEST_CASE("integers come out of Draco as they went in") {
    // Normals all around, so that none is what its neighbours foretell.
    GltfDocument d;
    const Sheet sheet(8);
    const std::size_t n = sheet.vertices;
    std::vector<std::int16_t> places;
    std::vector<std::int8_t> normals, tangents;
    std::vector<std::uint16_t> uvs;
    std::vector<std::uint8_t> colours;
    for (std::size_t v = 0; v < n; ++v) {
        const float a = 0.7f * float(v), z = std::cos(0.31f * float(v)), r = std::sqrt(1 - z * z);
        for (std::size_t c = 0; c < 3; ++c)
            places.push_back(std::int16_t(std::lround(4000 * sheet.positions[3 * v + c])));
        places.push_back(0);  // elements begin at multiples of four
        for (const float x : {r * std::cos(a), r * std::sin(a), z, 0.0f})
            normals.push_back(std::int8_t(std::lround(127 * x)));
        for (const float x : {-std::sin(a), std::cos(a), 0.0f, v % 2 == 0 ? 1.0f : -1.0f})
            tangents.push_back(std::int8_t(std::lround(127 * x)));
        for (std::size_t c = 0; c < 2; ++c)
            uvs.push_back(std::uint16_t(std::lround(65535 * sheet.uvs[2 * v + c])));
        for (const std::size_t x : {v, 255 - v, 7 * v % 256, std::size_t{255}})
            colours.push_back(std::uint8_t(x));
    }
    const auto with_stride = [&](std::size_t accessor, int stride) {
        d.root["bufferViews"][d.root["accessors"][accessor]["bufferView"].get<std::size_t>()]["byteStride"] =
            stride;
        return accessor;
    };
    const json normalised = {{"normalized", true}};
    const std::size_t position = with_stride(d.accessor(places, 5122, "VEC3", n), 8);
    d.root["accessors"][position].update({{"min", {0, 0, 0}}, {"max", {4000, 4000, 1000}}});
    const json attributes = {{"POSITION", position},
                             {"NORMAL", with_stride(d.accessor(normals, 5120, "VEC3", n, normalised), 4)},
                             {"TANGENT", d.accessor(tangents, 5120, "VEC4", n, normalised)},
                             {"TEXCOORD_0", d.accessor(uvs, 5123, "VEC2", n, normalised)},
                             {"COLOR_0", d.accessor(colours, 5121, "VEC4", n, normalised)}};
    d.scene_of({{"attributes", attributes}, {"indices", d.shorts(sheet.corners)}});
    d.root["extensionsUsed"] = d.root["extensionsRequired"] = {"KHR_mesh_quantization"};
    const bake::Scene scene = scene_of(d.glb());
    bake::SceneFormat format;
    format.draco = true;
    const bake::Scene back = scene_of(encoded(scene, levels_of(scene, 1), format));
    const auto rows = [](const Mesh& mesh) {
        std::vector<std::vector<float>> all;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            std::vector<float> row{mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z};
            for (const Attribute& a : mesh.attributes)
                row.insert(row.end(), a.values.begin() + std::ptrdiff_t(a.components * v),
                           a.values.begin() + std::ptrdiff_t(a.components * (v + 1)));
            all.push_back(row);
        }
        std::sort(all.begin(), all.end());
        return all;
    };
    const auto before = rows(scene.mesh), after = rows(back.mesh);
    REQUIRE(before.size() == after.size());
    for (std::size_t v = 0; v < before.size(); ++v)
        for (std::size_t c = 0; c < before[v].size(); ++c)
            REQUIRE(after[v][c] == Approx(before[v][c]).margin(1e-6));
}
