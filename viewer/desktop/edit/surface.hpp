// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Which vertices of a level a brush reaches, or a click selects.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "camera.hpp"

namespace vsplit::bake {
class TriangleTree;
}

namespace vsplit::studio {

/// The neighbourhoods of a mesh. Refers to the mesh, which must not change meanwhile.
class Surface {
  public:
    /// With `seams`, vertices at one place are one to the brush.
    Surface(std::span<const Float3> positions, std::span<const Triangle> triangles, bool seams);

    ~Surface();

    std::size_t vertices() const { return positions_.size(); }
    /// Vertices within `radius` of the point that are reached from `seed`'s triangle through such: a brush
    /// does not paint through to the other side. The triangle's own corners are always in.
    std::vector<std::uint32_t> within(Double3 point, std::uint32_t triangle, double radius);
    /// The first triangle that the ray meets, from either side.
    std::optional<Hit> pick(const Ray& ray);
    /// The triangle next to the point; nothing if none is within `reach`.
    std::optional<Hit> nearest(Double3 point, double reach);
    /// Makes the tree that pick() and nearest() need, if it is not there.
    void prepare();
    /// All that is connected with the vertex, through triangles or seams.
    std::vector<std::uint32_t> component(std::uint32_t vertex) const;
    /// Vertices where the surface turns by more than so much: the largest angle between the normals of two
    /// triangles at it.
    std::vector<std::uint32_t> sharper_than(double degrees) const;
    /// The same angle, of every vertex.
    std::vector<float> turns() const;
    std::span<const std::uint32_t> star(std::uint32_t v) const {
        return {star_.data() + starts_[v], starts_[v + 1] - starts_[v]};
    }

  private:
    std::span<const Float3> positions_;
    std::span<const Triangle> triangles_;
    std::vector<std::uint32_t> starts_, star_;
    std::vector<std::uint32_t> next_twin_;  // a ring of the vertices at one place; empty without seams
    Mesh mesh_;                             // the tree's
    std::unique_ptr<bake::TriangleTree> tree_;
    std::vector<std::uint32_t> seen_;  // by which call
    std::uint32_t call_ = 0;
};

/// The point seen in the plane through the centre of the box that is perpendicular to `axis` (0 x, 1 y, 2 z).
Double3 mirrored(Double3 point, const Box& box, int axis);
/// Whether the surface has an inside: each edge is run along as often one way as the other, and what it
/// bounds is a positive volume. Vertices at one place are one.
bool closed(std::span<const Float3> positions, std::span<const Triangle> triangles);

}  // namespace vsplit::studio
