// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// libFuzzer target: a file that arrives in pieces of any size, shown at any level in between, forward and
// back. The last bytes of the input say how; the rest is the file, its checksums made to fit.
#include <cstdlib>

#include "../unit/pmesh_bytes.hpp"
#include "vsplit/live_mesh.hpp"
#include "vsplit/progressive_mesh.hpp"

using namespace vsplit;

namespace {

/// The checksum of a block as it arrived, in the table of a decoder that is about to be made.
void reseal_blocks(test::Bytes& bytes) {
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
    const auto base = get<std::uint64_t>(bytes, test::kBaseOffsetAt);
    const std::uint64_t base_bytes = get<std::uint32_t>(bytes, test::kBaseBytesAt);
    if (base <= bytes.size() && base_bytes <= bytes.size() - base)
        test::put_at(bytes, test::kBaseChecksumAt, checksum64(std::span(bytes).subspan(base, base_bytes)));
    test::reseal(bytes);
}

void require(bool good) {
    if (!good) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t kSteps = 32;
    if (size < kSteps + kHeaderBytes) return 0;
    const auto* first = reinterpret_cast<const std::byte*>(data);
    test::Bytes file(first, first + size - kSteps);
    const std::uint8_t* step = data + size - kSteps;
    reseal_blocks(file);
    Limits limits;
    limits.max_bytes = 64 << 20;

    // Nothing, until header, table and base are there.
    std::size_t arrived = 0, at = 0;
    const auto next = [&] { return step[at++ % kSteps]; };
    const auto arrive = [&] { arrived = std::min(file.size(), arrived + 1 + 16 * std::size_t{next()}); };
    auto decoder = BlockDecoder::begin(std::span(file).first(0), limits);
    require(!decoder.ok());
    while (!decoder && arrived < file.size()) {
        arrive();
        decoder = BlockDecoder::begin(std::span(file).first(arrived), limits);
        if (!decoder && decoder.error().code != ErrorCode::kTruncated) return 0;
    }
    if (!decoder) return 0;
    require(progressive_mesh_fault(decoder->mesh()) == nullptr);
    for (;;) {
        const auto& blocks = decoder->info().blocks;
        if (decoder->blocks() == blocks.size()) break;
        const BlockInfo& block = blocks[decoder->blocks()];
        if (block.offset + block.bytes > file.size()) break;
        while (arrived < block.offset + block.bytes) arrive();
        const std::size_t splits = decoder->mesh().splits.size();
        // Another block's bytes, or half of it, is refused and harms nothing.
        if (next() % 4 == 0)
            require(!decoder->decode(std::span(file).subspan(block.offset, block.bytes - 1)).ok() &&
                    decoder->mesh().splits.size() == splits);
        if (!decoder->decode(std::span(file).subspan(block.offset, block.bytes)).ok()) return 0;
        require(decoder->mesh().splits.size() == block.splits_end);
    }
    if (progressive_mesh_fault(decoder->mesh()) != nullptr) return 0;  // readers ask this of a whole file
    LiveMesh live(decoder->release());
    const std::size_t levels = live.max_level() + 1;
    for (std::size_t i = 0; i < kSteps; ++i) {
        const std::size_t level = (std::size_t{next()} << 8 | next()) % levels;
        live.go_to(level);
        const Mesh mesh = live.snapshot();
        for (const Triangle& triangle : mesh.triangles)
            for (const std::uint32_t corner : triangle) require(corner < mesh.positions.size());
    }
    return 0;
}
