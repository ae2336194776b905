// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Splits of a fan, as nearly all are: the child takes a run of its parent's fan, and nothing happens but what
// that implies.
#include <algorithm>

#include "split_codec.hpp"

namespace vsplit {
namespace {

/// Ascending. Runs are short as a rule, and a comparison's outcome is news: no branches up to four.
void sort_few(std::span<std::uint32_t> row) {
    const auto pair = [&](std::size_t i, std::size_t j) {
        const std::uint32_t low = std::min(row[i], row[j]), high = std::max(row[i], row[j]);
        row[i] = low;
        row[j] = high;
    };
    if (row.size() > 4) {
        std::sort(row.begin(), row.end());
    } else if (row.size() == 4) {
        pair(0, 1), pair(2, 3), pair(0, 2), pair(1, 3), pair(1, 2);
    } else if (row.size() == 3) {
        pair(0, 1), pair(1, 2), pair(0, 1);
    } else if (row.size() == 2) {
        pair(0, 1);
    }
}

}  // namespace

bool SplitCodec::find_cut(std::span<const std::uint32_t> taken, const SplitPlan& wanted, std::uint32_t child,
                          Cut& cut) const {
    const std::uint32_t n = star_.size, k = static_cast<std::uint32_t>(taken.size());
    std::uint32_t in = 0;
    for (std::uint32_t i = 0; i < n; ++i)
        for (const std::uint32_t corner : taken)
            if (corner == star_.corner[i]) in |= 1u << i;
    const auto has = [&](std::uint32_t i) { return (in >> i & 1) != 0; };
    const auto born = [&](const Triangle& triangle) {
        return std::any_of(wanted.triangles.begin(), wanted.triangles.end(),
                           [&](const Triangle& t) { return is_rotation(t, triangle); });
    };
    cut.length = k;
    cut.begin = 0;
    if (star_.closed) {
        if (k == 0 || k == n) return false;
        while (!(has(cut.begin) && !has((cut.begin + n - 1) % n))) ++cut.begin;
        for (std::uint32_t i = 0; i < k; ++i)
            if (!has((cut.begin + i) % n)) return false;
        cut.first_wing = cut.last_wing = true;
        return true;
    }
    const std::uint32_t p = star_.centre;
    if (k == 0) {
        cut.last_wing = born({child, star_.ring[0], p});
        cut.first_wing = !cut.last_wing && born({child, p, star_.ring[n]});
        if (cut.first_wing) cut.begin = n;
        return cut.last_wing || cut.first_wing;
    }
    while (!has(cut.begin)) ++cut.begin;
    for (std::uint32_t i = 0; i < k; ++i)
        if (!has(cut.begin + i)) return false;
    const bool first = born({child, p, star_.ring[cut.begin]}),
               last = born({child, star_.ring[cut.begin + k], p});
    cut.first_wing = cut.last_wing = true;
    if (last && !first && cut.begin == 0) cut.first_wing = false;
    if (first && !last && cut.begin + k == n) cut.last_wing = false;
    return true;
}

void SplitCodec::take_run(std::uint32_t child, SplitPlan& out) {
    const std::uint32_t n = star_.size, p = star_.centre, begin = run_.begin, end = begin + run_.length;
    const std::size_t before = out.taken.size();
    out.taken.insert(out.taken.end(), star_.corner.data() + begin, star_.corner.data() + end);
    sort_few(std::span(out.taken).subspan(before));
    const auto group_of = [&](std::uint32_t i) { return groups.empty() ? 0u : groups[star_.corner[i] / 3]; };
    if (run_.last_wing) {
        implied_triangles_.push_back({child, star_.ring[end], p});
        implied_groups_.push_back(group_of(end > 0 ? end - 1 : 0));
    }
    if (run_.first_wing) {
        implied_triangles_.push_back({child, p, star_.ring[begin]});
        implied_groups_.push_back(group_of(begin < n ? begin : n - 1));
    }
    child_ring_.size = run_.length + 1;
    std::copy(star_.ring.data() + begin, star_.ring.data() + end + 1, child_ring_.vertex.data());
    child_ring_.open = !(run_.first_wing && run_.last_wing);
}

void SplitCodec::find_parent_ring() {
    const std::uint32_t n = star_.size, begin = run_.begin, end = begin + run_.length;
    parent_ring_.open = !star_.closed;
    const std::uint32_t* const ring = star_.ring.data();
    std::uint32_t* to = parent_ring_.vertex.data();
    if (star_.closed) {
        to = std::copy(ring + end, ring + begin + n + 1, to);
    } else {
        if (run_.last_wing) to = std::copy(ring + end, ring + n + 1, to);
        if (run_.first_wing) to = std::copy(ring, ring + begin + 1, to);
    }
    parent_ring_.size = static_cast<std::uint32_t>(to - parent_ring_.vertex.data());
}

bool SplitCodec::find_plain(std::uint32_t primary, const SplitPlan& wanted, Cut& cut,
                            std::vector<std::uint32_t>& sources) const {
    const std::uint32_t child = live.vertex_count();
    if (wanted.births.size() != 1 || wanted.moves.size() > 1 ||
        (wanted.moves.size() == 1 && wanted.moves[0].vertex != primary) ||
        !find_cut(wanted.taken, wanted, child, cut) ||
        wanted.triangles.size() != std::size_t{cut.first_wing} + std::size_t{cut.last_wing})
        return false;
    std::array<Triangle, 2> implied;
    std::size_t count = 0;
    if (cut.last_wing) implied[count++] = {child, star_.ring[cut.begin + cut.length], primary};
    if (cut.first_wing) implied[count++] = {child, primary, star_.ring[cut.begin]};
    sources.clear();
    for (std::size_t i = 0; i < count; ++i)
        for (std::uint32_t j = 0; j < wanted.triangles.size(); ++j)
            if (is_rotation(wanted.triangles[j], implied[i])) sources.push_back(j);
    if (sources.size() == count && (count < 2 || sources[0] != sources[1])) return true;
    sources.clear();
    return false;
}

template <class Coder>
const char* SplitCodec::code_plain(Coder& coder, std::uint32_t primary, const Cut& cut,
                                   const SplitPlan& wanted, SplitPlan& out) {
    is_run_ = true;
    if (!Coder::kWrites && !Coder::kDecodes)
        run_ = cut;
    else if (!cut_.code(coder, live, star_, is_batch() ? older_ : kNoVertex, cut, run_))
        return "a run has no place in its fan";
    SplitPlan::Birth& birth = out.births.emplace_back();
    birth.parent = primary;
    take_run(live.vertex_count(), out);
    birth.taken_end = static_cast<std::uint32_t>(out.taken.size());
    const bool moves = coder.bit(moved_[0], !wanted.moves.empty());
    code_birth_place(coder, wanted, 0, moves, out);
    if (moves) code_move(coder, wanted, 0, primary, true, out);
    code_implied(coder, wanted, out);
    if (!Coder::kDecodes) return nullptr;
    if (coder.overrun()) return "a block ends within a split";
    if (room.vertices == 0) return "a block bears more vertices than it announces";
    if (out.taken.size() > room.corners || out.triangles.size() > room.triangles ||
        out.moves.size() > room.moves)
        return "a split has more parts than its block announces";
    return nullptr;
}

void SplitCodec::apply_plain(const SplitPlan& plan) {
    const std::size_t stride = shape_.stride();
    const SplitPlan::Birth& birth = plan.births[0];
    const std::uint32_t p = birth.parent, child = live.vertex_count();
    Lattice3 parent_at = live.vertices[p].at;
    if (!plan.moves.empty()) {
        parent_at = plan.moves[0].at;
        if (shape_.lossless) finer[p] = plan.moves[0].finer;
        if (stride > 0)
            std::copy_n(plan.move_values.begin(), stride,
                        values.begin() + static_cast<std::ptrdiff_t>(p * stride));
    }
    live.split(star_, run_, parent_at, birth.at, sweep_);
    order_.add(p);
    if (stride > 0) values.insert(values.end(), plan.birth_values.begin(), plan.birth_values.end());
    if (shape_.lossless) finer.push_back(birth.finer);
    if (shape_.group_bits > 0) groups.insert(groups.end(), plan.groups.begin(), plan.groups.end());
    if (is_batch()) return;
    for (std::uint32_t i = 0; i < star_.ring_size(); ++i) ask_again(star_.ring[i]);
    ask_again(p);
    ask_again(child);
}

template const char* SplitCodec::code_plain(RangeDecoder&, std::uint32_t, const Cut&, const SplitPlan&,
                                            SplitPlan&);
#ifndef VSPLIT_READS_ONLY
template const char* SplitCodec::code_plain(RangeEncoder&, std::uint32_t, const Cut&, const SplitPlan&,
                                            SplitPlan&);
template const char* SplitCodec::code_plain(NoCoder&, std::uint32_t, const Cut&, const SplitPlan&,
                                            SplitPlan&);
#endif

}  // namespace vsplit
