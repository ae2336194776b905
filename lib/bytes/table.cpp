// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "table.hpp"

#include <bit>

#include "layout.hpp"

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

// Modulo 2^64, so that any table can be written.
std::uint64_t zigzag(std::uint64_t difference) {
    return (difference << 1) ^ (0 - (difference >> 63));
}
std::uint64_t unzigzag(std::uint64_t code) {
    return (code >> 1) ^ (0 - (code & 1));
}

void put_number(ByteWriter& out, std::uint64_t value) {
    for (; value >= 128; value >>= 7) out.put(static_cast<std::uint8_t>(value | 128));
    out.put(static_cast<std::uint8_t>(value));
}

void put_entry(ByteWriter& out, const BlockInfo& before, const BlockInfo& block) {
    const std::uint64_t splits = std::uint64_t{block.splits_end} - before.splits_end,
                        vertices = std::uint64_t{block.vertices_end} - before.vertices_end;
    put_number(out, block.bytes);
    put_number(out, splits);
    put_number(out, zigzag(vertices - splits));
    put_number(out, zigzag(block.triangles_end - std::uint64_t{before.triangles_end} - 2 * vertices));
    put_number(out, std::uint64_t{block.corners_end} - before.corners_end);
    put_number(out, std::uint64_t{block.moves_end} - before.moves_end);
    put_number(out, std::bit_cast<std::uint32_t>(before.error) - std::bit_cast<std::uint32_t>(block.error));
    out.put(block.checksum);
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
    BlockInfo before = base_as_block(front);
    for (const BlockInfo& block : blocks) {
        put_entry(out, before, block);
        before = block;
    }
    return std::move(out.bytes());
}

std::uint64_t table_entry_at(const FileInfo& info, std::size_t index) {
    return info.table_offset + encode_table(info, std::span(info.blocks).first(index)).size();
}

const char* decode_table(std::span<const std::byte> table, FileInfo& info, std::size_t& at) {
    BlockInfo before = base_as_block(info);
    std::uint64_t end = info.data_offset;
    info.blocks.clear();
    info.blocks.reserve(table.size() / kLeastEntryBytes);
    std::size_t next = 0;
    while (next < table.size()) {
        at = next;
        std::uint64_t bytes = 0, splits = 0, vertices = 0, triangles = 0, corners = 0, moves = 0, fall = 0;
        for (std::uint64_t* value : {&bytes, &splits, &vertices, &triangles, &corners, &moves, &fall})
            if (!take_number(table, next, *value)) return "a number of the table is not one";
        if (table.size() - next < 4) return "the table ends within an entry";
        if (bytes == 0) return "a block is empty";
        if (bytes > 0xFFFFFFFFu) return "a block is too long";
        if (splits == 0) return "a block has no splits";
        vertices = unzigzag(vertices) + splits;
        triangles = unzigzag(triangles) + 2 * vertices;
        std::uint64_t parts = 0;
        for (const std::uint64_t count : {splits, vertices, triangles, corners, moves}) {
            // So that no count can exceed what the file's bytes can hold.
            if (count > bytes * kPartsPerByte || (parts += count) > bytes * kPartsPerByte)
                return "a block announces more parts than its bytes can hold";
        }
        if (fall > std::bit_cast<std::uint32_t>(before.error)) return "a block's error is negative";
        BlockInfo block;
        const auto add = [](std::uint32_t total, std::uint64_t count, std::uint32_t& sum) {
            sum = static_cast<std::uint32_t>(total + count);
            return total + count < kNoVertex / 4 * std::uint64_t{3};
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
        block.checksum = get<std::uint32_t>(table, next);
        next += 4;
        end += bytes;
        info.blocks.push_back(block);
        before = block;
    }
    info.file_bytes = end;
    info.splits = before.splits_end;
    info.vertices = before.vertices_end;
    info.triangles = before.triangles_end;
    info.corner_changes = before.corners_end;
    info.moves = before.moves_end;
    return nullptr;
}

}  // namespace vsplit
