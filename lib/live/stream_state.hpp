// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What a Stream holds. Private to this room.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gather.hpp"
#include "vsplit/stream.hpp"

namespace vsplit {

inline constexpr std::size_t kFirstRequest = 16 * 1024;

inline std::uint64_t clamped_count(double value) {
    if (!(value > 0)) return 0;
    return value >= 4294967295.0 ? 4294967295u : std::uint64_t(value);
}

/// Where the file's places are.
inline PlaceGrid grid_of(const FileInfo& info) {
    return info.lossless ? PlaceGrid{} : PlaceGrid{info.lattice_origin, info.lattice_step};
}

struct Stream::State {
    explicit State(StreamOptions given) : options(std::move(given)) {}

    StreamOptions options;
    Target target;
    Gather front{0, kFirstRequest};
    std::optional<std::uint64_t> file_size;
    std::optional<FileInfo> info;
    std::optional<BlockDecoder> decoder;  // none before the base mesh, after the last block, or lent to a job
    bool lent = false;
    std::map<std::size_t, Gather> pending;                // blocks that are here, whole or in part
    std::map<std::size_t, std::vector<std::byte>> whole;  // and checked
    std::map<std::size_t, int> failures;                  // kFront for the front
    std::size_t decoded = 0;
    std::uint64_t pending_bytes = 0, received = 0;
    bool broken = false;
    std::optional<Error> error;
    LiveBuffers live;
    bool selective_wanted = false;
    std::optional<ViewMesh> selective;  ///< None if it is not wanted, and before the base mesh is there.
    std::optional<View> view;           ///< In the object's space; none: the target's order of priorities.
    std::array<ViewPlane, kViewPlanes> planes{};

    static constexpr std::size_t kFront = ~std::size_t{0};

    Error fail(Error what, bool final) {
        broken |= final;
        error = what;
        return what;
    }
    /// Counts a failure that another try may mend.
    Error retry(std::size_t part, Error what) {
        const int times = ++failures[part];
        if (times >= options.tries) what.message += " (" + std::to_string(times) + " tries: given up)";
        return fail(std::move(what), times >= options.tries);
    }

    Status take_front();
    Status take_block(std::size_t block);
    void drop_far(std::size_t keep);
    std::size_t blocks_for_target() const;
    std::size_t blocks_for_uniform() const;
    std::size_t blocks_for_kind() const;
    std::size_t blocks_for_triangles(std::uint64_t count) const;
    std::size_t blocks_for_selective() const;
    std::size_t level_for_target() const;
    std::size_t level_for_kind() const;
    std::size_t rank_for_target() const;
    std::size_t rank_for_kind() const;
    /// The first blocks, of which the last is enough.
    template <class Enough>
    std::size_t blocks_until(Enough is_enough) const {
        const auto& blocks = info->blocks;
        const auto at = std::partition_point(blocks.begin(), blocks.end(),
                                             [&](const BlockInfo& b) { return !is_enough(b); });
        return std::min(std::size_t(at - blocks.begin()) + 1, blocks.size());
    }
    /// Geometric error once so many blocks are decoded.
    float error_after(std::size_t blocks) const {
        return blocks == 0 ? info->base_error : info->blocks[blocks - 1].error;
    }
    std::uint64_t triangles_of_ratio() const {
        return clamped_count(std::round(target.value * double(info->triangles)));
    }
    Status begin_selective();
    bool update_selective(const Budget& budget, Updated& out);
    bool has(std::size_t block) const { return block < decoded || whole.contains(block); }
};

}  // namespace vsplit
