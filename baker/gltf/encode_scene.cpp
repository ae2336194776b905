// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <exception>
#include <limits>
#include <new>

#include "normals.hpp"
#include "scene_assembly.hpp"
#include "vsplit/bake/scene.hpp"

namespace vsplit::bake {
namespace {

Error fault(ErrorCode code, std::string message) {
    return {code, std::move(message), Error::kNowhere, 0};
}

Result<std::vector<std::byte>> write_scene(const Scene& scene, std::span<const GltfLevel> levels,
                                           const SceneFormat& format) {
    if (format.draco && (format.quantised || format.meshopt || format.shared_vertices))
        return fault(ErrorCode::kArgument, "Draco goes with none of quantised, meshopt, shared vertices");
    if (Status status = check_scene_levels(scene, levels); !status.ok()) return status.error();
    SceneAssembly assembly(scene, format);
    if (Status status = assembly.add_levels(levels); !status.ok()) return status.error();
    assembly.add_kept();
    return assembly.finish();
}

}  // namespace

Result<std::vector<std::byte>> encode_scene(const Scene& scene, std::span<const GltfLevel> levels,
                                            const SceneFormat& format) {
    try {
        return write_scene(scene, levels, format);
    } catch (const std::bad_alloc&) {
        return fault(ErrorCode::kLimit, "not enough memory for this GLB");
    } catch (const std::exception& error) {
        return fault(ErrorCode::kArgument, std::string("the scene's document: ") + error.what());
    }
}

Result<std::vector<std::byte>> encode_levels(std::span<const GltfLevel> levels, const SceneFormat& format) {
    const bool bare = std::all_of(levels.begin(), levels.end(), [](const GltfLevel& level) {
        return level.mesh.attributes.empty() && level.mesh.groups.empty();
    });
    const bool plain = !format.quantised && !format.draco && !format.meshopt && !format.shared_vertices;
    if (levels.empty() || (bare && plain)) return encode_glb(levels, format.screen);
    std::vector<GltfLevel> dressed(levels.begin(), levels.end());
    for (GltfLevel& level : dressed) {
        Mesh& mesh = level.mesh;
        if (const char* what = mesh_fault(mesh)) return fault(ErrorCode::kArgument, what);
        const bool has_normals =
            std::any_of(mesh.attributes.begin(), mesh.attributes.end(),
                        [](const Attribute& a) { return a.semantic == Semantic::kNormal; });
        // Levels that share vertices cannot have normals of their own: viewers then shade by face.
        if (!has_normals && !format.shared_vertices) {
            Attribute normals{"NORMAL", Semantic::kNormal, 3, {}};
            for (const Float3& n : smooth_normals(mesh))
                normals.values.insert(normals.values.end(), {n.x, n.y, n.z});
            mesh.attributes.insert(mesh.attributes.begin(), std::move(normals));
        }
        if (!mesh.weights.empty()) {
            Attribute weights{"_WEIGHT", Semantic::kOther, 1, mesh.weights};
            for (float& w : weights.values) w = std::min(w, std::numeric_limits<float>::max());
            mesh.attributes.push_back(std::move(weights));
        }
    }
    return encode_scene(plain_scene(dressed[0].mesh), dressed, format);
}

}  // namespace vsplit::bake
