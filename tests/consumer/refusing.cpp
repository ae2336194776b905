// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// refusing FILE.pmesh: in a program that cannot catch, every cut of a file is an error, and the whole is
// none.
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <vector>
#include <vsplit/live_mesh.hpp>
#include <vsplit/mesh.hpp>
#include <vsplit/progressive_mesh.hpp>
#include <vsplit/read.hpp>
#include <vsplit/result.hpp>
#include <vsplit/version.hpp>
#include <vsplit/write.hpp>

#if defined(__cpp_exceptions) || defined(__cpp_rtti)
#error "compiled with exceptions or RTTI"
#endif

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    std::ifstream file(argv[1], std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    const auto all = std::as_bytes(std::span(bytes));
    for (std::size_t size = 0; size < all.size(); ++size) {
        const auto cut = vsplit::read_progressive_mesh(all.first(size));
        if (cut.ok() || cut.error().offset > size) {
            std::fprintf(stderr, "cut at %zu: read, or an offset behind the end\n", size);
            return 1;
        }
    }
    const auto whole = vsplit::read_progressive_mesh(all);
    if (!whole || vsplit::progressive_mesh_fault(*whole) ||
        vsplit::mesh_fault(vsplit::cut(*whole, whole->splits.size())))
        return 1;
    vsplit::Limits tight;
    tight.max_bytes = 16;
    const auto refused = vsplit::read_info(all, tight);
    if (refused.ok() || refused.error().code != vsplit::ErrorCode::kLimit) return 1;
    return std::strlen(vsplit::version()) > 0 ? 0 : 1;
}
