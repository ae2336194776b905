// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What a collapse does: who stays, what it becomes, and what the edges around cost now.
#include <algorithm>
#include <cstring>

#include "region.hpp"
#include "wedge_cost.hpp"

namespace vsplit::bake {

std::uint32_t Region::parent_of(const EdgeStar& star, const Option& option) const {
    if (option.fold == Fold::kIntoFirst) return star.u;
    if (option.fold == Fold::kIntoSecond) return star.v;
    // In a batch, the end whose place is kept is the parent: no vertex moves.
    if (!state_.batch_of.empty()) return nearer_end(star, option.candidate.place);
    // A curve's vertex stays; else the one with the larger star, since the other's corners change.
    if (mesh_.kind(star.u) != mesh_.kind(star.v))
        return mesh_.kind(star.v) == VertexKind::kCurve ? star.v : star.u;
    return mesh_.star(star.v).size() > mesh_.star(star.u).size() ? star.v : star.u;
}

void Region::fold_wedges(const EdgeStar& star, Double3 place) {
    wedge_record_.add(wedge_star_, *state_.wedges);
    // All are mixed from what was there before any changes.
    const std::size_t stride = state_.wedges->stride();
    thread_local std::vector<float> mixed;
    mixed.resize(stride * wedge_star_.pairs.size());
    for (std::size_t i = 0; i < wedge_star_.pairs.size(); ++i)
        mix_at(mesh_, star, wedge_star_, wedge_star_.pairs[i], *state_.wedges, place,
               std::span(mixed).subspan(stride * i, stride));
    for (std::size_t i = 0; i < wedge_star_.pairs.size(); ++i)
        join_samples(mesh_, star, wedge_star_.pairs[i], *state_.wedges, place,
                     std::span(mixed).subspan(stride * i, stride));
    // Wedges of a point that moved together still do, whatever was mixed on each side of a seam: or it would
    // open in a pose. The first pair says how.
    WedgeValues& values = *state_.wedges;
    thread_local std::vector<std::uint32_t> alike;
    alike_in_motion(wedge_star_, values, alike);
    for (std::size_t i = 0; i < wedge_star_.pairs.size(); ++i) {
        const auto from = std::span(mixed).subspan(stride * i, stride);
        std::copy(from.begin(), from.end(), state_.wedges->of(wedge_star_.pairs[i].parent).begin());
    }
    for (const std::uint32_t wedge : alike)
        values.copy_motion(values.of(wedge_star_.pairs[0].parent), values.of(wedge));
    // Wedges without a partner keep their other attributes and move all the same.
    if (state_.wedges->most_poses() > 0)
        for (const auto* list : {&wedge_star_.moved, &wedge_star_.transferred})
            for (const std::uint32_t wedge : *list)
                state_.wedges->repose(wedge, mesh_.round(place), state_.wedges->of(wedge));
}

void Region::apply(const EdgeStar& star, const Option& option, std::uint32_t parent, Float3 place,
                   const Deviation& deviation, bool relaxed) {
    const std::uint32_t child = star.u + star.v - parent;
    if (mesh_.has_wedges()) fold_wedges(star, mesh_.work(place));
    if (!state_.batch_of.empty()) {
        for (const std::uint32_t t : mesh_.star(child))
            for (const std::uint32_t w : mesh_.triangle(t)) state_.batch_of[w] = state_.batch;
    }
    const bool onto_curve = mesh_.kind(child) == VertexKind::kCurve;
    const TrianglePart<double> part = update_ring(mesh_, star);
    const std::size_t before = record_.removed.size();
    const Float3 parent_position = mesh_.raw_position(parent);
    const float parent_weight = state_.weights.empty() ? 1 : state_.weights[parent];
    const std::span<const WedgePair> pairs =
        mesh_.has_wedges() ? wedge_star_.pairs : std::span<const WedgePair>{};
    const std::size_t taken = mesh_.fold(child, parent, pairs, record_.corners_changed, record_.removed,
                                         wedge_record_.corner_wedges);
    room_ -= std::min(room_, taken);
    if (mesh_.has_wedges()) wedge_record_.close();
    const bool moved =
        std::memcmp(&place, &parent_position, sizeof(Float3)) != 0 ||
        (!state_.weights.empty() && 0.5f * (parent_weight + state_.weights[child]) != parent_weight);
    record_.add(child, parent, parent_position, parent_weight, moved, float(deviation.largest));
    ++lost_vertices_;
    lose_of(state_.components.of(parent), std::uint32_t(record_.removed.size() - before));
    mesh_.set_raw_position(parent, place);

    VertexHistory& history = state_.histories[parent];
    for (std::size_t i = 0; i < 3; ++i) history.normal[i] += state_.histories[child].normal[i];
    history.deviation = deviation.at_place;
    history.witness = deviation.witness;
    Vertex& shape = mesh_.vertex(parent);
    const Vertex& gone = mesh_.vertex(child);
    // In a batch, the parent may be the inner one of the two: it is on the curve from now on.
    if (onto_curve && shape.kind == VertexKind::kInner) shape.kind = VertexKind::kCurve;
    shape.folded |= gone.folded;
    shape.seam |= gone.seam;
    shape.open |= gone.open;
    shape.junction |= gone.junction;
    shape.weight = 0.5f * (shape.weight + mesh_.vertex(child).weight);
    if (!state_.weights.empty())
        state_.weights[parent] = 0.5f * (state_.weights[parent] + state_.weights[child]);
    if (state_.paper) state_.paper->merge(parent, child);
    if (relaxed) classify_around(star);
    if (mesh_.kind(parent) == VertexKind::kInner)
        set_part(shape, part);
    else
        rebuild_shape(mesh_, parent, state_.options.boundary_weight, ring_);

    ring_edges_.clear();
    visit_neighbours(mesh_, parent, ring_, [&](std::uint32_t w) { ring_edges_.add(w, Fold::kNever); });
    for (const std::uint32_t w : ring_edges_.others)
        if ((relaxed || mesh_.kind(w) != VertexKind::kInner) && mesh_.star(w).size() <= kHub)
            rebuild_shape(mesh_, w, state_.options.boundary_weight, ring_);
    queue_.remove(child);
    reprice(parent, child, bucket_of(float(option.candidate.cost)));
}

void Region::classify_around(const EdgeStar& star) {
    const auto again = [&](std::uint32_t v) {
        if (mesh_.kind(v) == VertexKind::kDead || state_.locked[v]) return;
        mesh_.classify(v, classify_scratch_);
        if (mesh_.kind(v) != VertexKind::kDead) return;
        // It had no triangles but those that went.
        ++lost_vertices_;
        queue_.remove(v);
    };
    again(star.u);
    again(star.v);
    for (std::size_t i = 0; i < star.size; ++i) {
        again(star.a[i]);
        again(star.b[i]);
    }
    for (const std::uint32_t w : star.opposite) again(w);
}

void Region::reprice(std::uint32_t parent, std::uint32_t child, Bucket now) {
    for (std::size_t i = 0; i < ring_edges_.others.size(); ++i)
        ring_edges_.folds[i] = fold_of(parent, ring_edges_.others[i]);
    price(parent, ring_edges_);
    Target best;
    for (std::size_t i = 0; i < ring_edges_.others.size(); ++i) {
        const std::uint32_t w = ring_edges_.others[i];
        const float cost = ring_edges_.costs[i];
        Target& other = state_.targets[w];
        if (owns(parent, w)) best.offer(w, cost);
        if (!queue_.contains(w)) {
            // What stopped it may be gone.
            other.vertex = kNoVertex;
            queue_.push(w, now);
            continue;
        }
        const bool gone = other.vertex == parent || other.vertex == child;
        if (gone) other = {kNoVertex, other.runner_up, other.runner_up};
        if (owns(w, parent)) other.offer(parent, cost);
        if (gone || other.vertex == parent)
            queue_.push(w, other.cost < kNeverCost ? bucket_of(other.cost) : now);
    }
    state_.targets[parent] = best;
    if (best.vertex != kNoVertex)
        queue_.push(parent, bucket_of(best.cost));
    else
        queue_.remove(parent);
}

}  // namespace vsplit::bake
