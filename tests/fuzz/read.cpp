// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// libFuzzer target: any bytes are an error within them or a sound mesh. Checksums are made to fit first, half
// of the time, or the fuzzer would never get behind them.
#include <cstdlib>

#include "../unit/pmesh_bytes.hpp"
#include "vsplit/progressive_mesh.hpp"

using namespace vsplit;

namespace {

/// The checksums of base and blocks too, as far as the bytes go.
void reseal_all(test::Bytes& bytes) {
    if (bytes.size() < kHeaderBytes) return;
    const auto base = get<std::uint64_t>(bytes, test::kBaseOffsetAt);
    const std::uint64_t base_bytes = get<std::uint32_t>(bytes, test::kBaseBytesAt);
    if (base <= bytes.size() && base_bytes <= bytes.size() - base)
        test::put_at(bytes, test::kBaseChecksumAt, checksum64(std::span(bytes).subspan(base, base_bytes)));
    const auto table = get<std::uint64_t>(bytes, test::kTableOffsetAt);
    for (std::uint64_t i = 0; i < get<std::uint32_t>(bytes, test::kBlockCountAt); ++i) {
        if (table > bytes.size() || kTableEntryBytes * (i + 1) > bytes.size() - table) break;
        const std::size_t entry = table + kTableEntryBytes * i;
        const auto at = get<std::uint64_t>(bytes, entry);
        const std::uint64_t size = get<std::uint32_t>(bytes, entry + test::kEntryBytesAt);
        if (at <= bytes.size() && size <= bytes.size() - at)
            test::put_at(bytes, entry + test::kEntryChecksumAt,
                         checksum64(std::span(bytes).subspan(at, size)));
    }
    test::reseal(bytes);
}

void read(const test::Bytes& bytes) {
    Limits limits;
    limits.max_bytes = 64 << 20;
    const auto mesh = read_progressive_mesh(bytes, limits);
    if (mesh ? progressive_mesh_fault(*mesh) != nullptr : mesh.error().offset > bytes.size()) std::abort();
    const auto prefix = read_prefix(bytes, limits);
    if (prefix ? progressive_mesh_fault(*prefix) != nullptr
               : prefix.error().offset > bytes.size() + 0xFFFFFFFFu)
        std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto* first = reinterpret_cast<const std::byte*>(data);
    test::Bytes bytes(first, first + size);
    if (size % 2 == 0) reseal_all(bytes);
    read(bytes);
    return 0;
}
