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
        std::size_t at = 0, block = begin + table.size();
        while (at < table.size()) {
            std::uint64_t size = 0, other = 0;
            bool whole = take_number(table, at, size);
            for (int i = 0; i < 6 && whole; ++i) whole = take_number(table, at, other);
            if (!whole || table.size() - at < 4) break;
            if (size > bytes.size() - block) break;
            put_at(bytes, begin + at, checksum32(std::span(bytes).subspan(block, size)));
            at += 4;
            block += size;
        }
    }
    reseal(bytes);
}

}  // namespace vsplit::test
