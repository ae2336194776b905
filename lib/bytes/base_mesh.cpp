// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "base_mesh.hpp"

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <memory>

namespace vsplit {

Result<std::vector<std::byte>> encode_base(const BaseMesh& base) {
    if (base.triangles.empty()) return std::vector<std::byte>{};
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<std::uint32_t>(base.places.size()));
    mesh.SetNumFaces(base.triangles.size());
    for (std::uint32_t t = 0; t < base.triangles.size(); ++t) {
        draco::Mesh::Face face;
        for (std::size_t k = 0; k < 3; ++k) face[k] = draco::PointIndex(base.triangles[t][k]);
        mesh.SetFace(draco::FaceIndex(t), face);
    }
    draco::GeometryAttribute attribute;
    attribute.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_INT32, false, sizeof(Lattice3),
                   0);
    const int id = mesh.AddAttribute(attribute, true, mesh.num_points());
    for (std::uint32_t i = 0; i < mesh.num_points(); ++i)
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), base.places[i].data());

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

Result<BaseMesh> decode_base(std::span<const std::byte> bytes, std::uint32_t vertices,
                             std::uint32_t triangles) {
    const auto malformed = [](std::string message) {
        return Error{ErrorCode::kMalformed, std::move(message), Error::kNowhere, 0};
    };
    BaseMesh base;
    if (triangles == 0) {
        if (!bytes.empty()) return malformed("a base mesh without triangles has Draco bytes");
        base.places.resize(vertices);
        return base;
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
    const draco::PointAttribute* places = source->GetNamedAttribute(draco::GeometryAttribute::POSITION);
    if (!places || places->num_components() != 3 || places->data_type() != draco::DT_INT32)
        return malformed("the base mesh has no whole numbers for places");
    base.places.resize(vertices);
    for (std::uint32_t i = 0; i < vertices; ++i) {
        const draco::AttributeValueIndex at = places->mapped_index(draco::PointIndex(i));
        if (at.value() >= places->size()) return malformed("a place of the base mesh is missing");
        places->GetValue(at, base.places[i].data());
        for (const std::int32_t n : base.places[i])
            if (n < -kLatticeReach || n > kLatticeReach)
                return malformed("a place of the base mesh is too far away");
    }
    base.triangles.resize(triangles);
    for (std::uint32_t t = 0; t < triangles; ++t) {
        Triangle& out = base.triangles[t];
        for (std::size_t k = 0; k < 3; ++k) {
            out[k] = source->face(draco::FaceIndex(t))[k].value();
            if (out[k] >= vertices)
                return malformed("a triangle of the base mesh names a vertex that does not exist");
        }
        if (out[0] == out[1] || out[1] == out[2] || out[2] == out[0])
            return malformed("a triangle of the base mesh names a vertex twice");
    }
    return base;
}

}  // namespace vsplit
