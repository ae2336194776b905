// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// .pmesh bytes for tests that forge them: numbers put in place, and the checksums made to fit again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../../lib/bytes/checksum.hpp"
#include "../../lib/bytes/layout.hpp"
#include "vsplit/read.hpp"
#include "vsplit/write.hpp"

namespace vsplit::test {

using Bytes = std::vector<std::byte>;

template <class T>
void put_at(Bytes& bytes, std::size_t offset, T value) {
    std::memcpy(bytes.data() + offset, &value, sizeof(T));
}

/// Where things are in the header and in an entry of the table (formats/spec/pmesh-1.md).
inline constexpr std::size_t kFileBytesAt = 16, kBlockCountAt = 24, kVerticesAt = 28, kTrianglesAt = 32,
                             kBaseVerticesAt = 36, kBaseTrianglesAt = 40, kSplitsAt = 44, kCornersAt = 48,
                             kMovesAt = 52, kBoundsAt = 56, kBaseOffsetAt = 80, kBaseBytesAt = 88,
                             kBaseErrorAt = 92, kBaseChecksumAt = 96, kLatticeAt = 112, kPositionBitsAt = 144,
                             kDracoBytesAt = 148, kLargestGroupAt = 152, kDetailsBytesAt = 156,
                             kTableOffsetAt = 160;
inline constexpr std::size_t kEntryBytesAt = 8, kEntryChecksumAt = 12, kEntrySplitsAt = 20;

inline std::size_t entry_at(const FileInfo& info, std::size_t block) {
    return info.table_offset + kTableEntryBytes * block;
}

/// Checksums of details, table and header as the bytes are now; blocks' and base's own stay.
inline void reseal(Bytes& bytes) {
    const std::size_t details = get<std::uint32_t>(bytes, kDetailsBytesAt),
                      table_bytes = kTableEntryBytes * std::size_t{get<std::uint32_t>(bytes, kBlockCountAt)};
    const std::uint64_t table = get<std::uint64_t>(bytes, kTableOffsetAt);
    if (kHeaderBytes + details <= bytes.size())
        put_at(bytes, kDetailsChecksumAt, checksum64(std::span(bytes).subspan(kHeaderBytes, details)));
    if (table <= bytes.size() && table_bytes <= bytes.size() - table)
        put_at(bytes, kTableChecksumAt, checksum64(std::span(bytes).subspan(table, table_bytes)));
    put_at(bytes, kHeaderChecksumAt, checksum64(std::span(bytes).first(kHeaderChecksumAt)));
}

/// `file` with other Draco bytes in its base mesh, every place and checksum made to fit.
inline Bytes with_draco(const Bytes& file, const FileInfo& info, std::span<const std::byte> draco) {
    Bytes out(file.begin(), file.begin() + std::ptrdiff_t(info.base_offset));
    out.insert(out.end(), draco.begin(), draco.end());
    out.insert(out.end(), file.begin() + std::ptrdiff_t(info.base_offset + info.base_draco_bytes),
               file.end());
    const std::size_t base_bytes = info.base_bytes - info.base_draco_bytes + draco.size();
    put_at(out, kFileBytesAt, std::uint64_t{out.size()});
    put_at(out, kBaseBytesAt, std::uint32_t(base_bytes));
    put_at(out, kDracoBytesAt, std::uint32_t(draco.size()));
    put_at(out, kTableOffsetAt, std::uint64_t{info.base_offset + base_bytes});
    put_at(out, kBaseChecksumAt, checksum64(std::span(out).subspan(info.base_offset, base_bytes)));
    for (std::size_t i = 0; i < info.blocks.size(); ++i)
        put_at(out, info.base_offset + base_bytes + kTableEntryBytes * i,
               info.blocks[i].offset + draco.size() - info.base_draco_bytes);
    reseal(out);
    return out;
}

/// `file`, which has one block, with other stored bytes for it.
inline Bytes with_block(const Bytes& file, const FileInfo& info, std::span<const std::byte> stored) {
    Bytes out(file.begin(), file.begin() + std::ptrdiff_t(info.blocks[0].offset));
    out.insert(out.end(), stored.begin(), stored.end());
    put_at(out, kFileBytesAt, std::uint64_t{out.size()});
    put_at(out, entry_at(info, 0) + kEntryBytesAt, std::uint32_t(stored.size()));
    put_at(out, entry_at(info, 0) + kEntryChecksumAt, checksum64(stored));
    reseal(out);
    return out;
}

}  // namespace vsplit::test
