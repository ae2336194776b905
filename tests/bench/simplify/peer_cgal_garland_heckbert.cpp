// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Simple_cartesian.h>  // Before the policies: they call number functions that only it declares.
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>

#include "peer_cgal.hpp"

namespace vsplit::bench {
namespace {

namespace Sms = CGAL::Surface_mesh_simplification;

/// As CGAL's own example runs it: the placement bounded by the change of normals.
Result<std::vector<Mesh>> simplify(const Mesh& mesh, std::span<const std::size_t> targets) {
    return cgal_simplify(mesh, targets, [](CgalMesh& work, CgalStop stop) {
        using Policies = Sms::GarlandHeckbert_plane_policies<CgalMesh, CgalKernel>;
        Policies policies(work);
        Sms::Bounded_normal_change_placement<Policies::Get_placement> placement(policies.get_placement());
        Sms::edge_collapse(work, stop,
                           CGAL::parameters::get_cost(policies.get_cost()).get_placement(placement));
    });
}

}  // namespace

Peer cgal_garland_heckbert() {
    return {"CGAL GH", "CGAL " CGAL_VERSION_STR,
            "Garland-Heckbert plane policies, bounded normal change as in CGAL's example; snapshots on one "
            "way down",
            "", simplify};
}

}  // namespace vsplit::bench
