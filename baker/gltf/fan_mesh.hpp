// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Triangles and what is around each vertex, for vertex splits that name two neighbours and no triangles.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "vsplit/mesh.hpp"
#include "vsplit/progressive_mesh.hpp"

namespace vsplit::bake {

class FanMesh {
  public:
    FanMesh(std::span<const Triangle> triangles, std::size_t vertices) : around_(vertices) {
        for (const Triangle& t : triangles) add(t);
    }

    std::size_t vertices() const { return around_.size(); }
    std::size_t triangles() const { return triangles_.size(); }
    const Triangle& triangle(std::uint32_t t) const { return triangles_[t]; }
    std::size_t around(std::uint32_t vertex) const { return around_[vertex].size(); }

    /// Those of the triangles around `vertex` that go over to a new one: counter-clockwise from the edge to
    /// `right` to the edge to `left`, ascending by number. kNoVertex for a side without a triangle. `fault`:
    /// why there are none such.
    struct Goers {
        const char* fault = nullptr;
        std::vector<std::uint32_t> triangles;
    };
    Goers goers(std::uint32_t vertex, std::uint32_t left, std::uint32_t right) const {
        Goers out;
        if (left == right) return {"has no neighbours, or one twice", {}};
        struct Wing {
            std::uint32_t from, to, triangle;  // (vertex, from, to)
        };
        std::vector<Wing> by_from;
        for (const std::uint32_t t : around_[vertex]) {
            const Triangle& c = triangles_[t];
            const std::size_t k = c[0] == vertex ? 0 : c[1] == vertex ? 1 : 2;
            by_from.push_back({c[(k + 1) % 3], c[(k + 2) % 3], t});
        }
        std::vector<Wing> by_to = by_from;
        std::sort(by_from.begin(), by_from.end(),
                  [](const Wing& a, const Wing& b) { return a.from < b.from; });
        std::sort(by_to.begin(), by_to.end(), [](const Wing& a, const Wing& b) { return a.to < b.to; });
        for (std::size_t i = 1; i < by_from.size(); ++i)
            if (by_from[i].from == by_from[i - 1].from || by_to[i].to == by_to[i - 1].to)
                return {"splits a vertex whose triangles are no fan", {}};
        const auto from = [&](std::uint32_t v) {
            const auto it = std::lower_bound(by_from.begin(), by_from.end(), v,
                                             [](const Wing& a, std::uint32_t b) { return a.from < b; });
            return it != by_from.end() && it->from == v ? &*it : nullptr;
        };
        const auto to = [&](std::uint32_t v) {
            const auto it = std::lower_bound(by_to.begin(), by_to.end(), v,
                                             [](const Wing& a, std::uint32_t b) { return a.to < b; });
            return it != by_to.end() && it->to == v ? &*it : nullptr;
        };
        for (const std::uint32_t side : {left, right})
            if (side != kNoVertex && from(side) == nullptr && to(side) == nullptr)
                return {"names a neighbour that is none", {}};
        if (right != kNoVertex) {
            std::uint32_t at = right;
            for (const Wing* wing = from(at); wing != nullptr && at != left; wing = from(at)) {
                out.triangles.push_back(wing->triangle);
                at = wing->to;
                if (at == right) break;  // All around.
            }
            if (left != kNoVertex && at != left) return {"names neighbours that no fan leads between", {}};
            if (left == kNoVertex && at == right && !out.triangles.empty())
                return {"opens one side of a vertex within the surface", {}};
        } else {
            std::uint32_t at = left;
            for (const Wing* wing = to(at); wing != nullptr; wing = to(at)) {
                out.triangles.push_back(wing->triangle);
                at = wing->from;
                if (at == left) return {"opens one side of a vertex within the surface", {}};
            }
        }
        std::sort(out.triangles.begin(), out.triangles.end());
        return out;
    }

    std::uint32_t add_vertex() {
        around_.emplace_back();
        return std::uint32_t(around_.size() - 1);
    }
    void add(const Triangle& t) {
        for (const std::uint32_t v : t) around_[v].push_back(std::uint32_t(triangles_.size()));
        triangles_.push_back(t);
    }
    /// The corner `corner` (0 to 2) of a triangle becomes another vertex.
    void change(std::uint32_t triangle, std::size_t corner, std::uint32_t vertex) {
        std::uint32_t& now = triangles_[triangle][corner];
        std::erase(around_[now], triangle);
        now = vertex;
        around_[vertex].push_back(triangle);
    }

  private:
    std::vector<Triangle> triangles_;
    std::vector<std::vector<std::uint32_t>> around_;
};

}  // namespace vsplit::bake
