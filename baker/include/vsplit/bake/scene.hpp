// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A glTF scene taken apart for baking, and put together again around other geometry (docs/lods.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vsplit/bake/gltf.hpp"
#include "vsplit/bake/meshes.hpp"
#include "vsplit/bake/poses.hpp"
#include "vsplit/mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit::bake {

/// How a primitive's accessor holds an attribute.
struct StoredAttribute {
    std::uint32_t attribute = 0;          ///< In Scene::mesh.attributes.
    std::string type = "VEC3";            ///< glTF's.
    std::uint32_t component_type = 5126;  ///< glTF's; 5126 is float.
    bool normalised = false;
};

/// A triangle primitive, whose number in Scene::primitives is its triangles' group.
struct ScenePrimitive {
    std::uint32_t mesh = 0, primitive = 0;  ///< Numbers in the document.
    std::uint32_t targets = 0;              ///< Morph targets.
    StoredAttribute position;               ///< `attribute` is unused.
    std::vector<StoredAttribute> attributes;
};

/// One glTF mesh. Its vertices follow each other in Scene::mesh.
struct ScenePart {
    std::uint32_t mesh = 0;  ///< Number in the document.
    int exponent = 0;        ///< Coordinates are the file's times 2^exponent.
    std::uint32_t first_vertex = 0, end_vertex = 0;
};

/// A node of the default scene that shows a part.
struct PlacedPart {
    std::uint32_t part = 0;  ///< In Scene::parts.
    /// From the mesh's coordinates as the file has them to the world, column-major; of a skinned one, too,
    /// the node's.
    std::array<double, 16> matrix{};
    std::vector<Pose> poses{};  ///< From and to the world's coordinates, where the matrix puts it.
};

/// The document behind a scene: whatever is not triangles. Opaque.
struct SceneDocument;

/// The triangles of all meshes that nodes of the scene use, each mesh once, in its own space, and what
/// remains of the document.
struct Scene {
    /// All parts after each other, each in coordinates of its mesh, scaled by a power of two so that lengths
    /// times a factor from 1 to 2 are those of its largest place in the world: errors of all parts compare.
    /// Attributes are the union of all primitives' (0 where one lacks it; COLOR's alpha 1), in float:
    /// NORMAL, TANGENT, TEXCOORD_n, COLOR_n, JOINTS_n with WEIGHTS_n, others, then morph targets. Morph
    /// offsets are scaled as positions are. Groups number `primitives`. Vertices of one primitive that agree
    /// in every bit are one; vertices that only share their place are a seam or a border between primitives
    /// of the part. Between parts equal coordinates mean nothing.
    Mesh mesh;
    std::vector<std::uint32_t> part_of;  ///< Per vertex of `mesh`, its number in `parts`.
    std::vector<ScenePart> parts;
    std::vector<ScenePrimitive> primitives;
    std::vector<PlacedPart> places;  ///< Depth first. Not known of a progressive GLB.
    double radius =
        0;  ///< Of a ball around all places of all parts, in the world. About right for skinned ones.
    /// Errors of `mesh` times this are at least what they are anywhere in the world; from 1 to 2.
    double unit = 1;
    MeshReport report;
    std::vector<std::string> notes;  ///< What was met and not carried along, for people.
    std::shared_ptr<const SceneDocument> document;
    PoseSets poses;  ///< Of `mesh`, if GltfOptions::poses asked for them and there is an animation.
};

/// Reads a scene. What parse_gltf says of extensions, folders, limits and hostile bytes holds here too;
/// `options.weld` is not used. Meshes that no node uses, and points and lines, are left in the document.
/// A scene without a triangle is kMalformed.
Result<Scene> parse_scene(std::span<const std::byte> bytes, const std::string& folder,
                          const GltfOptions& options = {});

/// The scene's triangles where its nodes place them, as one mesh in world units, each place after the other:
/// what a .pmesh without a scene around it has. Normals, tangents and morph offsets turn with their node, a
/// mirroring node turns triangles over and handedness about. Skins and morph targets are in their bind pose,
/// where the node stands. Groups are numbers of materials in the document, those without one getting the
/// number after the last; none if all is one material. Colours are white where a primitive has none. Needs
/// `scene.mesh` and `scene.places`. Errors: kMalformed if no place shows a triangle, kLimit for more than
/// `max_triangles`.
Result<Mesh> placed_mesh(const Scene& scene, std::uint64_t max_triangles = std::uint64_t{1} << 26);

/// The poses of what placed_mesh() gives.
PoseSets placed_poses(const Scene& scene);

/// Where a node of the scene that the document shows has a part.
struct ScenePlace {
    std::uint32_t part = 0;
    std::array<double, 16> matrix{};  ///< From coordinates of Scene::mesh to the world, column by column.
};

/// All places in the order of the nodes, parents first; of a skinned part, where its first joint puts it.
/// Instances of EXT_mesh_gpu_instancing count as one.
std::vector<ScenePlace> scene_places(const Scene& scene);

/// What a primitive looks like, as far as a preview needs it.
struct SceneMaterial {
    std::uint32_t number = 0xFFFFFFFFu;  ///< In the document; the default if the primitive names none.
    std::string name;                    ///< May be empty.
    std::array<float, 4> base_color{1, 1, 1, 1};  ///< Linear; times the image, if there is one.
    std::span<const std::byte> image{};  ///< PNG, JPEG or another format, as stored; of the scene's document.
    std::uint32_t image_number = 0xFFFFFFFFu;
    std::uint32_t texcoord = 0;  ///< The set that the image is looked up by.
};

/// One for each of Scene::primitives. Images outside of the document are not read.
std::vector<SceneMaterial> scene_materials(const Scene& scene);

/// A scene of one node around a mesh that came without one, as from a .pmesh: a primitive and a plain
/// material a group, attributes as floats; where there are joints, a skin of as many nodes that stand where
/// they are. Its `mesh` has the attributes' names only.
Scene plain_scene(const Mesh& mesh);

/// How encode_scene writes geometry.
struct SceneFormat {
    bool quantised = false;  ///< KHR_mesh_quantization: 16-bit positions and texture coordinates, 8-bit
                             ///< normals and tangents, 16-bit colours and joint weights.
    bool draco = false;      ///< KHR_draco_mesh_compression. Not with the others.
    bool meshopt = false;    ///< EXT_meshopt_compression of the numbers as they are.
    /// Levels share one vertex array a primitive and differ in indices only. It is no longer than the finest
    /// level's where all that a coarser level has is a vertex of the finest (placement endpoint).
    bool shared_vertices = false;
    Screen screen;
};

/// A GLB of the scene with its triangles replaced by the levels', finest first: one level as it is, several
/// with MSFT_lod (docs/lods.md). Levels are cuts of a progressive mesh made of `scene.mesh`: they have its
/// attributes and groups, and errors in its scale. Errors: kArgument for no level, or one that does not fit
/// the scene.
Result<std::vector<std::byte>> encode_scene(const Scene& scene, std::span<const GltfLevel> levels,
                                            const SceneFormat& format = {});

/// The same of levels that came without a scene, as from a .pmesh: encode_glb if they have neither attributes
/// nor groups and the format is plain; else around plain_scene(), with smooth normals where they have none.
Result<std::vector<std::byte>> encode_levels(std::span<const GltfLevel> levels,
                                             const SceneFormat& format = {});

/// A GLB that shows `shown`, carries `pmesh`, a .pmesh file made of the scene's mesh, and says how the two go
/// together (formats/gltf/VSPLIT_progressive_mesh).
Result<std::vector<std::byte>> encode_progressive_scene(const Scene& scene, const GltfLevel& shown,
                                                        std::span<const std::byte> pmesh,
                                                        const SceneFormat& format = {});

/// Where a GLB carries a .pmesh.
struct CarriedStream {
    std::uint64_t offset = 0, bytes = 0;  ///< In the file.
};

/// Nothing if `bytes` is not a GLB with VSPLIT_progressive_mesh. A beginning of the file that holds its JSON
/// is enough. Hostile bytes are safe; errors as in parse_scene.
Result<std::optional<CarriedStream>> find_progressive(std::span<const std::byte> bytes);

/// The scene behind a progressive GLB: as parse_scene gave it, but for `mesh`, `part_of` and the parts'
/// ranges, which are empty: they are in the stream.
Result<Scene> parse_progressive_scene(std::span<const std::byte> bytes);

}  // namespace vsplit::bake
