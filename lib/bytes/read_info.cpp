// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "checksum.hpp"
#include "details.hpp"
#include "layout.hpp"
#include "table.hpp"
#include "vsplit/read.hpp"

namespace vsplit {
namespace {

Error at(std::uint64_t offset, ErrorCode code, std::string message) {
    return {code, std::move(message), offset, 0};
}

/// Bytes that the decoded mesh takes, and what decoding needs beside it.
std::uint64_t memory_needed(const FileInfo& info, const Details& details) {
    std::uint64_t floats = info.has_weights, numbers = info.has_weights;
    for (const ValueRule& rule : details.rules) {
        floats += rule.components;
        numbers += rule.numbers();
    }
    const std::uint64_t exact = info.lossless ? sizeof(std::array<std::uint32_t, 3>) : 0;
    const std::uint64_t vertex = sizeof(Float3) + sizeof(std::uint32_t) + 4 * floats;
    const std::uint64_t live_vertex = sizeof(LiveVertex) + 2 * sizeof(std::uint32_t) + 4 * numbers + exact;
    const std::uint64_t groups = info.largest_group > 0 ? 8 : 0;
    // Lists of slots have room for eight, and double as stars grow.
    const std::uint64_t lists = 8 * (8 * std::uint64_t{info.vertices} + 12 * std::uint64_t{info.triangles} +
                                     4 * std::uint64_t{info.corner_changes});
    const std::uint64_t models =
        SplitCodec::model_bytes(shape_of(details, info.has_weights, info.lossless, info.largest_group));
    return models + info.vertices * (vertex + live_vertex) +
           info.triangles * (3 * sizeof(Triangle) + groups) + lists +
           std::uint64_t{info.splits} * sizeof(Split) +
           std::uint64_t{info.corner_changes} * sizeof(CornerChange) +
           info.moves * (sizeof(VertexMove) + 4 * floats) +
           std::uint64_t{info.base_vertices} * sizeof(Lattice3) +
           std::uint64_t{info.base_triangles} * sizeof(Triangle);
}

/// What the header alone can contradict; `offset` is then where.
const char* header_fault(const FileInfo& info, std::uint64_t& offset) {
    offset = kBaseVerticesAt;
    if (info.base_vertices >= kNoVertex / 4 || info.base_triangles >= kNoVertex / 4)
        return "the base mesh's counts are too large";
    // Even the best compression leaves a trace of each vertex and triangle.
    if (info.base_vertices > std::uint64_t{info.base_bytes} * kPartsPerByte ||
        info.base_triangles > std::uint64_t{info.base_bytes} * kPartsPerByte)
        return "the base mesh announces more than its bytes can hold";
    offset = kDracoBytesAt;
    if (info.base_draco_bytes > info.base_bytes) return "the base mesh has more of Draco's bytes than it has";
    offset = kBaseErrorAt;
    if (!(info.base_error >= 0) || std::signbit(info.base_error))
        return "the base mesh's error is negative or not a number";
    offset = kLatticeAt;
    for (const double value : info.lattice_origin)
        if (!std::isfinite(value)) return "the lattice is not finite";
    if (!std::isfinite(info.lattice_step) || !(info.lattice_step >= 0)) return "the lattice is not finite";
    offset = kPositionBitsAt;
    if (info.lossless ? info.position_bits != 0
                      : info.position_bits < 2 || info.position_bits > kMostPositionBits)
        return "the lattice has a number of bits that does not exist";
    return nullptr;
}

}  // namespace

Result<FileInfo> read_info(std::span<const std::byte> bytes, const Limits& limits) {
    const std::size_t magic = std::min(bytes.size(), kMagic.size());
    if (magic == 0 ||
        !std::equal(kMagic.begin(), kMagic.begin() + magic, bytes.begin(),
                    [](unsigned char a, std::byte b) { return a == static_cast<unsigned char>(b); }))
        return at(0, ErrorCode::kMalformed, "not a .pmesh file");
    FileInfo info;
    if (bytes.size() >= 12) {
        info.version = get<std::uint32_t>(bytes, kVersionAt);
        if (info.version != kVersion)
            return at(
                kVersionAt, ErrorCode::kUnsupported,
                "version " + std::to_string(info.version) + " of the format; this is a reader of version 1");
    }
    if (bytes.size() < kHeaderBytes)
        return at(bytes.size(), ErrorCode::kTruncated,
                  "the file ends within its header of " + std::to_string(kHeaderBytes) + " bytes");
    if (get<std::uint32_t>(bytes, kHeaderChecksumAt) != checksum32(bytes.first(kHeaderChecksumAt)))
        return at(kHeaderChecksumAt, ErrorCode::kChecksum, "the header's checksum does not match");
    const auto flags = get<std::uint32_t>(bytes, kFlagsAt);
    if (flags & ~(kFlagWeights | kFlagLossless))
        return at(kFlagsAt, ErrorCode::kUnsupported, "unknown flags");
    info.has_weights = flags & kFlagWeights;
    info.lossless = flags & kFlagLossless;
    info.base_vertices = get<std::uint32_t>(bytes, kBaseVerticesAt);
    info.base_triangles = get<std::uint32_t>(bytes, kBaseTrianglesAt);
    info.bounds_min = get<Float3>(bytes, kBoundsAt);
    info.bounds_max = get<Float3>(bytes, kBoundsAt + sizeof(Float3));
    info.details_bytes = get<std::uint32_t>(bytes, kDetailsBytesAt);
    info.base_bytes = get<std::uint32_t>(bytes, kBaseBytesAt);
    info.base_draco_bytes = get<std::uint32_t>(bytes, kDracoBytesAt);
    info.table_bytes = get<std::uint32_t>(bytes, kTableBytesAt);
    info.base_error = get<float>(bytes, kBaseErrorAt);
    info.largest_group = get<std::uint32_t>(bytes, kLargestGroupAt);
    info.position_bits = get<std::uint32_t>(bytes, kPositionBitsAt);
    info.lattice_origin = get<std::array<double, 3>>(bytes, kLatticeAt);
    info.lattice_step = get<double>(bytes, kLatticeAt + sizeof(info.lattice_origin));
    info.position_step = info.lossless ? 0 : info.lattice_step;
    info.base_checksum = get<std::uint32_t>(bytes, kBaseChecksumAt);
    info.details_offset = kHeaderBytes;
    info.base_offset = info.details_offset + info.details_bytes;
    info.table_offset = info.base_offset + info.base_bytes;
    info.data_offset = info.table_offset + info.table_bytes;
    std::uint64_t offset = 0;
    if (const char* fault = header_fault(info, offset)) return at(offset, ErrorCode::kMalformed, fault);
    if (bytes.size() < info.base_offset)
        return at(bytes.size(), ErrorCode::kTruncated, "the file ends within its details");
    const auto detail_bytes = bytes.subspan(info.details_offset, info.details_bytes);
    if (get<std::uint32_t>(bytes, kDetailsChecksumAt) != checksum32(detail_bytes))
        return at(kDetailsChecksumAt, ErrorCode::kChecksum, "the details' checksum does not match");
    const char* fault = nullptr;
    std::size_t within = 0;
    const auto details = decode_details(detail_bytes, fault, within);
    if (!details) return at(info.details_offset + within, ErrorCode::kMalformed, fault);
    info.origin = details->origin;
    for (const ValueRule& rule : details->rules)
        info.attributes.push_back({rule.name, rule.semantic, rule.components,
                                   rule.coding == ValueCoding::kFloat || rule.coding == ValueCoding::kWhole});
    if (bytes.size() < info.data_offset)
        return at(bytes.size(), ErrorCode::kTruncated, "the file ends before its table does");
    const auto table = bytes.subspan(info.table_offset, info.table_bytes);
    if (get<std::uint32_t>(bytes, kTableChecksumAt) != checksum32(table))
        return at(kTableChecksumAt, ErrorCode::kChecksum, "the table's checksum does not match");
    if (const char* wrong = decode_table(table, info, within))
        return at(info.table_offset + within, ErrorCode::kMalformed, wrong);
    if (const std::uint64_t needed = memory_needed(info, *details); needed > limits.max_bytes)
        return at(info.table_offset, ErrorCode::kLimit,
                  "the mesh needs " + std::to_string(needed) + " bytes, the limit is " +
                      std::to_string(limits.max_bytes));
    return info;
}

}  // namespace vsplit
