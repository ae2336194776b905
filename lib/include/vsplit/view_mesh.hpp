// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// View-dependent refinement: the splits of a progressive mesh applied only where a camera sees them (Hoppe,
// View-dependent refinement of progressive meshes, SIGGRAPH 1997; Hu, Sander, Hoppe, Parallel view-dependent
// refinement of progressive meshes, I3D 2009, for an index buffer that is kept packed).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "vsplit/progressive_mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit {

/// Half-space x * p.x + y * p.y + z * p.z + w >= 0 with (x, y, z) of length 1.
struct ViewPlane {
    float x = 0, y = 0, z = 0, w = 0;
};

/// What a perspective camera sees of the object, all in the object's own space and units.
struct View {
    Float3 eye;
    /// Pixels that a length of 1 spans at distance 1: viewport height / (2 tan(vertical field of view / 2)).
    float pixels_at_distance_1 = 1000;
    /// The error on the screen that is not worth a split. 0 or less: every split within the planes is.
    float pixels = 1;
    /// A split is undone when its error falls below this share of `pixels`, 0 to 1.
    float hysteresis = 0.8f;
    /// How much of an error counts at least where the surface faces the camera, 0 to 1. At silhouettes all
    /// of it does, and where the surface turns away none.
    float facing = 0.3f;
    /// The frustum; empty: everything is in it. Surface outside is kept as coarse as it can be.
    std::span<const ViewPlane> planes{};
};

/// Bounds of one call of ViewMesh::update().
struct ViewBudget {
    std::size_t max_splits = ~std::size_t{0};  ///< Applied or undone, at most.
    /// Places looked at, at most; the next call goes on where this one ended.
    std::size_t max_visits = ~std::size_t{0};
};

struct ViewUpdated {
    std::size_t refined = 0, coarsened = 0;  ///< Splits applied and undone.
    std::size_t visits = 0;
    bool settled = false;  ///< All was looked at and nothing had to change.
};

/// A mesh refined differently in different places. Every triangle of it is, corner by corner and place by
/// place, a triangle of one of the uniform levels: a split is applied only after the splits that last
/// touched the triangles around its vertices, and undone before them. So nothing folds over that did not in
/// the sequence, and closed meshes stay closed.
///
/// Vertices keep the numbers that they have in the file, so that a vertex buffer of the whole mesh is
/// uploaded once; the index buffer is packed: a triangle that dies is replaced by the last one. With all
/// splits applied the triangles are those of the full mesh, in another order. Undoing them all restores the
/// base mesh.
/// Allocates when made, and never again. Not synchronised; objects are independent.
class ViewMesh {
  public:
    /// Contents must be sound (progressive_mesh_fault() is null). Time is linear in the number of triangles
    /// around each split's vertices. Errors: kLimit if those are too many (hubs of many thousand triangles
    /// that are split again and again).
    static Result<ViewMesh> make(ProgressiveMesh mesh);
    ViewMesh(ViewMesh&&) noexcept;
    ViewMesh& operator=(ViewMesh&&) noexcept;
    ~ViewMesh();

    /// Looks at the active vertices and applies and undoes splits. Always leaves a mesh as described above.
    ViewUpdated update(const View& view, const ViewBudget& budget = {});

    /// What to draw.
    std::span<const Triangle> triangles() const;
    /// Of all vertices, active or not.
    std::span<const Float3> positions() const;
    /// Empty if the mesh has none, else one for each vertex.
    std::span<const float> weights() const;
    const std::vector<Attribute>& attributes() const;
    /// Of a triangle of triangles(): its number in the file, whose group is that of the material.
    std::uint32_t triangle_number(std::size_t index) const;
    std::size_t active_vertices() const;
    std::size_t active_splits() const;

    struct Range {
        std::uint32_t begin = 0, end = 0;
    };
    struct Dirty {
        std::vector<Range> triangles, vertices;
    };
    /// What changed since the last call, as ascending ranges of whole pages of 64 (the last of triangles ends
    /// at triangles().size()): indices, and vertices that a split moved. Everything at first.
    Dirty take_dirty();

    /// Bytes allocated.
    std::size_t memory() const;

  private:
    struct State;
    explicit ViewMesh(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace vsplit
