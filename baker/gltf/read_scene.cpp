// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <exception>
#include <limits>
#include <map>
#include <new>

#include "document.hpp"
#include "primitive.hpp"
#include "scene_nodes.hpp"
#include "vsplit/bake/gltf.hpp"
#include "weight_channel.hpp"

namespace vsplit::bake {
namespace {

Error fault(ErrorCode code, std::string message) {
    return {code, std::move(message), Error::kNowhere, 0};
}

/// The scene as it is put together.
class Assembly {
  public:
    Assembly(Document& document, WeightChannel channel, std::uint64_t max_triangles)
        : document_(document), channel_(std::move(channel)), left_(max_triangles) {
        for (const tinygltf::Mesh& mesh : document.model.meshes)
            for (const tinygltf::Primitive& primitive : mesh.primitives)
                if (const auto found = primitive.attributes.find("POSITION");
                    found != primitive.attributes.end())
                    ++users_[found->second];
    }

    /// All primitives of a mesh, once for each of its places.
    Status add(const Instance& instance, std::size_t places_left) {
        const tinygltf::Mesh& mesh = document_.model.meshes[instance.mesh];
        auto& parts = meshes_[instance.mesh];
        if (!parts.read) {
            parts.read = true;
            for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
                if (!is_triangles(mesh.primitives[p])) {
                    if (mesh.primitives[p].mode < 0 || mesh.primitives[p].mode > TINYGLTF_MODE_TRIANGLE_FAN)
                        return fault(ErrorCode::kMalformed, object_name("meshes", instance.mesh) + "." +
                                                                object_name("primitives", p) + ".mode " +
                                                                std::to_string(mesh.primitives[p].mode) +
                                                                " is not one of glTF's");
                    ++parts.points_and_lines;
                    continue;
                }
                auto part = read_primitive(document_, instance.mesh, p, channel_, left_);
                if (!part.ok()) return part.error();
                count_unused(mesh.primitives[p], *part);
                parts.primitives.push_back(std::move(part).value());
            }
        }
        points_and_lines_ += parts.points_and_lines;
        for (const PrimitiveMesh& part : parts.primitives)
            if (Status status = append(part, instance.matrix); !status.ok()) return status;
        if (places_left == 0) meshes_.erase(instance.mesh);
        return Ok{};
    }

    Result<MeshFile> finish(Weld weld, const std::string& channel_text) {
        if (!channel_text.empty() && !any_weights_)
            return fault(ErrorCode::kArgument, "no primitive of the scene has the weight channel " +
                                                   channel_text + "; its attributes are " +
                                                   attributes_there(document_.model));
        if (!any_weights_) soup_.weights.clear();
        for (auto& [accessor, shared] : shared_) {
            std::sort(shared.used.begin(), shared.used.end());
            shared.used.erase(std::unique(shared.used.begin(), shared.used.end()), shared.used.end());
            unused_ += shared.listed - shared.used.size();
        }
        MeshReport report;
        report.format = document_.binary ? "glTF (binary)" : "glTF (JSON)";
        const auto note = [&](std::uint64_t count, const char* what) {
            if (count > 0) report.format += ", " + std::to_string(count) + what;
        };
        note(points_and_lines_, " primitives of points or lines left out");
        note(leftover_, " indices left over at the end of a primitive");
        const auto& used = document_.model.extensionsUsed;
        if (std::find(used.begin(), used.end(), "EXT_mesh_gpu_instancing") != used.end())
            report.format += ", EXT_mesh_gpu_instancing not read";
        report.vertices_in = report.vertices_dropped_unused = unused_;
        return assemble_mesh(std::move(soup_), weld == Weld::kAuto ? Weld::kAll : weld, std::move(report));
    }

  private:
    struct Parts {
        bool read = false;
        std::vector<PrimitiveMesh> primitives;
        std::uint64_t points_and_lines = 0;
    };
    struct Shared {
        std::vector<std::uint32_t> used;
        std::uint64_t listed = 0;
    };

    /// A vertex array that several primitives share is counted once.
    void count_unused(const tinygltf::Primitive& primitive, PrimitiveMesh& part) {
        leftover_ += part.leftover;
        const auto found = primitive.attributes.find("POSITION");
        if (found == primitive.attributes.end()) return;
        if (users_[found->second] > 1) {
            Shared& shared = shared_[found->second];
            shared.used.insert(shared.used.end(), part.used.begin(), part.used.end());
            shared.listed = std::max(shared.listed, part.listed);
        } else {
            unused_ += part.listed - part.used.size();
        }
        part.used = {};
    }

    Status append(const PrimitiveMesh& part, const Matrix& m) {
        const std::uint64_t triangles = part.corners.size() / 3;
        if (triangles > left_ ||
            soup_.positions.size() + part.positions.size() >= std::numeric_limits<std::uint32_t>::max())
            return fault(ErrorCode::kLimit,
                         "the scene has more triangles, with its instances, than the limit");
        left_ -= triangles;
        const auto base = static_cast<std::uint32_t>(soup_.positions.size());
        if (m == kIdentity) {  // The exact floats, -0 and all.
            soup_.positions.insert(soup_.positions.end(), part.positions.begin(), part.positions.end());
        } else {
            const auto row = [&](const Float3& p, std::size_t r) {
                return static_cast<float>(m[r] * p.x + m[4 + r] * p.y + m[8 + r] * p.z + m[12 + r]);
            };
            for (const Float3& p : part.positions)
                soup_.positions.push_back({row(p, 0), row(p, 1), row(p, 2)});
        }
        any_weights_ = any_weights_ || part.has_weights;
        if (part.has_weights)
            soup_.weights.insert(soup_.weights.end(), part.weights.begin(), part.weights.end());
        else
            soup_.weights.resize(soup_.positions.size(), 1.0f);
        // A mirror turns triangles inside out (glTF 2.0, section 3.7.4).
        const bool mirrored = determinant(m) < 0;
        for (std::size_t c = 0; c < part.corners.size(); c += 3) {
            soup_.corners.push_back(base + part.corners[c]);
            soup_.corners.push_back(base + part.corners[c + (mirrored ? 2 : 1)]);
            soup_.corners.push_back(base + part.corners[c + (mirrored ? 1 : 2)]);
            soup_.face_starts.push_back(soup_.corners.size());
        }
        return Ok{};
    }

    Document& document_;
    WeightChannel channel_;
    std::uint64_t left_;  // triangles that the limit still allows
    PolygonSoup soup_;
    bool any_weights_ = false;
    std::map<std::size_t, Parts> meshes_;
    std::map<int, int> users_;
    std::map<int, Shared> shared_;
    std::uint64_t unused_ = 0, leftover_ = 0, points_and_lines_ = 0;
};

Result<MeshFile> read_scene(std::span<const std::byte> bytes, const std::string& folder,
                            const GltfOptions& options) {
    auto channel = weight_channel(options.weight_channel);
    if (!channel.ok()) return channel.error();
    auto document = Document::parse(bytes, folder);
    if (!document.ok()) return document.error();
    const auto instances = place_meshes(*document);
    if (!instances.ok()) return instances.error();
    std::map<std::size_t, std::size_t> places;
    for (const Instance& instance : *instances) ++places[instance.mesh];
    Assembly assembly(*document, std::move(*channel), options.max_triangles);
    for (const Instance& instance : *instances)
        if (Status status = assembly.add(instance, --places[instance.mesh]); !status.ok())
            return status.error();
    return assembly.finish(options.weld, options.weight_channel);
}

}  // namespace

Result<MeshFile> parse_gltf(std::span<const std::byte> bytes, const std::string& folder,
                            const GltfOptions& options) {
    // The libraries below report by exception what is left after all our checks.
    try {
        return read_scene(bytes, folder, options);
    } catch (const std::bad_alloc&) {
        return fault(ErrorCode::kLimit, "not enough memory for this scene");
    } catch (const std::exception& error) {
        return fault(ErrorCode::kMalformed, std::string("glTF: ") + error.what());
    }
}

}  // namespace vsplit::bake
