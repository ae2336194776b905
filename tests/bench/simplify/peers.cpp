// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "peer.hpp"

namespace vsplit::bench {
namespace {

#if !defined(VSPLIT_BENCH_CGAL) || !defined(VSPLIT_BENCH_OPENMESH) || !defined(VSPLIT_BENCH_VTK) || \
    !defined(VSPLIT_BENCH_MESHOPTIMIZER)
Peer missing(const char* name, const char* package) {
    return {name, "", "", std::string("not found when this was configured: ") + package, {}};
}
#endif

}  // namespace

std::vector<Peer> all_peers() {
    std::vector<Peer> peers{vsplit_engine()};
#ifdef VSPLIT_BENCH_CGAL
    peers.push_back(cgal_lindstrom_turk());
    peers.push_back(cgal_garland_heckbert());
#else
    peers.push_back(missing("CGAL LT", "libcgal-dev (or VSPLIT_WITH_CGAL is off)"));
    peers.push_back(missing("CGAL GH", "libcgal-dev, libeigen3-dev (or VSPLIT_WITH_CGAL is off)"));
#endif
#ifdef VSPLIT_BENCH_VTK
    peers.push_back(vtk_quadric());
#else
    peers.push_back(missing("VTK", "libvtk9-dev"));
#endif
#ifdef VSPLIT_BENCH_OPENMESH
    peers.push_back(openmesh_quadric());
#else
    peers.push_back(missing("OpenMesh", "libopenmesh-dev"));
#endif
#ifdef VSPLIT_BENCH_MESHOPTIMIZER
    peers.push_back(meshoptimizer());
#else
    peers.push_back(missing("meshoptimizer", "libmeshoptimizer-dev"));
#endif
    return peers;
}

}  // namespace vsplit::bench
