// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Our readers against OpenMesh's, where the mesh is manifold so that OpenMesh keeps all of it; and the shared
// models.
#include <unistd.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <catch2/catch.hpp>
#include <filesystem>

#include "family.hpp"
#include "mesh_files.hpp"
#include "vsplit/bake/files.hpp"

using namespace vsplit;
using namespace vsplit::bake;
using namespace vsplit::test;

namespace {

struct FloatTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3f;
};
using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<FloatTraits>;

Mesh read_with_openmesh(const std::string& path) {
    HalfEdgeMesh read;
    REQUIRE(OpenMesh::IO::read_mesh(read, path));
    Mesh mesh;
    for (const auto v : read.vertices())
        mesh.positions.push_back({read.point(v)[0], read.point(v)[1], read.point(v)[2]});
    for (const auto f : read.faces()) {
        Triangle t{};
        std::size_t k = 0;
        for (const auto v : read.fv_range(f)) t[k++] = static_cast<std::uint32_t>(v.idx());
        mesh.triangles.push_back(t);
    }
    return mesh;
}

/// Triangles as sets of corner positions in order, started at the smallest index: OpenMesh turns them.
void check_same(const Mesh& ours, const Mesh& theirs) {
    REQUIRE(ours.positions.size() == theirs.positions.size());
    REQUIRE(ours.triangles.size() == theirs.triangles.size());
    std::vector<Float3> placed;  // OpenMesh knows no origin
    for (const Float3& p : ours.positions)
        placed.push_back({float(ours.origin[0] + double(p.x)), float(ours.origin[1] + double(p.y)),
                          float(ours.origin[2] + double(p.z))});
    CHECK(placed == theirs.positions);
    const auto turned = [](Triangle t) {
        while (t[0] > t[1] || t[0] > t[2]) t = {t[1], t[2], t[0]};
        return t;
    };
    std::size_t different = 0;
    for (std::size_t f = 0; f < ours.triangles.size(); ++f)
        different += turned(ours.triangles[f]) != turned(theirs.triangles[f]);
    CHECK(different == 0);
}

}  // namespace

TEST_CASE("OpenMesh reads the same from files of every format") {
    const std::string folder = std::filesystem::temp_directory_path().string();
    for (const auto& [name, mesh] : mesh_family()) {
        if (mesh.triangles.empty() || !survey_mesh(mesh).manifold() || name == "degenerate") continue;
        const std::pair<const char*, std::string> files[] = {{".ply", ply_of(mesh, "ascii")},
                                                             {".ply", ply_of(mesh, "binary_little_endian")},
                                                             {".ply", ply_of(mesh, "binary_big_endian")},
                                                             {".off", off_of(mesh)},
                                                             {".obj", obj_of(mesh)}};
        for (const auto& [extension, bytes] : files) {
            INFO(name << " " << extension);
            const std::string path = folder + "/vsplit-openmesh-" + std::to_string(::getpid()) + extension;
            REQUIRE(write_file(path, as_bytes(bytes), true).ok());
            const Mesh theirs = read_with_openmesh(path);
            std::filesystem::remove(path);
            ReadOptions options;
            options.weld = Weld::kNone;
            const auto ours = parse(bytes, extension, options);
            REQUIRE(ours.ok());
            check_same(ours->mesh, theirs);
            check_same(ours->mesh, mesh);
        }
    }
}

TEST_CASE("The shared models have the triangles that their makers say, and what OpenMesh reads") {
    const struct {
        const char* name;
        std::uint64_t triangles;
        bool closed;
    } models[] = {{"meshes/stanford-bunny.obj", 69451, false},
                  {"meshes/armadillo.obj", 86482, true},
                  {"meshes/nefertiti.obj", 99938, true},
                  {"meshes/igea.ply", 268686, true},
                  {"meshes/igea-1m.ply", 1074744, true},
                  {"meshes/fandisk.obj", 12946, true},
                  {"meshes/rocker-arm.obj", 20088, true},
                  {"meshes/spot.obj", 5856, true},
                  {"meshes/homer.obj", 12000, true}};
    for (const auto& model : models) {
        const auto path = corpus_file(model.name);
        if (!path) continue;
        INFO(model.name);
        const auto bytes = read_file(*path);
        REQUIRE(bytes.ok());
        const auto file = parse_mesh(*bytes, std::filesystem::path(*path).extension().string());
        REQUIRE(file.ok());
        CHECK(file->mesh.triangles.size() == model.triangles);
        const MeshSurvey s = survey_mesh(file->mesh);
        CHECK(s.manifold());
        CHECK(s.closed() == model.closed);
        // The largest takes OpenMesh some seconds, the bunny has vertices that no face uses.
        if (model.triangles > 300'000 || file->report.vertices_dropped_unused > 0) continue;
        check_same(file->mesh, read_with_openmesh(*path));
    }
}
