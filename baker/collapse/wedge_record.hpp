// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What is written down of wedges at each collapse, beside the Record.
#pragma once

#include <cstdint>
#include <vector>

#include "record.hpp"
#include "wedges.hpp"

namespace vsplit::bake {

/// Steps are parallel to those of a Record; a vanished component has an empty one.
struct WedgeRecord {
    /// The pairs of a collapse, and the wedges of the vertex that stayed with the values they had before.
    void add(const std::vector<WedgePair>& pairs, bool swapped, const std::vector<std::uint32_t>& moved,
             const WedgeValues& values);
    void add_vanished() { ends.push_back({std::uint32_t(pairs.size()), std::uint32_t(moved.size())}); }
    /// Appends steps `begin` to `end` - 1 of another one.
    void append(const WedgeRecord& other, std::size_t begin, std::size_t end, std::uint32_t stride);

    struct Ends {
        std::uint32_t pairs, moved;
    };
    std::vector<Ends> ends;
    std::vector<WedgePair> pairs;
    std::vector<std::uint32_t> moved;
    std::vector<float> moved_values;  ///< WedgeValues::stride() of each of `moved`.
};

/// Record::finish() of a mesh with wedges. `input` names the attributes; `weights` are those of points.
ProgressiveMesh finish_with_wedges(const Record& record, const WedgeRecord& wedges, const StarMesh& mesh,
                                   const WedgeValues& values, const Mesh& input,
                                   const std::vector<float>& weights);

}  // namespace vsplit::bake
