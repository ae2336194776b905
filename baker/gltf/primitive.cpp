// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "primitive.hpp"

#include <algorithm>
#include <limits>

#include "accessor.hpp"
#include "compressed.hpp"

namespace vsplit::bake {
namespace {

Error fault(ErrorCode code, const std::string& name, const std::string& what) {
    return {code, name + ": " + what, Error::kNowhere, 0};
}

/// Triangles of a list, strip or fan over `count` corners, as positions in the sequence of corners; the
/// orders of a strip and a fan are those of glTF 2.0, section 3.7.2.1.
template <class Emit>
void for_each_triangle(int mode, std::uint64_t count, Emit emit) {
    if (mode == TINYGLTF_MODE_TRIANGLES)
        for (std::uint64_t i = 0; i + 2 < count; i += 3) emit(i, i + 1, i + 2);
    else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
        for (std::uint64_t i = 0; i + 2 < count; ++i) emit(i, i + 1 + i % 2, i + 2 - i % 2);
    else
        for (std::uint64_t i = 0; i + 2 < count; ++i) emit(i + 1, i + 2, 0);
}

float weight_of(const std::array<float, 4>& value, const WeightChannel& channel) {
    const float weight = value[std::size_t(channel.component)];
    if (channel.own && weight == std::numeric_limits<float>::max())
        return std::numeric_limits<float>::infinity();
    return weight;
}

/// Renumbers `corners` to the vertices that are named, in ascending order, and returns those. Exporters often
/// let many primitives name parts of one long vertex array, so that nothing here may grow with that array.
std::vector<std::uint32_t> compact(std::vector<std::uint32_t>& corners) {
    std::vector<std::uint32_t> used;
    if (corners.empty()) return used;
    const auto [least, most] = std::minmax_element(corners.begin(), corners.end());
    const std::uint32_t first = *least;
    const std::uint64_t range = std::uint64_t{*most} - first + 1;
    if (range <= corners.size() * 4) {
        std::vector<std::uint32_t> number(range, 0);
        for (const std::uint32_t v : corners) number[v - first] = 1;
        for (std::uint64_t i = 0; i < range; ++i)
            if (number[i] != 0) {
                number[i] = static_cast<std::uint32_t>(used.size());
                used.push_back(first + static_cast<std::uint32_t>(i));
            }
        for (std::uint32_t& v : corners) v = number[v - first];
    } else {
        used = corners;
        std::sort(used.begin(), used.end());
        used.erase(std::unique(used.begin(), used.end()), used.end());
        for (std::uint32_t& v : corners)
            v = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), v) - used.begin());
    }
    return used;
}

Status check_triangles(std::uint64_t count, std::uint64_t max_triangles, const std::string& name) {
    if (count > max_triangles || count > std::numeric_limits<std::uint32_t>::max() / 3)
        return fault(ErrorCode::kLimit, name, "more triangles than the limit of the whole scene leaves");
    return Ok{};
}

Result<PrimitiveMesh> read_draco(Document& document, const DracoPrimitive& draco,
                                 const tinygltf::Primitive& primitive, const WeightChannel& channel,
                                 std::uint64_t max_triangles, const std::string& name) {
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES)
        return fault(ErrorCode::kUnsupported, name, "KHR_draco_mesh_compression of strips and fans");
    const auto id = draco.attributes.find("POSITION");
    if (id == draco.attributes.end())
        return fault(ErrorCode::kMalformed, name, "KHR_draco_mesh_compression without POSITION");
    const auto view = document.view(draco.view);
    if (!view.ok()) return fault(view.error().code, name, view.error().message);
    auto mesh = DracoMesh::decode(*view, max_triangles);
    if (!mesh.ok()) return fault(mesh.error().code, name, mesh.error().message);
    PrimitiveMesh out;
    out.corners = std::move(mesh->corners);
    out.used = compact(out.corners);
    out.listed = mesh->vertices;

    // Integers that the accessor calls normalised, but Draco does not.
    const auto scale = [&](const std::string& attribute, const DracoMesh::Attribute& values) {
        const auto found = primitive.attributes.find(attribute);
        if (found == primitive.attributes.end() || values.normalised) return 1.0f;
        const tinygltf::Accessor& accessor = document.model.accessors[std::size_t(found->second)];
        if (!accessor.normalized) return 1.0f;
        switch (accessor.componentType) {
            case TINYGLTF_COMPONENT_TYPE_BYTE:
                return 1 / 127.0f;
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
                return 1 / 255.0f;
            case TINYGLTF_COMPONENT_TYPE_SHORT:
                return 1 / 32767.0f;
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
                return 1 / 65535.0f;
            default:
                return 1.0f;
        }
    };
    const auto positions = mesh->attribute(id->second);
    if (!positions.ok()) return fault(positions.error().code, name, positions.error().message);
    if (positions->components != 3)
        return fault(ErrorCode::kMalformed, name, "Draco: POSITION is no vector of three");
    const float s = scale("POSITION", *positions);
    for (const std::uint32_t v : out.used) {
        const auto& p = positions->values[v];
        out.positions.push_back({p[0] * s, p[1] * s, p[2] * s});
    }
    const auto weight_id = draco.attributes.find(channel.attribute);
    if (channel.attribute.empty() || weight_id == draco.attributes.end()) return out;
    const auto weights = mesh->attribute(weight_id->second);
    if (!weights.ok()) return fault(weights.error().code, name, weights.error().message);
    if (channel.component >= weights->components) return out;
    const float w = scale(channel.attribute, *weights);
    out.has_weights = true;
    for (const std::uint32_t v : out.used) {
        const float weight = weight_of(weights->values[v], channel);
        out.weights.push_back(w == 1.0f ? weight : weight * w);
    }
    return out;
}

}  // namespace

bool is_triangles(const tinygltf::Primitive& primitive) {
    return primitive.mode == TINYGLTF_MODE_TRIANGLES || primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
           primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

Result<PrimitiveMesh> read_primitive(Document& document, std::size_t mesh_number, std::size_t number,
                                     const WeightChannel& channel, std::uint64_t max_triangles) {
    const std::string name = object_name("meshes", mesh_number) + "." + object_name("primitives", number);
    const tinygltf::Primitive& primitive = document.model.meshes[mesh_number].primitives[number];
    if (const auto draco = document.draco.find({mesh_number, number}); draco != document.draco.end())
        return read_draco(document, draco->second, primitive, channel, max_triangles, name);

    PrimitiveMesh out;
    const auto found = primitive.attributes.find("POSITION");
    if (found == primitive.attributes.end())
        return out;  // glTF lets extensions give the positions; none that we read does.
    const auto positions = AccessorReader::open(document, found->second, name + ".attributes.POSITION");
    if (!positions.ok()) return positions.error();
    if (positions->components() != 3 || positions->component_type() == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
        return fault(ErrorCode::kMalformed, name + ".attributes.POSITION",
                     "no vector of three floats, bytes or shorts");
    if (positions->count() > std::numeric_limits<std::uint32_t>::max())
        return fault(ErrorCode::kLimit, name, "more than 4,294,967,295 vertices");

    const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES;
    std::uint64_t count = positions->count();
    std::vector<std::uint32_t> sequence;
    if (primitive.indices >= 0) {
        const std::string place = name + ".indices";
        const auto indices = AccessorReader::open(document, primitive.indices, place);
        if (!indices.ok()) return indices.error();
        const int type = indices->component_type();
        if (indices->components() != 1 || indices->normalised() ||
            (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
             type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT))
            return fault(ErrorCode::kMalformed, place, "no unsigned integers");
        if (Status status = check_triangles(indices->count() / 3, max_triangles, name); !status.ok())
            return status.error();
        sequence.resize(indices->count());
        for (std::uint64_t i = 0; i < sequence.size(); ++i) {
            sequence[i] = indices->index(i);
            if (sequence[i] >= count)
                return fault(ErrorCode::kMalformed, place,
                             "index " + std::to_string(i) + " names vertex " + std::to_string(sequence[i]) +
                                 " of " + std::to_string(count));
        }
        count = sequence.size();
    }
    const std::uint64_t triangles = count < 3 ? 0 : list ? count / 3 : count - 2;
    if (Status status = check_triangles(triangles, max_triangles, name); !status.ok()) return status.error();
    out.leftover = list ? count % 3 : count < 3 ? count : 0;
    const auto vertex = [&](std::uint64_t i) {
        return sequence.empty() ? static_cast<std::uint32_t>(i) : sequence[i];
    };
    out.corners.reserve(triangles * 3);
    for_each_triangle(primitive.mode, count, [&](std::uint64_t a, std::uint64_t b, std::uint64_t c) {
        for (const std::uint64_t i : {a, b, c}) out.corners.push_back(vertex(i));
    });
    out.used = compact(out.corners);
    out.listed = positions->count();
    out.positions.reserve(out.used.size());
    for (const std::uint32_t v : out.used) {
        const auto p = positions->read(v);
        out.positions.push_back({p[0], p[1], p[2]});
    }

    const auto weight = primitive.attributes.find(channel.attribute);
    if (channel.attribute.empty() || weight == primitive.attributes.end()) return out;
    const std::string place = name + ".attributes." + channel.attribute;
    const auto weights = AccessorReader::open(document, weight->second, place);
    if (!weights.ok()) return weights.error();
    if (weights->count() != positions->count())
        return fault(ErrorCode::kMalformed, place,
                     std::to_string(weights->count()) + " elements for " +
                         std::to_string(positions->count()) + " vertices");
    if (channel.component >= weights->components()) return out;
    out.has_weights = true;
    out.weights.reserve(out.used.size());
    for (const std::uint32_t v : out.used) out.weights.push_back(weight_of(weights->read(v), channel));
    return out;
}

}  // namespace vsplit::bake
