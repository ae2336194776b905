// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "unsplit.hpp"

#include <algorithm>

namespace vsplit::bake {

Unsplitter::Unsplitter(const ProgressiveMesh& mesh)
    : mesh_(mesh),
      left_(std::uint32_t(mesh.splits.size())),
      positions_(mesh.positions),
      before_(mesh.moves.size()),
      corners_(mesh.triangles),
      first_(mesh.positions.size(), kNoVertex),
      next_(3 * mesh.triangles.size(), kNoVertex) {
    for (std::size_t i = 0; i < mesh.moves.size(); ++i) {
        Float3& place = positions_[mesh.moves[i].vertex];
        before_[i] = place;
        place = mesh.moves[i].position;
    }
    for (const CornerChange& change : mesh.corner_changes)
        corners_[change.corner / 3][change.corner % 3] = change.vertex;
    for (std::uint32_t t = 0; t < corners_.size(); ++t)
        for (std::uint32_t k = 0; k < 3; ++k) link(3 * t + k, corners_[t][k]);
}

Mesh Unsplitter::full(const ProgressiveMesh& mesh) {
    Mesh result;
    result.positions = mesh.positions;
    result.triangles = mesh.triangles;
    for (const VertexMove& move : mesh.moves) result.positions[move.vertex] = move.position;
    for (const CornerChange& change : mesh.corner_changes)
        result.triangles[change.corner / 3][change.corner % 3] = change.vertex;
    return result;
}

std::uint32_t Unsplitter::step() {
    const Split& split = mesh_.splits[--left_];
    const std::uint32_t changes = left_ == 0 ? 0 : mesh_.splits[left_ - 1].corners_end,
                        moves = left_ == 0 ? 0 : mesh_.splits[left_ - 1].moves_end;
    acts_.clear();
    for (std::uint32_t i = changes; i < split.corners_end; ++i) {
        const CornerChange& change = mesh_.corner_changes[i];
        const std::uint32_t parent = mesh_.parents[change.vertex];
        corners_[change.corner / 3][change.corner % 3] = parent;
        link(change.corner, parent);
    }
    for (std::uint32_t v = gone_begin(); v < gone_end(); ++v) {
        first_[v] = kNoVertex;
        if (mesh_.parents[v] != kNoVertex) acts_.push_back(mesh_.parents[v]);
    }
    for (std::uint32_t i = split.moves_end; i-- > moves;) {
        positions_[mesh_.moves[i].vertex] = before_[i];
        acts_.push_back(mesh_.moves[i].vertex);
    }
    std::sort(acts_.begin(), acts_.end());
    acts_.erase(std::unique(acts_.begin(), acts_.end()), acts_.end());
    return left_;
}

}  // namespace vsplit::bake
