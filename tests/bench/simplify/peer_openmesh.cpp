// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include "peer.hpp"

namespace vsplit::bench {
namespace {

using Half = OpenMesh::TriMesh_ArrayKernelT<>;
using Decimater = OpenMesh::Decimater::DecimaterT<Half>;
using Quadric = OpenMesh::Decimater::ModQuadricT<Half>;

/// False if OpenMesh refuses a face (it would be non-manifold).
bool fill(Half& half, const Mesh& mesh) {
    half.reserve(mesh.positions.size(), mesh.positions.size() + mesh.triangles.size(), mesh.triangles.size());
    for (const Float3& p : mesh.positions) half.add_vertex({p.x, p.y, p.z});
    for (const Triangle& t : mesh.triangles)
        if (!half.add_face(half.vertex_handle(t[0]), half.vertex_handle(t[1]), half.vertex_handle(t[2]))
                 .is_valid())
            return false;
    return true;
}

Mesh plain(const Half& half) {
    Mesh mesh;
    for (const auto v : half.vertices())
        mesh.positions.push_back({half.point(v)[0], half.point(v)[1], half.point(v)[2]});
    for (const auto f : half.faces()) {
        Triangle t{};
        std::size_t k = 0;
        for (const auto v : f.vertices()) t[k++] = std::uint32_t(v.idx());
        mesh.triangles.push_back(t);
    }
    return mesh;
}

Result<std::vector<Mesh>> simplify(const Mesh& mesh, std::span<const std::size_t> targets) {
    std::vector<Mesh> levels;
    omerr().disable();  // It reports every refused face on stderr.
    for (const std::size_t target : targets) {
        Half half;
        if (!fill(half, mesh))
            return Error{ErrorCode::kUnsupported, "OpenMesh refuses a face: the input is not manifold",
                         Error::kNowhere, 0};
        half.request_face_normals();
        half.update_face_normals();
        Decimater decimater(half);
        OpenMesh::Decimater::ModHandleT<Quadric> quadric;
        decimater.add(quadric);
        decimater.module(quadric).unset_max_err();
        if (!decimater.initialize())
            return Error{ErrorCode::kUnsupported, "OpenMesh's decimater does not start", Error::kNowhere, 0};
        decimater.decimate_to_faces(0, target);
        half.garbage_collection();
        levels.push_back(plain(half));
    }
    return levels;
}

}  // namespace

Peer openmesh_quadric() {
    return {"OpenMesh", "OpenMesh " + std::to_string(OM_GET_VER) + "." + std::to_string(OM_GET_MAJ),
            "DecimaterT, ModQuadricT without limit, no recorder; a run for each ratio", "", simplify};
}

}  // namespace vsplit::bench
