// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "vsplit/mesh.hpp"

#include <cmath>

namespace vsplit {

const char* mesh_fault(const Mesh& mesh) {
    for (const Float3& p : mesh.positions)
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            return "a position is not finite";
    for (const Triangle& t : mesh.triangles) {
        for (const std::uint32_t v : t)
            if (v >= mesh.positions.size()) return "a triangle names a vertex that does not exist";
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return "a triangle names a vertex twice";
    }
    if (!mesh.weights.empty() && mesh.weights.size() != mesh.positions.size())
        return "there are not as many weights as vertices";
    for (const float w : mesh.weights)
        if (!(w >= 0)) return "a weight is negative or not a number";
    return nullptr;
}

}  // namespace vsplit
