// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The splits as patch lists. Nearly all of them give birth to one vertex and at most three triangles, change
// at most 15 corners and move nothing or the parent: their counts are one byte, the vertex born is the next
// one, and what a changed corner held before is that vertex's parent. The others are `specials`.
#include "vsplit/live_buffers.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace vsplit {
namespace {

constexpr unsigned kCornerBits = 0x0f, kTriangleShift = 4, kTriangleBits = 3, kMoveBit = 0x40,
                   kSpecialBit = 0x80;
constexpr std::size_t kInterval = 128;  // splits between checkpoints
constexpr std::size_t kAhead = 32;      // corners between the one fetched and the one written
constexpr std::size_t kFetched = 3;     // corners fetched a split: about as many as change
constexpr std::size_t kAlways = 4;      // corners written without looking at how many there are
constexpr std::size_t kChunk = 256;     // moves listed at a time

/// Reads a byte beyond a corner of three. Compilers make one load of it.
template <unsigned kBytes>
std::uint32_t load(const std::uint8_t* p) {
    const std::uint32_t four = std::uint32_t{p[0]} | std::uint32_t{p[1]} << 8 | std::uint32_t{p[2]} << 16 |
                               std::uint32_t{p[3]} << 24;
    return kBytes == 3 ? four & 0xffffff : four;
}

void prefetch(const void* address) {
#if defined(__GNUC__)
    __builtin_prefetch(address, 1);
#else
    static_cast<void>(address);
#endif
}

template <class T>
void extend(std::vector<T>& to, const std::vector<T>& from, std::size_t end) {
    to.insert(to.end(), from.begin() + std::ptrdiff_t(to.size()), from.begin() + std::ptrdiff_t(end));
}

template <class T>
std::size_t bytes(const std::vector<T>& v) {
    return v.capacity() * sizeof(T);
}

/// Exchanges `kComponents` (or, if that is 0, `components`) floats of each vertex with the moves from
/// `moved` on, forward or backward.
template <bool kForward, std::size_t kComponents>
void swap_values(std::span<const std::uint32_t> vertices, float* alive, float* moved,
                 std::size_t components) {
    constexpr std::size_t kVerticesAhead = 12;
    const std::size_t n = kComponents != 0 ? kComponents : components;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (i + kVerticesAhead < vertices.size()) prefetch(alive + n * vertices[i + kVerticesAhead]);
        float* const a = alive + n * vertices[i];
        for (std::size_t k = 0; k < n; ++k) std::swap(a[k], moved[k]);
        if (kForward)
            moved += n;
        else if (i + 1 < vertices.size())
            moved -= n;
    }
}

template <bool kForward>
void swap_any(std::span<const std::uint32_t> vertices, float* alive, float* moved, std::size_t components) {
    switch (components) {
        case 1:
            return swap_values<kForward, 1>(vertices, alive, moved, 1);
        case 2:
            return swap_values<kForward, 2>(vertices, alive, moved, 2);
        case 3:
            return swap_values<kForward, 3>(vertices, alive, moved, 3);
        case 4:
            return swap_values<kForward, 4>(vertices, alive, moved, 4);
        default:
            return swap_values<kForward, 0>(vertices, alive, moved, components);
    }
}

}  // namespace

void LiveBuffers::begin(const ProgressiveMesh& mesh, std::uint32_t vertices, std::uint32_t triangles,
                        std::uint32_t splits, std::uint32_t corner_changes, std::uint32_t moves) {
    const bool tracks = tracks_;
    *this = LiveBuffers();
    tracks_ = tracking_ = tracks;
    if (tracking_) vertex_runs_.resize(vertices), triangle_runs_.resize(triangles);
    totals_ = {vertices, triangles, corner_changes, moves, 0, 0, 0};
    total_splits_ = splits;
    corner_bytes_ = std::uint64_t{3} * triangles <= 0x1000000 ? 3 : 4;
    positions_.reserve(vertices);
    triangles_.reserve(triangles);
    if (!mesh.weights.empty()) weights_.reserve(vertices), moved_weights_.reserve(moves);
    for (const Attribute& attribute : mesh.attributes) {
        Values& values = attributes_.emplace_back();
        values.components = attribute.components;
        values.alive.reserve(std::size_t{attribute.components} * vertices);
        values.moved.reserve(std::size_t{attribute.components} * moves);
    }
    if (!mesh.groups.empty()) groups_.reserve(triangles);
    parents_.reserve(vertices);
    codes_.reserve(splits);
    corners_.reserve(std::size_t{corner_bytes_} * corner_changes + 1);
    corners_.push_back(0);
    moved_positions_.reserve(moves);
    checkpoints_.reserve(splits / kInterval + 1);

    known_.vertices = mesh.base_vertices;
    known_.triangles = mesh.base_triangles;
    now_ = known_;
    dirty_ = {0, now_.vertices, 0, now_.triangles};
    if (tracking_) vertex_runs_.mark(0, now_.vertices), triangle_runs_.mark(0, now_.triangles);
    checkpoints_.push_back({known_, ~0u, 0});
    append(mesh);
}

void LiveBuffers::append(const ProgressiveMesh& mesh) {
    std::size_t end = codes_.size();
    for (; end < mesh.splits.size() && end < total_splits_; ++end) {
        const Split& split = mesh.splits[end];
        if (split.vertices_end > totals_.vertices || split.triangles_end > totals_.triangles ||
            split.corners_end > totals_.corners || split.moves_end > totals_.moves)
            break;
    }
    for (std::size_t split = codes_.size(); split < end; ++split) encode(mesh, split);

    extend(positions_, mesh.positions, known_.vertices);
    extend(parents_, mesh.parents, known_.vertices);
    extend(triangles_, mesh.triangles, known_.triangles);
    if (!mesh.weights.empty()) extend(weights_, mesh.weights, known_.vertices);
    if (!mesh.groups.empty()) extend(groups_, mesh.groups, known_.triangles);
    for (std::size_t i = moved_positions_.size(); i < known_.moves; ++i) {
        moved_positions_.push_back(mesh.moves[i].position);
        if (!mesh.weights.empty()) moved_weights_.push_back(mesh.moves[i].weight);
    }
    for (std::size_t i = 0; i < attributes_.size(); ++i) {
        extend(attributes_[i].alive, mesh.attributes[i].values,
               std::size_t{attributes_[i].components} * known_.vertices);
        extend(attributes_[i].moved, mesh.moved_values[i],
               std::size_t{attributes_[i].components} * known_.moves);
    }
}

void LiveBuffers::store_corner(std::uint32_t corner) {
    corners_.pop_back();
    for (unsigned i = 0; i < corner_bytes_; ++i) corners_.push_back(std::uint8_t(corner >> 8 * i));
    corners_.push_back(0);
    Checkpoint& checkpoint = checkpoints_.back();
    checkpoint.first_corner = std::min(checkpoint.first_corner, corner);
    checkpoint.last_corner = std::max(checkpoint.last_corner, corner);
}

void LiveBuffers::encode(const ProgressiveMesh& mesh, std::size_t index) {
    const Split& split = mesh.splits[index];
    const Special counts{split.vertices_end - known_.vertices, split.triangles_end - known_.triangles,
                         split.corners_end - known_.corners, split.moves_end - known_.moves};
    const bool common =
        counts.vertices == 1 && counts.triangles <= kTriangleBits && counts.corners <= kCornerBits &&
        (counts.moves == 0 ||
         (counts.moves == 1 && mesh.moves[known_.moves].vertex == mesh.parents[known_.vertices]));
    for (std::uint32_t i = known_.corners; i < split.corners_end; ++i) {
        store_corner(mesh.corner_changes[i].corner);
        if (!common) special_corners_.push_back(mesh.corner_changes[i].vertex);
    }
    if (common) {
        codes_.push_back(std::uint8_t(counts.corners | counts.triangles << kTriangleShift |
                                      (counts.moves != 0 ? kMoveBit : 0)));
    } else {
        codes_.push_back(kSpecialBit);
        specials_.push_back(counts);
        for (std::uint32_t i = known_.moves; i < split.moves_end; ++i)
            special_moves_.push_back(mesh.moves[i].vertex);
    }
    if (errors_.empty() || errors_.back().error != split.error)
        errors_.push_back({std::uint32_t(index), split.error});
    pass(known_, index);
    if ((index + 1) % kInterval == 0) checkpoints_.push_back({known_, ~0u, 0});
}

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
    std::size_t sum = sizeof(*this) + bytes(positions_) + bytes(triangles_) + bytes(weights_) +
                      bytes(attributes_) + bytes(groups_) + bytes(parents_) + bytes(codes_) +
                      bytes(corners_) + bytes(moved_positions_) + bytes(moved_weights_) + bytes(specials_) +
                      bytes(special_corners_) + bytes(special_moves_) + bytes(checkpoints_) + bytes(errors_) +
                      vertex_runs_.memory() + triangle_runs_.memory();
    for (const Values& values : attributes_) sum += bytes(values.alive) + bytes(values.moved);
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

/// Corners of the splits from level_ to `level`. Writing a fixed number of corners saves guessing a branch:
/// those too many belong to the splits that follow, which set them right.
template <unsigned kBytes>
void LiveBuffers::patch(std::size_t level, const Ends& to) {
    if (now_.corners == to.corners) return;
    std::uint32_t* const out = triangles_.data()->data();
    const std::uint8_t* change = corners_.data() + std::size_t{kBytes} * now_.corners;
    const std::uint8_t* const end = corners_.data() + std::size_t{kBytes} * to.corners;
    const std::uint32_t* special_corner = special_corners_.data() + now_.special_corners;
    const Special* special = specials_.data() + now_.specials;
    std::uint32_t vertex = now_.vertices;
    for (std::size_t i = level_; i < level; ++i) {
        const unsigned code = codes_[i];
        if ((code & kSpecialBit) != 0) {
            for (std::uint32_t k = 0; k < special->corners; ++k, change += kBytes)
                out[load<kBytes>(change)] = *special_corner++;
            vertex += special++->vertices;
            continue;
        }
        const std::size_t count = code & kCornerBits;
        if (std::size_t(end - change) >= kBytes * (kAhead + kFetched))
            for (std::size_t k = kAhead; k < kAhead + kFetched; ++k)
                prefetch(out + load<kBytes>(change + kBytes * k));
        if (std::size_t(end - change) >= kBytes * kAlways) {
            std::array<std::uint32_t, kAlways> corners;
            for (std::size_t k = 0; k < kAlways; ++k) corners[k] = load<kBytes>(change + kBytes * k);
            for (const std::uint32_t corner : corners) out[corner] = vertex;
            for (std::size_t k = kAlways; k < count; ++k) out[load<kBytes>(change + kBytes * k)] = vertex;
        } else {
            for (std::size_t k = 0; k < count; ++k) out[load<kBytes>(change + kBytes * k)] = vertex;
        }
        change += kBytes * count;
        ++vertex;
    }
}

/// The same backward, from level_ down to `level`.
template <unsigned kBytes>
void LiveBuffers::unpatch(std::size_t level, const Ends& to) {
    if (now_.corners == to.corners) return;
    std::uint32_t* const out = triangles_.data()->data();
    const std::uint8_t* change = corners_.data() + std::size_t{kBytes} * now_.corners;
    const std::uint8_t* const end = corners_.data() + std::size_t{kBytes} * to.corners;
    const std::uint32_t* special_corner = special_corners_.data() + now_.special_corners;
    const Special* special = specials_.data() + now_.specials;
    const std::uint32_t* parent = parents_.data() + now_.vertices;
    for (std::size_t i = level_; i-- > level;) {
        const unsigned code = codes_[i];
        if ((code & kSpecialBit) != 0) {
            --special;
            for (std::uint32_t k = 0; k < special->corners; ++k)
                out[load<kBytes>(change -= kBytes)] = parents_[*--special_corner];
            parent -= special->vertices;
            continue;
        }
        const std::size_t count = code & kCornerBits;
        const std::uint32_t old = *--parent;
        if (std::size_t(change - end) >= kBytes * (kAhead + kFetched))
            for (std::size_t k = kAhead; k < kAhead + kFetched; ++k)
                prefetch(out + load<kBytes>(change - kBytes * (k + 1)));
        if (std::size_t(change - end) >= kBytes * kAlways) {
            std::array<std::uint32_t, kAlways> corners;
            for (std::size_t k = 0; k < kAlways; ++k) corners[k] = load<kBytes>(change - kBytes * (k + 1));
            for (const std::uint32_t corner : corners) out[corner] = old;
            for (std::size_t k = kAlways; k < count; ++k) out[load<kBytes>(change - kBytes * (k + 1))] = old;
        } else {
            for (std::size_t k = 0; k < count; ++k) out[load<kBytes>(change - kBytes * (k + 1))] = old;
        }
        change -= kBytes * count;
    }
}

/// Exchanges the values of moves with those of their vertices, in order from `first_move` on, or backward.
template <bool kForward>
void LiveBuffers::exchange(std::span<const std::uint32_t> vertices, std::size_t first_move) {
    static_assert(sizeof(Float3) == 3 * sizeof(float));
    if (vertices.empty()) return;
    swap_values<kForward, 3>(vertices, &positions_.data()->x, &moved_positions_[first_move].x, 3);
    if (!weights_.empty())
        swap_values<kForward, 1>(vertices, weights_.data(), moved_weights_.data() + first_move, 1);
    for (Values& values : attributes_)
        swap_any<kForward>(vertices, values.alive.data(),
                           values.moved.data() + values.components * first_move, values.components);
    for (const std::uint32_t vertex : vertices) {
        dirty_.vertices_begin = std::min(dirty_.vertices_begin, vertex);
        dirty_.vertices_end = std::max(dirty_.vertices_end, vertex + 1);
    }
    if (tracking_)
        for (const std::uint32_t vertex : vertices) vertex_runs_.mark(vertex);
}

/// Moves of the splits between level_ and `level`, in order or backward: their vertices are listed first, so
/// that what they hold is fetched ahead.
template <bool kForward>
void LiveBuffers::move(std::size_t level, const Ends& to) {
    if (now_.moves == to.moves) return;
    std::array<std::uint32_t, kChunk> list;
    std::size_t listed = 0;
    std::size_t first = kForward ? now_.moves : now_.moves - 1;
    const auto add = [&](std::uint32_t vertex) {
        list[listed++] = vertex;
        if (listed < kChunk) return;
        exchange<kForward>(list, first);
        first = kForward ? first + listed : first - listed;
        listed = 0;
    };
    const Special* special = specials_.data() + now_.specials;
    const std::uint32_t* special_move = special_moves_.data() + now_.special_moves;
    const std::uint32_t* parent = parents_.data() + now_.vertices;
    for (std::size_t i = level_; i != level;) {
        const unsigned code = codes_[kForward ? i++ : --i];
        if ((code & kSpecialBit) != 0) {
            if (!kForward) --special;
            for (std::uint32_t k = 0; k < special->moves; ++k)
                add(kForward ? *special_move++ : *--special_move);
            parent = kForward ? parent + special->vertices : parent - special->vertices;
            if (kForward) ++special;
            continue;
        }
        if (!kForward) --parent;
        if ((code & kMoveBit) != 0) add(*parent);
        if (kForward) ++parent;
    }
    exchange<kForward>(std::span(list).first(listed), first);
}

void LiveBuffers::refine(std::size_t splits) {
    const std::size_t level = level_ + std::min(splits, available() - level_);
    if (level == level_) return;
    const Ends to = at(level);
    corner_bytes_ == 3 ? patch<3>(level, to) : patch<4>(level, to);
    move<true>(level, to);
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
    move<false>(level, to);
    corner_bytes_ == 3 ? unpatch<3>(level, to) : unpatch<4>(level, to);
    mark_triangles(level, to, level_, now_);
    level_ = level;
    now_ = to;
}

void LiveBuffers::jump(std::size_t level) {
    level = std::min(level, available());
    level > level_ ? refine(level - level_) : coarsen(level_ - level);
}

}  // namespace vsplit
