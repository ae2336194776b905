// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What is written down of wedges at each collapse, beside the Record.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "record.hpp"
#include "wedges.hpp"

namespace vsplit::bake {

/// Steps are parallel to those of a Record; a vanished component has an empty one.
struct WedgeRecord {
    /// The pairs of a collapse, the wedges of the vertex that stayed and those transferred to it, with the
    /// values they had before.
    void add(const WedgeStar& star, const WedgeValues& values);
    /// Closes a step, once the mesh is folded; of a vanished component nothing was added.
    void close() {
        ends.push_back({std::uint32_t(pairs.size()), std::max(own_, ends.empty() ? 0 : ends.back().moved),
                        std::uint32_t(moved.size()), std::uint32_t(corner_wedges.size())});
    }
    /// Which wedge each corner had before; beside Record::corners_changed.
    std::vector<std::uint32_t> corner_wedges;
    /// Appends steps `begin` to `end` - 1 of another one.
    void append(const WedgeRecord& other, std::size_t begin, std::size_t end, std::uint32_t stride);

    struct Ends {
        std::uint32_t pairs = 0;
        std::uint32_t own = 0;  ///< In `moved`: the wedges of the vertex that stayed end here.
        std::uint32_t moved = 0;
        std::uint32_t corners = 0;
    };
    std::vector<Ends> ends;
    std::vector<WedgePair> pairs;
    std::vector<std::uint32_t> moved;
    std::vector<float> moved_values;  ///< WedgeValues::stride() of each of `moved`.

  private:
    std::uint32_t own_ = 0;  // of the step that is open
};

/// Where each pose has the vertices of a record: places at birth, and of moves.
struct PosedRecord {
    std::vector<Float3> positions, moves;
};

/// What else the end of a record tells.
struct WedgeExtras {
    std::vector<PosedRecord> posed;  ///< One a pose.
    bool wants_births = false;       ///< Also of a mesh without wedges.
    std::vector<std::uint32_t>
        births;  ///< Per vertex of the input, its number; kNoVertex if no triangle has it.
};

/// Record::finish() of a mesh with wedges. `input` names the attributes; `weights` are those of points.
ProgressiveMesh finish_with_wedges(const Record& record, const WedgeRecord& wedges, const StarMesh& mesh,
                                   const WedgeValues& values, const Mesh& input,
                                   const std::vector<float>& weights, WedgeExtras& extras);

}  // namespace vsplit::bake
