// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// LiveBuffers: the way back from patch lists to a record.
#include <bit>

#include "live_codes.hpp"
#include "vsplit/live_buffers.hpp"

namespace vsplit {

ProgressiveMesh LiveBuffers::record() {
    const std::size_t level = level_;
    const DirtyRanges dirty = dirty_;
    coarsen(level);
    ProgressiveMesh out;
    out.base_vertices = now_.vertices;
    out.base_triangles = now_.triangles;
    out.positions = positions_;
    out.weights = weights_;
    out.parents = parents_;
    out.triangles = triangles_;
    out.groups = groups_;
    for (const Values& values : attributes_) {
        out.attributes.push_back({{}, Semantic::kOther, values.components, values.alive});
        out.moved_values.emplace_back().reserve(values.moved.size());
    }
    out.splits.reserve(codes_.size());
    out.corner_changes.reserve(known_.corners);
    out.moves.reserve(known_.moves);
    const auto change = [&](std::uint32_t index, std::uint32_t vertex) {
        const std::uint8_t* const p = corners_.data() + std::size_t{corner_bytes_} * index;
        out.corner_changes.push_back({corner_bytes_ == 3 ? load<3>(p) : load<4>(p), vertex});
    };
    // Moves are differences: what they come to is the sum.
    std::vector<Float3> places = positions_;
    std::vector<float> weights = weights_;
    std::vector<std::vector<float>> values;
    for (const Values& of : attributes_) values.push_back(of.alive);
    const auto flip = [](float& value, std::uint32_t bits) {
        value = std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) ^ bits);
    };
    const auto move = [&](std::uint32_t index, std::uint32_t vertex) {
        Float3& place = places[vertex];
        if (packed_) {
            std::array<std::int32_t, 3> at = grid_point(grid_, place);
            for (std::size_t axis = 0; axis < 3; ++axis) at[axis] += steps_[index][axis];
            place = grid_place(grid_, at);
        } else {
            flip(place.x, moved_positions_[index][0]);
            flip(place.y, moved_positions_[index][1]);
            flip(place.z, moved_positions_[index][2]);
        }
        if (!weights.empty()) flip(weights[vertex], moved_weights_[index]);
        out.moves.push_back({vertex, place, weights.empty() ? 1 : weights[vertex]});
        for (std::size_t i = 0; i < attributes_.size(); ++i) {
            const std::size_t n = attributes_[i].components;
            for (std::size_t k = 0; k < n; ++k) {
                float& value = values[i][n * vertex + k];
                flip(value, attributes_[i].moved[n * index + k]);
                out.moved_values[i].push_back(value);
            }
        }
    };
    auto run = errors_.begin();
    Ends ends = now_;
    for (std::size_t split = 0; split < codes_.size(); ++split) {
        const Ends before = ends;
        pass(ends, split);
        const bool special = (codes_[split] & kSpecialBit) != 0;
        for (std::uint32_t i = before.corners; i < ends.corners; ++i)
            change(i, special ? special_corners_[before.special_corners + (i - before.corners)]
                              : before.vertices);
        for (std::uint32_t i = before.moves; i < ends.moves; ++i)
            move(i, special ? special_moves_[before.special_moves + (i - before.moves)]
                            : parents_[before.vertices]);
        if (run + 1 != errors_.end() && (run + 1)->split == split) ++run;
        out.splits.push_back({ends.vertices, ends.triangles, ends.corners, ends.moves, run->error});
    }
    refine(level);
    dirty_ = dirty;
    return out;
}

}  // namespace vsplit
