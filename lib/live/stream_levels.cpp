// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Stream: which level a target is, which blocks hold it, and the same for selective refinement.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "stream_state.hpp"

namespace vsplit {

// ---- Levels

/// How many blocks hold the target's level.
std::size_t Stream::State::blocks_for_target() const {
    if (selective) return blocks_for_selective();
    return blocks_for_uniform();
}

std::size_t Stream::State::blocks_for_uniform() const {
    return std::min(blocks_for_kind(), blocks_for_triangles(target.max_triangles));
}

std::size_t Stream::State::blocks_for_triangles(std::uint64_t count) const {
    return blocks_until([&](const BlockInfo& b) { return b.triangles_end > count; });
}

std::size_t Stream::State::blocks_for_kind() const {
    switch (target.kind) {
        case Target::Kind::kRatio:
            return blocks_for_triangles(triangles_of_ratio());
        case Target::Kind::kTriangles:
            return blocks_for_triangles(clamped_count(target.value));
        case Target::Kind::kVertices:
            return blocks_until(
                [&](const BlockInfo& b) { return b.vertices_end > clamped_count(target.value); });
        case Target::Kind::kError:
        case Target::Kind::kPixels:
            if (double(info->base_error) <= target.value) return 0;
            return blocks_until([&](const BlockInfo& b) { return double(b.error) <= target.value; });
    }
    return info->blocks.size();
}

std::size_t Stream::State::level_for_target() const {
    return std::min(level_for_kind(), live.level_for_triangles(target.max_triangles));
}

std::size_t Stream::State::level_for_kind() const {
    // Within what is decoded, error() of the last level is that of the table.
    const auto coarsest = [&](double most) {
        return double(error_after(decoded)) > most ? live.available() : live.level_for_error(most);
    };
    switch (target.kind) {
        case Target::Kind::kRatio:
            return live.level_for_triangles(triangles_of_ratio());
        case Target::Kind::kTriangles:
            return live.level_for_triangles(clamped_count(target.value));
        case Target::Kind::kVertices:
            return live.level_for_vertices(clamped_count(target.value));
        case Target::Kind::kError:
            return coarsest(target.value);
        case Target::Kind::kPixels: {
            const std::size_t least = coarsest(target.value);
            const std::size_t most = coarsest(target.value / (1 + std::max(0.0, options.hysteresis)));
            return std::clamp(live.level(), least, std::max(least, most));
        }
    }
    return live.available();
}

// ---- Selective refinement

/// A later split can only be wanted if its error times the largest priority is more than what is not worth
/// it.
std::size_t Stream::State::blocks_for_selective() const {
    const double largest = double(selective->largest_priority());
    const auto until_error = [&](double most) {
        if (double(info->base_error) * largest <= most) return std::size_t{0};
        return blocks_until([&](const BlockInfo& b) { return double(b.error) * largest <= most; });
    };
    if (view) {
        // Where no error is allowed, splits without any are wanted, too.
        const double most = error_of_view(*view, info->bounds_min, info->bounds_max);
        return most > 0 ? until_error(most) : info->blocks.size();
    }
    const bool by_error = target.kind == Target::Kind::kError || target.kind == Target::Kind::kPixels;
    const std::size_t most = by_error ? until_error(target.value) : info->blocks.size();
    if (by_error && target.max_triangles >= info->triangles) return most;
    // A count: as many as the uniform level has, and then those that may be worth more than the last ones.
    const std::size_t uniform = blocks_for_uniform(), rank = rank_for_target();
    if (rank >= selective->ranked()) return std::min(most, std::max(uniform, decoded + 1));
    return std::min(most, std::max(uniform, until_error(double(selective->error_at_rank(rank)))));
}

std::size_t Stream::State::rank_for_target() const {
    return std::min(rank_for_kind(), selective->rank_for_triangles(target.max_triangles));
}

std::size_t Stream::State::rank_for_kind() const {
    switch (target.kind) {
        case Target::Kind::kRatio:
            return selective->rank_for_triangles(triangles_of_ratio());
        case Target::Kind::kTriangles:
            return selective->rank_for_triangles(clamped_count(target.value));
        case Target::Kind::kVertices:
            return selective->rank_for_vertices(clamped_count(target.value));
        case Target::Kind::kError:
            return selective->rank_for_error(target.value);
        case Target::Kind::kPixels: {
            const std::size_t least = selective->rank_for_error(target.value);
            const std::size_t most =
                selective->rank_for_error(target.value / (1 + std::max(0.0, options.hysteresis)));
            return std::clamp(selective->active_splits(), least, std::max(least, most));
        }
    }
    return selective->ranked();
}

/// Takes what is decoded.
Status Stream::State::begin_selective() {
    ProgressiveMesh record = live.record();
    for (std::size_t i = 0; i < record.attributes.size(); ++i) {
        record.attributes[i].name = info->attributes[i].name;
        record.attributes[i].semantic = info->attributes[i].semantic;
    }
    record.origin = info->origin;
    auto made = ViewMesh::make(std::move(record), {info->vertices, info->triangles, info->splits,
                                                   info->corner_changes, info->moves});
    selective_wanted = made.ok();
    if (!made) return fail(made.error(), false);
    selective = *std::move(made);
    return Ok{};
}

bool Stream::State::update_selective(const Budget& budget, Updated& out) {
    const ViewBudget within{budget.max_splits, budget.max_visits, budget.out_of_time};
    ViewUpdated done;
    if (view) {
        done = selective->update(*view, within);
    } else {
        // Ordering anew for each block would take longer than decoding: an eighth more, or the last ones.
        const std::size_t known = selective->available(), ranked = selective->ranked();
        if (known > ranked && (known - ranked > ranked / 8 || decoded >= blocks_for_target()))
            selective->rank();
        done = selective->refine_to(rank_for_target(), within);
        done.settled = done.settled && selective->ranked() == known;
    }
    out.splits = done.refined + done.coarsened;
    return done.settled;
}

Status Stream::set_selective(bool on) {
    State& s = *state_;
    s.selective_wanted = on;
    if (!on) s.selective.reset();
    return on && !s.selective && ready() ? s.begin_selective() : Ok{};
}

const ViewMesh* Stream::selective() const {
    return state_->selective ? &*state_->selective : nullptr;
}
ViewMesh* Stream::selective() {
    return state_->selective ? &*state_->selective : nullptr;
}

void Stream::set_view(const CameraView& view) {
    state_->view = object_view(view, state_->planes);
}
void Stream::clear_view() {
    state_->view.reset();
}

}  // namespace vsplit
