// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// .pmesh bytes for tests that forge them: numbers put in place, and the checksums made to fit again.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../../lib/bytes/checksum.hpp"
#include "../../lib/bytes/layout.hpp"
#include "../../lib/bytes/table.hpp"
#include "vsplit/read.hpp"
#include "vsplit/write.hpp"

namespace vsplit::test {

using Bytes = std::vector<std::byte>;

template <class T>
void put_at(Bytes& bytes, std::size_t offset, T value) {
    std::memcpy(bytes.data() + offset, &value, sizeof(T));
}

/// The parts that the header announces, as far as the bytes go: details, base mesh, table.
inline std::array<std::span<const std::byte>, 3> front_parts(const Bytes& bytes) {
    std::array<std::span<const std::byte>, 3> parts;
    std::size_t at = kHeaderBytes, part = 0;
    for (const std::size_t field : {kDetailsBytesAt, kBaseBytesAt, kTableBytesAt}) {
        const std::size_t size = get<std::uint32_t>(bytes, field);
        if (at > bytes.size() || size > bytes.size() - at) break;
        parts[part++] = std::span(bytes).subspan(at, size);
        at += size;
    }
    return parts;
}

/// Checksums of details, table and header as the bytes are now; blocks' and base's own stay.
inline void reseal(Bytes& bytes) {
    const auto parts = front_parts(bytes);
    if (parts[0].data()) put_at(bytes, kDetailsChecksumAt, checksum32(parts[0]));
    if (parts[2].data()) put_at(bytes, kTableChecksumAt, checksum32(parts[2]));
    put_at(bytes, kHeaderChecksumAt, checksum32(std::span(bytes).first(kHeaderChecksumAt)));
}

/// `file` with other entries in its table, as they are: what is wrong with them stays.
inline Bytes with_table(const Bytes& file, const FileInfo& info, std::span<const BlockInfo> blocks) {
    Bytes out(file.begin(), file.begin() + std::ptrdiff_t(info.table_offset));
    const Bytes table = encode_table(info, blocks);
    out.insert(out.end(), table.begin(), table.end());
    out.insert(out.end(), file.begin() + std::ptrdiff_t(info.data_offset), file.end());
    put_at(out, kTableBytesAt, std::uint32_t(table.size()));
    reseal(out);
    return out;
}

/// `file` with the checksums of base mesh and blocks as these bytes are now, where the table says that they
/// are.
inline Bytes with_true_checksums(Bytes file, const FileInfo& info) {
    put_at(file, kBaseChecksumAt, checksum32(std::span(file).subspan(info.base_offset, info.base_bytes)));
    std::vector<BlockInfo> blocks = info.blocks;
    for (BlockInfo& block : blocks)
        block.checksum = checksum32(std::span(file).subspan(block.offset, block.bytes));
    return with_table(file, info, blocks);
}

/// `file` with other Draco bytes in its base mesh, every place and checksum made to fit.
inline Bytes with_draco(const Bytes& file, const FileInfo& info, std::span<const std::byte> draco) {
    Bytes out(file.begin(), file.begin() + std::ptrdiff_t(info.base_offset));
    out.insert(out.end(), draco.begin(), draco.end());
    out.insert(out.end(), file.begin() + std::ptrdiff_t(info.base_offset + info.base_draco_bytes),
               file.end());
    const std::size_t base_bytes = info.base_bytes - info.base_draco_bytes + draco.size();
    put_at(out, kBaseBytesAt, std::uint32_t(base_bytes));
    put_at(out, kDracoBytesAt, std::uint32_t(draco.size()));
    put_at(out, kBaseChecksumAt, checksum32(std::span(out).subspan(info.base_offset, base_bytes)));
    reseal(out);
    return out;
}

/// `file`, which has one block, with other stored bytes for it.
inline Bytes with_block(const Bytes& file, const FileInfo& info, std::span<const std::byte> stored) {
    Bytes out(file.begin(), file.begin() + std::ptrdiff_t(info.blocks[0].offset));
    out.insert(out.end(), stored.begin(), stored.end());
    BlockInfo block = info.blocks[0];
    block.bytes = std::uint32_t(stored.size());
    block.checksum = checksum32(stored);
    return with_table(out, info, std::span(&block, 1));
}

}  // namespace vsplit::test
