// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "vsplit/read.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>

#include "base_mesh.hpp"
#include "checksum.hpp"
#include "columns.hpp"
#include "layout.hpp"

namespace vsplit {
namespace {

Error at(std::uint64_t offset, ErrorCode code, std::string message) {
    return {code, std::move(message), offset, 0};
}

/// Turns the columns of a block back into splits, appended to a mesh whose arrays have room for all that the
/// header announces.
class BlockDecoder {
  public:
    BlockDecoder(ProgressiveMesh& mesh, const FileInfo& info) : mesh_(mesh), info_(info) {
        end_.vertices_end = info.base_vertices;
        end_.triangles_end = info.base_triangles;
    }

    /// The reason if `raw` contradicts the format or the table.
    const char* decode(std::span<const std::byte> raw, const BlockInfo& block) {
        if (raw.size() < 4 * kColumnCount) return "a block is too short for its column sizes";
        std::size_t start = 4 * kColumnCount;
        for (std::size_t i = 0; i < kColumnCount; ++i) {
            const std::size_t size = get<std::uint32_t>(raw, 4 * i);
            if (size > raw.size() - start) return "a column ends behind its block";
            columns_[i] = {raw.subspan(start, size)};
            start += size;
        }
        if (start != raw.size()) return "a block is longer than its columns";
        error_bits_ = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::max());
        while (mesh_.splits.size() < block.splits_end)
            if (const char* fault = split(block)) return fault;
        for (const ColumnReader& column : columns_) {
            if (!column.ok) return "a column ends too early";
            if (!column.bytes.empty()) return "a column is longer than its splits need";
        }
        if (end_.vertices_end != block.vertices_end || end_.triangles_end != block.triangles_end ||
            end_.corners_end != block.corners_end || end_.moves_end != block.moves_end)
            return "a block ends at other counts than the table announces";
        return nullptr;
    }

  private:
    std::uint32_t next(Column which) { return columns_[static_cast<std::size_t>(which)].varint(); }
    float next_float(Column which, float predicted) {
        return from_ordered_bits(ordered_bits(predicted) + unzigzag(next(which)));
    }
    Float3 next_position(Column x, const Float3& predicted) {
        const auto first = static_cast<std::uint8_t>(x);
        return {next_float(static_cast<Column>(first), predicted.x),
                next_float(static_cast<Column>(first + 1), predicted.y),
                next_float(static_cast<Column>(first + 2), predicted.z)};
    }

    const char* split(const BlockInfo& block) {
        const std::uint32_t vertices = next(Column::kNewVertices), triangles = next(Column::kNewTriangles),
                            corners = next(Column::kCornerCount), moves = next(Column::kMoveCount);
        if (vertices > block.vertices_end - end_.vertices_end ||
            triangles > block.triangles_end - end_.triangles_end ||
            corners > block.corners_end - end_.corners_end || moves > block.moves_end - end_.moves_end)
            return "a split has more parts than its block announces";
        const std::uint32_t first = end_.vertices_end;
        Split split{first + vertices, end_.triangles_end + triangles, end_.corners_end + corners,
                    end_.moves_end + moves, 0};
        error_bits_ -= next(Column::kErrors);
        split.error = std::bit_cast<float>(error_bits_);

        Float3 place;
        for (std::uint32_t v = first; v < split.vertices_end; ++v) {
            const std::uint32_t back = next(Column::kParents);
            if (back > first) return "a vertex has a parent before the first";
            const std::uint32_t parent = back == 0 ? kNoVertex : first - back;
            mesh_.parents.push_back(parent);
            if (parent != kNoVertex) place = current_[parent];
            place = next_position(Column::kBirthX, place);
            mesh_.positions.push_back(place);
            if (info_.has_weights)
                mesh_.weights.push_back(
                    next_float(Column::kWeights, parent == kNoVertex ? 1.0f : current_weights_[parent]));
        }
        const std::uint32_t parent = vertices > 0 ? mesh_.parents[first] : kNoVertex;
        for (std::uint32_t i = 0; i < moves; ++i) {
            VertexMove move;
            move.vertex = (parent == kNoVertex ? 0 : parent) + unzigzag(next(Column::kMovedVertices));
            if (move.vertex >= first) return "a move names a vertex that does not exist";
            move.position = next_position(Column::kMoveX, current_[move.vertex]);
            if (info_.has_weights) move.weight = next_float(Column::kWeights, current_weights_[move.vertex]);
            mesh_.moves.push_back(move);
        }
        for (std::uint32_t i = end_.moves_end; i < split.moves_end; ++i) {
            const VertexMove& move = mesh_.moves[i];
            current_[move.vertex] = move.position;
            if (info_.has_weights) current_weights_[move.vertex] = move.weight;
        }
        current_.insert(current_.end(), mesh_.positions.begin() + first, mesh_.positions.end());
        if (info_.has_weights)
            current_weights_.insert(current_weights_.end(), mesh_.weights.begin() + first,
                                    mesh_.weights.end());
        std::uint32_t corner = 3 * end_.triangles_end;
        for (std::uint32_t i = 0; i < corners; ++i) {
            corner -= unzigzag(next(Column::kCorners));
            mesh_.corner_changes.push_back({corner, first + next(Column::kCornerVertices)});
        }
        for (std::uint32_t t = 0; t < triangles; ++t) {
            Triangle triangle;
            for (std::uint32_t& v : triangle) v = split.vertices_end - 1 - next(Column::kTriangles);
            mesh_.triangles.push_back(triangle);
        }
        mesh_.splits.push_back(split);
        end_ = split;
        return nullptr;
    }

  public:
    /// The full mesh's positions, after the last block.
    std::span<const Float3> positions() const { return current_; }

    void begin_with(const Mesh& base) {
        current_ = base.positions;
        current_.reserve(info_.vertices);
        current_weights_ = base.weights;
        current_weights_.reserve(info_.has_weights ? info_.vertices : 0);
    }

  private:
    ProgressiveMesh& mesh_;
    const FileInfo& info_;
    std::vector<Float3> current_;  // at the level reached
    std::vector<float> current_weights_;
    std::array<ColumnReader, kColumnCount> columns_;
    Split end_;
    std::uint32_t error_bits_ = 0;
};

/// Bytes that the decoded mesh takes, and what decoding needs beside it.
std::uint64_t memory_needed(const FileInfo& info) {
    std::uint32_t largest_block = 0;
    for (const BlockInfo& block : info.blocks) largest_block = std::max(largest_block, block.raw_bytes);
    const std::uint64_t vertex = (info.has_weights ? 4 : 0) + sizeof(Float3) + sizeof(std::uint32_t);
    const std::uint64_t current = (info.has_weights ? 4 : 0) + sizeof(Float3);
    return info.vertices * (vertex + current) + std::uint64_t{info.triangles} * 2 * sizeof(Triangle) +
           std::uint64_t{info.splits} * sizeof(Split) +
           std::uint64_t{info.corner_changes} * sizeof(CornerChange) +
           std::uint64_t{info.moves} * sizeof(VertexMove) + largest_block;
}

/// The reason if counts of the table contradict each other; `offset` is then where.
const char* table_fault(const FileInfo& info, std::uint64_t& offset) {
    BlockInfo before;
    before.vertices_end = info.base_vertices;
    before.triangles_end = info.base_triangles;
    before.error = info.base_error;
    std::uint64_t place = info.base_offset + info.base_bytes;
    for (std::size_t i = 0; i < info.blocks.size(); ++i) {
        const BlockInfo& block = info.blocks[i];
        offset = kHeaderBytes + kTableEntryBytes * i;
        if (block.offset != place) return "a block does not begin where the one before ends";
        if (block.bytes == 0 || block.raw_bytes == 0) return "a block is empty";
        if (block.splits_end <= before.splits_end || block.vertices_end < before.vertices_end ||
            block.triangles_end < before.triangles_end || block.corners_end < before.corners_end ||
            block.moves_end < before.moves_end)
            return "a block's counts do not grow";
        // Every part costs at least a byte of its columns; so no count can exceed what the block's bytes can
        // hold.
        const std::uint64_t parts =
            std::uint64_t{block.splits_end - before.splits_end} + (block.vertices_end - before.vertices_end) +
            (block.triangles_end - before.triangles_end) + (block.corners_end - before.corners_end) +
            (block.moves_end - before.moves_end);
        if (parts > block.raw_bytes) return "a block announces more parts than its bytes can hold";
        // zstd's strongest possible packing: a run of 128 KiB in a block of three bytes.
        if (block.raw_bytes > std::uint64_t{block.bytes} * 65536)
            return "a block announces more bytes than it can unpack to";
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

/// The reason if the header or the table announces other errors or bounds than the mesh has; `offset` is then
/// where.
const char* announcement_fault(const FileInfo& info, const ProgressiveMesh& mesh,
                               std::span<const Float3> full, std::uint64_t& offset) {
    offset = 92;
    if (double(info.base_error) != error_at(mesh, 0))
        return "the base mesh has another error than the header announces";
    for (std::size_t i = 0; i < info.blocks.size(); ++i) {
        offset = kHeaderBytes + kTableEntryBytes * i + 44;
        if (double(info.blocks[i].error) != error_at(mesh, info.blocks[i].splits_end))
            return "a block ends at another error than the table announces";
    }
    offset = 56;
    const Bounds bounds = bounds_of(full);
    if (bounds.low != info.bounds_min || bounds.high != info.bounds_max)
        return "the mesh has other bounds than the header announces";
    return nullptr;
}

}  // namespace

Result<FileInfo> read_info(std::span<const std::byte> bytes, const Limits& limits) {
    const std::size_t magic = std::min(bytes.size(), kMagic.size());
    if (magic == 0 ||
        !std::equal(kMagic.begin(), kMagic.begin() + magic, bytes.begin(),
                    [](unsigned char a, std::byte b) { return a == static_cast<unsigned char>(b); }))
        return at(0, ErrorCode::kMalformed, "not a .pmesh file");
    if (bytes.size() < kHeaderBytes)
        return at(bytes.size(), ErrorCode::kTruncated, "the file ends within its header of 120 bytes");
    FileInfo info;
    info.version = get<std::uint32_t>(bytes, 8);
    if (info.version != kVersion)
        return at(
            8, ErrorCode::kUnsupported,
            "version " + std::to_string(info.version) + " of the format; this is a reader of version 0");
    if (get<std::uint64_t>(bytes, kHeaderChecksumAt) != checksum64(bytes.first(kHeaderChecksumAt)))
        return at(kHeaderChecksumAt, ErrorCode::kChecksum, "the header's checksum does not match");
    const auto flags = get<std::uint32_t>(bytes, 12);
    if (flags & ~kFlagWeights) return at(12, ErrorCode::kUnsupported, "unknown flags");
    info.has_weights = flags & kFlagWeights;
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
    info.data_offset = kHeaderBytes + kTableEntryBytes * block_count;
    if (info.base_offset != info.data_offset || info.base_offset + info.base_bytes > info.file_bytes)
        return at(80, ErrorCode::kMalformed,
                  "the base mesh is not between the table and the end of the file");
    if (info.base_vertices > info.vertices || info.base_triangles > info.triangles ||
        info.vertices >= kNoVertex / 4 || info.triangles >= kNoVertex / 4)
        return at(28, ErrorCode::kMalformed, "the counts contradict each other");
    if (!(info.base_error >= 0))
        return at(92, ErrorCode::kMalformed, "the base mesh's error is negative or not a number");
    if (bytes.size() < info.data_offset)
        return at(bytes.size(), ErrorCode::kTruncated,
                  "the file ends within its table of " + std::to_string(block_count) + " blocks");
    const auto table = bytes.subspan(kHeaderBytes, info.data_offset - kHeaderBytes);
    if (get<std::uint64_t>(bytes, kTableChecksumAt) != checksum64(table))
        return at(kTableChecksumAt, ErrorCode::kChecksum, "the table's checksum does not match");
    info.blocks.resize(block_count);
    for (std::size_t i = 0; i < block_count; ++i) {
        const auto entry = table.subspan(kTableEntryBytes * i, kTableEntryBytes);
        BlockInfo& block = info.blocks[i];
        block.offset = get<std::uint64_t>(entry, 0);
        block.bytes = get<std::uint32_t>(entry, 8);
        block.raw_bytes = get<std::uint32_t>(entry, 12);
        block.checksum = get<std::uint64_t>(entry, 16);
        block.splits_end = get<std::uint32_t>(entry, 24);
        block.vertices_end = get<std::uint32_t>(entry, 28);
        block.triangles_end = get<std::uint32_t>(entry, 32);
        block.corners_end = get<std::uint32_t>(entry, 36);
        block.moves_end = get<std::uint32_t>(entry, 40);
        block.error = get<float>(entry, 44);
    }
    std::uint64_t offset = 0;
    if (const char* fault = table_fault(info, offset)) return at(offset, ErrorCode::kMalformed, fault);
    if (const std::uint64_t needed = memory_needed(info); needed > limits.max_bytes)
        return at(28, ErrorCode::kLimit,
                  "the mesh needs " + std::to_string(needed) + " bytes, the limit is " +
                      std::to_string(limits.max_bytes));
    return info;
}

Result<ProgressiveMesh> read_progressive_mesh(std::span<const std::byte> bytes, const Limits& limits) {
    auto read = read_info(bytes, limits);
    if (!read) return read.error();
    const FileInfo& info = *read;
    if (bytes.size() < info.file_bytes)
        return at(bytes.size(), ErrorCode::kTruncated,
                  "the file ends here, but announces " + std::to_string(info.file_bytes) + " bytes");
    if (bytes.size() > info.file_bytes)
        return at(info.file_bytes, ErrorCode::kMalformed, "the file goes on behind its announced end");

    const auto base_bytes = bytes.subspan(info.base_offset, info.base_bytes);
    if (checksum64(base_bytes) != info.base_checksum)
        return at(info.base_offset, ErrorCode::kChecksum, "the base mesh's checksum does not match");
    auto base = decode_base(base_bytes, info.base_vertices, info.base_triangles, info.has_weights);
    if (!base) return at(info.base_offset, base.error().code, base.error().message);

    ProgressiveMesh mesh;
    mesh.base_vertices = info.base_vertices;
    mesh.base_triangles = info.base_triangles;
    BlockDecoder decoder(mesh, info);
    decoder.begin_with(*base);
    mesh.positions = std::move(base->positions);
    mesh.triangles = std::move(base->triangles);
    mesh.weights = std::move(base->weights);
    mesh.parents.assign(info.base_vertices, kNoVertex);
    mesh.positions.reserve(info.vertices);
    mesh.triangles.reserve(info.triangles);
    mesh.weights.reserve(info.has_weights ? info.vertices : 0);
    mesh.parents.reserve(info.vertices);
    mesh.splits.reserve(info.splits);
    mesh.corner_changes.reserve(info.corner_changes);
    mesh.moves.reserve(info.moves);
    std::vector<std::byte> raw;
    for (std::size_t i = 0; i < info.blocks.size(); ++i) {
        const BlockInfo& block = info.blocks[i];
        const auto stored = bytes.subspan(block.offset, block.bytes);
        const auto in_block = [&](ErrorCode code, const std::string& message) {
            return at(block.offset, code, "block " + std::to_string(i) + ": " + message);
        };
        if (checksum64(stored) != block.checksum)
            return in_block(ErrorCode::kChecksum, "its checksum does not match");
        if (ZSTD_getFrameContentSize(stored.data(), stored.size()) != block.raw_bytes)
            return in_block(ErrorCode::kMalformed, "its zstd frame announces another size than the table");
        raw.resize(block.raw_bytes);
        const std::size_t size = ZSTD_decompress(raw.data(), raw.size(), stored.data(), stored.size());
        if (ZSTD_isError(size) || size != block.raw_bytes)
            return in_block(ErrorCode::kMalformed, "its zstd frame does not unpack");
        if (const char* fault = decoder.decode(raw, block)) return in_block(ErrorCode::kMalformed, fault);
    }
    std::uint64_t offset = 0;
    if (const char* fault = announcement_fault(info, mesh, decoder.positions(), offset))
        return at(offset, ErrorCode::kMalformed, fault);
    if (const char* fault = progressive_mesh_fault(mesh))
        return at(info.base_offset, ErrorCode::kMalformed, fault);
    return mesh;
}

}  // namespace vsplit
