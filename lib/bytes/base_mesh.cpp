// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "base_mesh.hpp"

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <cstring>
#include <memory>

namespace vsplit {
namespace {

/// Adds `values` as an attribute whose entry i belongs to point i.
template <int kComponents>
int add_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, const float* values) {
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, kComponents, draco::DT_FLOAT32, false, kComponents * sizeof(float), 0);
    const int id = mesh.AddAttribute(attribute, true, mesh.num_points());
    for (std::uint32_t i = 0; i < mesh.num_points(); ++i)
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i),
                                              values + std::size_t{kComponents} * i);
    return id;
}

template <int kComponents>
bool read_attribute(const draco::Mesh& mesh, draco::GeometryAttribute::Type type, float* values) {
    const draco::PointAttribute* attribute = mesh.GetNamedAttribute(type);
    if (!attribute || attribute->num_components() != kComponents ||
        attribute->data_type() != draco::DT_FLOAT32)
        return false;
    for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
        const draco::AttributeValueIndex at = attribute->mapped_index(draco::PointIndex(i));
        if (at.value() >= attribute->size()) return false;
        attribute->GetValue(at, values + std::size_t{kComponents} * i);
    }
    return true;
}

/// Draco knows no mesh without a triangle: its floats as they are, positions, then weights.
std::vector<std::byte> encode_points(const Mesh& base) {
    const auto positions = std::as_bytes(std::span(base.positions)),
               weights = std::as_bytes(std::span(base.weights));
    std::vector<std::byte> bytes(positions.begin(), positions.end());
    bytes.insert(bytes.end(), weights.begin(), weights.end());
    return bytes;
}

bool decode_points(std::span<const std::byte> bytes, std::uint32_t vertices, bool has_weights, Mesh& base) {
    const std::size_t positions = std::size_t{vertices} * sizeof(Float3),
                      weights = has_weights ? std::size_t{vertices} * sizeof(float) : 0;
    if (bytes.size() != positions + weights) return false;
    base.positions.resize(vertices);
    base.weights.resize(has_weights ? vertices : 0);
    if (positions > 0) std::memcpy(base.positions.data(), bytes.data(), positions);
    if (weights > 0) std::memcpy(base.weights.data(), bytes.data() + positions, weights);
    return true;
}

}  // namespace

Result<std::vector<std::byte>> encode_base(const Mesh& base) {
    if (base.triangles.empty()) return encode_points(base);
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<std::uint32_t>(base.positions.size()));
    mesh.SetNumFaces(base.triangles.size());
    for (std::uint32_t t = 0; t < base.triangles.size(); ++t) {
        draco::Mesh::Face face;
        for (std::size_t k = 0; k < 3; ++k) face[k] = draco::PointIndex(base.triangles[t][k]);
        mesh.SetFace(draco::FaceIndex(t), face);
    }
    add_attribute<3>(mesh, draco::GeometryAttribute::POSITION, &base.positions.data()->x);
    if (!base.weights.empty()) add_attribute<1>(mesh, draco::GeometryAttribute::GENERIC, base.weights.data());

    draco::Encoder encoder;
    encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);
    encoder.SetSpeedOptions(0, 0);
    draco::EncoderBuffer buffer;
    if (const draco::Status status = encoder.EncodeMeshToBuffer(mesh, &buffer); !status.ok())
        return Error{ErrorCode::kMalformed, "Draco cannot encode the base mesh: " + status.error_msg_string(),
                     Error::kNowhere, 0};
    const auto* data = reinterpret_cast<const std::byte*>(buffer.data());
    return std::vector<std::byte>(data, data + buffer.size());
}

Result<Mesh> decode_base(std::span<const std::byte> bytes, std::uint32_t vertices, std::uint32_t triangles,
                         bool has_weights) {
    const auto malformed = [](std::string message) {
        return Error{ErrorCode::kMalformed, std::move(message), Error::kNowhere, 0};
    };
    if (triangles == 0) {
        Mesh points;
        if (!decode_points(bytes, vertices, has_weights, points))
            return malformed("the base mesh has other bytes than its points need");
        return points;
    }
    if (vertices == 0) return malformed("the base mesh has triangles but no vertices");
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
        return malformed("Draco cannot decode the base mesh: " + decoded.status().error_msg_string());
    const std::unique_ptr<draco::Mesh> source = std::move(decoded).value();
    if (source->num_points() != vertices || source->num_faces() != triangles)
        return malformed("the base mesh has other counts than the header announces");
    Mesh mesh;
    mesh.positions.resize(vertices);
    mesh.triangles.resize(triangles);
    if (!read_attribute<3>(*source, draco::GeometryAttribute::POSITION, &mesh.positions.data()->x))
        return malformed("the base mesh has no float positions");
    if (has_weights) {
        mesh.weights.resize(vertices);
        if (!read_attribute<1>(*source, draco::GeometryAttribute::GENERIC, mesh.weights.data()))
            return malformed("the base mesh has no float weights");
    }
    for (std::uint32_t t = 0; t < triangles; ++t)
        for (std::size_t k = 0; k < 3; ++k)
            mesh.triangles[t][k] = source->face(draco::FaceIndex(t))[k].value();
    return mesh;
}

}  // namespace vsplit
