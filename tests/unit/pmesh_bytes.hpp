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

/// Where things are in the header and in an entry of the table (formats/spec/pmesh-0.md).
inline constexpr std::size_t kFileBytesAt = 16, kBlockCountAt = 24, kVerticesAt = 28, kTrianglesAt = 32,
                             kBaseVerticesAt = 36, kBaseTrianglesAt = 40, kSplitsAt = 44, kCornersAt = 48,
                             kMovesAt = 52, kBoundsAt = 56, kBaseOffsetAt = 80, kBaseBytesAt = 88,
                             kBaseErrorAt = 92, kBaseChecksumAt = 96;
inline constexpr std::size_t kEntryBytesAt = 8, kEntryRawBytesAt = 12, kEntryChecksumAt = 16,
                             kEntrySplitsAt = 24;

inline std::size_t entry_at(std::size_t block) {
    return kHeaderBytes + kTableEntryBytes * block;
}

/// Checksums of table and header as the bytes are now; blocks' and base's own stay.
inline void reseal(Bytes& bytes) {
    const std::size_t table_bytes = kTableEntryBytes * std::size_t{get<std::uint32_t>(bytes, kBlockCountAt)};
    if (kHeaderBytes + table_bytes <= bytes.size())
        put_at(bytes, kTableChecksumAt, checksum64(std::span(bytes).subspan(kHeaderBytes, table_bytes)));
    put_at(bytes, kHeaderChecksumAt, checksum64(std::span(bytes).first(kHeaderChecksumAt)));
}

/// `file` with other bytes as its base mesh, every place and checksum made to fit.
inline Bytes with_base(const Bytes& file, const FileInfo& info, std::span<const std::byte> base) {
    Bytes out(file.begin(), file.begin() + std::ptrdiff_t(info.base_offset));
    out.insert(out.end(), base.begin(), base.end());
    out.insert(out.end(), file.begin() + std::ptrdiff_t(info.base_offset + info.base_bytes), file.end());
    put_at(out, kFileBytesAt, std::uint64_t{out.size()});
    put_at(out, kBaseBytesAt, std::uint32_t(base.size()));
    put_at(out, kBaseChecksumAt, checksum64(base));
    for (std::size_t i = 0; i < info.blocks.size(); ++i)
        put_at(out, entry_at(i), info.blocks[i].offset + base.size() - info.base_bytes);
    reseal(out);
    return out;
}

/// `file`, which has one block, with other stored bytes for it that announce `raw_bytes`.
inline Bytes with_block(const Bytes& file, const FileInfo& info, std::span<const std::byte> stored,
                        std::uint32_t raw_bytes) {
    Bytes out(file.begin(), file.begin() + std::ptrdiff_t(info.blocks[0].offset));
    out.insert(out.end(), stored.begin(), stored.end());
    put_at(out, kFileBytesAt, std::uint64_t{out.size()});
    put_at(out, entry_at(0) + kEntryBytesAt, std::uint32_t(stored.size()));
    put_at(out, entry_at(0) + kEntryRawBytesAt, raw_bytes);
    put_at(out, entry_at(0) + kEntryChecksumAt, checksum64(stored));
    reseal(out);
    return out;
}

}  // namespace vsplit::test
