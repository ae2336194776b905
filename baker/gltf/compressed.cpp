// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "compressed.hpp"

#include <draco/compression/decode.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <limits>

namespace vsplit::bake {
namespace {

Error fault(ErrorCode code, std::string message) {
    return {code, std::move(message), Error::kNowhere, 0};
}

/// Draco puts about seven triangles of a flat, regular grid into a byte, and fewer of anything else; a stream
/// that announces more than this is made to exhaust memory.
constexpr std::uint64_t kTrianglesPerByte = 1024;

/// The face count that a Draco stream announces, read as its decoder will (Draco bitstream specification 2.2,
/// sections 3 and 4), so that it can be refused before the decoder allocates for it.
Result<std::uint64_t> announced_faces(Bytes source) {
    std::size_t at = 0;
    bool ended = false;
    const auto byte = [&]() -> std::uint32_t {
        if (at >= source.size()) {
            ended = true;
            return 0;
        }
        return std::to_integer<std::uint32_t>(source[at++]);
    };
    const auto varint = [&] {
        std::uint64_t value = 0;
        for (int shift = 0; shift < 35; shift += 7) {
            const std::uint32_t b = byte();
            value |= std::uint64_t{b & 0x7f} << shift;
            if ((b & 0x80) == 0) break;
        }
        return value;
    };
    for (const char c : {'D', 'R', 'A', 'C', 'O'})
        if (byte() != static_cast<std::uint32_t>(c)) return fault(ErrorCode::kMalformed, "no Draco stream");
    const std::uint32_t major = byte(), minor = byte(), type = byte(), method = byte(),
                        flags = byte() | byte() << 8;
    // glTF's extension asks for bitstream 2.2; older ones lay their counts out differently.
    if (!ended && (major != 2 || minor != 2))
        return fault(ErrorCode::kUnsupported, "Draco bitstream " + std::to_string(major) + "." +
                                                  std::to_string(minor) + ", only 2.2 is read");
    if (!ended && type != 1) return fault(ErrorCode::kMalformed, "the Draco stream is no mesh");
    if (!ended && (flags & 0x8000) != 0)
        return fault(ErrorCode::kUnsupported, "a Draco stream with metadata");
    std::uint64_t faces = 0;
    if (method == 1) {
        byte();  // how edgebreaker's traversal is coded
        const auto vertices = varint();
        faces = varint();
        if (vertices > 3 * faces)
            return fault(ErrorCode::kMalformed, "the Draco stream has more vertices than corners");
    } else {
        faces = varint();
        const auto points = varint();
        if (points > 3 * faces)
            return fault(ErrorCode::kMalformed, "the Draco stream has more vertices than corners");
    }
    if (ended) return fault(ErrorCode::kTruncated, "the Draco stream ends in its header");
    return faces;
}

}  // namespace

Result<std::vector<std::byte>> decode_meshopt(const MeshoptView& view, Bytes source,
                                              std::uint64_t max_bytes) {
    const bool attributes = view.mode == "ATTRIBUTES", triangles = view.mode == "TRIANGLES";
    if (!attributes && !triangles && view.mode != "INDICES")
        return fault(ErrorCode::kUnsupported,
                     "EXT_meshopt_compression: mode '" + view.mode.substr(0, 40) + "'");
    const std::uint64_t stride = view.stride, count = view.count;
    const bool oct = view.filter == "OCTAHEDRAL", quat = view.filter == "QUATERNION",
               exponential = view.filter == "EXPONENTIAL";
    if (!view.filter.empty() && view.filter != "NONE" && !oct && !quat && !exponential)
        return fault(ErrorCode::kUnsupported,
                     "EXT_meshopt_compression: filter '" + view.filter.substr(0, 40) + "'");
    const bool fits = attributes ? stride > 0 && stride <= 256 && stride % 4 == 0 &&
                                       (!oct || stride == 4 || stride == 8) && (!quat || stride == 8)
                                 : (stride == 2 || stride == 4) && !oct && !quat && !exponential &&
                                       (!triangles || count % 3 == 0);
    if (!fits)
        return fault(ErrorCode::kMalformed,
                     "EXT_meshopt_compression: mode, stride, count and filter do not go together");
    // No count can be real that these bytes could not hold; 4096 covers the blocks' rounding.
    const std::uint64_t most = kMeshoptExpansion * (source.size() + 4096);
    if (count > most / stride || (!attributes && count > source.size() * 3))
        return fault(ErrorCode::kMalformed, "EXT_meshopt_compression: " + std::to_string(count) +
                                                " elements cannot be in " + std::to_string(source.size()) +
                                                " bytes");
    if (count * stride > max_bytes)
        return fault(ErrorCode::kLimit,
                     "EXT_meshopt_compression: the views expand to more than 64 times the file");
    std::vector<std::byte> bytes(count * stride);
    if (count == 0) return bytes;
    const auto* from = reinterpret_cast<const unsigned char*>(source.data());
    const int failed =
        attributes  ? meshopt_decodeVertexBuffer(bytes.data(), count, stride, from, source.size())
        : triangles ? meshopt_decodeIndexBuffer(bytes.data(), count, stride, from, source.size())
                    : meshopt_decodeIndexSequence(bytes.data(), count, stride, from, source.size());
    if (failed != 0)
        return fault(ErrorCode::kMalformed, "EXT_meshopt_compression: the stream does not decode");
    if (oct) meshopt_decodeFilterOct(bytes.data(), count, stride);
    if (quat) meshopt_decodeFilterQuat(bytes.data(), count, stride);
    if (exponential) meshopt_decodeFilterExp(bytes.data(), count, stride);
    return bytes;
}

Result<DracoMesh> DracoMesh::decode(Bytes source, std::uint64_t max_triangles) {
    const auto faces = announced_faces(source);
    if (!faces.ok()) return faces.error();
    if (*faces > max_triangles || *faces > kTrianglesPerByte * source.size())
        return fault(ErrorCode::kLimit, "the Draco stream announces " + std::to_string(*faces) +
                                            " triangles in " + std::to_string(source.size()) + " bytes");
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(source.data()), source.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
        return fault(ErrorCode::kMalformed, std::string("Draco: ") + decoded.status().error_msg());
    std::shared_ptr<draco::Mesh> mesh(std::move(decoded).value());
    DracoMesh out;
    out.vertices = mesh->num_points();
    out.corners.reserve(std::size_t{mesh->num_faces()} * 3);
    for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f)
        for (const draco::PointIndex& p : mesh->face(f)) {
            if (p.value() >= out.vertices)
                return fault(ErrorCode::kMalformed, "Draco: a face names a vertex that does not exist");
            out.corners.push_back(p.value());
        }
    out.mesh_ = std::move(mesh);
    return out;
}

Result<DracoMesh::Attribute> DracoMesh::attribute(std::uint32_t id) const {
    const auto* mesh = static_cast<const draco::Mesh*>(mesh_.get());
    const draco::PointAttribute* source = mesh->GetAttributeByUniqueId(id);
    if (source == nullptr)
        return fault(ErrorCode::kMalformed, "Draco: there is no attribute with the id " + std::to_string(id));
    if (!source->is_mapping_identity() && source->indices_map_size() < vertices)
        return fault(ErrorCode::kMalformed, "Draco: an attribute has fewer values than vertices");
    Attribute out;
    out.components = std::min<int>(source->num_components(), 4);
    out.normalised = source->normalized();
    out.values.resize(vertices);
    for (std::uint32_t v = 0; v < vertices; ++v) {
        const auto entry = source->mapped_index(draco::PointIndex(v));
        if (entry.value() >= source->size() || !source->ConvertValue<float, 4>(entry, out.values[v].data()))
            return fault(ErrorCode::kMalformed, "Draco: an attribute value does not exist");
    }
    return out;
}

}  // namespace vsplit::bake
