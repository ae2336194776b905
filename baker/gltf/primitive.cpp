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

float weight_of(float weight, const WeightChannel& channel) {
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

/// Integers that the accessor calls normalised, but Draco does not.
float draco_scale(const tinygltf::Accessor& accessor, bool by_draco) {
    if (by_draco || !accessor.normalized) return 1.0f;
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
}

/// A primitive's attributes by name, from accessors or out of Draco.
class VertexSource {
  public:
    VertexSource(Document& document, const tinygltf::Primitive& primitive, const std::string& name)
        : document_(document), primitive_(primitive), name_(name) {}

    const DracoPrimitive* draco = nullptr;
    DracoMesh mesh;
    std::uint64_t count = 0;  // of vertices, that each attribute must have

    bool has(const std::string& attribute) const {
        return primitive_.attributes.contains(attribute) || in_draco(attribute);
    }

    /// The values of the vertices in `used`. More than `max_values` floats are refused (kLimit).
    Result<PrimitiveAttribute> read(const std::string& attribute, const std::vector<std::uint32_t>& used,
                                    std::uint64_t max_values) const {
        const std::string place = name_ + ".attributes." + attribute.substr(0, 100);
        const auto found = primitive_.attributes.find(attribute);
        const int accessor = found == primitive_.attributes.end() ? -1 : found->second;
        if (!in_draco(attribute)) return read_accessor(accessor, attribute, place, used, max_values);
        auto values = mesh.attribute(draco->attributes.at(attribute));
        if (!values.ok()) return fault(values.error().code, place, values.error().message);
        PrimitiveAttribute out;
        out.name = attribute;
        constexpr int kTypes[] = {TINYGLTF_TYPE_SCALAR, TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC3,
                                  TINYGLTF_TYPE_VEC4};
        const int components = values->components;
        if (components < 1) return fault(ErrorCode::kMalformed, place, "Draco: no components");
        out.type = kTypes[components - 1];
        out.component_type = TINYGLTF_COMPONENT_TYPE_FLOAT;
        float scale = 1;
        if (accessor >= 0) {
            const tinygltf::Accessor& stored = document_.model.accessors[std::size_t(accessor)];
            out.component_type = stored.componentType;
            out.normalised = stored.normalized;
            scale = draco_scale(stored, values->normalised);
        }
        if (used.size() * std::uint64_t(components) > max_values) return too_many(place);
        out.values.reserve(used.size() * std::size_t(components));
        for (const std::uint32_t v : used)
            for (int c = 0; c < components; ++c) {
                const float value = values->values[v][std::size_t(c)];
                out.values.push_back(scale == 1.0f ? value : value * scale);
            }
        return out;
    }

    Result<PrimitiveAttribute> read_accessor(int accessor, const std::string& attribute,
                                             const std::string& place, const std::vector<std::uint32_t>& used,
                                             std::uint64_t max_values) const {
        const auto source = AccessorReader::open(document_, accessor, place);
        if (!source.ok()) return source.error();
        if (source->count() != count)
            return fault(
                ErrorCode::kMalformed, place,
                std::to_string(source->count()) + " elements for " + std::to_string(count) + " vertices");
        PrimitiveAttribute out;
        out.name = attribute;
        out.type = source->type();
        out.component_type = source->component_type();
        out.normalised = source->normalised();
        const auto components = std::size_t(source->components());
        if (used.size() * std::uint64_t{components} > max_values) return too_many(place);
        out.values.resize(used.size() * components);
        for (std::size_t i = 0; i < used.size(); ++i)
            source->read(used[i], std::span(out.values).subspan(i * components, components));
        return out;
    }

    static Error too_many(const std::string& place) {
        return fault(ErrorCode::kLimit, place,
                     "more attribute values than the limit of the whole scene leaves");
    }

  private:
    bool in_draco(const std::string& attribute) const {
        return draco != nullptr && draco->attributes.contains(attribute);
    }

    Document& document_;
    const tinygltf::Primitive& primitive_;
    const std::string& name_;
};

Status decode_draco(VertexSource& source, Document& document, const DracoPrimitive& draco,
                    const tinygltf::Primitive& primitive, std::uint64_t max_triangles,
                    const std::string& name) {
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES)
        return fault(ErrorCode::kUnsupported, name, "KHR_draco_mesh_compression of strips and fans");
    if (!draco.attributes.contains("POSITION"))
        return fault(ErrorCode::kMalformed, name, "KHR_draco_mesh_compression without POSITION");
    const auto view = document.view(draco.view);
    if (!view.ok()) return fault(view.error().code, name, view.error().message);
    auto mesh = DracoMesh::decode(*view, max_triangles);
    if (!mesh.ok()) return fault(mesh.error().code, name, mesh.error().message);
    source.draco = &draco;
    source.mesh = std::move(*mesh);
    source.count = source.mesh.vertices;
    return Ok{};
}

/// The corners of a primitive's triangles, three each, from its indices or in the vertices' order.
Result<std::vector<std::uint32_t>> read_corners(Document& document, const tinygltf::Primitive& primitive,
                                                std::uint64_t vertices, std::uint64_t max_triangles,
                                                const std::string& name, std::uint64_t& leftover) {
    const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES;
    std::uint64_t count = vertices;
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
            if (sequence[i] >= vertices)
                return fault(ErrorCode::kMalformed, place,
                             "index " + std::to_string(i) + " names vertex " + std::to_string(sequence[i]) +
                                 " of " + std::to_string(vertices));
        }
        count = sequence.size();
    }
    const std::uint64_t triangles = count < 3 ? 0 : list ? count / 3 : count - 2;
    if (Status status = check_triangles(triangles, max_triangles, name); !status.ok()) return status.error();
    leftover = list ? count % 3 : count < 3 ? count : 0;
    const auto vertex = [&](std::uint64_t i) {
        return sequence.empty() ? static_cast<std::uint32_t>(i) : sequence[i];
    };
    std::vector<std::uint32_t> corners;
    corners.reserve(triangles * 3);
    for_each_triangle(primitive.mode, count, [&](std::uint64_t a, std::uint64_t b, std::uint64_t c) {
        for (const std::uint64_t i : {a, b, c}) corners.push_back(vertex(i));
    });
    return corners;
}

/// Everything but POSITION, the morph targets last.
Status read_attributes(const VertexSource& source, const tinygltf::Primitive& primitive,
                       const std::string& name, std::uint64_t left, PrimitiveMesh& out) {
    std::vector<std::string> names;
    for (const auto& [attribute, accessor] : primitive.attributes) names.push_back(attribute);
    if (source.draco != nullptr)
        for (const auto& [attribute, id] : source.draco->attributes)
            if (!primitive.attributes.contains(attribute)) names.push_back(attribute);
    const auto add = [&](Result<PrimitiveAttribute> read) -> Status {
        if (!read.ok()) return read.error();
        left -= read->values.size();
        out.attributes.push_back(std::move(*read));
        return Ok{};
    };
    // A slash, which no valid name has, is how morph targets' names are told from these.
    for (const std::string& attribute : names)
        if (attribute != "POSITION" && attribute.find('/') == attribute.npos)
            if (Status status = add(source.read(attribute, out.used, left)); !status.ok()) return status;
    for (std::size_t k = 0; k < primitive.targets.size(); ++k)
        for (const auto& [attribute, accessor] : primitive.targets[k]) {
            const std::string full = std::to_string(k) + "/" + attribute;
            const std::string place = name + "." + object_name("targets", k) + "." + attribute.substr(0, 100);
            if (Status status = add(source.read_accessor(accessor, full, place, out.used, left));
                !status.ok())
                return status;
        }
    return Ok{};
}

}  // namespace

bool is_triangles(const tinygltf::Primitive& primitive) {
    return primitive.mode == TINYGLTF_MODE_TRIANGLES || primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
           primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

int components_of(int type) {
    switch (type) {
        case TINYGLTF_TYPE_SCALAR:
            return 1;
        case TINYGLTF_TYPE_VEC2:
            return 2;
        case TINYGLTF_TYPE_VEC3:
            return 3;
        case TINYGLTF_TYPE_VEC4:
        case TINYGLTF_TYPE_MAT2:
            return 4;
        case TINYGLTF_TYPE_MAT3:
            return 9;
        case TINYGLTF_TYPE_MAT4:
            return 16;
        default:
            return 0;
    }
}

Result<PrimitiveMesh> read_primitive(Document& document, std::size_t mesh_number, std::size_t number,
                                     const WeightChannel& channel, std::uint64_t max_triangles,
                                     std::uint64_t max_attribute_values) {
    const std::string name = object_name("meshes", mesh_number) + "." + object_name("primitives", number);
    const tinygltf::Primitive& primitive = document.model.meshes[mesh_number].primitives[number];
    VertexSource source(document, primitive, name);
    PrimitiveMesh out;
    if (const auto draco = document.draco.find({mesh_number, number}); draco != document.draco.end()) {
        if (Status status = decode_draco(source, document, draco->second, primitive, max_triangles, name);
            !status.ok())
            return status.error();
        out.corners = std::move(source.mesh.corners);
    } else {
        const auto found = primitive.attributes.find("POSITION");
        if (found == primitive.attributes.end())
            return out;  // glTF lets extensions give the positions; none that we read does.
        const auto positions = AccessorReader::open(document, found->second, name + ".attributes.POSITION");
        if (!positions.ok()) return positions.error();
        if (positions->type() != TINYGLTF_TYPE_VEC3 ||
            positions->component_type() == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
            return fault(ErrorCode::kMalformed, name + ".attributes.POSITION",
                         "no vector of three floats, bytes or shorts");
        if (positions->count() > std::numeric_limits<std::uint32_t>::max())
            return fault(ErrorCode::kLimit, name, "more than 4,294,967,295 vertices");
        source.count = positions->count();
        auto corners = read_corners(document, primitive, source.count, max_triangles, name, out.leftover);
        if (!corners.ok()) return corners.error();
        out.corners = std::move(*corners);
    }
    out.used = compact(out.corners);
    out.listed = source.count;

    constexpr std::uint64_t kAll = std::numeric_limits<std::uint64_t>::max();
    const auto positions = source.read("POSITION", out.used, kAll);
    if (!positions.ok()) return positions.error();
    if (positions->type != TINYGLTF_TYPE_VEC3)
        return fault(ErrorCode::kMalformed, name, "Draco: POSITION is no vector of three");
    out.position_type = positions->component_type;
    out.position_normalised = positions->normalised;
    out.positions.reserve(out.used.size());
    for (std::size_t i = 0; i < out.used.size(); ++i) {
        const float* p = positions->values.data() + 3 * i;
        out.positions.push_back({p[0], p[1], p[2]});
    }
    if (!channel.attribute.empty() && source.has(channel.attribute)) {
        const auto weights = source.read(channel.attribute, out.used, kAll);
        if (!weights.ok()) return weights.error();
        const auto components = std::size_t(components_of(weights->type));
        if (std::size_t(channel.component) < components) {
            out.has_weights = true;
            out.weights.reserve(out.used.size());
            for (std::size_t i = 0; i < out.used.size(); ++i)
                out.weights.push_back(
                    weight_of(weights->values[i * components + std::size_t(channel.component)], channel));
        }
    }
    if (max_attribute_values > 0)
        if (Status status = read_attributes(source, primitive, name, max_attribute_values, out); !status.ok())
            return status.error();
    return out;
}

}  // namespace vsplit::bake
