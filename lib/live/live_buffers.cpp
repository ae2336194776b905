// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "vsplit/live_buffers.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <utility>

#include "extend.hpp"
#include "live_codes.hpp"
#include "move_values.hpp"
#include "prefetch.hpp"

namespace vsplit {
namespace {

constexpr std::size_t kAhead = 96;   // corners between the one fetched and the one written
constexpr std::size_t kFetched = 3;  // corners fetched a split: about as many as change
constexpr std::size_t kAlways = 4;   // corners written without looking at how many there are

/// Eight splits that each move their parent and nothing else.
bool all_move(const std::uint8_t* codes) {
    constexpr std::uint64_t kEach = 0x0101010101010101;
    std::uint64_t eight = 0;
    std::memcpy(&eight, codes, sizeof eight);
    return (eight & kEach * (kSpecialBit | kMoveBit)) == kEach * kMoveBit;
}

}  // namespace

/// From the level `split` to the next.
void LiveBuffers::pass(Ends& ends, std::size_t split) const {
    const unsigned code = codes_[split];
    if ((code & kSpecialBit) == 0) {
        ++ends.vertices;
        ends.triangles += code >> kTriangleShift & kTriangleBits;
        ends.corners += code & kCornerBits;
        ends.moves += (code & kMoveBit) != 0;
        return;
    }
    const Special& special = specials_[ends.specials++];
    ends.vertices += special.vertices;
    ends.triangles += special.triangles;
    ends.corners += special.corners;
    ends.moves += special.moves;
    ends.special_corners += special.corners;
    ends.special_moves += special.moves;
}

LiveBuffers::Ends LiveBuffers::at(std::size_t level) const {
    if (checkpoints_.empty()) return {};
    level = std::min(level, available());
    Ends ends = checkpoints_[level / kInterval].ends;
    for (std::size_t i = level / kInterval * kInterval; i < level; ++i) pass(ends, i);
    return ends;
}

template <class Count>
std::size_t LiveBuffers::last_level(std::uint64_t limit, Count count) const {
    const auto after = std::partition_point(checkpoints_.begin(), checkpoints_.end(),
                                            [&](const Checkpoint& c) { return count(c.ends) <= limit; });
    if (after == checkpoints_.begin()) return 0;
    std::size_t level = std::size_t(after - checkpoints_.begin() - 1) * kInterval;
    for (Ends ends = std::prev(after)->ends; level < available(); ++level) {
        pass(ends, level);
        if (count(ends) > limit) break;
    }
    return level;
}

std::size_t LiveBuffers::level_for_triangles(std::uint64_t count) const {
    return last_level(count, [](const Ends& ends) { return ends.triangles; });
}

std::size_t LiveBuffers::level_for_vertices(std::uint64_t count) const {
    return last_level(count, [](const Ends& ends) { return ends.vertices; });
}

float LiveBuffers::error_at(std::size_t level) const {
    if (level >= total_splits_) return 0;
    const auto after = std::partition_point(errors_.begin(), errors_.end(),
                                            [&](const ErrorRun& run) { return run.split <= level; });
    return after == errors_.begin() ? std::numeric_limits<float>::infinity() : std::prev(after)->error;
}

std::size_t LiveBuffers::level_for_error(double error) const {
    const auto run = std::partition_point(errors_.begin(), errors_.end(),
                                          [&](const ErrorRun& r) { return double(r.error) > error; });
    return run == errors_.end() ? available() : run->split;
}

std::span<const float> LiveBuffers::weights() const {
    return weights_.empty() ? std::span<const float>{} : std::span(weights_).first(now_.vertices);
}

std::span<const float> LiveBuffers::attribute(std::size_t index) const {
    const Values& values = attributes_[index];
    return std::span(values.alive).first(std::size_t{values.components} * now_.vertices);
}

std::span<const std::uint32_t> LiveBuffers::groups() const {
    return groups_.empty() ? std::span<const std::uint32_t>{} : std::span(groups_).first(now_.triangles);
}

std::size_t LiveBuffers::memory() const {
    std::size_t sum = sizeof(*this) + bytes_of(positions_) + bytes_of(triangles_) + bytes_of(weights_) +
                      bytes_of(attributes_) + bytes_of(groups_) + bytes_of(parents_) + bytes_of(codes_) +
                      bytes_of(corners_) + bytes_of(steps_) + bytes_of(moved_positions_) +
                      bytes_of(last_moves_) + bytes_of(moving_) + bytes_of(moved_weights_) +
                      bytes_of(specials_) + bytes_of(special_corners_) + bytes_of(special_moves_) +
                      bytes_of(checkpoints_) + bytes_of(errors_) + vertex_runs_.memory() +
                      triangle_runs_.memory();
    for (const Values& values : attributes_) sum += bytes_of(values.alive) + bytes_of(values.moved);
    return sum;
}

DirtyRanges LiveBuffers::take_dirty() {
    DirtyRanges dirty = dirty_;
    dirty_ = {~0u, 0, ~0u, 0};
    // What died is marked again when it is born again.
    dirty.vertices_end = std::min(dirty.vertices_end, now_.vertices);
    dirty.triangles_end = std::min(dirty.triangles_end, now_.triangles);
    if (dirty.vertices_begin >= dirty.vertices_end) dirty.vertices_begin = dirty.vertices_end = 0;
    if (dirty.triangles_begin >= dirty.triangles_end) dirty.triangles_begin = dirty.triangles_end = 0;
    return dirty;
}

void LiveBuffers::take_dirty_runs(std::vector<ElementRange>& vertices, std::vector<ElementRange>& triangles) {
    vertex_runs_.take(now_.vertices, vertices);
    triangle_runs_.take(now_.triangles, triangles);
}

/// Triangles with corners changed in a range of splits: of whole intervals from the checkpoints.
void LiveBuffers::mark_triangles(std::size_t from_level, const Ends& from, std::size_t to_level,
                                 const Ends& to) {
    std::uint32_t first = ~0u, last = 0;
    const auto scan = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint8_t* const p = corners_.data() + i * corner_bytes_;
            const std::uint32_t corner = corner_bytes_ == 3 ? load<3>(p) : load<4>(p);
            first = std::min(first, corner);
            last = std::max(last, corner);
            if (tracking_) triangle_runs_.mark(corner / 3);
        }
    };
    const std::size_t a = (from_level + kInterval - 1) / kInterval, b = to_level / kInterval;
    if (a >= b || tracking_) {
        scan(from.corners, to.corners);
    } else {
        scan(from.corners, checkpoints_[a].ends.corners);
        for (std::size_t i = a; i < b; ++i) {
            first = std::min(first, checkpoints_[i].first_corner);
            last = std::max(last, checkpoints_[i].last_corner);
        }
        scan(checkpoints_[b].ends.corners, to.corners);
    }
    if (first > last) return;
    dirty_.triangles_begin = std::min(dirty_.triangles_begin, first / 3);
    dirty_.triangles_end = std::max(dirty_.triangles_end, last / 3 + 1);
}

/// Corners of the splits from level_ to `level`, in order or backward: to the vertex that is born, or to its
/// parent. Writing a fixed number of corners saves guessing a branch: those too many belong to the splits
/// that follow, which set them right.
template <bool kForward, unsigned kBytes>
void LiveBuffers::patch(std::size_t level, const Ends& to) {
    if (now_.corners == to.corners) return;
    std::uint32_t* const out = triangles_.data()->data();
    const std::uint8_t* change = corners_.data() + std::size_t{kBytes} * now_.corners;
    std::size_t left = kForward ? to.corners - now_.corners : now_.corners - to.corners;
    const std::uint32_t* special_corner = special_corners_.data() + now_.special_corners;
    const Special* special = specials_.data() + now_.specials;
    std::uint32_t vertex = now_.vertices;
    const auto corner = [&](std::size_t k) {
        return load<kBytes>(kForward ? change + kBytes * k : change - kBytes * (k + 1));
    };
    const auto pass_corners = [&](std::size_t count) {
        change = kForward ? change + kBytes * count : change - kBytes * count;
        left -= count;
    };
    for (std::size_t i = level_; i != level;) {
        const unsigned code = codes_[kForward ? i++ : --i];
        if ((code & kSpecialBit) != 0) {
            if (!kForward) --special;
            for (std::uint32_t k = 0; k < special->corners; ++k)
                out[corner(k)] = kForward ? *special_corner++ : parents_[*--special_corner];
            pass_corners(special->corners);
            vertex = kForward ? vertex + special->vertices : vertex - special->vertices;
            if (kForward) ++special;
            continue;
        }
        const std::uint32_t value = kForward ? vertex++ : parents_[--vertex];
        const std::size_t count = code & kCornerBits;
        prefetch_once(change, kForward ? kBytesAhead : -kBytesAhead);
        if (left >= kAhead + kFetched)
            for (std::size_t k = kAhead; k < kAhead + kFetched; ++k) prefetch(out + corner(k));
        if (left >= kAlways) {
            std::array<std::uint32_t, kAlways> corners;
            for (std::size_t k = 0; k < kAlways; ++k) corners[k] = corner(k);
            for (const std::uint32_t c : corners) out[c] = value;
            for (std::size_t k = kAlways; k < count; ++k) out[corner(k)] = value;
        } else {
            for (std::size_t k = 0; k < count; ++k) out[corner(k)] = value;
        }
        pass_corners(count);
    }
}

/// What moves change, from `first_move` on.
template <bool kForward>
void LiveBuffers::exchange(std::span<const std::uint32_t> vertices, std::size_t first_move) {
    static_assert(sizeof(Float3) == 3 * sizeof(float));
    if (vertices.empty()) return;
    if (packed_)
        step_places<kForward>(vertices, positions_.data(), steps_.data() + first_move, grid_);
    else
        flip_values<3>(vertices, &positions_.data()->x, moved_positions_[first_move].data(), 3);
    if (!weights_.empty()) flip_values<1>(vertices, weights_.data(), moved_weights_.data() + first_move, 1);
    for (Values& values : attributes_)
        flip_any(vertices, values.alive.data(), values.moved.data() + values.components * first_move,
                 values.components);
    std::uint32_t least = vertices[0], most = vertices[0];
    for (const std::uint32_t vertex : vertices)
        least = std::min(least, vertex), most = std::max(most, vertex);
    dirty_.vertices_begin = std::min(dirty_.vertices_begin, least);
    dirty_.vertices_end = std::max(dirty_.vertices_end, most + 1);
    if (tracking_)
        for (const std::uint32_t vertex : vertices) vertex_runs_.mark(vertex);
}

/// Moves of the splits between two levels: differences, so that their order is of no account. Their vertices
/// are listed first, so that what they hold is fetched ahead.
template <bool kForward>
void LiveBuffers::move(std::size_t from_level, const Ends& from, std::size_t to_level, const Ends& to) {
    if (from.moves == to.moves) return;
    std::uint32_t* const list = moving_.data();
    const std::size_t most = moving_.size();
    std::size_t listed = 0, first = from.moves;
    const auto add = [&](std::uint32_t vertex) {
        list[listed++] = vertex;
        if (listed < most) return;
        exchange<kForward>(moving_, first);
        first += listed;
        listed = 0;
    };
    const Special* special = specials_.data() + from.specials;
    const std::uint32_t* special_move = special_moves_.data() + from.special_moves;
    const std::uint32_t* parent = parents_.data() + from.vertices;
    for (std::size_t i = from_level; i < to_level; ++i) {
        if (i + 8 <= to_level && listed + 8 < most && all_move(&codes_[i])) {
            std::memcpy(list + listed, parent, 8 * sizeof(std::uint32_t));
            listed += 8, parent += 8, i += 7;
            continue;
        }
        const unsigned code = codes_[i];
        if ((code & kSpecialBit) != 0) {
            for (std::uint32_t k = 0; k < special->moves; ++k) add(*special_move++);
            parent += special++->vertices;
            continue;
        }
        if ((code & kMoveBit) != 0) add(*parent);
        ++parent;
    }
    exchange<kForward>(std::span(moving_).first(listed), first);
}

void LiveBuffers::refine(std::size_t splits) {
    const std::size_t level = level_ + std::min(splits, available() - level_);
    if (level == level_) return;
    const Ends to = at(level);
    corner_bytes_ == 3 ? patch<true, 3>(level, to) : patch<true, 4>(level, to);
    move<true>(level_, now_, level, to);
    mark_triangles(level_, now_, level, to);
    if (to.vertices > now_.vertices) {
        dirty_.vertices_begin = std::min(dirty_.vertices_begin, now_.vertices);
        dirty_.vertices_end = std::max(dirty_.vertices_end, to.vertices);
        if (tracking_) vertex_runs_.mark(now_.vertices, to.vertices);
    }
    if (to.triangles > now_.triangles) {
        dirty_.triangles_begin = std::min(dirty_.triangles_begin, now_.triangles);
        dirty_.triangles_end = std::max(dirty_.triangles_end, to.triangles);
        if (tracking_) triangle_runs_.mark(now_.triangles, to.triangles);
    }
    level_ = level;
    now_ = to;
}

void LiveBuffers::coarsen(std::size_t splits) {
    const std::size_t level = level_ - std::min(splits, level_);
    if (level == level_) return;
    const Ends to = at(level);
    move<false>(level, to, level_, now_);
    corner_bytes_ == 3 ? patch<false, 3>(level, to) : patch<false, 4>(level, to);
    mark_triangles(level, to, level_, now_);
    level_ = level;
    now_ = to;
}

void LiveBuffers::jump(std::size_t level) {
    level = std::min(level, available());
    level > level_ ? refine(level - level_) : coarsen(level_ - level);
}

}  // namespace vsplit
