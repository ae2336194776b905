// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// MANYFOLD_mesh_progressive by our reading: what is written replays, and what is broken stops there.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "family.hpp"
#include "gltf_scene.hpp"
#include "mesh_checks.hpp"
#include "vsplit/bake/collapse.hpp"
#include "vsplit/bake/manyfold.hpp"
#include "vsplit/live_mesh.hpp"

using namespace vsplit;
using namespace vsplit::bake;
using namespace vsplit::test;

namespace {

/// A tetrahedron, one vertex of which splits: four triangles to six. Faces by hand.
struct ByHand {
    GltfDocument document;
    std::vector<std::uint32_t> splits;
    std::vector<float> displacements;

    ByHand(std::vector<std::uint32_t> records, std::vector<float> d)
        : splits(std::move(records)), displacements(std::move(d)) {}

    std::vector<std::byte> glb(bool on_mesh = false) {
        GltfDocument& d = document;
        const std::size_t positions = d.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
        const std::size_t indices = d.shorts({0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2});
        const std::size_t count = splits.size() / 3;
        const json extension = {
            {"MANYFOLD_mesh_progressive",
             {{"indices", d.accessor(splits, 5125, "VEC3", count)},
              {"attributes",
               {{"POSITION", d.accessor(displacements, 5126, "VEC3", displacements.size() / 3)}}}}}};
        json primitive = {{"attributes", {{"POSITION", positions}}}, {"indices", indices}};
        if (!on_mesh) primitive["extensions"] = extension;
        d.scene_of(primitive);
        if (on_mesh) d.root["meshes"][0]["extensions"] = extension;
        d.root["extensionsUsed"] = {"MANYFOLD_mesh_progressive"};
        return d.glb();
    }
};

ManyfoldFile read(std::span<const std::byte> glb) {
    auto file = parse_manyfold(glb, "");
    INFO((file.ok() ? std::string() : file.error().message));
    REQUIRE(file.ok());
    REQUIRE(file->has_value());
    REQUIRE(progressive_mesh_fault((*file)->mesh) == nullptr);
    return std::move(**file);
}

}  // namespace

TEST_CASE("a split of MANYFOLD_mesh_progressive moves the faces between its neighbours") {
    // Around vertex 0: (0, 2, 1), (0, 1, 3), (0, 3, 2), counter-clockwise 2, 1, 3, 2. From 2 to 3 two go
    // over.
    for (const bool on_mesh : {false, true}) {
        const ManyfoldFile file = read(ByHand({0, 3, 2}, {0, 0, -0.25f}).glb(on_mesh));
        REQUIRE(file.fault.empty());
        REQUIRE(file.read == 1);
        const Mesh full = cut(file.mesh, 1);
        const std::vector<Triangle> expected = {{4, 2, 1}, {4, 1, 3}, {1, 2, 3},
                                                {0, 3, 2}, {0, 4, 3}, {4, 0, 2}};
        REQUIRE(full.triangles == expected);
        REQUIRE(full.positions[4] == Float3{0, 0, -0.25f});
        REQUIRE(full.positions[0] == Float3{0, 0, 0.25f});
        REQUIRE(cut(file.mesh, 0).triangles.size() == 4);
        REQUIRE(error_at(file.mesh, 0) == Approx(0.25));
        REQUIRE(error_at(file.mesh, 1) == 0);
    }
}

TEST_CASE("records of MANYFOLD_mesh_progressive that do not fit stop the reading where they are") {
    const float nan = std::numeric_limits<float>::quiet_NaN(), most = std::numeric_limits<float>::max();
    const std::vector<std::uint32_t> sound = {0, 3, 2};
    const struct {
        std::vector<std::uint32_t> record;
        std::vector<float> d;
        const char* says;
    } cases[] = {{{5, 0, 1}, {0, 0, 1}, "not there yet"},
                 {{0, 7, 1}, {0, 0, 1}, "not there yet"},
                 {{0, 3, 4294967295u}, {0, 0, 1}, "not there yet"},
                 {{0, 3, 3}, {0, 0, 1}, "or one twice"},
                 {{0, 0, 0}, {0, 0, 1}, "has no neighbours"},
                 {{1, 0, 3}, {0, 0, 1}, "neighbour that is none"},
                 {{0, 0, 3}, {0, 0, 1}, "within the surface"},
                 {{0, 3, 0}, {0, 0, 1}, "within the surface"},
                 {{0, 3, 2}, {nan, 0, 1}, "no number"},
                 {{0, 3, 2}, {most, 0, most}, nullptr}};
    for (const auto& c : cases) {
        CAPTURE(c.record, c.says);
        std::vector<std::uint32_t> records = sound;
        records.insert(records.end(), c.record.begin(), c.record.end());
        // After the bad one comes a sound one, which is not read.
        records.insert(records.end(), sound.begin(), sound.end());
        std::vector<float> d = {0, 0, -0.25f};
        d.insert(d.end(), c.d.begin(), c.d.end());
        d.insert(d.end(), {0, 0, 0});
        const ManyfoldFile file = read(ByHand(records, d).glb());
        REQUIRE(file.records == 3);
        if (c.says == nullptr) {
            REQUIRE(file.read == 3);  // Large, and still numbers.
            continue;
        }
        REQUIRE(file.read == 1);
        REQUIRE(file.fault.find(c.says) != std::string::npos);
        REQUIRE(file.mesh.splits.size() == 1);
    }
    const ManyfoldFile beyond = read(ByHand({0, 3, 2, 0, 4, 3}, {most, 0, 0, most, 0, 0}).glb());
    REQUIRE(beyond.read == 1);
    REQUIRE(beyond.fault.find("beyond all numbers") != std::string::npos);
}

TEST_CASE("documents of MANYFOLD_mesh_progressive that do not fit are refused") {
    const auto refused = [](const std::vector<std::byte>& glb) {
        const auto file = parse_manyfold(glb, "");
        return !file.ok();
    };
    {
        ByHand fewer({0, 3, 2, 0, 3, 2}, {0, 0, 1});
        REQUIRE(refused(fewer.glb()));
    }
    for (const char* key : {"indices", "attributes"}) {
        ByHand whole({0, 3, 2}, {0, 0, 1});
        whole.glb();
        json& extension =
            whole.document.root["meshes"][0]["primitives"][0]["extensions"]["MANYFOLD_mesh_progressive"];
        json broken = extension;
        extension.erase(key);
        REQUIRE(refused(whole.document.glb()));
        extension = broken;
        REQUIRE(!refused(whole.document.glb()));
        extension["indices"] = 99;
        REQUIRE(refused(whole.document.glb()));
    }
    // No extension is no error.
    const auto plain = parse_manyfold(RichScene().document.glb(), "");
    REQUIRE(plain.ok());
    REQUIRE(!plain->has_value());
}

TEST_CASE(
    "a MANYFOLD_mesh_progressive file cut anywhere is an error, and bytes changed anywhere are no crash") {
    const std::vector<std::byte> glb = ByHand({0, 3, 2, 1, 3, 4}, {0, 0, -0.25f, 0.125f, 0, 0}).glb();
    read(glb);
    for (std::size_t size = 0; size < glb.size(); ++size)
        REQUIRE(!parse_manyfold(std::span(glb).first(size), "").ok());
    for (std::size_t at = 0; at < glb.size(); ++at)
        for (const int value : {0x00, 0x7F, 0xFF}) {
            std::vector<std::byte> changed = glb;
            changed[at] = std::byte(value);
            const auto file = parse_manyfold(changed, "");
            if (file.ok() && file->has_value()) REQUIRE(progressive_mesh_fault((*file)->mesh) == nullptr);
        }
}

TEST_CASE("what is written as MANYFOLD_mesh_progressive reads back as the mesh it was made of") {
    for (const NamedMesh& named :
         {NamedMesh{"sphere", make_sphere(24, 16)}, NamedMesh{"grid", make_grid(12)},
          NamedMesh{"torus", make_torus(20, 12)},
          NamedMesh{"two", join(make_sphere(16, 12), make_sphere(6, 4), {3, 0, 0})}}) {
        CAPTURE(named.name);
        auto baked = collapse(named.mesh);
        REQUIRE(baked.ok());
        const auto glb = encode_manyfold(baked->mesh);
        INFO((glb.ok() ? std::string() : glb.error().message));
        REQUIRE(glb.ok());
        REQUIRE(glb->records + glb->left_out == baked->mesh.splits.size());
        if (named.name != "two") REQUIRE(glb->left_out == 0);
        const ManyfoldFile file = read(glb->bytes);
        REQUIRE(file.fault.empty());
        REQUIRE(file.read == glb->records);
        REQUIRE(file.mesh.base_triangles == glb->base_triangles);
        // Both number vertices by birth.
        const Mesh full = cut(file.mesh, file.mesh.splits.size()),
                   wanted = cut(baked->mesh, baked->mesh.splits.size());
        REQUIRE(full.positions.size() == wanted.positions.size());
        for (std::size_t v = 0; v < full.positions.size(); ++v) {
            const Float3 &a = full.positions[v], &b = wanted.positions[v];
            REQUIRE(std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)}) < 1e-5f);
        }
        const auto sorted = [](std::vector<Triangle> triangles) {
            for (Triangle& t : triangles)
                std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
            std::sort(triangles.begin(), triangles.end());
            return triangles;
        };
        REQUIRE(sorted(full.triangles) == sorted(wanted.triangles));
        // Every level is as the record has it, and within what is said of it.
        for (std::size_t back : {std::size_t{1}, file.mesh.splits.size() / 2, file.mesh.splits.size()}) {
            const std::size_t level = file.mesh.splits.size() - back;
            const Mesh coarse = cut(file.mesh, level);
            REQUIRE(sorted(coarse.triangles) == sorted(cut(baked->mesh, level + glb->left_out).triangles));
            REQUIRE(distance_to(coarse, named.mesh.positions) <= error_at(file.mesh, level) + 1e-5);
        }
    }
}

TEST_CASE("what MANYFOLD_mesh_progressive cannot say is an argument error") {
    // Three triangles at one edge: nothing of it is a fan, and no split of it either.
    Mesh fin;
    fin.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, -1}};
    fin.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
    auto baked = collapse(fin);
    REQUIRE(baked.ok());
    const auto glb = encode_manyfold(baked->mesh);
    REQUIRE(!glb.ok());
    REQUIRE(glb.error().code == ErrorCode::kArgument);
}
