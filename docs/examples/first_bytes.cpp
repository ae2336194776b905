// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// first_bytes FILE.pmesh: what the first 16 KiB of a file say about all of it.
#include <cstdio>
#include <fstream>
#include <span>
#include <vector>
#include <vsplit/read.hpp>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    std::vector<char> first(16 * 1024);
    std::ifstream file(argv[1], std::ios::binary);
    file.read(first.data(), std::streamsize(first.size()));
    first.resize(std::size_t(file.gcount()));

    vsplit::Limits limits;
    limits.max_bytes = 256 << 20;  // refuse what would take more memory than this
    const auto info = vsplit::read_info(std::as_bytes(std::span(first)), limits);
    if (!info) {
        std::fprintf(stderr, "%s: %s\n", argv[1], info.error().describe().c_str());
        return 1;
    }
    std::printf("%llu bytes: %u triangles\n",
                static_cast<unsigned long long>(info->base_offset + info->base_bytes), info->base_triangles);
    for (const vsplit::BlockInfo& block : info->blocks)
        std::printf("%llu bytes: %u triangles, error %g\n",
                    static_cast<unsigned long long>(block.offset + block.bytes), block.triangles_end,
                    double(block.error));
}
