// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What the studio works on: a model, its collapse sequence at a level, and the paint on it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera.hpp"
#include "painting.hpp"
#include "placement.hpp"
#include "surface.hpp"
#include "vsplit/bake/collapse.hpp"
#include "vsplit/bake/scene.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/view_mesh.hpp"
#include "vsplit/write.hpp"

namespace vsplit::studio {

using Rgb = std::array<std::uint8_t, 3>;

/// A model as it was opened.
struct Source {
    std::string path;
    Mesh mesh;                              ///< Weights, if any, become region "painted".
    std::optional<bake::Scene> scene;       ///< Around it; its `mesh` may be empty.
    std::vector<std::uint32_t> part_of;     ///< As CollapseOptions::part_of.
    std::vector<std::uint32_t> vertex_of;   ///< As MeshFile::vertex_of.
    std::size_t file_vertices = 0;          ///< As the file lists them, to which weight files refer.
    std::vector<Rgb> colours;               ///< Per vertex of `mesh`, what it looks like unpainted; or empty.
    std::optional<ProgressiveMesh> record;  ///< If the file had one; `mesh` is then its full level.
};

struct Brush {
    double radius = 0;        ///< Object units.
    float strength = 1;       ///< 0 to 1, in the middle; it falls off towards the rim if below 1.
    std::uint8_t region = 1;  ///< 0 erases.
    unsigned mirror = 0;      ///< Bits: 1 x, 2 y, 4 z; the plane through the box's centre.
};

class Document {
  public:
    /// Takes the model; bakes it first if it has no record. Errors: what collapse() returns.
    static Result<std::unique_ptr<Document>> open(Source source, bake::CollapseOptions options,
                                                  const bake::Progress& progress = {});

    const Source& source() const { return source_; }
    const Box& box() const { return box_; }
    const bake::CollapseOptions& options() const { return options_; }

    LiveMesh& live() { return *live_; }
    const LiveMesh& live() const { return *live_; }
    std::size_t level_for_ratio(double ratio) const;
    double ratio() const;
    void go_to(std::size_t level);
    /// A level of the record, or anything with its vertices' numbers, as it is shown: a scene's parts where
    /// its nodes have them. What the brush, the rays and the box are about is the shown level.
    Shown show(std::span<const Float3> positions, std::span<const Triangle> triangles,
               std::span<const std::uint32_t> groups) const {
        return placement_.show(positions, triangles, groups);
    }
    bool placed() const { return !placement_.trivial(); }
    /// The vertex of the model that a vertex of the record is.
    std::uint32_t origin(std::uint32_t v) const { return origins_[v]; }

    Painting& painting() { return painting_; }
    const Painting& painting() const { return painting_; }
    /// What a ray meets, or what is next to a point, at the level shown. The first call at a level makes a
    /// search tree, if prepare() has not.
    std::optional<Hit> pick(const Ray& ray) { return surface().pick(ray); }
    std::optional<Hit> nearest(Double3 point, double reach) { return surface().nearest(point, reach); }
    void prepare() { surface().prepare(); }
    /// The level's triangles with a corner whose mark has changed since the last call.
    std::vector<Triangle> take_repainted();
    /// The model bounds a volume: from outside nobody sees a back side.
    bool closed() const { return closed_; }
    /// Marks the vertices of the level that the brush reaches around the hit, and all that is split off from
    /// them. Between painting().begin() and end().
    void dab(const Hit& hit, const Brush& brush);
    void mark_level_vertices(std::span<const std::uint32_t> vertices, std::uint8_t region, float strength);
    /// One stroke each, of what a pick() has hit. False if nothing changed.
    bool select_component(std::uint32_t vertex, std::uint8_t region);
    bool select_sharper_than(double degrees, std::uint8_t region);
    /// All primitives that have the triangle's material.
    bool select_material(std::uint32_t triangle, std::uint8_t region);
    /// Its name, or number; empty if there are none.
    std::string material_of(std::uint32_t triangle);

    /// Weights for the model as it is painted.
    std::vector<float> weights() const;
    const bake::AutomaticWeights& automatic() const { return automatic_; }
    /// The region's weight, whether its own or the automatic one.
    double weight_of(std::size_t region) const;
    /// The model with those weights: what Apply bakes.
    Mesh painted() const;
    /// Goes over to a record of painted(); the ratio shown stays.
    void adopt(ProgressiveMesh record);

    /// The level with all that is marked at full detail, at once and without a bake: the splits of the record
    /// whose error is above the level's, and all that the marked vertices need (ViewMesh, by priorities at
    /// run time). Vertices keep the record's numbers: those that no triangle has are not there. Errors:
    /// kLimit, as ViewMesh::make().
    Result<Mesh> refined_in_place();

    /// Marks as a file has them, for the file's own vertices.
    std::vector<std::byte> encode_marks() const;
    std::vector<std::byte> encode_weights() const;
    /// Marks, or plain weights, of the file's vertices.
    Status load_marks(std::span<const std::byte> bytes);

    /// By extension: .pmesh, or a level as .ply, .obj, .glb; a scene as a whole .glb. `ratio` 1 and .glb of a
    /// scene: a progressive GLB.
    Result<std::vector<std::byte>> encode(const std::string& extension, double ratio,
                                          const WriteOptions& write = {}) const;

  private:
    Document() = default;
    Surface& surface();
    std::span<const Float3> shown_positions();
    std::span<const Triangle> shown_triangles();
    std::span<const std::uint32_t> groups_at_level() const;
    bool every_part_closed() const;
    std::uint32_t level_vertex(std::uint32_t shown) const {
        return shown_.vertex_of.empty() ? shown : shown_.vertex_of[shown];
    }
    std::uint32_t level_triangle(std::uint32_t shown) const {
        return shown_.triangle_of.empty() ? shown : shown_.triangle_of[shown];
    }
    std::vector<std::uint32_t> level_vertices(std::vector<std::uint32_t> shown) const;
    std::uint32_t material_number(std::uint32_t group) const;

    Source source_;
    bake::CollapseOptions options_;
    Box box_;
    std::unique_ptr<LiveMesh> live_;
    std::vector<std::uint32_t> origins_, record_of_;
    bool closed_ = false;
    std::vector<std::uint32_t> child_starts_, children_;  // of the record's vertices
    Mesh full_;                                           // in the record's numbers
    Painting painting_;
    bake::AutomaticWeights automatic_;
    Placement placement_;
    std::vector<bake::SceneMaterial> materials_;  // by group
    Shown shown_;                                 // the level, if it is placed; made with the surface
    std::optional<ViewMesh> refined_;             // made when first needed
    std::unique_ptr<Surface> surface_;            // of the level as shown, made when first needed
};

}  // namespace vsplit::studio
