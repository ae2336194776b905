// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// CGAL's edge_collapse with any policy, snapshots taken on the way down: the same sequence as a run for each
// target.
#pragma once

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/version.h>

#include <optional>

#include "peer.hpp"

namespace vsplit::bench {

using CgalKernel = CGAL::Simple_cartesian<double>;
using CgalMesh = CGAL::Surface_mesh<CgalKernel::Point_3>;

/// Nothing if CGAL refuses a face (it would be non-manifold).
inline std::optional<CgalMesh> to_cgal(const Mesh& mesh) {
    CgalMesh out;
    out.reserve(CgalMesh::size_type(mesh.positions.size()),
                CgalMesh::size_type(mesh.positions.size() + mesh.triangles.size()),
                CgalMesh::size_type(mesh.triangles.size()));
    for (const Float3& p : mesh.positions) out.add_vertex({p.x, p.y, p.z});
    for (const Triangle& t : mesh.triangles)
        if (out.add_face(CgalMesh::Vertex_index(t[0]), CgalMesh::Vertex_index(t[1]),
                         CgalMesh::Vertex_index(t[2])) == CgalMesh::null_face())
            return std::nullopt;
    return out;
}

inline Mesh from_cgal(const CgalMesh& mesh) {
    Mesh out;
    std::vector<std::uint32_t> number(mesh.num_vertices());
    for (const auto v : mesh.vertices()) {
        number[v] = std::uint32_t(out.positions.size());
        const auto& p = mesh.point(v);
        out.positions.push_back({float(p.x()), float(p.y()), float(p.z())});
    }
    for (const auto f : mesh.faces()) {
        Triangle t{};
        std::size_t k = 0;
        for (const auto v : mesh.vertices_around_face(mesh.halfedge(f))) t[k++] = number[v];
        out.triangles.push_back(t);
    }
    return out;
}

struct CgalSnapshots {
    std::span<const std::size_t> targets;
    std::vector<Mesh> levels;

    bool take(const CgalMesh& mesh) {
        while (levels.size() < targets.size() && mesh.number_of_faces() <= targets[levels.size()])
            levels.push_back(from_cgal(mesh));
        return levels.size() == targets.size();
    }
};

/// Asked before every collapse; CGAL copies it, so the snapshots live outside.
struct CgalStop {
    CgalSnapshots* snapshots;

    template <class Cost, class Profile>
    bool operator()(const Cost&, const Profile& profile, std::size_t, std::size_t) const {
        return snapshots->take(profile.surface_mesh());
    }
};

/// `collapse(mesh, stop)` runs edge_collapse with its policies.
template <class Collapse>
Result<std::vector<Mesh>> cgal_simplify(const Mesh& mesh, std::span<const std::size_t> targets,
                                        const Collapse& collapse) {
    auto work = to_cgal(mesh);
    if (!work)
        return Error{ErrorCode::kUnsupported, "CGAL refuses a face: the input is not manifold",
                     Error::kNowhere, 0};
    CgalSnapshots snapshots{targets, {}};
    collapse(*work, CgalStop{&snapshots});
    snapshots.take(*work);
    while (snapshots.levels.size() < targets.size())
        snapshots.levels.push_back(from_cgal(*work));  // It stopped short.
    return std::move(snapshots.levels);
}

}  // namespace vsplit::bench
