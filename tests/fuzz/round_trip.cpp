// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// libFuzzer target: a mesh of the fuzzer's triangles, folded as its seed says and dressed with attributes, is
// written and read back as the writer promised.
#include <algorithm>
#include <cstdlib>

#include "../unit/decorated.hpp"
#include "vsplit/read.hpp"
#include "vsplit/write.hpp"

using namespace vsplit;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 10 || size > 600) return 0;
    const std::uint32_t seed = data[0], kind = data[1];
    const std::size_t vertices = 4 + data[2] % 60;
    Mesh mesh;
    for (std::size_t v = 0; v < vertices; ++v)
        mesh.positions.push_back(
            {float(data[3 + v % (size - 3)]), float(data[3 + 5 * v % (size - 3)]), float(v * 7 % 64)});
    for (std::size_t i = 3; i + 3 <= size; i += 3) {
        const Triangle t = {data[i] % std::uint32_t(vertices), data[i + 1] % std::uint32_t(vertices),
                            data[i + 2] % std::uint32_t(vertices)};
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh.triangles.push_back(t);
    }
    if (kind & 1) mesh.weights = test::some_weights(vertices);
    ProgressiveMesh record = test::naive_record(mesh, seed);
    if (kind & 2) record = test::decorated(std::move(record), seed);
    WriteOptions options;
    options.block_bytes = 1024;
    options.position_bits = kind & 4 ? 0 : 2 + (kind >> 3) % 19;
    const auto promised = canonical_progressive_mesh(record, options);
    const auto bytes = write_progressive_mesh(record, options);
    if (!promised || !bytes) std::abort();
    const auto back = read_progressive_mesh(*bytes);
    if (!back || !test::same_bytes(*back, *promised) || back->attributes != promised->attributes ||
        back->moved_values != promised->moved_values || back->groups != promised->groups)
        std::abort();
    return 0;
}
