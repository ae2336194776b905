// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// LiveBuffers: taking splits.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "../bytes/large_pages.hpp"
#include "extend.hpp"
#include "live_codes.hpp"
#include "prefetch.hpp"
#include "vsplit/live_buffers.hpp"

namespace vsplit {
namespace {

constexpr std::int32_t kMostShort = 32767;
constexpr std::size_t kMovesAhead = 16;
constexpr std::uint32_t kMostListed = 16384;  // moves, before each of their arrays is gone through

}  // namespace

void LiveBuffers::begin(const ProgressiveMesh& mesh, std::uint32_t vertices, std::uint32_t triangles,
                        std::uint32_t splits, std::uint32_t corner_changes, std::uint32_t moves,
                        const PlaceGrid& grid) {
    const bool tracks = tracks_;
    *this = LiveBuffers();
    tracks_ = tracking_ = tracks;
    if (tracking_) vertex_runs_.resize(vertices), triangle_runs_.resize(triangles);
    grid_ = grid;
    packed_ = grid.step > 0 && std::isfinite(1 / grid.step) && std::isfinite(grid.origin[0]) &&
              std::isfinite(grid.origin[1]) && std::isfinite(grid.origin[2]);
    totals_ = {vertices, triangles, corner_changes, moves, 0, 0, 0};
    total_splits_ = splits;
    corner_bytes_ = std::uint64_t{3} * triangles <= 0x1000000 ? 3 : 4;
    reserve_large(positions_, vertices);
    reserve_large(triangles_, triangles);
    if (!mesh.weights.empty()) reserve_large(weights_, vertices), reserve_large(moved_weights_, moves);
    for (const Attribute& attribute : mesh.attributes) {
        Values& values = attributes_.emplace_back();
        values.components = attribute.components;
        reserve_large(values.alive, std::size_t{attribute.components} * vertices);
        reserve_large(values.moved, std::size_t{attribute.components} * moves);
    }
    if (!mesh.groups.empty()) reserve_large(groups_, triangles);
    reserve_large(parents_, vertices);
    reserve_large(codes_, splits);
    reserve_large(corners_, std::size_t{corner_bytes_} * corner_changes + 1);
    corners_.push_back(0);
    packed_ ? reserve_large(steps_, moves) : reserve_large(moved_positions_, moves);
    moving_.resize(std::min(moves, kMostListed));
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
    for (std::size_t i = 0; i < attributes_.size(); ++i)
        extend(attributes_[i].alive, mesh.attributes[i].values,
               std::size_t{attributes_[i].components} * known_.vertices);
    append_moves(mesh);
}

namespace {

constexpr std::uint32_t kNever = ~0u;

/// Where the values are that each move from `begin` on replaces: the move before of its vertex, or kNever: at
/// birth. `last` is the last one of each vertex.
std::vector<std::uint32_t> moves_before(const ProgressiveMesh& mesh, std::size_t begin, std::size_t end,
                                        std::vector<std::uint32_t>& last) {
    std::vector<std::uint32_t> before;
    before.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
        prefetch(&last[mesh.moves[std::min(i + kMovesAhead, end - 1)].vertex]);
        before.push_back(std::exchange(last[mesh.moves[i].vertex], std::uint32_t(i)));
    }
    return before;
}

std::uint32_t flip(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) ^ std::bit_cast<std::uint32_t>(b);
}

bool same_bits(const Float3& a, const Float3& b) {
    return (flip(a.x, b.x) | flip(a.y, b.y) | flip(a.z, b.z)) == 0;
}

/// The grid's points. A place is on it only bit by bit.
class OnGrid {
  public:
    explicit OnGrid(const PlaceGrid& grid) : grid_(grid), inverse_(1 / grid.step) {}

    /// The point nearest to a place, which must be on the grid.
    std::array<std::int32_t, 3> point(const Float3& place) const {
        return {grid_point(grid_.origin[0], inverse_, place.x),
                grid_point(grid_.origin[1], inverse_, place.y),
                grid_point(grid_.origin[2], inverse_, place.z)};
    }
    bool has(const Float3& place) const {
        const double far = std::max({std::abs(double(place.x) - grid_.origin[0]),
                                     std::abs(double(place.y) - grid_.origin[1]),
                                     std::abs(double(place.z) - grid_.origin[2])});
        return far * inverse_ < kGridReach && same_bits(grid_place(grid_, point(place)), place);
    }

  private:
    PlaceGrid grid_;
    double inverse_;
};

}  // namespace

/// What is exchanged by the moves that are new: kept as differences, which go both ways and in any order.
void LiveBuffers::append_moves(const ProgressiveMesh& mesh) {
    if (last_moves_.empty()) reserve_large(last_moves_, totals_.vertices);
    last_moves_.resize(known_.vertices, kNever);
    const std::size_t begin = moves_stored_, end = known_.moves;
    moves_stored_ = end;
    std::vector<std::uint32_t> before = moves_before(mesh, begin, end, last_moves_);
    const auto each = [&](std::size_t from, auto&& store) {
        for (std::size_t i = from; i < end; ++i) store(i, before[i - from]);
    };
    // What is replaced lies anywhere: fetched ahead.
    const auto fetch = [&](std::size_t i) {
        if (i >= end) return;
        const std::uint32_t was = before[i - begin], vertex = mesh.moves[i].vertex;
        prefetch(was == kNever ? &mesh.positions[vertex].x : &mesh.moves[was].position.x, 3);
    };
    const auto place_before = [&](std::size_t i, std::uint32_t was) {
        return was == kNever ? mesh.positions[mesh.moves[i].vertex] : mesh.moves[was].position;
    };
    if (!mesh.weights.empty())
        each(begin, [&](std::size_t i, std::uint32_t was) {
            const VertexMove& move = mesh.moves[i];
            moved_weights_.push_back(
                flip(was == kNever ? mesh.weights[move.vertex] : mesh.moves[was].weight, move.weight));
        });
    for (std::size_t a = 0; a < attributes_.size(); ++a) {
        const std::size_t n = attributes_[a].components;
        const std::vector<float>&born = mesh.attributes[a].values, &moved = mesh.moved_values[a];
        attributes_[a].moved.resize(n * end);
        std::uint32_t* const out = attributes_[a].moved.data();
        const auto replaced = [&](std::size_t i, std::uint32_t was) {
            return was == kNever ? &born[n * mesh.moves[i].vertex] : &moved[n * std::size_t{was}];
        };
        each(begin, [&](std::size_t i, std::uint32_t was) {
            const std::size_t later = std::min(i + kMovesAhead, end - 1);
            prefetch(replaced(later, before[later - begin]), n);
            const float* const old = replaced(i, was);
            for (std::size_t k = 0; k < n; ++k) out[n * i + k] = flip(old[k], moved[n * i + k]);
        });
    }
    if (packed_) {
        const OnGrid grid(grid_);
        steps_.resize(end);
        for (std::size_t i = begin; i < end && packed_; ++i) {
            fetch(i + kMovesAhead);
            const std::uint32_t was = before[i - begin];
            const Float3 from = place_before(i, was), to = mesh.moves[i].position;
            // Where an earlier move led was looked at then.
            packed_ = grid.has(to) && (was != kNever || grid.has(from));
            if (!packed_) break;
            const std::array<std::int32_t, 3> a = grid.point(from), b = grid.point(to);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const std::int32_t by = b[axis] - a[axis];
                packed_ = packed_ && by >= -kMostShort && by <= kMostShort;
                steps_[i][axis] = std::int16_t(by);
            }
        }
    }
    if (!packed_) {
        std::size_t from = begin;
        if (!steps_.empty()) {
            // One that is not on the grid, or too far for it: all are kept as they are, from the first on.
            steps_ = std::vector<std::array<std::int16_t, 3>>();
            reserve_large(moved_positions_, totals_.moves);
            std::vector<std::uint32_t> last(known_.vertices, kNever);
            from = 0;
            before = moves_before(mesh, 0, end, last);
        }
        each(from, [&](std::size_t i, std::uint32_t was) {
            const Float3 a = place_before(i, was), b = mesh.moves[i].position;
            moved_positions_.push_back({flip(a.x, b.x), flip(a.y, b.y), flip(a.z, b.z)});
        });
    }
    if (available() == total_splits_) last_moves_ = std::vector<std::uint32_t>();  // {} would keep the memory
}

void LiveBuffers::store_corner(std::uint32_t corner) {
    const std::size_t at = corners_.size() - 1;
    corners_.resize(at + corner_bytes_ + 1);
    for (unsigned i = 0; i < corner_bytes_; ++i) corners_[at + i] = std::uint8_t(corner >> 8 * i);
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

}  // namespace vsplit
