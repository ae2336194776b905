// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Checksums of all parts made to fit, or a fuzzer would never get behind them.
#pragma once

#include "../unit/pmesh_bytes.hpp"

namespace vsplit::test {

/// Those of base and blocks too, as far as the bytes go.
inline void reseal_all(Bytes& bytes) {
    if (bytes.size() < kHeaderBytes) return;
    const auto parts = front_parts(bytes);
    if (parts[1].data()) put_at(bytes, kBaseChecksumAt, checksum32(parts[1]));
    if (parts[2].data()) {
        const std::span<const std::byte> table = parts[2];
        const auto begin = std::size_t(table.data() - bytes.data());
        FileInfo info;
        info.data_offset = begin + table.size();
        info.base_error = std::numeric_limits<float>::max();
        std::size_t at = 0;
        std::uint64_t count = 0;
        static_cast<void>(decode_table(table, info, at));
        if (table_checksums(table, at, count))
            for (const BlockInfo& block : info.blocks) {
                if (block.offset + block.bytes > bytes.size()) break;
                put_at(bytes, begin + at, checksum32(std::span(bytes).subspan(block.offset, block.bytes)));
                at += 4;
            }
    }
    reseal(bytes);
}

}  // namespace vsplit::test
