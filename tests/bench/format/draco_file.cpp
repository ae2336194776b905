// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "draco_file.hpp"

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/core/draco_version.h>
#include <draco/mesh/mesh.h>

namespace vsplit::bench {

std::vector<char> encode_draco(const Mesh& mesh, int bits, int level) {
    draco::Mesh out;
    out.set_num_points(std::uint32_t(mesh.positions.size()));
    out.SetNumFaces(mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        draco::Mesh::Face face;
        for (std::size_t k = 0; k < 3; ++k) face[k] = draco::PointIndex(mesh.triangles[t][k]);
        out.SetFace(draco::FaceIndex(t), face);
    }
    draco::GeometryAttribute attribute;
    attribute.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, sizeof(Float3),
                   0);
    const int id = out.AddAttribute(attribute, true, out.num_points());
    for (std::uint32_t i = 0; i < out.num_points(); ++i)
        out.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &mesh.positions[i]);
    draco::Encoder encoder;
    if (bits > 0) encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
    encoder.SetSpeedOptions(10 - level, 10 - level);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeMeshToBuffer(out, &buffer).ok()) return {};
    return {buffer.data(), buffer.data() + buffer.size()};
}

std::size_t decode_draco(const std::vector<char>& bytes) {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
    return mesh.ok() ? mesh.value()->num_points() : 0;
}

std::string draco_version() {
    return draco::kDracoVersion;
}

}  // namespace vsplit::bench
