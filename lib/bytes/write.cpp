// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "vsplit/write.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>

#include "base_mesh.hpp"
#include "checksum.hpp"
#include "columns.hpp"
#include "layout.hpp"
#include "vsplit/live_mesh.hpp"

namespace vsplit {
namespace {

/// A block on its way: what it stores, and where it ends.
struct Block {
    std::vector<std::byte> stored;
    std::uint32_t raw_bytes = 0;
    std::size_t splits_end = 0;
};

/// Replays the splits, as the reader will, and turns them into columns: what is predicted from the state
/// costs little.
class BlockEncoder {
  public:
    explicit BlockEncoder(const ProgressiveMesh& mesh)
        : mesh_(mesh), positions_(mesh.positions), weights_(mesh.weights) {
        end_.vertices_end = mesh.base_vertices;
        end_.triangles_end = mesh.base_triangles;
    }

    /// Encodes splits from where it stands until about `raw_target` bytes are full. Returns the raw bytes.
    std::vector<std::byte> next(std::size_t raw_target) {
        for (auto& column : columns_) column.clear();
        error_bits_ = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::max());
        const std::size_t first = at_;
        while (at_ < mesh_.splits.size() && (at_ == first || size() < raw_target)) add(mesh_.splits[at_++]);
        ByteWriter raw;
        for (const auto& column : columns_) raw.put(static_cast<std::uint32_t>(column.size()));
        for (const auto& column : columns_)
            raw.bytes().insert(raw.bytes().end(), column.begin(), column.end());
        return std::move(raw.bytes());
    }
    std::size_t at() const { return at_; }

  private:
    std::vector<std::byte>& column(Column which) { return columns_[static_cast<std::size_t>(which)]; }
    void put(Column which, std::uint32_t value) { put_varint(column(which), value); }
    void put_float(Column which, float value, float predicted) {
        put(which, zigzag(ordered_bits(value) - ordered_bits(predicted)));
    }
    void put_position(Column x, const Float3& value, const Float3& predicted) {
        const auto first = static_cast<std::uint8_t>(x);
        put_float(static_cast<Column>(first), value.x, predicted.x);
        put_float(static_cast<Column>(first + 1), value.y, predicted.y);
        put_float(static_cast<Column>(first + 2), value.z, predicted.z);
    }
    std::size_t size() const {
        std::size_t sum = 4 * kColumnCount;
        for (const auto& column : columns_) sum += column.size();
        return sum;
    }

    void add(const Split& split) {
        put(Column::kNewVertices, split.vertices_end - end_.vertices_end);
        put(Column::kNewTriangles, split.triangles_end - end_.triangles_end);
        put(Column::kCornerCount, split.corners_end - end_.corners_end);
        put(Column::kMoveCount, split.moves_end - end_.moves_end);
        // Errors never grow, and so do the bits of floats that are not negative.
        put(Column::kErrors, error_bits_ - std::bit_cast<std::uint32_t>(split.error));
        error_bits_ = std::bit_cast<std::uint32_t>(split.error);

        const std::uint32_t parent =
            split.vertices_end > end_.vertices_end ? mesh_.parents[end_.vertices_end] : kNoVertex;
        Float3 place;
        for (std::uint32_t v = end_.vertices_end; v < split.vertices_end; ++v) {
            const std::uint32_t p = mesh_.parents[v];
            put(Column::kParents, p == kNoVertex ? 0 : end_.vertices_end - p);
            if (p != kNoVertex) place = positions_[p];
            put_position(Column::kBirthX, mesh_.positions[v], place);
            place = mesh_.positions[v];
            if (!weights_.empty())
                put_float(Column::kWeights, mesh_.weights[v], p == kNoVertex ? 1.0f : weights_[p]);
        }
        for (std::uint32_t i = end_.moves_end; i < split.moves_end; ++i) {
            const VertexMove& move = mesh_.moves[i];
            put(Column::kMovedVertices, zigzag(move.vertex - (parent == kNoVertex ? 0 : parent)));
            put_position(Column::kMoveX, move.position, positions_[move.vertex]);
            if (!weights_.empty()) put_float(Column::kWeights, move.weight, weights_[move.vertex]);
        }
        std::uint32_t corner = 3 * end_.triangles_end;
        for (std::uint32_t i = end_.corners_end; i < split.corners_end; ++i) {
            const CornerChange& change = mesh_.corner_changes[i];
            put(Column::kCorners, zigzag(corner - change.corner));
            corner = change.corner;
            put(Column::kCornerVertices, change.vertex - end_.vertices_end);
        }
        for (std::uint32_t t = end_.triangles_end; t < split.triangles_end; ++t)
            for (const std::uint32_t v : mesh_.triangles[t])
                put(Column::kTriangles, split.vertices_end - 1 - v);
        for (std::uint32_t i = end_.moves_end; i < split.moves_end; ++i) {
            const VertexMove& move = mesh_.moves[i];
            positions_[move.vertex] = move.position;
            if (!weights_.empty()) weights_[move.vertex] = move.weight;
        }
        end_ = split;
    }

    const ProgressiveMesh& mesh_;
    std::vector<Float3> positions_;  // at the current level; later vertices: at birth
    std::vector<float> weights_;
    std::array<std::vector<std::byte>, kColumnCount> columns_;
    std::size_t at_ = 0;
    Split end_;
    std::uint32_t error_bits_ = 0;
};

Error cannot(std::string message) {
    return {ErrorCode::kArgument, std::move(message), Error::kNowhere, 0};
}

}  // namespace

Result<std::vector<std::byte>> write_progressive_mesh(const ProgressiveMesh& mesh,
                                                      const WriteOptions& options) {
    if (options.block_bytes < 1024 || options.block_bytes > (1u << 24))
        return cannot("block_bytes must be 1 KiB to 16 MiB");
    if (options.zstd_level < 1 || options.zstd_level > 19) return cannot("zstd_level must be 1 to 19");
    if (const char* fault = progressive_mesh_fault(mesh))
        return cannot(std::string("unsound mesh: ") + fault);

    Mesh base;
    base.positions.assign(mesh.positions.begin(), mesh.positions.begin() + mesh.base_vertices);
    base.triangles.assign(mesh.triangles.begin(), mesh.triangles.begin() + mesh.base_triangles);
    if (!mesh.weights.empty())
        base.weights.assign(mesh.weights.begin(), mesh.weights.begin() + mesh.base_vertices);
    auto base_bytes = encode_base(base);
    if (!base_bytes) return base_bytes.error();

    // Blocks start small, so that the first bytes already refine, and grow to the size asked for. How many
    // raw bytes fill a block is learnt from the block before.
    std::vector<Block> blocks;
    BlockEncoder encoder(mesh);
    double raw_per_stored = 1.5;
    std::size_t target = std::min<std::size_t>(options.block_bytes, 4096);
    while (encoder.at() < mesh.splits.size()) {
        Block block;
        const auto raw = encoder.next(static_cast<std::size_t>(double(target) * raw_per_stored));
        block.raw_bytes = static_cast<std::uint32_t>(raw.size());
        block.splits_end = encoder.at();
        block.stored.resize(ZSTD_compressBound(raw.size()));
        const std::size_t size = ZSTD_compress(block.stored.data(), block.stored.size(), raw.data(),
                                               raw.size(), options.zstd_level);
        if (ZSTD_isError(size)) return cannot(std::string("zstd: ") + ZSTD_getErrorName(size));
        block.stored.resize(size);
        raw_per_stored = std::clamp(double(raw.size()) / double(size), 1.0, 8.0);
        target = std::min<std::size_t>(options.block_bytes, 2 * target);
        blocks.push_back(std::move(block));
    }

    const std::uint64_t data_offset = kHeaderBytes + kTableEntryBytes * blocks.size();
    ByteWriter table;
    std::uint64_t offset = data_offset + base_bytes->size();
    for (const Block& block : blocks) {
        const Split& last = mesh.splits[block.splits_end - 1];
        table.put(offset);
        table.put(static_cast<std::uint32_t>(block.stored.size()));
        table.put(block.raw_bytes);
        table.put(checksum64(block.stored));
        table.put(static_cast<std::uint32_t>(block.splits_end));
        table.put(last.vertices_end);
        table.put(last.triangles_end);
        table.put(last.corners_end);
        table.put(last.moves_end);
        table.put(static_cast<float>(error_at(mesh, block.splits_end)));
        offset += block.stored.size();
    }

    ByteWriter file;
    file.put(kMagic);
    file.put(kVersion);
    file.put(mesh.weights.empty() ? std::uint32_t{0} : kFlagWeights);
    file.put(offset);
    file.put(static_cast<std::uint32_t>(blocks.size()));
    file.put(static_cast<std::uint32_t>(mesh.positions.size()));
    file.put(static_cast<std::uint32_t>(mesh.triangles.size()));
    file.put(mesh.base_vertices);
    file.put(mesh.base_triangles);
    file.put(static_cast<std::uint32_t>(mesh.splits.size()));
    file.put(static_cast<std::uint32_t>(mesh.corner_changes.size()));
    file.put(static_cast<std::uint32_t>(mesh.moves.size()));
    LiveMesh full(mesh);
    full.go_to(full.max_level());
    const Bounds bounds = bounds_of(full.positions());
    file.put(bounds.low);
    file.put(bounds.high);
    file.put(data_offset);
    file.put(static_cast<std::uint32_t>(base_bytes->size()));
    file.put(static_cast<float>(error_at(mesh, 0)));
    file.put(checksum64(*base_bytes));
    file.put(checksum64(table.bytes()));
    file.put(checksum64(file.bytes()));
    auto& bytes = file.bytes();
    bytes.reserve(offset);
    bytes.insert(bytes.end(), table.bytes().begin(), table.bytes().end());
    bytes.insert(bytes.end(), base_bytes->begin(), base_bytes->end());
    for (const Block& block : blocks) bytes.insert(bytes.end(), block.stored.begin(), block.stored.end());
    return std::move(bytes);
}

}  // namespace vsplit
