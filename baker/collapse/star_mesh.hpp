// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The mesh that is being collapsed: flat triangles, and for every vertex the list of its triangles.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "copies.hpp"
#include "vec.hpp"
#include "vertex.hpp"
#include "vsplit/mesh.hpp"
#include "vsplit/progressive_mesh.hpp"

namespace vsplit::bake {

/// Stars above this size are searched by sorting, and not fetched ahead.
inline constexpr std::size_t kLargeStar = 64;

/// A wedge (a vertex of a mesh with attributes) that goes, and the one that it becomes.
struct WedgePair {
    std::uint32_t child, parent;
};

/// Asks for a cache line. The empty assembly keeps g++ 12 from taking functions that only do this for ones
/// without effect, whose calls it drops.
inline void fetch_ahead(const void* line) {
    __builtin_prefetch(line);
    asm volatile("");
}

/// The vertices around one, each once, and how often its triangles run along the edge to it.
struct Neighbour {
    std::uint32_t vertex;
    std::uint32_t out = 0, in = 0;  ///< Triangles with the edge centre->vertex, vertex->centre.
    std::uint32_t here = 0, there = 0,
                  group = 0;  ///< Wedges and group of the first of them, if there are any.
    bool seam = false;        ///< Others have other ones.
    bool special() const { return seam || out != 1 || in != 1; }
};

/// Vertices and triangles are numbered along a Morton curve, so that neighbours share cache lines.
/// Positions stay the input's floats; working coordinates are exact differences to the centre, times a power
/// of two.
class StarMesh {
  public:
    explicit StarMesh(const Mesh& mesh);
    /// A mesh of points, with the wedges at its corners: edges where they or the groups differ are seams.
    StarMesh(const Mesh& mesh, const std::vector<Triangle>& corners,
             const std::vector<std::uint32_t>& groups);

    std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(vertices_.size()); }
    std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(triangles_.size()); }
    std::uint32_t live_triangles() const { return live_triangles_; }
    std::uint32_t live_vertices() const { return live_vertices_; }

    const Float3& raw_position(std::uint32_t v) const { return vertices_[v].position; }
    void set_raw_position(std::uint32_t v, const Float3& p) { vertices_[v].position = p; }
    Double3 position(std::uint32_t v) const { return work(vertices_[v].position); }
    Double3 work(const Float3& p) const {
        return {(double(p.x) - centre_.x) * scale_, (double(p.y) - centre_.y) * scale_,
                (double(p.z) - centre_.z) * scale_};
    }
    VSPLIT_INLINE Lanes3 work(const Lanes (&p)[4]) const {
        return {(p[0] - centre_.x) * scale_, (p[1] - centre_.y) * scale_, (p[2] - centre_.z) * scale_};
    }
    /// Of four vertices.
    VSPLIT_INLINE Lanes3 positions(const std::uint32_t* v) const {
        alignas(32) Lanes row[4];
        transpose(&vertices_[v[0]].position.x, &vertices_[v[1]].position.x, &vertices_[v[2]].position.x,
                  &vertices_[v[3]].position.x, row);
        return work(row);
    }
    /// The float position nearest to a working position.
    Float3 round(Double3 p) const {
        const double inverse = 1 / scale_;
        return {float(p.x * inverse + centre_.x), float(p.y * inverse + centre_.y),
                float(p.z * inverse + centre_.z)};
    }
    /// Working units per object unit, a power of two.
    double scale() const { return scale_; }

    /// A removed triangle keeps the corners that it had when it went.
    const Triangle& triangle(std::uint32_t t) const { return triangles_[t]; }
    bool has_wedges() const { return !corners_.empty(); }
    /// The wedges at a triangle's corners, in the input's numbers; a removed one keeps those it had.
    const Triangle& corners(std::uint32_t t) const { return corners_[t]; }
    /// 0 without groups.
    std::uint32_t group(std::uint32_t t) const { return groups_.empty() ? 0 : groups_[t]; }
    bool has_groups() const { return !groups_.empty(); }
    /// Of a mesh without wedges.
    const TriangleCopies& copies() const { return copies_; }
    TriangleCopies take_copies() { return std::move(copies_); }
    std::span<const std::uint32_t> star(std::uint32_t v) const {
        return {arena_.data() + vertices_[v].star_begin, vertices_[v].star_size};
    }
    const Vertex& vertex(std::uint32_t v) const { return vertices_[v]; }
    Vertex& vertex(std::uint32_t v) { return vertices_[v]; }
    VertexKind kind(std::uint32_t v) const { return vertices_[v].kind; }
    void fix(std::uint32_t v) { vertices_[v].kind = VertexKind::kFixed; }
    /// Says anew what kind of vertex it is, after what was around it changed its topology.
    struct ClassifyScratch {
        std::vector<Neighbour> ring;
        std::vector<std::uint32_t> roots;
    };
    void classify(std::uint32_t v, ClassifyScratch& scratch);

    /// Fetches ahead: the vertex; then the list of its star; then its triangles.
    void prefetch_vertex(std::uint32_t v) const { fetch_ahead(&vertices_[v]); }
    void prefetch_triangle(std::uint32_t t) const { fetch_ahead(&triangles_[t]); }
    void prefetch_star(std::uint32_t v) const { fetch_ahead(arena_.data() + vertices_[v].star_begin); }
    void prefetch_triangles(std::uint32_t v) const {
        if (vertices_[v].star_size > kLargeStar) return;
        for (const std::uint32_t t : star(v)) fetch_ahead(&triangles_[t]);
    }
    /// Twice the area vector of a triangle.
    Double3 normal(const Triangle& t) const {
        const Double3 a = position(t[0]);
        return cross(position(t[1]) - a, position(t[2]) - a);
    }

    /// Folds `child` into `parent`: triangles with both go, the child's others get the parent as corner
    /// (appended to `corners_changed` as 3 * triangle + corner), removed ones are appended to `removed`.
    /// May run at once for edges whose stars share no vertex, if there is room() for all of them. Returns how
    /// many entries of the arena it took. live_triangles() and live_vertices() stay as they were until
    /// lose().
    /// Wedges of the child's other triangles become what `pairs` says; what they were is appended to
    /// `corner_wedges`.
    std::size_t fold(std::uint32_t child, std::uint32_t parent, std::span<const WedgePair> pairs,
                     std::vector<std::uint32_t>& corners_changed, std::vector<std::uint32_t>& removed,
                     std::vector<std::uint32_t>& corner_wedges);
    void lose(std::uint32_t vertices, std::uint32_t triangles) {
        live_vertices_ -= vertices;
        live_triangles_ -= triangles;
    }
    /// Makes room for `entries` more in the arena of stars: packs it if much of it is left over, else lets
    /// it grow. A fold takes at most one for each triangle around its edge.
    void make_room(std::size_t entries) {
        if (arena_end_ + entries > arena_.size()) grow_room(entries);
    }
    /// Frees the lists of triangles, which are empty from then on.
    void drop_stars() {
        std::vector<std::uint32_t>().swap(arena_);
        for (Vertex& v : vertices_) v.star_size = 0;
    }
    /// Takes out the vertices of a whole component; its triangles are left as they are.
    void vanish(std::span<const std::uint32_t> vertices);

    /// Index in the input of each vertex.
    const std::vector<std::uint32_t>& input_vertices() const { return input_vertices_; }

  private:
    /// Of all vertices; whether triangles on two sides of an edge disagree anywhere.
    bool classify();
    /// Surely one closed fan, consistently oriented, of few triangles.
    bool is_closed_fan(std::uint32_t v) const;

    std::vector<Vertex> vertices_;
    std::vector<Triangle> triangles_;
    std::vector<Triangle> corners_;      // empty without wedges
    std::vector<std::uint32_t> groups_;  // empty, or one per triangle
    TriangleCopies copies_;
    void grow_room(std::size_t entries);

    std::vector<std::uint32_t> arena_;  // used up to arena_end_
    std::uint32_t arena_end_ = 0;
    std::vector<std::uint32_t> input_vertices_;
    Double3 centre_;
    double scale_ = 1;
    std::uint32_t live_triangles_ = 0, live_vertices_ = 0;
};

/// Collects the neighbours of `v` into `out`: in order of first appearance, or by number if the star is
/// larger than kLargeStar.
void neighbours_of(const StarMesh& mesh, std::uint32_t v, std::vector<Neighbour>& out);

/// Visits each neighbour of `v`; those that two triangles name come once where the fan is closed and
/// consistently oriented.
template <class Visit>
void visit_neighbours(const StarMesh& mesh, std::uint32_t v, std::vector<Neighbour>& scratch,
                      const Visit& visit) {
    if (mesh.kind(v) == VertexKind::kInner) {
        for (const std::uint32_t t : mesh.star(v)) {
            const Triangle& c = mesh.triangle(t);
            visit(c[0] == v ? c[1] : c[1] == v ? c[2] : c[0]);
        }
        return;
    }
    neighbours_of(mesh, v, scratch);
    for (const Neighbour& n : scratch) visit(n.vertex);
}

}  // namespace vsplit::bake
