// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What the library reads from a .pmesh, a line a prefix, in the words of formats/decoder/decode.py.
#include <cstdio>
#include <fstream>
#include <iterator>

#include "../../lib/bytes/checksum.hpp"
#include "vsplit/read.hpp"

using namespace vsplit;

namespace {

template <class T>
void print(const std::vector<T>& values) {
    std::printf(" %016llx", static_cast<unsigned long long>(checksum64(std::as_bytes(std::span(values)))));
}

void digest(const ProgressiveMesh& mesh) {
    std::printf("%zu %zu %zu", mesh.positions.size(), mesh.triangles.size(), mesh.splits.size());
    print(mesh.positions);
    print(mesh.weights);
    print(mesh.parents);
    print(mesh.triangles);
    print(mesh.splits);
    print(mesh.corner_changes);
    print(mesh.moves);
    print(mesh.groups);
    for (const Attribute& attribute : mesh.attributes) print(attribute.values);
    for (const auto& values : mesh.moved_values) print(values);
    std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    std::ifstream in(argv[1], std::ios::binary);
    const std::vector<char> text{std::istreambuf_iterator<char>(in), {}};
    const auto bytes = std::as_bytes(std::span(text));
    const auto failed = [](const Error& error) {
        std::fprintf(stderr, "%s: %s\n", error_code_name(error.code), error.describe().c_str());
        return 1;
    };
    if (const auto whole = read_progressive_mesh(bytes); !whole) return failed(whole.error());
    auto decoder = BlockDecoder::begin(bytes);
    if (!decoder) return failed(decoder.error());
    digest(decoder->mesh());
    for (const BlockInfo& block : decoder->info().blocks) {
        if (const auto status = decoder->decode(bytes.subspan(block.offset, block.bytes)); !status)
            return failed(status.error());
        digest(decoder->mesh());
    }
    return 0;
}
