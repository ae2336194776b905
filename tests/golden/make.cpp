// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Writes the golden and malformed files of this version into FOLDER/golden and FOLDER/malformed. Run by
// golden_test.py --update alone: what is there stays readable for ever.
#include <cstdio>
#include <string>

#include "../unit/decorated.hpp"
#include "../unit/pmesh_bytes.hpp"

using namespace vsplit;
using test::Bytes;

namespace {

bool save(const std::string& path, std::span<const std::byte> bytes) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (!file) return false;
    const bool good = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    return std::fclose(file) == 0 && good;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const std::string folder = argv[1];
    bool good = true;
    const auto write = [&](std::string name, const ProgressiveMesh& record, std::uint32_t bits,
                           BaseCoding base_coding = BaseCoding::kLeast) {
        WriteOptions options;
        options.base_coding = base_coding;
        options.position_bits = bits;
        options.block_bytes = 1024;
        for (char& c : name)
            if (c == ' ') c = '-';
        auto bytes = write_progressive_mesh(record, options);
        good &=
            bytes.ok() && save(folder + "/golden/1-" + name + (bits ? "" : "-lossless") + ".pmesh", *bytes);
        return *std::move(bytes);
    };
    for (auto [name, mesh] : test::mesh_family()) {
        write(name, test::naive_record(mesh, 71), 14);
        if (name == "many components" || name == "non-manifold") {
            mesh.weights = test::some_weights(mesh.positions.size());
            write(name + " weighted", test::naive_record(mesh, 72), 0);
        }
    }
    for (const std::uint32_t bits : {0u, 14u}) {
        write("attributes", test::decorated(test::naive_record(test::make_sphere(12, 8), 73), 74), bits);
        write("seam", test::decorated(test::seam(true), 75), bits);
        write("returning", test::decorated(test::returning(), 76), bits);
        write("draco", test::decorated(test::naive_record(test::make_sphere(12, 8), 78, 30), 79), bits,
              BaseCoding::kDraco);
    }

    const Bytes whole = write("torus small", test::naive_record(test::make_torus(9, 6), 77), 12);
    const auto info = read_info(whole);
    if (!info) return 1;
    const auto spoil = [&](const char* name, auto change) {
        Bytes bytes = whole;
        change(bytes);
        good &= save(folder + "/malformed/" + name + ".pmesh", bytes);
    };
    spoil("malformed-magic", [](Bytes& b) { b[1] = std::byte{'P'}; });
    spoil("malformed-behind-the-end", [](Bytes& b) { b.push_back({}); });
    spoil("malformed-counts", [](Bytes& b) {
        test::put_at(b, kBaseVerticesAt, 0xFFFFFFu);
        test::reseal(b);
    });
    spoil("malformed-stream", [&](Bytes& b) {
        const BlockInfo& block = info->blocks[0];
        for (std::uint32_t i = 0; i < block.bytes; ++i) b[block.offset + i] = std::byte(7 * i);
        b = test::with_true_checksums(std::move(b), *info);
    });
    {
        // A lattice beyond the floats, from which some places are one step more: infinite.
        WriteOptions lossless;
        lossless.position_bits = 0;
        auto written = write_progressive_mesh(test::naive_record(test::make_torus(9, 6), 77), lossless);
        if (!written) return 1;
        Bytes far = *std::move(written);
        for (std::size_t axis = 0; axis < 3; ++axis) test::put_at(far, kLatticeAt + 8 * axis, 1e39);
        test::reseal(far);
        good &= save(folder + "/malformed/malformed-not-finite.pmesh", far);
    }
    spoil("unsupported-version", [](Bytes& b) { test::put_at(b, kVersionAt, 2u); });
    spoil("unsupported-flag", [](Bytes& b) {
        test::put_at(b, kFlagsAt, 0x80u);
        test::reseal(b);
    });
    spoil("truncated-header", [](Bytes& b) { b.resize(100); });
    spoil("truncated-table", [&](Bytes& b) { b.resize(info->data_offset - 1); });
    spoil("truncated-block", [](Bytes& b) { b.pop_back(); });
    spoil("checksum-header", [](Bytes& b) { b[30] ^= std::byte{1}; });
    spoil("checksum-details", [&](Bytes& b) { b[info->details_offset] ^= std::byte{1}; });
    spoil("checksum-base", [&](Bytes& b) { b[info->base_offset] ^= std::byte{1}; });
    spoil("checksum-table", [&](Bytes& b) { b[info->table_offset] ^= std::byte{1}; });
    spoil("checksum-block", [](Bytes& b) { b.back() ^= std::byte{1}; });
    return good ? 0 : 1;
}
