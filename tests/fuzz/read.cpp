// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// libFuzzer target: any bytes are an error within them or a sound mesh. Checksums are made to fit first, half
// of the time, or the fuzzer would never get behind them.
#include <cstdlib>

#include "reseal_all.hpp"
#include "vsplit/progressive_mesh.hpp"

using namespace vsplit;

namespace {

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
    if (size % 2 == 0) test::reseal_all(bytes);
    read(bytes);
    return 0;
}
