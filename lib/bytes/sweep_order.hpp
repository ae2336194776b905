// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The order in which sweeps ask vertices: each right behind the parent that bore it, so that what is near in
// the order is near on the surface, and vertices and triangles of one sweep are born near each other in
// memory too.
#pragma once

#include <cstdint>
#include <vector>

#include "vsplit/progressive_mesh.hpp"

namespace vsplit {

class SweepOrder {
  public:
    void reserve(std::size_t vertices) { next_.reserve(vertices); }
    /// The next vertex: right behind its parent, at the end without one (kNoVertex).
    void add(std::uint32_t parent) {
        const auto v = static_cast<std::uint32_t>(next_.size());
        if (parent == kNoVertex) parent = last_;
        if (parent == last_) last_ = v;
        if (parent == kNoVertex) {
            next_.push_back(kNoVertex);
            return;
        }
        next_.push_back(next_[parent]);
        next_[parent] = v;
    }
    /// All vertices, in order.
    void list(std::vector<std::uint32_t>& out) const {
        out.resize(next_.size());
        std::uint32_t v = 0;
        for (std::uint32_t& place : out) {
            place = v;
            v = next_[v];
        }
    }

  private:
    std::vector<std::uint32_t> next_;  // the first vertex stays the first
    std::uint32_t last_ = kNoVertex;
};

}  // namespace vsplit
