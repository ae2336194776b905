// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The connected parts of a mesh, which may vanish as a whole once they are small against the error.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "star_mesh.hpp"

namespace vsplit::bake {

class Components {
  public:
    /// A part vanishes only when at most this many of its triangles are left: one split has to bring it
    /// back. Parts with many holes through them end no smaller.
    static constexpr std::uint32_t kMaxVanishing = 256;

    /// `part_of`: empty, or one per vertex of the input; distances between different parts mean nothing.
    Components(const StarMesh& mesh, std::span<const std::uint32_t> part_of);

    std::uint32_t count() const { return static_cast<std::uint32_t>(triangles_.size()); }
    std::uint32_t of(std::uint32_t vertex) const { return component_.empty() ? 0 : component_[vertex]; }
    std::uint32_t live_triangles(std::uint32_t component) const { return triangles_[component]; }
    /// May run at once for several regions of the mesh.
    void lose(std::uint32_t component, std::uint32_t triangles) {
        std::atomic_ref(triangles_[component]).fetch_sub(triangles, std::memory_order_relaxed);
    }

    /// How far its points may be from the rest of the mesh, working units: its extent and the gap to the
    /// nearest larger one. Of the largest of a scene's part, which others hold in some place: its diagonal.
    double reach(std::uint32_t component) const { return reach_[component]; }
    /// The last part never vanishes, nor one with a fixed vertex or painted weight above 1.
    bool may_vanish(std::uint32_t component) const { return alive_ > 1 && !kept_[component]; }
    void keep(std::uint32_t component) { kept_[component] = true; }
    void vanish(std::uint32_t component) {
        triangles_[component] = 0;
        --alive_;
    }
    /// Some vertex of the part, from which to collect the others.
    std::vector<std::uint32_t> live_vertices(const StarMesh& mesh, std::uint32_t component) const;

  private:
    std::vector<std::uint32_t> component_;  // of each vertex; empty if there is one only
    std::vector<std::uint32_t> triangles_;  // live ones of each component
    std::vector<std::uint32_t> first_;      // its vertices: members_[first_[c] .. first_[c + 1])
    std::vector<std::uint32_t> members_;
    std::vector<double> reach_;
    std::vector<bool> kept_;
    std::uint32_t alive_ = 0;
};

}  // namespace vsplit::bake
