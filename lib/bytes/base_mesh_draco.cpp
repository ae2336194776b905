// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <memory>

#include "base_mesh.hpp"

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
    std::vector<std::byte> bytes(data, data + buffer.size());
    BaseMesh back{std::vector<Lattice3>(base.places.size()), std::vector<Triangle>(base.triangles.size())};
    const Status read = decode_draco(bytes, std::span(back.places.data()->data(), 3 * back.places.size()),
                                     std::span(back.triangles.data()->data(), 3 * back.triangles.size()));
    if (!read || back.places != base.places || back.triangles != base.triangles) bytes.clear();
    return bytes;
}

Status decode_draco(std::span<const std::byte> bytes, std::span<std::int32_t> places_out,
                    std::span<std::uint32_t> corners) {
    const auto malformed = [](std::string message) {
        return Error{ErrorCode::kMalformed, std::move(message), Error::kNowhere, 0};
    };
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
        return malformed("Draco cannot decode the base mesh: " + decoded.status().error_msg_string());
    const std::unique_ptr<draco::Mesh> source = std::move(decoded).value();
    if (3 * std::size_t{source->num_points()} != places_out.size() ||
        3 * std::size_t{source->num_faces()} != corners.size())
        return malformed("the base mesh has other counts than the header announces");
    const draco::PointAttribute* places = source->GetNamedAttribute(draco::GeometryAttribute::POSITION);
    if (!places || places->num_components() != 3 || places->data_type() != draco::DT_INT32)
        return malformed("the base mesh has no whole numbers for places");
    for (std::uint32_t i = 0; i < source->num_points(); ++i) {
        const draco::AttributeValueIndex at = places->mapped_index(draco::PointIndex(i));
        if (at.value() >= places->size()) return malformed("a place of the base mesh is missing");
        places->GetValue(at, &places_out[std::size_t{3} * i]);
    }
    for (std::uint32_t t = 0; t < source->num_faces(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            corners[3 * std::size_t{t} + k] = source->face(draco::FaceIndex(t))[k].value();
    return Ok{};
}

}  // namespace vsplit
