// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "family.hpp"
#include "gltf_document.hpp"
#include "vsplit/bake/files.hpp"
#include "vsplit/bake/gltf.hpp"

using namespace vsplit;
using namespace vsplit::bake;
using namespace vsplit::test;

namespace {

const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};

MeshFile read(const std::vector<std::byte>& bytes, const GltfOptions& options = {Weld::kNone, "", 1u << 20}) {
    auto out = parse_gltf(bytes, "", options);
    INFO((out.ok() ? "" : out.error().describe()));
    REQUIRE(out.ok());
    REQUIRE(mesh_fault(out->mesh) == nullptr);
    return *out;
}

Error refuse(const std::vector<std::byte>& bytes, const GltfOptions& options = {},
             const std::string& folder = "") {
    auto out = parse_gltf(bytes, folder, options);
    REQUIRE_FALSE(out.ok());
    return out.error();
}

/// Positive where a triangle looks along +Z.
double normal_z(const Mesh& mesh, std::size_t t) {
    const Float3 a = mesh.positions[mesh.triangles[t][0]], b = mesh.positions[mesh.triangles[t][1]],
                 c = mesh.positions[mesh.triangles[t][2]];
    return double(b.x - a.x) * (c.y - a.y) - double(b.y - a.y) * (c.x - a.x);
}

}  // namespace

TEST_CASE("lists, strips and fans, indexed or not") {
    struct Case {
        int mode;
        std::vector<float> positions;
        std::vector<std::uint16_t> indices;
        std::vector<Triangle> expected;
    };
    const std::vector<float> six = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 1, 2, 0};
    const std::vector<Case> cases = {
        {4, six, {}, {{0, 1, 2}, {3, 4, 5}}},
        {4, kSquare, {0, 1, 2, 2, 1, 3}, {{0, 1, 2}, {2, 1, 3}}},
        {5, six, {}, {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}}},
        {5, kSquare, {0, 1, 2, 3}, {{0, 1, 2}, {1, 3, 2}}},
        {6, kSquare, {0, 1, 3, 2}, {{1, 3, 0}, {3, 2, 0}}},
    };
    for (const Case& c : cases) {
        GltfDocument document;
        json primitive = {{"attributes", {{"POSITION", document.floats(c.positions)}}}, {"mode", c.mode}};
        if (!c.indices.empty()) primitive["indices"] = document.shorts(c.indices);
        document.scene_of(primitive);
        for (const auto& bytes : {document.glb(), document.gltf()}) {
            const MeshFile out = read(bytes);
            CHECK(out.mesh.triangles == c.expected);
            // All faces of a strip or a fan look the same way.
            for (std::size_t t = 0; t < out.mesh.triangles.size() && c.mode != 4; ++t)
                CHECK(normal_z(out.mesh, t) > 0);
        }
    }
}

TEST_CASE("points and lines are counted and left out, leftover indices too") {
    GltfDocument document;
    const std::size_t positions = document.floats(kSquare);
    const std::size_t mesh = document.add(
        "meshes", {{"primitives", json::array({{{"attributes", {{"POSITION", positions}}}, {"mode", 0}},
                                               {{"attributes", {{"POSITION", positions}}},
                                                {"indices", document.shorts({0, 1, 2, 1})}},
                                               {{"attributes", {{"POSITION", positions}}}, {"mode", 3}}})}});
    document.scene({document.node({{"mesh", mesh}})});
    const MeshFile out = read(document.glb());
    CHECK(out.mesh.triangles.size() == 1);
    CHECK(out.report.format ==
          "glTF (binary), 2 primitives of points or lines left out, 1 indices left over at the end of a "
          "primitive");
    CHECK(out.report.vertices_in == 4);
    CHECK(out.report.vertices_dropped_unused == 1);
}

TEST_CASE("a vertex array that primitives share is read in parts") {
    GltfDocument document;
    std::vector<float> positions;
    for (int i = 0; i < 3000; ++i) positions.insert(positions.end(), {float(i), float(i % 2), 0});
    const std::size_t shared = document.floats(positions);
    json primitives = json::array();
    for (std::uint16_t p = 0; p < 10; ++p)
        primitives.push_back(
            {{"attributes", {{"POSITION", shared}}},
             {"indices", document.shorts({std::uint16_t(p * 2), std::uint16_t(p * 2 + 1), 2999})}});
    document.scene({document.node({{"mesh", document.add("meshes", {{"primitives", primitives}})}})});
    const MeshFile out = read(document.glb(), {Weld::kAll, "", 1u << 20});
    CHECK(out.mesh.triangles.size() == 10);
    CHECK(out.mesh.positions.size() == 21);
    CHECK(out.report.vertices_welded == 9);
    CHECK(out.report.vertices_dropped_unused == 3000 - 21);
}

TEST_CASE("interleaved, sparse and zero-based accessors") {
    GltfDocument document;
    // Positions every 16 bytes, from byte 4 on.
    std::vector<float> interleaved;
    for (int v = 0; v < 4; ++v)
        interleaved.insert(interleaved.end(),
                           {99, kSquare[std::size_t(v) * 3], kSquare[std::size_t(v) * 3 + 1],
                            kSquare[std::size_t(v) * 3 + 2]});
    const std::size_t view = document.view(interleaved);
    document.root["bufferViews"][view]["byteStride"] = 16;
    const std::size_t strided = document.add(
        "accessors",
        {{"bufferView", view}, {"byteOffset", 4}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 4}});
    const json sparse = {
        {"count", 2},
        {"indices",
         {{"bufferView", document.view(std::vector<std::uint16_t>{1, 3})}, {"componentType", 5123}}},
        {"values", {{"bufferView", document.view(std::vector<float>{5, 0, 0, 5, 5, 0})}}}};
    SECTION("strided") {
        document.scene_of({{"attributes", {{"POSITION", strided}}}, {"mode", 5}});
        CHECK(read(document.glb()).mesh.positions[3] == Float3{1, 1, 0});
    }
    SECTION("sparse over dense") {
        document.root["accessors"][strided]["sparse"] = sparse;
        document.scene_of({{"attributes", {{"POSITION", strided}}}, {"mode", 5}});
        const Mesh mesh = read(document.glb()).mesh;
        CHECK(mesh.positions == std::vector<Float3>{{0, 0, 0}, {5, 0, 0}, {0, 1, 0}, {5, 5, 0}});
    }
    SECTION("sparse over zeros") {
        const std::size_t zeros = document.add(
            "accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 4}, {"sparse", sparse}});
        document.scene_of({{"attributes", {{"POSITION", zeros}}}, {"mode", 5}});
        const Mesh mesh = read(document.glb()).mesh;
        CHECK(mesh.positions == std::vector<Float3>{{0, 0, 0}, {5, 0, 0}, {0, 0, 0}, {5, 5, 0}});
    }
    SECTION("sparse indices out of order") {
        json broken = sparse;
        broken["indices"]["bufferView"] = document.view(std::vector<std::uint16_t>{3, 1});
        document.root["accessors"][strided]["sparse"] = broken;
        document.scene_of({{"attributes", {{"POSITION", strided}}}, {"mode", 5}});
        CHECK(refuse(document.glb())
                  .message.find(
                      "meshes[0].primitives[0].attributes.POSITION (accessors[0]): its sparse indices") == 0);
    }
    SECTION("zeros without end") {
        const std::size_t zeros =
            document.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 4000000000}});
        document.scene_of({{"attributes", {{"POSITION", zeros}}}});
        CHECK(refuse(document.glb()).code == ErrorCode::kLimit);
    }
}

TEST_CASE("KHR_mesh_quantization: integer positions, normalised and not") {
    GltfDocument document;
    document.root["extensionsUsed"] = document.root["extensionsRequired"] = {"KHR_mesh_quantization"};
    const auto positions = [&](auto values, int component, bool normalised) {
        const std::size_t view = document.view(values);
        document.root["bufferViews"][view]["byteStride"] = 4 * sizeof(values[0]);
        const std::size_t a = document.add("accessors", {{"bufferView", view},
                                                         {"componentType", component},
                                                         {"type", "VEC3"},
                                                         {"count", 3},
                                                         {"normalized", normalised}});
        return document.add("meshes", {{"primitives", json::array({{{"attributes", {{"POSITION", a}}}}})}});
    };
    std::vector<std::size_t> nodes;
    nodes.push_back(document.node(
        {{"mesh", positions(std::vector<std::int16_t>{-32768, 0, 0, 0, 32767, 0, 0, 0, 0, 16384, 0, 0}, 5122,
                            true)}}));
    nodes.push_back(document.node(
        {{"mesh",
          positions(std::vector<std::int16_t>{-32768, 0, 0, 0, 32767, 0, 0, 0, 0, 16384, 0, 0}, 5122, false)},
         {"scale", {0.5, 0.5, 0.5}}}));
    nodes.push_back(document.node(
        {{"mesh", positions(std::vector<std::uint8_t>{0, 51, 255, 0, 1, 2, 3, 0, 7, 8, 9, 0}, 5121, true)}}));
    document.scene(nodes);
    const Mesh mesh = read(document.glb()).mesh;
    REQUIRE(mesh.positions.size() == 9);
    CHECK(mesh.positions[0] == Float3{-1, 0, 0});
    CHECK(mesh.positions[1] == Float3{1, 0, 0});
    CHECK(mesh.positions[2].y == Approx(16384.0 / 32767));
    CHECK(mesh.positions[3] == Float3{-16384, 0, 0});
    CHECK(mesh.positions[5] == Float3{0, 8192, 0});
    CHECK(mesh.positions[6] == Float3{0, 0.2f, 1});
}

TEST_CASE("nested transforms, mirrors and instances") {
    GltfDocument document;
    const std::size_t mesh =
        document.mesh({{"attributes", {{"POSITION", document.floats({0, 0, 0, 1, 0, 0, 0, 1, 0})}}}});
    // Column-major: x -> 2y, y -> -2x, then 10 along x.
    const std::size_t leaf = document.node({{"mesh", mesh}, {"translation", {1, 0, 0}}});
    const std::size_t turned =
        document.node({{"children", {leaf}}, {"matrix", {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 10, 0, 0, 1}}});
    const double h = std::sqrt(0.5);
    const std::size_t quarter = document.node(
        {{"mesh", mesh}, {"rotation", {0, 0, h, h}}, {"scale", {3, 1, 1}}, {"translation", {0, 0, 7}}});
    const std::size_t inner = document.node({{"mesh", mesh}, {"scale", {1, -1, 1}}});
    const std::size_t mirror = document.node({{"children", {inner}}, {"scale", {-1, 1, 1}}});
    const std::size_t flipped = document.node({{"mesh", mesh}, {"scale", {-1, 1, 1}}});
    document.node({{"mesh", mesh}});  // in no scene
    document.scene({turned, quarter, mirror, flipped});
    const Mesh out = read(document.glb()).mesh;
    REQUIRE(out.triangles.size() == 4);
    REQUIRE(out.positions.size() == 12);
    const auto near = [](Float3 a, Float3 b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z) < 1e-6; };
    CHECK(near(out.positions[0], {10, 2, 0}));
    CHECK(near(out.positions[1], {10, 4, 0}));
    CHECK(near(out.positions[2], {8, 2, 0}));
    CHECK(near(out.positions[4], {0, 3, 7}));  // scaled, then turned, then moved
    CHECK(near(out.positions[5], {-1, 0, 7}));
    CHECK(near(out.positions[7], {-1, 0, 0}));
    CHECK(near(out.positions[10], {-1, 0, 0}));
    CHECK(out.triangles[2] == Triangle{6, 7, 8});    // two mirrors make none
    CHECK(out.triangles[3] == Triangle{9, 11, 10});  // one turns the winding
    for (std::size_t t = 0; t < 4; ++t) CHECK(normal_z(out, t) > 0);
}

TEST_CASE("nodes that are no tree are an error; chains of any length are not") {
    GltfDocument document;
    const std::size_t mesh =
        document.mesh({{"attributes", {{"POSITION", document.floats({0, 0, 0, 1, 0, 0, 0, 1, 0})}}}});
    SECTION("a cycle below the root") {
        document.node({{"children", {1}}});
        document.node({{"children", {0}}, {"mesh", mesh}});
        document.scene({0});
        CHECK(refuse(document.glb()).message == "nodes[0] is reached twice: the nodes are no tree");
        document.root.erase("scenes");
        document.root.erase("scene");
        CHECK(refuse(document.glb()).code == ErrorCode::kMalformed);
    }
    SECTION("a child of two") {
        document.node({{"children", {2}}});
        document.node({{"children", {2}}});
        document.node({{"mesh", mesh}});
        document.scene({0, 1});
        CHECK(refuse(document.glb()).message == "nodes[2] is reached twice: the nodes are no tree");
    }
    SECTION("a long chain") {
        for (std::size_t i = 0; i < 100000; ++i)
            document.node({{"children", {i + 1}}, {"translation", {0, 0, 1}}});
        document.node({{"mesh", mesh}});
        document.scene({0});
        CHECK(read(document.glb()).mesh.positions[0].z == 100000);
    }
}

TEST_CASE("a mesh repeated without end meets the limit") {
    GltfDocument document;
    const std::size_t mesh =
        document.mesh({{"attributes", {{"POSITION", document.floats(kSquare)}}}, {"mode", 5}});
    std::vector<std::size_t> nodes;
    for (int i = 0; i < 50; ++i) nodes.push_back(document.node({{"mesh", mesh}}));
    document.scene(nodes);
    CHECK(read(document.glb(), {Weld::kNone, "", 100}).mesh.triangles.size() == 100);
    CHECK(refuse(document.glb(), {Weld::kNone, "", 99}).code == ErrorCode::kLimit);
}

TEST_CASE("weights from a colour channel") {
    GltfDocument document;
    const auto node = [&](json color) {
        json attributes = {{"POSITION", document.floats({0, 0, 0, 1, 0, 0, 0, 1, 0})}};
        if (!color.is_null()) attributes["COLOR_0"] = color;
        return document.node({{"mesh", document.mesh({{"attributes", attributes}})}});
    };
    document.scene(
        {node(document.floats({0.25f, 0, 0, 0.5f, 0, 0, 2, 0, 0})),
         node(document.accessor(std::vector<std::uint8_t>{255, 0, 0, 51, 51, 0, 0, 102, 0, 0, 0, 255}, 5121,
                                "VEC4", 3, {{"normalized", true}})),
         node(document.accessor(std::vector<std::uint16_t>{65535, 0, 0, 13107, 13107, 0, 0, 0, 0, 0, 0, 0},
                                5123, "VEC4", 3, {{"normalized", true}})),
         node(nullptr)});
    CHECK(read(document.glb()).mesh.weights.empty());
    CHECK(read(document.glb(), {Weld::kNone, "COLOR_0.r", 100}).mesh.weights ==
          std::vector<float>{0.25f, 0.5f, 2, 1, 0.2f, 0, 1, 0.2f, 0, 1, 1, 1});
    CHECK(read(document.glb(), {Weld::kNone, "COLOR_0.a", 100}).mesh.weights ==
          std::vector<float>{1, 1, 1, 0.2f, 0.4f, 1, 0.2f, 0, 0, 1, 1, 1});
    const Error missing = refuse(document.glb(), {Weld::kNone, "COLOR_1.r", 100});
    CHECK(missing.code == ErrorCode::kArgument);
    CHECK(missing.message ==
          "no primitive of the scene has the weight channel COLOR_1.r; its attributes are COLOR_0, POSITION");
    for (const char* text : {"COLOR_0", "COLOR_0.", "COLOR_0.x", ".r", "COLOR_0.rg"})
        CHECK(refuse(document.glb(), {Weld::kNone, text, 100}).code == ErrorCode::kArgument);
}

TEST_CASE("weights that are negative or NaN are counted by the assembly") {
    GltfDocument document;
    document.scene_of({{"attributes",
                        {{"POSITION", document.floats({0, 0, 0, 1, 0, 0, 0, 1, 0})},
                         {"COLOR_0", document.floats({-1, 0, 0, std::nanf(""), 0, 0, 3, 0, 0})}}}});
    const MeshFile out = read(document.glb(), {Weld::kNone, "COLOR_0.r", 100});
    CHECK(out.mesh.weights == std::vector<float>{0, 0, 3});
    CHECK(out.report.weights_clamped == 2);
}

TEST_CASE("required extensions that may change geometry are refused by name") {
    GltfDocument document;
    document.scene_of({{"attributes", {{"POSITION", document.floats(kSquare)}}}, {"mode", 5}});
    document.root["extensionsUsed"] = {"EXT_mesh_gpu_instancing", "KHR_materials_unlit"};
    CHECK(read(document.glb()).report.format == "glTF (binary), EXT_mesh_gpu_instancing not read");
    document.root["extensionsRequired"] = {"KHR_materials_unlit", "KHR_texture_transform"};
    CHECK(read(document.glb()).mesh.triangles.size() == 2);
    document.root["extensionsRequired"].push_back("EXT_mesh_gpu_instancing");
    const Error error = refuse(document.glb());
    CHECK(error.code == ErrorCode::kUnsupported);
    CHECK(error.message == "the scene requires the extension EXT_mesh_gpu_instancing, which is not read");
}

TEST_CASE("external buffers: only from the folder, and never from outside of it") {
    namespace fs = std::filesystem;
    const fs::path folder =
        fs::temp_directory_path() /
        ("vsplit_gltf_" + std::to_string(std::hash<std::string>{}(
                              std::to_string(reinterpret_cast<std::uintptr_t>(&kSquare)) + VSPLIT_CORPUS)));
    fs::remove_all(folder);
    fs::create_directories(folder / "scene" / "sub dir");
    struct Remove {
        fs::path path;
        ~Remove() { fs::remove_all(path); }
    } const remove{folder};
    GltfDocument document;
    document.scene_of({{"attributes", {{"POSITION", document.floats(kSquare)}}}, {"mode", 5}});
    const auto save = [&](const fs::path& path) {
        REQUIRE(write_file((folder / path).string(), document.bin, true).ok());
    };
    save("outside.bin");
    save("scene/a.bin");
    save("scene/sub dir/b.bin");
    fs::create_symlink(folder / "outside.bin", folder / "scene" / "link.bin");
    const std::string scene = (folder / "scene").string();
    const auto with = [&](const std::string& uri) {
        return GltfDocument::bytes(document.with_buffer({{"uri", uri}}).dump());
    };
    for (const char* uri : {"a.bin", "sub%20dir/b.bin", "./a.bin"}) CHECK(parse_gltf(with(uri), scene).ok());
    CHECK(refuse(with("a.bin")).code == ErrorCode::kUnsupported);
    const std::string absolute = (folder / "outside.bin").string();
    for (const std::string uri :
         {"../outside.bin", "sub dir/../../outside.bin", "%2e%2e/outside.bin", "link.bin", "..\\outside.bin",
          absolute.c_str(), "file:///etc/passwd", "http://example.org/a.bin", ""}) {
        CAPTURE(uri);
        const Error error = refuse(with(uri), {}, scene);
        CHECK(error.code == ErrorCode::kUnsupported);
        CHECK(error.message.find("buffers[0]: its file") == 0);
    }
    CHECK(refuse(with("missing.bin"), {}, scene).code == ErrorCode::kIo);
    CHECK(refuse(with("sub dir"), {}, scene).code == ErrorCode::kIo);
    document.bin.pop_back();
    save("scene/short.bin");
    document.bin.push_back({});
    CHECK(refuse(with("short.bin"), {}, scene).code == ErrorCode::kTruncated);
}

TEST_CASE("data: URIs of any media type") {
    GltfDocument document;
    document.scene_of({{"attributes", {{"POSITION", document.floats(kSquare)}}}, {"mode", 5}});
    const auto with = [&](const std::string& uri) {
        return GltfDocument::bytes(document.with_buffer({{"uri", uri}}).dump());
    };
    const std::string data = GltfDocument::base64(document.bin);
    for (const char* type : {"application/octet-stream", "application/gltf-buffer", "", "x/y;charset=z"})
        CHECK(read(with("data:" + std::string(type) + ";base64," + data)).mesh.triangles.size() == 2);
    CHECK(refuse(with("data:," + data)).code == ErrorCode::kUnsupported);
    CHECK(refuse(with("data:;base64," + data.substr(4))).code == ErrorCode::kTruncated);
    CHECK(refuse(with("data:;base64,!" + data)).code == ErrorCode::kMalformed);
}

TEST_CASE("real scenes have the triangles that their JSON promises") {
    for (const char* name : {"gltf/Duck.glb", "gltf/CesiumMan.glb", "gltf/2CylinderEngine.glb"}) {
        const auto path = corpus_file(name);
        if (!path) continue;
        CAPTURE(name);
        const auto bytes = read_file(*path);
        REQUIRE(bytes.ok());
        std::uint32_t length = 0;
        std::memcpy(&length, bytes->data() + 12, 4);
        const json document =
            json::parse(std::string(reinterpret_cast<const char*>(bytes->data()) + 20, length));
        std::uint64_t expected = 0;
        const std::function<void(std::size_t)> count = [&](std::size_t n) {
            const json& node = document["nodes"][n];
            if (node.contains("mesh"))
                for (const json& p : document["meshes"][node["mesh"].get<std::size_t>()]["primitives"]) {
                    REQUIRE(p.value("mode", 4) == 4);
                    expected +=
                        document["accessors"][p["indices"].get<std::size_t>()]["count"].get<std::uint64_t>() /
                        3;
                }
            for (const json& child : node.value("children", json::array())) count(child.get<std::size_t>());
        };
        for (const json& n : document["scenes"][document["scene"].get<std::size_t>()]["nodes"])
            count(n.get<std::size_t>());
        const auto out = parse_gltf(*bytes, "");
        REQUIRE(out.ok());
        CHECK(mesh_fault(out->mesh) == nullptr);
        CHECK(out->report.faces_in == expected);
        CHECK(out->mesh.triangles.size() + out->report.faces_dropped_degenerate == expected);
        CHECK(out->report.faces_dropped_non_finite == 0);
        CHECK(out->mesh.positions.size() + out->report.vertices_welded +
                  out->report.vertices_dropped_unused ==
              out->report.vertices_in);
        // An external texture or none: the colours do not matter here.
        CHECK(parse_gltf(*bytes, "", {Weld::kAll, "COLOR_0.r", 1u << 26}).error().code ==
              ErrorCode::kArgument);
    }
}
