// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// .pmesh bytes in. Every function here accepts hostile bytes: an Error with its offset, never a crash.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vsplit/progressive_mesh.hpp"
#include "vsplit/result.hpp"

namespace vsplit {

/// What a reader may spend. Checked against the file's own announcements before anything is allocated.
struct Limits {
    std::uint64_t max_bytes = std::uint64_t{1} << 30;  ///< Memory for all that is returned, 1 GiB.
};

/// A host's decoder of base meshes in place of Draco; needed where the library was built without it
/// (VSPLIT_WITH_DRACO=OFF). Asked for the mesh in `bytes`, which is Draco's: the three whole numbers of each
/// point's position attribute and the three points of each face, in the order in which Draco gives them;
/// places.size() / 3 points and corners.size() / 3 faces are there, or the bytes are malformed. False if it
/// cannot. `bytes` are hostile; what it writes is checked. Empty: Draco.
using BaseMeshDecoder = std::function<bool(std::span<const std::byte> bytes, std::span<std::int32_t> places,
                                           std::span<std::uint32_t> corners)>;

/// One block of splits, as the table at the front of the file announces it.
struct BlockInfo {
    std::uint64_t offset = 0;      ///< In the file.
    std::uint32_t bytes = 0;       ///< As stored.
    std::uint32_t checksum = 0;    ///< The low half of the stored bytes' XXH64.
    std::uint32_t splits_end = 0;  ///< Counts at the end of the block, from the start of the file.
    std::uint32_t vertices_end = 0;
    std::uint32_t triangles_end = 0;
    std::uint32_t corners_end = 0;
    std::uint32_t moves_end = 0;
    float error = 0;  ///< Geometric error after the block, in the object's units.
};

/// An attribute that the file has.
struct AttributeInfo {
    std::string name;
    Semantic semantic = Semantic::kOther;
    std::uint32_t components = 1;
    bool exact = true;  ///< Every float is the input's.
};

/// What the front of the file says: everything but the mesh itself.
struct FileInfo {
    std::uint32_t version = 0;
    bool has_weights = false;
    bool lossless = false;            ///< Every float is the input's.
    std::uint32_t position_bits = 0;  ///< 0 if lossless.
    /// Distance of neighbouring places, in the object's units; none is further than half of it from where it
    /// was, along an axis.
    double position_step = 0;
    std::array<double, 3> lattice_origin{};
    std::array<double, 3> origin{};  ///< As ProgressiveMesh::origin.
    double lattice_step = 0;         ///< Also of a lossless file, which goes on from there.
    std::uint32_t largest_group = 0;
    std::vector<AttributeInfo> attributes;
    std::uint64_t file_bytes = 0;
    std::uint64_t details_offset = 0;
    std::uint32_t details_bytes = 0;
    std::uint64_t table_offset = 0;
    std::uint32_t table_bytes = 0;
    std::uint64_t data_offset = 0;  ///< End of the table: what read_info() wants to see.
    Float3 bounds_min, bounds_max;  ///< Of the full mesh.
    std::uint64_t base_offset = 0;
    std::uint32_t base_bytes = 0;
    std::uint32_t base_draco_bytes = 0;  ///< The first of them.
    std::uint32_t base_checksum = 0;
    std::uint32_t base_vertices = 0, base_triangles = 0;
    float base_error = 0;  ///< Geometric error of the base mesh.
    std::uint32_t vertices = 0, triangles = 0, splits = 0, corner_changes = 0, moves = 0;
    std::vector<BlockInfo> blocks;
};

/// Reads header and table. `bytes` may be the whole file or a beginning of it that holds the table;
/// `file_bytes` is not compared with bytes.size(). Errors: kTruncated, kMalformed, kChecksum, kUnsupported (a
/// newer version), kLimit.
Result<FileInfo> read_info(std::span<const std::byte> bytes, const Limits& limits = {});

/// Reads a whole file. The result is sound: progressive_mesh_fault() is null.
Result<ProgressiveMesh> read_progressive_mesh(std::span<const std::byte> bytes, const Limits& limits = {},
                                              const BaseMeshDecoder& decode_base = {});

/// Reads what a beginning of a file holds: table and base mesh at least, and all blocks that are whole. What
/// is left of a block is ignored. The result is sound, and its error_at() the end is 0: ask the table for the
/// error.
Result<ProgressiveMesh> read_prefix(std::span<const std::byte> bytes, const Limits& limits = {},
                                    const BaseMeshDecoder& decode_base = {});

/// Decodes a file block by block, in order, as its bytes arrive. Memory as announced by read_info().
class BlockDecoder {
  public:
    /// `front` is the file's beginning up to the end of table and base mesh (data_offset), or more of it.
    static Result<BlockDecoder> begin(std::span<const std::byte> front, const Limits& limits = {},
                                      const BaseMeshDecoder& decode_base = {});
    BlockDecoder(BlockDecoder&&) noexcept;
    BlockDecoder& operator=(BlockDecoder&&) noexcept;
    ~BlockDecoder();

    const FileInfo& info() const;
    /// Blocks decoded so far; the next one wanted is info().blocks[blocks()].
    std::size_t blocks() const;
    /// Takes the stored bytes of the next block and appends its splits. After an error the decoder stays as
    /// it is with the blocks before, unless the checksum was right and the contents lied: then it refuses all
    /// that follows.
    Status decode(std::span<const std::byte> stored);
    /// The base mesh and the splits so far, each of them checked against the rules.
    const ProgressiveMesh& mesh() const;
    /// Gives the mesh away; the decoder is of no use afterwards.
    ProgressiveMesh release();

  private:
    struct State;
    explicit BlockDecoder(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace vsplit
