// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "container.hpp"
#include "coverage.hpp"
#include "normals.hpp"
#include "vsplit/bake/gltf.hpp"

namespace vsplit::bake {
namespace {

using json = nlohmann::ordered_json;  // the order in which we write, which is the same everywhere

constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedInt = 5125;
constexpr int kVertices = 34962, kIndices = 34963;

Error fault(ErrorCode code, std::string message) {
    return {code, std::move(message), Error::kNowhere, 0};
}

/// The BIN chunk as it grows, and its views and accessors.
struct Contents {
    std::vector<std::byte> bytes;
    json views = json::array(), accessors = json::array();

    /// Returns the accessor's number.
    std::size_t add(const void* data, std::size_t size, std::size_t count, int component, const char* type,
                    int target) {
        bytes.resize((bytes.size() + 3) / 4 * 4);
        views.push_back(
            {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", size}, {"target", target}});
        const auto* from = static_cast<const std::byte*>(data);
        bytes.insert(bytes.end(), from, from + size);
        accessors.push_back({{"bufferView", views.size() - 1},
                             {"componentType", component},
                             {"count", count},
                             {"type", type}});
        return accessors.size() - 1;
    }
};

json add_mesh(const Mesh& mesh, Contents& out) {
    static_assert(sizeof(Float3) == 12 && sizeof(Triangle) == 12);
    json attributes = json::object();
    const std::size_t count = mesh.positions.size();
    const std::size_t positions =
        out.add(mesh.positions.data(), count * 12, count, kFloat, "VEC3", kVertices);
    Float3 least = mesh.positions.front(), most = least;
    for (const Float3& p : mesh.positions) {
        least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
        most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
    }
    // As doubles the floats are printed with the digits that read back exactly.
    out.accessors.back()["min"] = {double(least.x), double(least.y), double(least.z)};
    out.accessors.back()["max"] = {double(most.x), double(most.y), double(most.z)};
    attributes["POSITION"] = positions;
    const std::vector<Float3> normals = smooth_normals(mesh);
    attributes["NORMAL"] = out.add(normals.data(), count * 12, count, kFloat, "VEC3", kVertices);
    if (!mesh.weights.empty()) {
        // glTF has no infinity; the largest float stands for it.
        std::vector<float> weights = mesh.weights;
        for (float& w : weights) w = std::min(w, std::numeric_limits<float>::max());
        attributes["_WEIGHT"] = out.add(weights.data(), count * 4, count, kFloat, "SCALAR", kVertices);
    }
    std::size_t indices = 0;
    const std::size_t corners = mesh.triangles.size() * 3;
    if (count <= 65535) {  // 65535 itself restarts a primitive, and so is no index
        std::vector<std::uint16_t> narrow;
        narrow.reserve(corners);
        for (const Triangle& t : mesh.triangles)
            for (const std::uint32_t v : t) narrow.push_back(static_cast<std::uint16_t>(v));
        indices = out.add(narrow.data(), corners * 2, corners, kUnsignedShort, "SCALAR", kIndices);
    } else {
        indices = out.add(mesh.triangles.data(), corners * 4, corners, kUnsignedInt, "SCALAR", kIndices);
    }
    return {{"primitives", {{{"attributes", attributes}, {"indices", indices}, {"material", 0}}}}};
}

/// What a viewer sees of every level before it looks at any: half the diagonal of the finest level's box.
double bounding_radius(const Mesh& mesh) {
    Float3 least = mesh.positions.front(), most = least;
    for (const Float3& p : mesh.positions) {
        least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
        most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
    }
    const double x = double(most.x) - least.x, y = double(most.y) - least.y, z = double(most.z) - least.z;
    return 0.5 * std::sqrt(x * x + y * y + z * z);
}

Status check_levels(std::span<const GltfLevel> levels) {
    if (levels.empty()) return fault(ErrorCode::kArgument, "no level of detail to write");
    for (std::size_t k = 0; k < levels.size(); ++k) {
        const std::string name = "level " + std::to_string(k);
        if (levels[k].mesh.triangles.empty())
            return fault(ErrorCode::kArgument, name + " has no triangle, which glTF cannot say");
        if (const char* what = mesh_fault(levels[k].mesh))
            return fault(ErrorCode::kArgument, name + ": " + what);
        if (!(levels[k].error >= 0) || !std::isfinite(levels[k].error))
            return fault(ErrorCode::kArgument, name + ": its error is no distance");
        if (levels[k].mesh.positions.size() >= std::numeric_limits<std::uint32_t>::max())
            return fault(ErrorCode::kLimit, name + ": more vertices than a 32-bit index can name");
    }
    return Ok{};
}

Result<std::vector<std::byte>> write_levels(std::span<const GltfLevel> levels, const Screen& screen) {
    if (Status status = check_levels(levels); !status.ok()) return status.error();
    Contents contents;
    json nodes = json::array(), meshes = json::array();
    bool sheet = false;
    for (const GltfLevel& level : levels) {
        meshes.push_back(add_mesh(level.mesh, contents));
        nodes.push_back({{"mesh", nodes.size()}});
        const MeshSurvey survey = survey_mesh(level.mesh);
        sheet = sheet || !survey.closed() || survey.misoriented_edges > 0;
    }
    json material = {{"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.8}}}};
    if (sheet) material["doubleSided"] = true;  // its back can be seen

    json document = {{"asset", {{"version", "2.0"}, {"generator", "vsplit"}}}};
    if (const auto& origin = levels.front().mesh.origin; origin != std::array<double, 3>{})
        document["asset"]["extras"] = {{"origin", origin}};
    if (levels.size() > 1) {
        document["extensionsUsed"] = {"MSFT_lod"};
        json ids = json::array();
        std::vector<double> errors;
        for (const GltfLevel& level : levels) {
            if (!errors.empty()) ids.push_back(errors.size());
            errors.push_back(level.error);
        }
        nodes[0]["extensions"] = {{"MSFT_lod", {{"ids", ids}}}};
        nodes[0]["extras"] = {
            {"MSFT_screencoverage", screen_coverage(errors, bounding_radius(levels[0].mesh), screen)}};
    }
    document["scene"] = 0;
    document["scenes"] = {{{"nodes", {0}}}};
    document["nodes"] = std::move(nodes);
    document["meshes"] = std::move(meshes);
    document["materials"] = json::array({std::move(material)});
    document["accessors"] = std::move(contents.accessors);
    document["bufferViews"] = std::move(contents.views);
    document["buffers"] = json::array({{{"byteLength", contents.bytes.size()}}});

    return seal_container(document.dump(), contents.bytes);
}

}  // namespace

Result<std::vector<std::byte>> encode_glb(std::span<const GltfLevel> levels, const Screen& screen) {
    try {
        return write_levels(levels, screen);
    } catch (const std::bad_alloc&) {
        return fault(ErrorCode::kLimit, "not enough memory for this GLB");
    }
}

}  // namespace vsplit::bake
