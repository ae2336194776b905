// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <exception>
#include <new>

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

}  // namespace vsplit::bake
