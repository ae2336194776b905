// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "checksum.hpp"
#include "details.hpp"
#include "layout.hpp"
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
    return info.vertices * (vertex + live_vertex) + info.triangles * (3 * sizeof(Triangle) + groups) + lists +
           std::uint64_t{info.splits} * sizeof(Split) +
           std::uint64_t{info.corner_changes} * sizeof(CornerChange) +
           info.moves * (sizeof(VertexMove) + 4 * floats) +
           std::uint64_t{info.base_vertices} * sizeof(Lattice3) +
           std::uint64_t{info.base_triangles} * sizeof(Triangle);
}

/// The reason if counts of the table contradict each other; `offset` is then where.
const char* table_fault(const FileInfo& info, std::uint64_t& offset) {
    BlockInfo before;
    before.vertices_end = info.base_vertices;
    before.triangles_end = info.base_triangles;
    before.error = info.base_error;
    std::uint64_t place = info.data_offset;
    for (std::size_t i = 0; i < info.blocks.size(); ++i) {
        const BlockInfo& block = info.blocks[i];
        offset = info.table_offset + kTableEntryBytes * i;
        if (block.offset != place) return "a block does not begin where the one before ends";
        if (block.bytes == 0) return "a block is empty";
        if (block.splits_end <= before.splits_end || block.vertices_end < before.vertices_end ||
            block.triangles_end < before.triangles_end || block.corners_end < before.corners_end ||
            block.moves_end < before.moves_end)
            return "a block's counts do not grow";
        // So that no count can exceed what the file's bytes can hold.
        const std::uint64_t parts =
            std::uint64_t{block.splits_end - before.splits_end} + (block.vertices_end - before.vertices_end) +
            (block.triangles_end - before.triangles_end) + (block.corners_end - before.corners_end) +
            (block.moves_end - before.moves_end);
        if (parts > block.bytes * kPartsPerByte)
            return "a block announces more parts than its bytes can hold";
        if (!(block.error >= 0) || !(block.error <= before.error))
            return "a block's error is negative or grows";
        place += block.bytes;
        before = block;
    }
    offset = 16;
    if (place != info.file_bytes) return "the last block does not end where the file does";
    offset = 28;
    if (before.splits_end != info.splits || before.vertices_end != info.vertices ||
        before.triangles_end != info.triangles || before.corners_end != info.corner_changes ||
        before.moves_end != info.moves)
        return "the table does not end at the counts of the header";
    return nullptr;
}

/// What the header alone can contradict; `offset` is then where.
const char* header_fault(const FileInfo& info, std::uint64_t block_count, std::uint64_t& offset) {
    offset = 28;
    if (info.base_vertices > info.vertices || info.base_triangles > info.triangles ||
        info.vertices >= kNoVertex / 4 || info.triangles >= kNoVertex / 4)
        return "the counts contradict each other";
    offset = 80;
    if (info.base_offset != kHeaderBytes + std::uint64_t{info.details_bytes} ||
        info.table_offset != info.base_offset + info.base_bytes || info.base_draco_bytes > info.base_bytes)
        return "the parts of the file do not follow each other";
    offset = 24;
    if (info.table_offset + kTableEntryBytes * block_count > info.file_bytes)
        return "the table does not end before the file does";
    offset = 92;
    if (!(info.base_error >= 0)) return "the base mesh's error is negative or not a number";
    offset = 36;
    // Even the best compression leaves a trace of each vertex and triangle.
    if (info.base_vertices > std::uint64_t{info.base_bytes} * kPartsPerByte ||
        info.base_triangles > std::uint64_t{info.base_bytes} * kPartsPerByte)
        return "the base mesh announces more than its bytes can hold";
    offset = 112;
    for (const double value : info.lattice_origin)
        if (!std::isfinite(value)) return "the lattice is not finite";
    if (!std::isfinite(info.lattice_step) || !(info.lattice_step >= 0)) return "the lattice is not finite";
    offset = 176;
    for (const double value : info.origin)
        if (!std::isfinite(value)) return "the origin is not finite";
    offset = 144;
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
        info.version = get<std::uint32_t>(bytes, 8);
        if (info.version != kVersion)
            return at(
                8, ErrorCode::kUnsupported,
                "version " + std::to_string(info.version) + " of the format; this is a reader of version 1");
    }
    if (bytes.size() < kHeaderBytes)
        return at(bytes.size(), ErrorCode::kTruncated,
                  "the file ends within its header of " + std::to_string(kHeaderBytes) + " bytes");
    if (get<std::uint64_t>(bytes, kHeaderChecksumAt) != checksum64(bytes.first(kHeaderChecksumAt)))
        return at(kHeaderChecksumAt, ErrorCode::kChecksum, "the header's checksum does not match");
    const auto flags = get<std::uint32_t>(bytes, 12);
    if (flags & ~(kFlagWeights | kFlagLossless)) return at(12, ErrorCode::kUnsupported, "unknown flags");
    info.has_weights = flags & kFlagWeights;
    info.lossless = flags & kFlagLossless;
    info.file_bytes = get<std::uint64_t>(bytes, 16);
    const std::uint64_t block_count = get<std::uint32_t>(bytes, 24);
    info.vertices = get<std::uint32_t>(bytes, 28);
    info.triangles = get<std::uint32_t>(bytes, 32);
    info.base_vertices = get<std::uint32_t>(bytes, 36);
    info.base_triangles = get<std::uint32_t>(bytes, 40);
    info.splits = get<std::uint32_t>(bytes, 44);
    info.corner_changes = get<std::uint32_t>(bytes, 48);
    info.moves = get<std::uint32_t>(bytes, 52);
    info.bounds_min = get<Float3>(bytes, 56);
    info.bounds_max = get<Float3>(bytes, 68);
    info.base_offset = get<std::uint64_t>(bytes, 80);
    info.base_bytes = get<std::uint32_t>(bytes, 88);
    info.base_error = get<float>(bytes, 92);
    info.base_checksum = get<std::uint64_t>(bytes, 96);
    info.lattice_origin = get<std::array<double, 3>>(bytes, 112);
    info.lattice_step = get<double>(bytes, 136);
    info.position_bits = get<std::uint32_t>(bytes, 144);
    info.position_step = info.lossless ? 0 : info.lattice_step;
    info.base_draco_bytes = get<std::uint32_t>(bytes, 148);
    info.largest_group = get<std::uint32_t>(bytes, 152);
    info.details_offset = kHeaderBytes;
    info.details_bytes = get<std::uint32_t>(bytes, 156);
    info.table_offset = get<std::uint64_t>(bytes, 160);
    info.origin = get<std::array<double, 3>>(bytes, 176);
    std::uint64_t offset = 0;
    if (const char* fault = header_fault(info, block_count, offset))
        return at(offset, ErrorCode::kMalformed, fault);
    info.data_offset = info.table_offset + kTableEntryBytes * block_count;
    if (bytes.size() < info.base_offset)
        return at(bytes.size(), ErrorCode::kTruncated, "the file ends within its details");
    const auto detail_bytes = bytes.subspan(info.details_offset, info.details_bytes);
    if (get<std::uint64_t>(bytes, kDetailsChecksumAt) != checksum64(detail_bytes))
        return at(kDetailsChecksumAt, ErrorCode::kChecksum, "the details' checksum does not match");
    const char* fault = nullptr;
    std::size_t in_details = 0;
    const auto details = decode_details(detail_bytes, fault, in_details);
    if (!details) return at(info.details_offset + in_details, ErrorCode::kMalformed, fault);
    for (const ValueRule& rule : details->rules)
        info.attributes.push_back({rule.name, rule.semantic, rule.components,
                                   rule.coding == ValueCoding::kFloat || rule.coding == ValueCoding::kWhole});
    if (bytes.size() < info.data_offset)
        return at(bytes.size(), ErrorCode::kTruncated,
                  "the file ends before its table of " + std::to_string(block_count) + " blocks does");
    const auto table = bytes.subspan(info.table_offset, info.data_offset - info.table_offset);
    if (get<std::uint64_t>(bytes, kTableChecksumAt) != checksum64(table))
        return at(kTableChecksumAt, ErrorCode::kChecksum, "the table's checksum does not match");
    info.blocks.resize(block_count);
    for (std::size_t i = 0; i < block_count; ++i) {
        const auto entry = table.subspan(kTableEntryBytes * i, kTableEntryBytes);
        BlockInfo& block = info.blocks[i];
        block.offset = get<std::uint64_t>(entry, 0);
        block.bytes = get<std::uint32_t>(entry, 8);
        block.checksum = get<std::uint64_t>(entry, 12);
        block.splits_end = get<std::uint32_t>(entry, 20);
        block.vertices_end = get<std::uint32_t>(entry, 24);
        block.triangles_end = get<std::uint32_t>(entry, 28);
        block.corners_end = get<std::uint32_t>(entry, 32);
        block.moves_end = get<std::uint32_t>(entry, 36);
        block.error = get<float>(entry, 40);
    }
    if (const char* wrong = table_fault(info, offset)) return at(offset, ErrorCode::kMalformed, wrong);
    if (const std::uint64_t needed = memory_needed(info, *details); needed > limits.max_bytes)
        return at(28, ErrorCode::kLimit,
                  "the mesh needs " + std::to_string(needed) + " bytes, the limit is " +
                      std::to_string(limits.max_bytes));
    return info;
}

}  // namespace vsplit
