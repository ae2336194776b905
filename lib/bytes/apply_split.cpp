// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What a split does to the live mesh; those of a fan are in plain_split.cpp.
#include <algorithm>

#include "split_codec.hpp"

namespace vsplit {

void SplitCodec::count_locked(std::uint32_t first) {
    touched_.clear();
    for (std::uint32_t v = first; v < live.vertex_count(); ++v) {
        live.gather_corners(v, scratch_);
        for (const std::uint32_t corner : scratch_) touched_.push_back(corner / 3);
    }
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    for (const std::uint32_t t : touched_)
        for (const std::uint32_t v : live.triangles[t]) ++live.vertices[v].locked;
}

void SplitCodec::apply(const SplitPlan& plan) {
    if (is_plain_) return apply_plain(plan);
    const std::size_t stride = shape_.stride();
    const std::uint32_t first = live.vertex_count();
    // Triangles whose places change: all around a vertex that moves, else those that are taken.
    touched_.clear();
    const auto touch_star = [&](std::uint32_t v) {
        live.gather_corners(v, scratch_);
        for (const std::uint32_t corner : scratch_) touched_.push_back(corner / 3);
    };
    for (const SplitPlan::Move& move : plan.moves)
        if (live.vertices[move.vertex].at != move.at) touch_star(move.vertex);
    const bool single = touched_.empty();
    for (const std::uint32_t corner : plan.taken) touched_.push_back(corner / 3);
    if (!single || plan.births.size() > 1) {
        std::sort(touched_.begin(), touched_.end());
        touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    }
    for (const std::uint32_t t : touched_) live.weigh(t, -1);

    for (std::size_t i = 0; i < plan.moves.size(); ++i) {
        const SplitPlan::Move& move = plan.moves[i];
        live.vertices[move.vertex].at = move.at;
        if (shape_.lossless) finer[move.vertex] = move.finer;
        std::copy_n(plan.move_values.begin() + static_cast<std::ptrdiff_t>(i * stride), stride,
                    values.begin() + static_cast<std::ptrdiff_t>(move.vertex * stride));
        touch(move.vertex).acted = sweep_;
    }
    values.insert(values.end(), plan.birth_values.begin(), plan.birth_values.end());
    for (const SplitPlan::Birth& birth : plan.births) {
        live.add_vertex(birth.at);
        order_.add(birth.parent);
        if (shape_.lossless) finer.push_back(birth.finer);
    }
    const auto touch_ring = [&](std::uint32_t v) {
        touch(v).acted = sweep_;
        for (const std::uint32_t corner : scratch_)
            for (const std::uint32_t w : live.triangles[corner / 3]) touch(w);
    };
    std::uint32_t begin = 0;
    for (std::uint32_t i = 0; i < plan.births.size(); ++i) {
        const SplitPlan::Birth& birth = plan.births[i];
        const auto taken = std::span(plan.taken).subspan(begin, birth.taken_end - begin);
        begin = birth.taken_end;
        touch(first + i).acted = sweep_;
        if (birth.parent == kNoVertex) continue;
        live.gather_corners(birth.parent, scratch_);
        touch_ring(birth.parent);
        // The neighbours see another vertex in the triangles that go over.
        for (const std::uint32_t corner : taken)
            for (const std::uint32_t w : live.triangles[corner / 3]) live.forget(w);
        for (const std::uint32_t corner : taken) live.hand_over(corner, first + i);
        std::erase_if(scratch_, [&](std::uint32_t corner) {
            return live.triangles[corner / 3][corner % 3] == first + i;
        });
        live.relink(birth.parent, scratch_);
        live.relink(first + i, taken);
    }
    for (const SplitPlan::Move& move : plan.moves) {
        live.gather_corners(move.vertex, scratch_);
        touch_ring(move.vertex);
    }
    for (const std::uint32_t t : touched_) live.weigh(t, 1);
    for (std::size_t i = 0; i < plan.triangles.size(); ++i) {
        live.add_triangle(plan.triangles[i]);
        if (shape_.group_bits > 0) groups.push_back(plan.groups[i]);
        for (const std::uint32_t v : plan.triangles[i]) touch(v);
    }
    if (is_batch()) count_locked(first);
    live.link_twins(first);
}

}  // namespace vsplit
