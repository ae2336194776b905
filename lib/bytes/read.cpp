// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "vsplit/read.hpp"

#include <algorithm>
#include <bit>

#include "base_mesh.hpp"
#include "checksum.hpp"
#include "details.hpp"
#include "layout.hpp"
#include "table.hpp"

namespace vsplit {
namespace {

Error at(std::uint64_t offset, ErrorCode code, std::string message) {
    return {code, std::move(message), offset, 0};
}

/// Whatever follows the bytes that a stream took must be zeros, and few streams are padded.
}  // namespace

constexpr const char* kUnsoundValue = "a place or value is not finite, or a weight is negative";

struct BlockDecoder::State {
    FileInfo info;
    ProgressiveMesh mesh;
    SplitCodec codec;
    MeshOutput output;
    std::size_t blocks = 0;
    bool broken = false;
    // Where in a sweep the blocks so far end.
    std::uint32_t marked_left = 0, unmarked_left = 0;
    float error = 0;
    SplitPlan nothing, plan;

    State(FileInfo file, const Details& details)
        : info(std::move(file)),
          codec(shape_of(details, info.has_weights, info.lossless, info.largest_group), details.weights),
          output(mesh, Lattice{info.lattice_origin, info.lattice_step}, details, info.has_weights,
                 info.lossless, info.largest_group > 0) {}

    const char* begin_base(BaseMesh base, std::span<const std::byte> extras);
    const char* decode_splits(std::span<const std::byte> stored, const BlockInfo& block);
};

const char* BlockDecoder::State::begin_base(BaseMesh base, std::span<const std::byte> extras) {
    mesh.origin = info.origin;
    output.reserve(info.vertices, info.triangles, info.splits, info.corner_changes, info.moves);
    codec.live.reserve(info.vertices, info.triangles);
    codec.values.reserve(codec.shape().stride() * info.vertices);
    codec.values.resize(codec.shape().stride() * info.base_vertices);
    if (info.lossless) {
        codec.finer.reserve(info.vertices);
        codec.finer.resize(info.base_vertices);
    }
    if (info.largest_group > 0) {
        codec.groups.reserve(info.triangles);
        codec.groups.resize(info.base_triangles);
    }
    for (const Lattice3& place : base.places) codec.live.add_vertex(place);
    for (const Triangle& triangle : base.triangles) codec.live.add_triangle(triangle);
    RangeDecoder coder(extras);
    if (const char* fault = codec.code_base(coder, info.base_draco_bytes == 0, info.base_triangles))
        return fault;
    if (coder.overrun()) return "the base mesh's stream ends too early";
    if (!only_zeros(extras.subspan(std::min(coder.taken(), extras.size()))))
        return "the base mesh's stream is longer than it needs";
    output.add_base(codec);
    return output.sound() ? nullptr : kUnsoundValue;
}

const char* BlockDecoder::State::decode_splits(std::span<const std::byte> stored, const BlockInfo& block) {
    const std::size_t begin = mesh.splits.size();
    const float before = blocks == 0 ? info.base_error : info.blocks[blocks - 1].error;
    RangeDecoder coder(stored);
    while (mesh.splits.size() < block.splits_end) {
        if (marked_left == 0 && unmarked_left == 0) {
            SweepHead head;
            head.begins_block = mesh.splits.size() == begin;
            head.error_bits = std::bit_cast<std::uint32_t>(before);
            if (const char* fault = codec.code_head(coder, head)) return fault;
            marked_left = head.marked;
            unmarked_left = head.unmarked;
            error = std::bit_cast<float>(head.error_bits);
        }
        std::uint32_t primary = kNoVertex;
        if (marked_left > 0) {
            if (const char* fault = codec.code_mark(coder, primary)) return fault;
            --marked_left;
        } else {
            --unmarked_left;
        }
        codec.room = {block.vertices_end - mesh.positions.size(), block.triangles_end - mesh.triangles.size(),
                      block.corners_end - mesh.corner_changes.size(), block.moves_end - mesh.moves.size()};
        if (const char* fault = codec.code_split(coder, primary, nothing, plan)) return fault;
        if (coder.overrun()) return "it ends within a split";
        codec.apply(plan);
        output.add(plan, error);
    }
    if (!output.sound()) return kUnsoundValue;
    if (!only_zeros(stored.subspan(std::min(coder.taken(), stored.size()))))
        return "it is longer than its splits need";
    if (mesh.positions.size() != block.vertices_end || mesh.triangles.size() != block.triangles_end ||
        mesh.corner_changes.size() != block.corners_end || mesh.moves.size() != block.moves_end)
        return "it ends at other counts than the table announces";
    // What the table says of the error is that of the next split, so only a sweep that goes on can contradict
    // it.
    const bool ends = mesh.splits.size() == info.splits;
    if (ends && block.error != 0) return "the full mesh has an error";
    if (!ends && (marked_left > 0 || unmarked_left > 0) && block.error != error)
        return "it ends at another error than the table announces";
    return nullptr;
}

BlockDecoder::BlockDecoder(std::unique_ptr<State> state) : state_(std::move(state)) {}
BlockDecoder::BlockDecoder(BlockDecoder&&) noexcept = default;
BlockDecoder& BlockDecoder::operator=(BlockDecoder&&) noexcept = default;
BlockDecoder::~BlockDecoder() = default;

Result<BlockDecoder> BlockDecoder::begin(std::span<const std::byte> front, const Limits& limits,
                                         const BaseMeshDecoder& decode_base_mesh) {
    auto read = read_info(front, limits);
    if (!read) return read.error();
    const FileInfo& info = *read;
    const auto base_bytes = front.subspan(info.base_offset, info.base_bytes);
    if (checksum32(base_bytes) != info.base_checksum)
        return at(info.base_offset, ErrorCode::kChecksum, "the base mesh's checksum does not match");
    auto base = decode_base(base_bytes.first(info.base_draco_bytes), info.base_vertices, info.base_triangles,
                            decode_base_mesh);
    if (!base) return at(info.base_offset, base.error().code, base.error().message);
    const char* fault = nullptr;
    std::size_t in_details = 0;
    const auto details =
        decode_details(front.subspan(info.details_offset, info.details_bytes), fault, in_details);
    const std::uint64_t base_offset = info.base_offset;
    const std::size_t draco_bytes = info.base_draco_bytes;
    auto state = std::make_unique<State>(*std::move(read), *details);
    if (const char* wrong = state->begin_base(*std::move(base), base_bytes.subspan(draco_bytes)))
        return at(base_offset, ErrorCode::kMalformed, wrong);
    return BlockDecoder(std::move(state));
}

const FileInfo& BlockDecoder::info() const {
    return state_->info;
}
std::size_t BlockDecoder::blocks() const {
    return state_->blocks;
}
const ProgressiveMesh& BlockDecoder::mesh() const {
    return state_->mesh;
}
ProgressiveMesh BlockDecoder::release() {
    state_->broken = true;
    return std::move(state_->mesh);
}

Status BlockDecoder::decode(std::span<const std::byte> stored) {
    State& s = *state_;
    if (s.broken || s.blocks == s.info.blocks.size())
        return Error{ErrorCode::kArgument, "there is no block to come", Error::kNowhere, 0};
    const BlockInfo& block = s.info.blocks[s.blocks];
    const auto in_block = [&](ErrorCode code, const std::string& message) {
        return at(block.offset, code, "block " + std::to_string(s.blocks) + ": " + message);
    };
    if (stored.size() != block.bytes)
        return in_block(ErrorCode::kArgument, "it has " + std::to_string(block.bytes) + " bytes");
    if (checksum32(stored) != block.checksum)
        return in_block(ErrorCode::kChecksum, "its checksum does not match");
    if (const char* fault = s.decode_splits(stored, block)) {
        s.broken = true;
        return in_block(ErrorCode::kMalformed, fault);
    }
    ++s.blocks;
    return Ok{};
}

namespace {

/// Decodes blocks as long as they are whole.
Result<BlockDecoder> decode_prefix(std::span<const std::byte> bytes, const Limits& limits,
                                   const BaseMeshDecoder& decode_base_mesh) {
    auto decoder = BlockDecoder::begin(bytes, limits, decode_base_mesh);
    if (!decoder) return decoder.error();
    for (const BlockInfo& block : decoder->info().blocks) {
        if (block.offset + block.bytes > bytes.size()) break;
        if (auto status = decoder->decode(bytes.subspan(block.offset, block.bytes)); !status)
            return status.error();
    }
    return decoder;
}

/// The reason if the header or the table announces other errors or bounds than the mesh has; `offset` is then
/// where.
const char* announcement_fault(const FileInfo& info, const ProgressiveMesh& mesh, std::size_t blocks,
                               std::uint64_t& offset) {
    offset = kBaseErrorAt;
    const bool whole = blocks == info.blocks.size();
    if ((whole || !mesh.splits.empty()) && double(info.base_error) != error_at(mesh, 0))
        return "the base mesh has another error than the header announces";
    for (std::size_t i = 0; i < blocks; ++i) {
        if ((whole || i + 1 < blocks) &&
            double(info.blocks[i].error) != error_at(mesh, info.blocks[i].splits_end)) {
            offset = info.table_offset;
            return "a block ends at another error than the table announces";
        }
    }
    if (!whole) return nullptr;
    std::vector<Float3> places(mesh.positions);
    for (const VertexMove& move : mesh.moves) places[move.vertex] = move.position;
    offset = kBoundsAt;
    const Bounds bounds = bounds_of(places);
    if (bounds.low != info.bounds_min || bounds.high != info.bounds_max)
        return "the mesh has other bounds than the header announces";
    return nullptr;
}

Result<ProgressiveMesh> checked(BlockDecoder decoder) {
    std::uint64_t offset = 0;
    if (const char* fault = announcement_fault(decoder.info(), decoder.mesh(), decoder.blocks(), offset))
        return at(offset, ErrorCode::kMalformed, fault);
    if (const char* fault = progressive_mesh_fault(decoder.mesh()))
        return at(decoder.info().base_offset, ErrorCode::kMalformed, fault);
    return decoder.release();
}

}  // namespace

Result<ProgressiveMesh> read_progressive_mesh(std::span<const std::byte> bytes, const Limits& limits,
                                              const BaseMeshDecoder& decode_base_mesh) {
    auto read = read_info(bytes, limits);
    if (!read) return read.error();
    if (bytes.size() < read->file_bytes)
        return at(bytes.size(), ErrorCode::kTruncated,
                  "the file ends here, but announces " + std::to_string(read->file_bytes) + " bytes");
    if (bytes.size() > read->file_bytes)
        return at(read->file_bytes, ErrorCode::kMalformed, "the file goes on behind its announced end");
    auto decoder = decode_prefix(bytes, limits, decode_base_mesh);
    if (!decoder) return decoder.error();
    return checked(*std::move(decoder));
}

Result<ProgressiveMesh> read_prefix(std::span<const std::byte> bytes, const Limits& limits,
                                    const BaseMeshDecoder& decode_base_mesh) {
    auto decoder = decode_prefix(bytes, limits, decode_base_mesh);
    if (!decoder) return decoder.error();
    return checked(*std::move(decoder));
}

}  // namespace vsplit
