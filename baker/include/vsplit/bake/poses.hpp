// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// How skins and morph targets put the vertices of a mesh at chosen moments: what a collapse is judged by
// besides the bind pose.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace vsplit::bake {

/// One moment of one skin.
struct Pose {
    /// Per joint, from the mesh's coordinates in the bind pose to the posed ones, in the same unit: three
    /// rows of an affine matrix. Empty: not skinned. Joints that are not there stay where they are.
    std::vector<std::array<double, 12>> joints;
    /// Per morph target, its weight; targets that are not there have 0. Offsets are added before the joints
    /// act.
    std::vector<double> morphs;
};

/// Poses of a mesh. Vertices of one set are posed together; a set has as many poses as it has, and others
/// stay where they are meanwhile.
struct PoseSets {
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::vector<Pose>> sets;
    /// Per vertex its set, or kNone: it never moves.
    std::vector<std::uint32_t> set_of;
    bool empty() const { return sets.empty(); }
};

}  // namespace vsplit::bake
