// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>

#include "peer_cgal.hpp"

namespace vsplit::bench {
namespace {

namespace Sms = CGAL::Surface_mesh_simplification;

Result<std::vector<Mesh>> simplify(const Mesh& mesh, std::span<const std::size_t> targets) {
    return cgal_simplify(mesh, targets, [](CgalMesh& work, CgalStop stop) {
        Sms::edge_collapse(work, stop,
                           CGAL::parameters::get_cost(Sms::LindstromTurk_cost<CgalMesh>())
                               .get_placement(Sms::LindstromTurk_placement<CgalMesh>()));
    });
}

}  // namespace

Peer cgal_lindstrom_turk() {
    return {"CGAL LT", "CGAL " CGAL_VERSION_STR,
            "Lindstrom-Turk cost and placement, defaults (memoryless); snapshots on one way down", "",
            simplify};
}

}  // namespace vsplit::bench
