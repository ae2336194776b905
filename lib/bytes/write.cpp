// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "vsplit/write.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "checksum.hpp"
#include "layout.hpp"
#include "place_fit.hpp"
#include "record_encoder.hpp"
#include "table.hpp"

namespace vsplit {
namespace {

constexpr std::uint32_t kLosslessLatticeBits = 18;
/// About so many splits tell the weights of prediction.
constexpr std::size_t kFitted = 1 << 16;

/// Blocks of fewer bytes would pay more for their place in the table.
constexpr std::size_t kLeastBlock = 512;
constexpr std::size_t kUsualEntryBytes = 11;

/// Where a sweep ends the error falls: a block of this share of what it may hold ends there too.
constexpr double kEnoughBlock = 0.7;
/// Where it reaches a level that somebody may ask for, a block that is smaller still; so many bytes it must
/// have.
constexpr double kEnoughForLevel = 0.02;
constexpr std::size_t kLeastLevelBlock = 128;

Error cannot(std::string message) {
    return {ErrorCode::kArgument, std::move(message), Error::kNowhere, 0};
}

struct Block {
    std::vector<std::byte> stored;
    Split end;
};

/// All that a file is made of, and the mesh that it holds.
struct Encoded {
    WholeNumbers numbers;
    std::vector<std::byte> base;
    std::size_t draco_bytes = 0;
    std::vector<Block> blocks;
    Bounds bounds;
    ProgressiveMesh canonical;
};

const char* options_fault(const WriteOptions& o) {
    if (o.block_bytes < 1024 || o.block_bytes > (1u << 24)) return "block_bytes must be 1 KiB to 16 MiB";
    if (o.position_bits != 0 && (o.position_bits < 2 || o.position_bits > kMostPositionBits))
        return "position_bits must be 2 to 20, or 0 for lossless";
    if (o.normal_bits < 2 || o.normal_bits > 16) return "normal_bits must be 2 to 16";
    if (o.texcoord_bits < 2 || o.texcoord_bits > 24) return "texcoord_bits must be 2 to 24";
    if (o.color_bits < 2 || o.color_bits > 16) return "color_bits must be 2 to 16";
    return nullptr;
}
/// The base mesh, whole in the file's stream or its places and triangles as Draco's bytes; the encoder's next
/// are the splits.
Status write_base(RecordEncoder& encoder, BaseCoding coding, Encoded& out) {
    auto draco = encode_base(encoder.base());
    if (!draco) return draco.error();
    const auto stream = [](RecordEncoder to, bool whole) {
        RangeEncoder coder;
        to.code_base(coder, whole);
        return coder.finish();
    };
    out.base = stream(encoder, true);
    bool whole = true;
    if (!draco->empty()) {
        const std::vector<std::byte> rest = stream(encoder, false);
        whole = coding == BaseCoding::kLeast && out.base.size() <= draco->size() + rest.size();
        if (!whole) {
            out.base = *std::move(draco);
            out.draco_bytes = out.base.size();
            out.base.insert(out.base.end(), rest.begin(), rest.end());
        }
    }
    RangeEncoder written;
    encoder.code_base(written, whole);
    return Ok{};
}

Result<Encoded> encode(const ProgressiveMesh& mesh, const WriteOptions& options) {
    if (const char* fault = options_fault(options)) return cannot(fault);
    if (const char* fault = progressive_mesh_fault(mesh))
        return cannot(std::string("unsound mesh: ") + fault);
    if (mesh.attributes.size() > 0xFFFF) return cannot("there are more than 65535 attributes");
    for (const Attribute& attribute : mesh.attributes)
        if (attribute.name.size() > 0xFFFF) return cannot("an attribute's name is longer than 65535 bytes");
    Encoded out;
    out.canonical.origin = mesh.origin;
    {
        std::vector<Float3> full = mesh.positions;
        for (const VertexMove& move : mesh.moves) full[move.vertex] = move.position;
        const Bounds box = bounds_of(full);
        out.numbers = whole_numbers(
            mesh,
            Lattice::of(box.low, box.high,
                        options.position_bits == 0 ? kLosslessLatticeBits : options.position_bits),
            options);
    }
    WholeNumbers& numbers = out.numbers;
    numbers.details.origin = mesh.origin;
    const auto raised = [&](float error) { return numbers.roughness.raised(error); };
    std::vector<Sweep> sweeps = schedule(mesh, numbers.traded, numbers.idle, raised);
    for (Sweep& sweep : sweeps) sweep.error = raised(sweep.error);

    // The first pass learns the weights of prediction.
    PlaceFit fit;
    numbers.details.weights = default_place_weights();
    {
        NoCoder look;
        RecordEncoder first(mesh, numbers, sweeps);
        first.codec().fit = &fit;
        first.codec().fit_every = static_cast<std::uint32_t>(mesh.splits.size() / kFitted + 1);
        first.code_base(look, true);
        const auto nothing = [](const SplitPlan&, float, const Sweep*) { return false; };
        if (const char* fault = first.code_splits(look, nothing))
            return cannot(std::string("the record cannot be put in order: ") + fault);
    }
    numbers.details.weights = fit.solve();

    RecordEncoder encoder(mesh, numbers, sweeps);
    MeshOutput output(out.canonical, numbers.lattice, numbers.details, numbers.weights, numbers.lossless,
                      numbers.largest_group > 0);
    output.reserve(mesh.positions.size(), mesh.triangles.size(), mesh.splits.size(),
                   mesh.corner_changes.size(), mesh.moves.size());
    if (const auto base = write_base(encoder, options.base_coding, out); !base) return base.error();
    RangeEncoder coder;
    const std::size_t base_parts = std::max(mesh.base_vertices, mesh.base_triangles);
    if (out.base.size() * kPartsPerByte < base_parts)
        out.base.resize((base_parts + kPartsPerByte - 1) / kPartsPerByte);
    output.add_base(encoder.codec());

    // Blocks start small, so that the first bytes already refine, and grow with what precedes them.
    std::size_t before_blocks = kHeaderBytes + 64 + out.base.size();
    std::size_t target = 0;
    // A sweep of rounds about doubles the mesh, and what ends within it promises nothing new.
    const std::size_t growth = !sweeps.empty() && sweeps.front().kind == SweepKind::kRounds ? 1 : 2;
    const auto next_target = [&] {
        target = std::min<std::size_t>(options.block_bytes, std::max(kLeastBlock, before_blocks / growth));
    };
    next_target();
    std::uint32_t made = 0, ended = 0;
    const auto end_block = [&] {
        Block block;
        block.stored = coder.finish();
        block.end = out.canonical.splits.back();
        const Split before = ended == 0 ? Split{mesh.base_vertices, mesh.base_triangles, 0, 0, 0}
                                        : out.canonical.splits[ended - 1];
        const std::uint64_t parts =
            std::uint64_t{made - ended} + (block.end.vertices_end - before.vertices_end) +
            (block.end.triangles_end - before.triangles_end) + (block.end.corners_end - before.corners_end) +
            (block.end.moves_end - before.moves_end);
        if (block.stored.size() * kPartsPerByte < parts)
            block.stored.resize((parts + kPartsPerByte - 1) / kPartsPerByte);
        before_blocks += block.stored.size() + kUsualEntryBytes;
        out.blocks.push_back(std::move(block));
        ended = made;
        next_target();
    };
    const auto coded = [&](const SplitPlan& plan, float error, const Sweep* ended_sweep) {
        output.add(plan, error);
        ++made;
        const bool level = ended_sweep && ended_sweep->reaches_level && coder.size() >= kLeastLevelBlock;
        const double enough = level ? kEnoughForLevel : ended_sweep ? kEnoughBlock : 1;
        if (double(coder.size()) >= enough * double(target)) end_block();
        return made == ended;
    };
    if (const char* fault = encoder.code_splits(coder, coded))
        return cannot(std::string("the record cannot be put in order: ") + fault);
    if (made > ended) end_block();

    const SplitCodec& codec = encoder.codec();
    std::vector<Float3> places;
    places.reserve(codec.live.vertices.size());
    for (std::uint32_t v = 0; v < codec.live.vertex_count(); ++v)
        places.push_back(numbers.lossless ? numbers.lattice.exact(codec.live.vertices[v].at, codec.finer[v])
                                          : numbers.lattice.point(codec.live.vertices[v].at));
    out.bounds = bounds_of(places);
    return out;
}

}  // namespace

Result<ProgressiveMesh> canonical_progressive_mesh(const ProgressiveMesh& mesh, const WriteOptions& options) {
    auto encoded = encode(mesh, options);
    if (!encoded) return encoded.error();
    return std::move(encoded->canonical);
}

Result<std::vector<std::byte>> write_progressive_mesh(const ProgressiveMesh& mesh,
                                                      const WriteOptions& options) {
    auto encoded = encode(mesh, options);
    if (!encoded) return encoded.error();
    const ProgressiveMesh& written = encoded->canonical;
    const std::vector<std::byte> details = encode_details(encoded->numbers.details);

    FileInfo front;
    front.base_vertices = written.base_vertices;
    front.base_triangles = written.base_triangles;
    front.base_error = static_cast<float>(error_at(written, 0));
    std::vector<BlockInfo> blocks;
    std::uint64_t stored = 0, splits = 0;
    for (const Block& block : encoded->blocks) {
        while (splits < written.splits.size() &&
               written.splits[splits].vertices_end <= block.end.vertices_end &&
               written.splits[splits].triangles_end <= block.end.triangles_end &&
               written.splits[splits].corners_end <= block.end.corners_end &&
               written.splits[splits].moves_end <= block.end.moves_end)
            ++splits;
        BlockInfo entry;
        entry.bytes = static_cast<std::uint32_t>(block.stored.size());
        entry.checksum = checksum32(block.stored);
        entry.splits_end = static_cast<std::uint32_t>(splits);
        entry.vertices_end = block.end.vertices_end;
        entry.triangles_end = block.end.triangles_end;
        entry.corners_end = block.end.corners_end;
        entry.moves_end = block.end.moves_end;
        entry.error = static_cast<float>(error_at(written, splits));
        blocks.push_back(entry);
        stored += block.stored.size();
    }
    const std::vector<std::byte> table = encode_table(front, blocks);

    ByteWriter file;
    file.put(kMagic);
    file.put(kVersion);
    file.put((encoded->numbers.weights ? kFlagWeights : 0) | (encoded->numbers.lossless ? kFlagLossless : 0));
    file.put(written.base_vertices);
    file.put(written.base_triangles);
    file.put(encoded->bounds.low);
    file.put(encoded->bounds.high);
    file.put(static_cast<std::uint32_t>(details.size()));
    file.put(static_cast<std::uint32_t>(encoded->base.size()));
    file.put(static_cast<std::uint32_t>(encoded->draco_bytes));
    file.put(static_cast<std::uint32_t>(table.size()));
    file.put(front.base_error);
    file.put(encoded->numbers.largest_group);
    file.put(options.position_bits);
    file.put(encoded->numbers.lattice.origin);
    file.put(encoded->numbers.lattice.step);
    file.put(checksum32(details));
    file.put(checksum32(encoded->base));
    file.put(checksum32(table));
    file.put(checksum32(file.bytes()));
    auto& bytes = file.bytes();
    bytes.reserve(bytes.size() + details.size() + encoded->base.size() + table.size() + stored);
    const auto append = [&](const std::vector<std::byte>& part) {
        bytes.insert(bytes.end(), part.begin(), part.end());
    };
    append(details);
    append(encoded->base);
    append(table);
    for (const Block& block : encoded->blocks) append(block.stored);
    return std::move(bytes);
}

}  // namespace vsplit
