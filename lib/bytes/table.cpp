// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "table.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "layout.hpp"
#include "number_models.hpp"

namespace vsplit {
namespace {

BlockInfo base_as_block(const FileInfo& info) {
    BlockInfo base;
    base.offset = info.data_offset;
    base.vertices_end = info.base_vertices;
    base.triangles_end = info.base_triangles;
    base.error = info.base_error;
    return base;
}

std::uint32_t zigzag(std::uint32_t difference) {
    return (difference << 1) ^ (0u - (difference >> 31));
}
std::uint32_t unzigzag(std::uint32_t code) {
    return (code >> 1) ^ (0u - (code & 1));
}

/// What an entry says beside its checksum, modulo 2^32, so that any table can be written.
struct Entry {
    std::uint32_t bytes, splits, vertices, triangles, corners, moves, fall;
};

class EntryModel {
  public:
    template <class Coder>
    void code(Coder& coder, Entry& entry) {
        std::size_t i = 0;
        for (std::uint32_t* value : {&entry.bytes, &entry.splits, &entry.vertices, &entry.triangles,
                                     &entry.corners, &entry.moves, &entry.fall})
            *value = models_[i++].code(coder, *value);
    }

  private:
    std::array<NumberModel, 7> models_;
};

Entry entry_of(const BlockInfo& before, const BlockInfo& block) {
    const std::uint32_t splits = block.splits_end - before.splits_end,
                        vertices = block.vertices_end - before.vertices_end;
    return {block.bytes,
            splits,
            zigzag(vertices - splits),
            zigzag(block.triangles_end - before.triangles_end - 2 * vertices),
            block.corners_end - before.corners_end,
            block.moves_end - before.moves_end,
            std::bit_cast<std::uint32_t>(before.error) - std::bit_cast<std::uint32_t>(block.error)};
}

void put_number(ByteWriter& out, std::uint64_t value) {
    for (; value >= 128; value >>= 7) out.put(static_cast<std::uint8_t>(value | 128));
    out.put(static_cast<std::uint8_t>(value));
}

}  // namespace

bool take_number(std::span<const std::byte> bytes, std::size_t& at, std::uint64_t& value) {
    value = 0;
    for (std::size_t i = 0; i < 10 && at + i < bytes.size(); ++i) {
        const auto byte = static_cast<std::uint64_t>(bytes[at + i]);
        if (i == 9 && byte > 1) return false;
        value |= (byte & 127) << (7 * i);
        if (byte >= 128) continue;
        if (i > 0 && byte == 0) return false;
        at += i + 1;
        return true;
    }
    return false;
}

std::vector<std::byte> encode_table(const FileInfo& front, std::span<const BlockInfo> blocks) {
    ByteWriter out;
    put_number(out, blocks.size());
    for (const BlockInfo& block : blocks) out.put(block.checksum);
    RangeEncoder coder;
    EntryModel model;
    BlockInfo before = base_as_block(front);
    for (const BlockInfo& block : blocks) {
        Entry entry = entry_of(before, block);
        model.code(coder, entry);
        before = block;
    }
    const std::vector<std::byte> stream = coder.finish();
    out.bytes().insert(out.bytes().end(), stream.begin(), stream.end());
    return std::move(out.bytes());
}

bool table_checksums(std::span<const std::byte> table, std::size_t& at, std::uint64_t& count) {
    at = 0;
    return take_number(table, at, count) && count <= (table.size() - at) / sizeof(std::uint32_t);
}

const char* decode_table(std::span<const std::byte> table, FileInfo& info, std::size_t& at) {
    BlockInfo before = base_as_block(info);
    std::uint64_t end = info.data_offset, count = 0;
    std::size_t sums = 0;
    info.blocks.clear();
    at = 0;
    if (!table_checksums(table, sums, count)) return "the table ends within its checksums";
    info.blocks.reserve(count);
    const auto stream = table.subspan(sums + count * sizeof(std::uint32_t));
    at = table.size() - stream.size();
    RangeDecoder coder(stream);
    EntryModel model;
    for (std::size_t i = 0; i < count; ++i) {
        Entry entry{};
        model.code(coder, entry);
        if (coder.overrun()) return "the table ends within an entry";
        const std::uint64_t bytes = entry.bytes, splits = entry.splits, corners = entry.corners,
                            moves = entry.moves, fall = entry.fall;
        if (bytes == 0) return "a block is empty";
        if (splits == 0) return "a block has no splits";
        const auto births = static_cast<std::uint32_t>(unzigzag(entry.vertices) + entry.splits);
        const std::uint64_t vertices = births,
                            triangles = static_cast<std::uint32_t>(unzigzag(entry.triangles) + 2 * births);
        std::uint64_t parts = 0;
        for (const std::uint64_t part : {splits, vertices, triangles, corners, moves}) {
            // So that no count can exceed what the file's bytes can hold.
            if (part > bytes * kPartsPerByte || (parts += part) > bytes * kPartsPerByte)
                return "a block announces more parts than its bytes can hold";
        }
        if (fall > std::bit_cast<std::uint32_t>(before.error)) return "a block's error is negative";
        BlockInfo block;
        const auto add = [](std::uint32_t total, std::uint64_t more, std::uint32_t& sum) {
            sum = static_cast<std::uint32_t>(total + more);
            return total + more < kNoVertex / 4 * std::uint64_t{3};
        };
        if (!add(before.splits_end, splits, block.splits_end) ||
            !add(before.vertices_end, vertices, block.vertices_end) ||
            !add(before.triangles_end, triangles, block.triangles_end) ||
            !add(before.corners_end, corners, block.corners_end) ||
            !add(before.moves_end, moves, block.moves_end) || block.vertices_end >= kNoVertex / 4 ||
            block.triangles_end >= kNoVertex / 4)
            return "a block's counts are too large";
        block.offset = end;
        block.bytes = static_cast<std::uint32_t>(bytes);
        block.error = std::bit_cast<float>(std::bit_cast<std::uint32_t>(before.error) -
                                           static_cast<std::uint32_t>(fall));
        block.checksum = get<std::uint32_t>(table, sums + i * sizeof(std::uint32_t));
        end += bytes;
        info.blocks.push_back(block);
        before = block;
    }
    if (!only_zeros(stream.subspan(std::min(coder.taken(), stream.size()))))
        return "the table is longer than it needs";
    info.file_bytes = end;
    info.splits = before.splits_end;
    info.vertices = before.vertices_end;
    info.triangles = before.triangles_end;
    info.corner_changes = before.corners_end;
    info.moves = before.moves_end;
    return nullptr;
}

}  // namespace vsplit
