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
    const auto base = get<std::uint64_t>(bytes, kBaseOffsetAt);
    const std::uint64_t base_bytes = get<std::uint32_t>(bytes, kBaseBytesAt);
    if (base <= bytes.size() && base_bytes <= bytes.size() - base)
        put_at(bytes, kBaseChecksumAt, checksum64(std::span(bytes).subspan(base, base_bytes)));
    const auto table = get<std::uint64_t>(bytes, kTableOffsetAt);
    for (std::uint64_t i = 0; i < get<std::uint32_t>(bytes, kBlockCountAt); ++i) {
        if (table > bytes.size() || kTableEntryBytes * (i + 1) > bytes.size() - table) break;
        const std::size_t entry = table + kTableEntryBytes * i;
        const auto at = get<std::uint64_t>(bytes, entry);
        const std::uint64_t size = get<std::uint32_t>(bytes, entry + kEntryBytesAt);
        if (at <= bytes.size() && size <= bytes.size() - at)
            put_at(bytes, entry + kEntryChecksumAt, checksum64(std::span(bytes).subspan(at, size)));
    }
    reseal(bytes);
}

}  // namespace vsplit::test
