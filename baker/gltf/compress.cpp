// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "compress.hpp"

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>

#include "compressed.hpp"
#include "level_geometry.hpp"

namespace vsplit::bake {
namespace {

draco::DataType data_type(std::uint32_t component_type) {
    switch (component_type) {
        case kByte:
            return draco::DT_INT8;
        case kUnsignedByte:
            return draco::DT_UINT8;
        case kShort:
            return draco::DT_INT16;
        case kUnsignedShort:
            return draco::DT_UINT16;
        default:
            return draco::DT_FLOAT32;
    }
}

draco::GeometryAttribute::Type draco_type(const VertexValues& values, bool floats) {
    if (values.name == "POSITION") return draco::GeometryAttribute::POSITION;
    switch (values.semantic) {
        case Semantic::kNormal:
            // Normals of integers are predicted as if they were on the octahedron, and come out as anything.
            return floats ? draco::GeometryAttribute::NORMAL : draco::GeometryAttribute::GENERIC;
        case Semantic::kTexcoord:
            return draco::GeometryAttribute::TEX_COORD;
        case Semantic::kColor:
            return draco::GeometryAttribute::COLOR;
        default:
            return draco::GeometryAttribute::GENERIC;
    }
}

Error fault(const std::string& message) {
    return {ErrorCode::kUnsupported, "Draco: " + message, Error::kNowhere, 0};
}

}  // namespace

Result<DracoStream> encode_draco(std::span<const VertexValues* const> names,
                                 std::span<const PackedValues> values, std::span<const std::uint32_t> corners,
                                 const Grid& box, bool keep_order) {
    const std::size_t vertices = values[0].count;
    draco::Mesh mesh;
    mesh.set_num_points(std::uint32_t(vertices));
    mesh.SetNumFaces(corners.size() / 3);
    for (std::size_t f = 0; f < corners.size() / 3; ++f)
        mesh.SetFace(draco::FaceIndex(std::uint32_t(f)),
                     {draco::PointIndex(corners[3 * f]), draco::PointIndex(corners[3 * f + 1]),
                      draco::PointIndex(corners[3 * f + 2])});
    std::vector<int> numbers;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const PackedValues& from = values[i];
        const std::uint32_t width = component_bytes(from.stored.component_type) * names[i]->components;
        draco::GeometryAttribute attribute;
        attribute.Init(draco_type(*names[i], from.stored.component_type == kFloat), nullptr,
                       std::int8_t(names[i]->components), data_type(from.stored.component_type),
                       from.stored.normalised, width, 0);
        const int number = mesh.AddAttribute(attribute, true, std::uint32_t(vertices));
        for (std::uint32_t v = 0; v < vertices; ++v)
            mesh.attribute(number)->SetAttributeValue(draco::AttributeValueIndex(v),
                                                      from.bytes.data() + std::size_t{v} * from.stride);
        numbers.push_back(number);
    }
    DracoStream out;
    for (const int number : numbers) out.ids.push_back(mesh.attribute(number)->unique_id());
    if (!keep_order) {
        // Only so does the connectivity coder see across seams.
        mesh.DeduplicateAttributeValues();
        mesh.DeduplicatePointIds();
    }
    draco::ExpertEncoder encoder(mesh);
    encoder.SetSpeedOptions(3, 3);
    encoder.SetEncodingMethod(keep_order ? draco::MESH_SEQUENTIAL_ENCODING
                                         : draco::MESH_EDGEBREAKER_ENCODING);
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (values[i].stored.component_type != kFloat) continue;
        if (i == 0) {
            const float origin[3] = {float(box.offset[0]), float(box.offset[1]), float(box.offset[2])};
            encoder.SetAttributeExplicitQuantization(numbers[i], 14, 3, origin, float(box.scale));
        } else if (names[i]->semantic == Semantic::kTexcoord) {
            encoder.SetAttributeQuantization(numbers[i], 12);
        } else if (names[i]->semantic == Semantic::kNormal || names[i]->semantic == Semantic::kTangent ||
                   names[i]->semantic == Semantic::kColor) {
            encoder.SetAttributeQuantization(numbers[i], 10);
        }
    }
    draco::EncoderBuffer buffer;
    if (const draco::Status status = encoder.EncodeToBuffer(&buffer); !status.ok())
        return fault(status.error_msg());
    const auto* bytes = reinterpret_cast<const std::byte*>(buffer.data());
    out.bytes.assign(bytes, bytes + buffer.size());
    // What comes out is what the accessors must announce.
    const auto decoded = DracoMesh::decode(out.bytes, corners.size() / 3);
    if (!decoded.ok()) return decoded.error();
    const auto positions = decoded->attribute(out.ids[0]);
    if (!positions.ok()) return positions.error();
    out.vertices = decoded->vertices;
    out.corners = decoded->corners.size();
    if (keep_order && out.vertices != vertices) return fault("the vertices did not keep their order");
    if (positions->values.empty()) return fault("nothing is left of the primitive");
    for (std::size_t c = 0; c < 3; ++c) {
        const auto [least, most] =
            std::minmax_element(positions->values.begin(), positions->values.end(),
                                [&](const auto& a, const auto& b) { return a[c] < b[c]; });
        out.min.push_back(double((*least)[c]));
        out.max.push_back(double((*most)[c]));
    }
    return out;
}

}  // namespace vsplit::bake
