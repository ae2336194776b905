// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// View-dependent refinement: the splits of a progressive mesh applied only where a camera sees them (Hoppe,
// View-dependent refinement of progressive meshes, SIGGRAPH 1997; Hu, Sander, Hoppe, Parallel view-dependent
// refinement of progressive meshes, I3D 2009, for an index buffer that is kept packed).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "vsplit/camera.hpp"
#include "vsplit/progressive_mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit {

/// Bounds of one call of ViewMesh::update() or refine_to().
struct ViewBudget {
    std::size_t max_splits = ~std::size_t{0};  ///< Applied or undone, at most.
    /// Places looked at, at most; the next call goes on where this one ended.
    std::size_t max_visits = ~std::size_t{0};
    /// Asked every few hundred visits or splits; true ends the call. May be empty.
    std::function<bool()> out_of_time{};
};

struct ViewUpdated {
    std::size_t refined = 0, coarsened = 0;  ///< Splits applied and undone.
    std::size_t visits = 0;
    bool settled = false;  ///< All was looked at and nothing had to change; of refine_to(): it is there.
};

/// What a mesh that is still arriving will have in the end; see FileInfo.
struct ViewRoom {
    std::uint32_t vertices = 0, triangles = 0, splits = 0, corner_changes = 0, moves = 0;
};

/// A mesh refined differently in different places (selective refinement): where a camera looks, or by
/// priorities, such as painted weights, under a budget of triangles. Every triangle of it is, corner by
/// corner and place by place, a triangle of one of the uniform levels: a split is applied only after the
/// splits that last touched the triangles around its vertices, and undone before them. So nothing folds over
/// that did not in the sequence, and closed meshes stay closed.
///
/// Vertices keep the numbers that they have in the file, so that a vertex buffer of the whole mesh is
/// uploaded once; the index buffer is packed: a triangle that dies is replaced by the last one. With all
/// splits applied the triangles are those of the full mesh, in another order. Undoing them all restores the
/// base mesh; undoing them in the order in which they were applied backward restores every byte.
/// Allocates in make(), append(), set_priority(), use_weights() and rank(), nowhere else. Not synchronised;
/// objects are independent.
class ViewMesh {
  public:
    /// Contents must be sound (progressive_mesh_fault() is null). Time is linear in the number of triangles
    /// around each split's vertices. Errors: kLimit if those are too many (hubs of many thousand triangles
    /// that are split again and again). With `room`, append() within it moves no data, and memory for further
    /// splits' planning is kept until there are room.splits of them.
    static Result<ViewMesh> make(ProgressiveMesh mesh, const ViewRoom& room = {});
    ViewMesh(ViewMesh&&) noexcept;
    ViewMesh& operator=(ViewMesh&&) noexcept;
    ~ViewMesh();

    /// Takes the splits of `mesh` that are new; what is drawn stays. `mesh` is what it was before and more,
    /// at level 0, as BlockDecoder::mesh() is; it must be sound. Errors: kLimit as make(), and this object is
    /// then only good for drawing; kArgument: more splits than make() was given room for.
    Status append(const ProgressiveMesh& mesh);
    /// Splits known.
    std::size_t available() const;

    /// Looks at the active vertices and applies and undoes splits. Always leaves a mesh as described above.
    ViewUpdated update(const View& view, const ViewBudget& budget = {});

    /// Priorities: by how much an error counts more (or less) than elsewhere, for update() and refine_to().
    /// One for each vertex from 0 on, of as many as wanted, finite and not negative; those that follow take
    /// their parent's, and 1 without one (Hoppe's rule for weights set at run time, inherit_weights()).
    /// Empty: all alike. A split has the largest priority of its new vertices. Errors: kArgument.
    Status set_priority(std::span<const float> of_vertices);
    /// The file's painted weights are the priorities, also of splits that are yet to come. All alike if it
    /// has none.
    void use_weights();
    /// The largest of the priorities of splits known; 1 if all are alike.
    float largest_priority() const;

    /// The other way to refine: all splits in the order of their error (Split::error) times their priority, a
    /// split being as important as the most important that has to wait for it. Each beginning of that order
    /// is a mesh, whose length is its rank. With all priorities alike, ranks are the levels of the file.
    /// Brings the order up to date with priorities and splits: O(n log n); nothing if it is.
    void rank();
    /// How many splits the order has: available() after rank(), 0 when priorities were set since.
    std::size_t ranked() const;
    /// The largest rank with at most `count` triangles (vertices); 0 if there is none.
    std::size_t rank_for_triangles(std::uint64_t count) const;
    std::size_t rank_for_vertices(std::uint64_t count) const;
    /// The smallest rank from which on no error times priority is above `error`; ranked() if there is none.
    std::size_t rank_for_error(double error) const;
    /// Error times priority of the next split; 0 at ranked().
    float error_at_rank(std::size_t rank) const;
    /// Towards a rank, clamped to ranked(): first undoes what does not belong to it, the least important
    /// first, then applies the most important first.
    ViewUpdated refine_to(std::size_t rank, const ViewBudget& budget = {});

    /// What to draw.
    std::span<const Triangle> triangles() const;
    /// Of the triangles, one each; empty if the mesh has none.
    std::span<const std::uint32_t> groups() const;
    /// Of all vertices known, active or not.
    std::span<const Float3> positions() const;
    /// Empty if the mesh has none, else one for each vertex.
    std::span<const float> weights() const;
    std::span<const std::uint32_t> parents() const;
    const std::vector<Attribute>& attributes() const;
    /// Of a triangle of triangles(): its number in the file.
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
    /// at triangles().size()): indices, and vertices that a split moved or that are new. Everything at first.
    Dirty take_dirty();

    /// Bytes allocated.
    std::size_t memory() const;

  private:
    struct State;
    explicit ViewMesh(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace vsplit
