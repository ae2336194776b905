// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Mesh files in and out: OBJ, PLY, OFF, STL. (Scenes: gltf.hpp. Point clouds: points.hpp.)
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vsplit/mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit::bake {

/// Which vertices with bitwise equal positions (0 and -0 being equal) become one.
enum class Weld : std::uint8_t {
    kAuto,      ///< kAll for STL and glTF, whose files cannot say what is connected; kBoundary for the rest.
    kNone,      ///< The file's own indices state the topology.
    kBoundary,  ///< Only vertices on an edge with a single triangle: closes seams that a file's attributes
                ///< cut.
    kAll,       ///< All.
};

/// What a reader met on the way. Nothing is changed or left out without being counted here.
struct MeshReport {
    std::string format;             ///< "PLY (binary little endian)", for people.
    std::uint64_t vertices_in = 0;  ///< As the file lists them.
    std::uint64_t faces_in = 0;     ///< Polygons as the file lists them, strips counted by triangle.
    std::uint64_t polygons_triangulated = 0;     ///< Faces of four corners and more.
    std::uint64_t faces_dropped_degenerate = 0;  ///< Triangles that name a vertex twice (after welding).
    std::uint64_t faces_dropped_non_finite = 0;  ///< Triangles with a NaN or infinite corner.
    std::uint64_t vertices_welded = 0;
    std::uint64_t vertices_dropped_unused = 0;  ///< Not used by any kept triangle.
    std::uint64_t weights_clamped = 0;          ///< Weights that were negative or NaN, read as 0.
};

/// A mesh's topology, counted. Edges are undirected; "duplicate" triangles share all three vertices with an
/// earlier one.
struct MeshSurvey {
    std::uint64_t vertices = 0, triangles = 0,
                  components = 0;             ///< Components are connected through shared vertices.
    std::uint64_t boundary_edges = 0;         ///< One triangle.
    std::uint64_t non_manifold_edges = 0;     ///< Three triangles and more.
    std::uint64_t misoriented_edges = 0;      ///< Two triangles that run along it in the same direction.
    std::uint64_t non_manifold_vertices = 0;  ///< Triangles around it form more than one fan.
    std::uint64_t duplicate_triangles = 0;
    std::uint64_t zero_area_triangles =
        0;  ///< Exactly, or below 1e-14 of the squared diagonal of the bounding box.
    bool closed() const { return triangles > 0 && boundary_edges == 0; }
    bool manifold() const {
        return non_manifold_edges == 0 && non_manifold_vertices == 0 && misoriented_edges == 0;
    }
};

/// A mesh as read, and what was met.
struct MeshFile {
    static constexpr std::uint32_t kDropped = 0xFFFFFFFFu;

    Mesh mesh;
    MeshReport report;
    /// For each vertex as the file lists them: its number in `mesh` after welding and renumbering, or
    /// kDropped. Empty: the same.
    std::vector<std::uint32_t> vertex_of{};
};

/// How to read.
struct ReadOptions {
    Weld weld = Weld::kAuto;
    /// PLY vertex property to take as weights; empty: "quality" or "weight" if there. Missing, if named:
    /// kArgument.
    std::string weight_property;
};

/// Polygons as a file lists them: face f has corners[face_starts[f] .. face_starts[f + 1]).
struct PolygonSoup {
    std::vector<Float3> positions;
    std::vector<std::uint64_t> face_starts{0};
    std::vector<std::uint32_t> corners;
    std::vector<float> weights;  ///< Empty, or one per vertex.
};

/// Triangulates, welds, drops what is no triangle, and counts; the way every reader ends. `report.format` is
/// kept. Order of vertices and triangles is the file's. kAuto means kBoundary. Counts add to those already in
/// `report`; triangles kept and dropped together are the corners less two of every face of three corners and
/// more, plus the faces of fewer. Errors: kMalformed if indices, weights or starts do not fit together or no
/// triangle is left, kLimit.
Result<MeshFile> assemble_mesh(PolygonSoup&& soup, Weld weld, MeshReport report);

/// Reads a mesh file's bytes. The format is told by content, then by `extension` (".obj"; any case).
/// Errors carry the offset (binary) or line (text); hostile bytes are safe: counts are checked against the
/// size of the input before anything is allocated. A file without a triangle is an error (kMalformed).
/// Coordinates of text, doubles or large integers that are far from 0 are taken relative to Mesh::origin.
Result<MeshFile> parse_mesh(std::span<const std::byte> bytes, std::string_view extension,
                            const ReadOptions& options = {});

/// The origin that a source with these bounds is moved to: zeros unless its coordinates are more than 256
/// times its longest side from 0, where floats would keep less than 16 bits of it. A multiple of a power of
/// two of about that side, near the middle. A box without extent, or not finite, gives zeros.
std::array<double, 3> local_origin(const std::array<double, 3>& low, const std::array<double, 3>& high);

/// Per-vertex weights as text: one number a line (blank lines and # comments skipped). Exactly `count` of
/// them, each >= 0; "inf" is allowed (never collapses). With MeshReport::vertices_in for `count`, see
/// apply_weights.
Result<std::vector<float>> parse_weights(std::span<const std::byte> bytes, std::size_t count);

/// Sets the mesh's weights from one per vertex as the file lists them; of vertices that were welded the
/// largest counts. Errors: kArgument if there are not report.vertices_in of them.
Status apply_weights(MeshFile& file, std::span<const float> weights);

MeshSurvey survey_mesh(const Mesh& mesh);

/// PLY, binary little endian; weights as the float property "quality". Positions exact: floats, or with an
/// origin doubles that it is added to.
std::vector<std::byte> encode_ply(const Mesh& mesh);
/// OBJ text; positions with the fewest digits that read back exactly, the origin added. Weights are not part
/// of OBJ.
std::vector<std::byte> encode_obj(const Mesh& mesh);

}  // namespace vsplit::bake
