// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A simplifier under test: vsplit's own engine or somebody else's, behind one call.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "vsplit/mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit::bench {

struct Peer {
    std::string name;     ///< "CGAL LT"
    std::string library;  ///< "CGAL 5.5.1"
    std::string setting;  ///< What was chosen, in words.
    std::string missing;  ///< Why it was not built; empty if it was.
    /// One mesh for each target, in order: the first that has at most so many triangles, or the coarsest
    /// reached. Targets descend. Converts from and to the plain mesh on its own. May throw: it runs in a
    /// process of its own.
    std::function<Result<std::vector<Mesh>>(const Mesh&, std::span<const std::size_t> targets)> simplify;
};

Peer vsplit_engine();
Peer cgal_lindstrom_turk();
Peer cgal_garland_heckbert();
Peer openmesh_quadric();
Peer vtk_quadric();
Peer meshoptimizer();

/// vsplit's engine first; then every peer, those that are missing too.
std::vector<Peer> all_peers();

}  // namespace vsplit::bench
