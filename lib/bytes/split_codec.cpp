// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "split_codec.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "place_fit.hpp"

namespace vsplit {
void SplitPlan::clear() {
    births.clear();
    taken.clear();
    triangles.clear();
    groups.clear();
    sources.clear();
    moves.clear();
    birth_values.clear();
    move_values.clear();
}

SplitCodec::SplitCodec(const StreamShape& shape, const PlaceWeights& weights)
    : shape_(shape),
      place_(weights),
      error_bits_(std::bit_cast<std::uint32_t>(std::numeric_limits<float>::max())) {
    value_.resize(shape.stride());
    for (const std::uint32_t bits : shape.direction_bits)
        if (bits > 0) normal_.emplace_back(bits);
    predicted_.resize(shape.stride());
    scales_.resize(shape.stride());
}

std::uint64_t SplitCodec::model_bytes(const StreamShape& shape) {
    const auto directions = std::count_if(shape.direction_bits.begin(), shape.direction_bits.end(),
                                          [](auto bits) { return bits > 0; });
    return shape.stride() * sizeof(ValueModel) + static_cast<std::uint64_t>(directions) * sizeof(NormalModel);
}

// ---- Sweeps

template <class Coder>
const char* SplitCodec::code_head(Coder& coder, SweepHead& head) {
    const std::uint32_t kind = kinds_.code(coder, static_cast<std::uint32_t>(head.kind));
    if (kind > static_cast<std::uint32_t>(SweepKind::kBatchAll)) return "a sweep is of no known kind";
    head.kind = kind_ = static_cast<SweepKind>(kind);
    head.marked = marked_.code(coder, head.marked);
    head.unmarked = unmarked_.code(coder, head.unmarked);
    if (head.begins_block) {
        if (head.error_bits > error_bits_) return "a sweep's error grows";
        error_bits_ = head.error_bits;
    } else {
        // Within a block eight digits will do; rounded up.
        const auto steps = [](std::uint32_t bits) { return (bits + (1u << kErrorShift) - 1) >> kErrorShift; };
        const std::uint32_t before = steps(error_bits_),
                            fall = error_.code(coder, before - steps(head.error_bits));
        if (fall > before) return "a sweep's error is negative";
        head.error_bits = error_bits_ = std::min(error_bits_, (before - fall) << kErrorShift);
    }
    const std::uint32_t alive = live.vertex_count();
    if (head.marked == 0 && head.unmarked == 0) return "a sweep is empty";
    ++sweep_;
    cursor_ = 0;
    older_ = alive;
    sparse_ = is_sparse(head.marked, alive);
    if (!(Coder::kWrites || Coder::kDecodes) || sparse_) return nullptr;
    order_.list(asked_);
    if (is_batch()) return nullptr;
    asks_.begin(alive);
    for (std::uint32_t i = 0; i < alive; ++i) live.vertices[asked_[i]].row = i;
    return nullptr;
}

template <class Coder>
bool SplitCodec::ask(Coder& coder, std::uint32_t v, bool splits) {
    const LiveVertex& vertex = live.vertices[v];
    const Lattice3 bump = live.bump(v);
    std::uint64_t squared = 1;
    for (const std::int32_t b : bump) squared += static_cast<std::uint64_t>(std::int64_t{b} * b);
    const std::int32_t size = log2_fixed(squared);
    const std::size_t valence = std::clamp<std::uint32_t>(vertex.star, 3, 10) - 3;
    const std::size_t touched = std::min(sweep_ - vertex.touched, 2u),
                      acted = std::min(sweep_ - vertex.acted, 2u);
    const std::size_t age = (touched * 3 + acted) * 2 + asks_.again();
    const auto bumpy = static_cast<std::size_t>(std::clamp((size - split_size_ + 6 * 256) >> 8, 0, 9));
    const bool answer = coder.bit(mark_[(valence * 18 + age) * 10 + bumpy], splits);
    if (answer) split_size_ += (size - split_size_) >> 5;
    return answer;
}

template <class Coder>
bool SplitCodec::ask_batch(Coder& coder, std::uint32_t v, bool splits) {
    const LiveVertex& vertex = live.vertices[v];
    const Lattice3 bump = live.bump(v);
    std::uint64_t squared = 1;
    for (const std::int32_t b : bump) squared += static_cast<std::uint64_t>(std::int64_t{b} * b);
    const std::int32_t size = log2_fixed(squared);
    const std::size_t valence = std::clamp<std::uint32_t>(vertex.star, 3, 12) - 3;
    const std::size_t locked = std::min(vertex.star - unlocked(vertex), 6u);
    const std::size_t acted = std::min(sweep_ - vertex.acted, 2u);
    const auto bumpy = static_cast<std::size_t>(std::clamp((size - split_size_ + 6 * 256) >> 8, 0, 9));
    const bool answer = coder.bit(batch_mark_[((valence * 7 + locked) * 3 + acted) * 10 + bumpy], splits);
    if (answer) split_size_ += (size - split_size_) >> 5;
    return answer;
}

// Inlined: GCC 12 takes a function of prefetches alone for one without effects, and drops the calls.
VSPLIT_INLINE void SplitCodec::fetch_ahead(std::uint32_t place) const {
    // The vertex, its list, then its ring.
    constexpr std::array<std::uint32_t, 3> kAhead = {96, 64, 32};
    if (place + kAhead[0] < older_) live.fetch(asked_[place + kAhead[0]]);
    if (place + kAhead[1] < older_) live.fetch(asked_[place + kAhead[1]], 0);
    if (place + kAhead[2] < older_) live.fetch(asked_[place + kAhead[2]], 1);
}

template <class Coder>
const char* SplitCodec::code_mark(Coder& coder, std::uint32_t& primary) {
    if (!Coder::kWrites && !Coder::kDecodes) return nullptr;
    if (sparse_) {
        // Round the vertices, from the last one on.
        const std::uint32_t gap = gap_.code(
            coder, primary >= cursor_ ? primary - cursor_ : primary + live.vertex_count() - cursor_);
        if (gap >= live.vertex_count()) return "a sweep marks a vertex that does not exist";
        primary = gap < live.vertex_count() - cursor_ ? cursor_ + gap : gap - (live.vertex_count() - cursor_);
        cursor_ = primary;
        return nullptr;
    }
    if (is_batch()) {
        for (; cursor_ < older_; ++cursor_) {
            const std::uint32_t v = asked_[cursor_];
            fetch_ahead(cursor_);
            if (kind_ == SweepKind::kBatch && unlocked(live.vertices[v]) == 0) continue;
            if (!ask_batch(coder, v, v == primary)) continue;
            primary = v;
            return nullptr;
        }
        return "a sweep marks fewer vertices than it announces";
    }
    const auto at = [&](std::uint32_t place) { return place < older_ ? asked_[place] : place; };
    for (std::uint32_t place; (place = asks_.next()) != AskList::kNoPlace;) {
        if (!asks_.again()) fetch_ahead(place);
        const std::uint32_t v = at(place);
        if (ask(coder, v, v == primary)) {
            primary = v;
            return nullptr;
        }
    }
    return "a sweep marks fewer vertices than it announces";
}

// ---- A split

template <class Coder>
const char* SplitCodec::code_split(Coder& coder, std::uint32_t primary, const SplitPlan& wanted,
                                   SplitPlan& out) {
    out.clear();
    implied_triangles_.clear();
    implied_groups_.clear();
    is_plain_ = false;
    if (++fits_ >= fit_every) fits_ = 0;
    const bool marked = primary != kNoVertex;
    if (marked) {
        live.gather(primary, star_);
        if (star_.fan) {
            Cut cut;
            is_plain_ = coder.bit(plain_[star_.closed],
                                  !Coder::kDecodes && find_plain(primary, wanted, cut, out.sources));
            live.fetch(star_);
            if (is_plain_) return code_plain(coder, primary, cut, wanted, out);
        }
    }
    auto births = static_cast<std::uint32_t>(wanted.births.size());
    births = coder.bit(one_birth_[marked], births == 1) ? 1 : births_.code(coder, births);
    if (marked && births == 0) return "a marked split bears no vertex";
    if (Coder::kDecodes && births > room.vertices) return "a block bears more vertices than it announces";
    for (std::size_t i = 0; i < births; ++i) {
        if (const char* fault = code_birth(coder, primary, i, wanted, out)) return fault;
        if (coder.overrun()) return "a block ends within a split";
    }
    if (Coder::kDecodes && births > 1) {
        scratch_ = out.taken;
        std::sort(scratch_.begin(), scratch_.end());
        if (std::adjacent_find(scratch_.begin(), scratch_.end()) != scratch_.end())
            return "two births take one corner";
    }
    if (const char* fault = code_extra_moves(coder, wanted, out)) return fault;
    if (const char* fault = code_triangles(coder, wanted, out)) return fault;
    if (Coder::kDecodes && (out.taken.size() > room.corners || out.triangles.size() > room.triangles ||
                            out.moves.size() > room.moves))
        return "a split has more parts than its block announces";
    return nullptr;
}

template <class Coder>
const char* SplitCodec::code_birth(Coder& coder, std::uint32_t primary, std::size_t index,
                                   const SplitPlan& wanted, SplitPlan& out) {
    out.births.emplace_back();
    if (const char* fault = code_parent(coder, primary, wanted, index, out)) return fault;
    const std::uint32_t parent = out.births[index].parent;
    if (Coder::kDecodes && is_batch() && parent != kNoVertex && parent >= older_)
        return "a batch splits a vertex that it bore";
    is_run_ = false;
    bool moves = false;
    std::size_t move = 0;
    if (parent != kNoVertex) {
        if (const char* fault = code_taken(coder, wanted, index, out)) return fault;
        const auto is_parent = [&](const SplitPlan::Birth& birth) { return birth.parent == parent; };
        if (std::none_of(out.births.begin(), out.births.end() - 1, is_parent)) {
            if (!Coder::kDecodes)
                while (move < wanted.moves.size() && wanted.moves[move].vertex != parent) ++move;
            const std::size_t kind = index == 0 ? 0 : out.moves.empty() ? 1 : 2;
            moves = coder.bit(moved_[kind], move < wanted.moves.size());
        }
    }
    out.births[index].taken_end = static_cast<std::uint32_t>(out.taken.size());
    code_birth_place(coder, wanted, index, moves, out);
    if (moves) code_move(coder, wanted, move, parent, is_run_, out);
    return nullptr;
}

template <class Coder>
const char* SplitCodec::code_parent(Coder& coder, std::uint32_t primary, const SplitPlan& wanted,
                                    std::size_t index, SplitPlan& out) {
    std::uint32_t& parent = out.births[index].parent;
    if (index == 0 && primary != kNoVertex) {
        parent = primary;
        return nullptr;
    }
    enum : std::uint32_t { kNone, kTwin, kEarlier, kFar };
    constexpr std::uint32_t kTwins = 64;
    std::uint32_t kind = kNone, which = 0;
    const std::uint32_t alive = live.vertex_count();
    if (!Coder::kDecodes && wanted.births[index].parent != kNoVertex) {
        const std::uint32_t asked = wanted.births[index].parent;
        kind = kFar;
        which = alive - 1 - asked;
        for (std::size_t i = 0; i < index && kind == kFar; ++i)
            if (out.births[i].parent == asked) kind = kEarlier, which = static_cast<std::uint32_t>(i);
        if (kind == kFar && primary != kNoVertex) {
            std::uint32_t twin = live.vertices[primary].twin;
            for (std::uint32_t i = 0; i < kTwins && twin != primary; ++i, twin = live.vertices[twin].twin)
                if (twin == asked) {
                    kind = kTwin, which = i;
                    break;
                }
        }
    }
    kind = parent_kind_.code(coder, kind);
    if (kind == kNone) return nullptr;
    if (primary == kNoVertex) return "a split without a parent has one";
    if (kind == kTwin) {
        which = twin_.code(coder, which);
        if (which >= kTwins) return "a twin is too far";
        parent = live.vertices[primary].twin;
        for (; which > 0; --which) parent = live.vertices[parent].twin;
    } else if (kind == kEarlier) {
        which = births_.code(coder, which);
        if (which >= index) return "a birth shares the parent of a later one";
        parent = out.births[which].parent;
        if (parent == kNoVertex) return "a birth shares a parent that is none";
    } else {
        which = far_.code(coder, which);
        if (which >= alive) return "a birth has a parent before the first vertex";
        parent = alive - 1 - which;
    }
    return nullptr;
}

template <class Coder>
const char* SplitCodec::code_taken(Coder& coder, const SplitPlan& wanted, std::size_t index, SplitPlan& out) {
    live.gather(out.births[index].parent, star_);
    std::span<const std::uint32_t> taken;
    if (!Coder::kDecodes) {
        const std::uint32_t begin = index == 0 ? 0 : wanted.births[index - 1].taken_end;
        taken = std::span(wanted.taken).subspan(begin, wanted.births[index].taken_end - begin);
    }
    if (star_.fan) {
        Cut cut;
        is_run_ = coder.bit(regular_[star_.closed],
                            !Coder::kDecodes && find_cut(taken, wanted, birth_id(index), cut));
        if (is_run_) {
            if (Coder::kWrites || Coder::kDecodes) {
                if (!cut_.code(coder, live, star_, is_batch() ? older_ : kNoVertex, cut, run_))
                    return "a run has no place in its fan";
            } else {
                run_ = cut;
            }
            take_run(birth_id(index), out);
            return Coder::kDecodes && out.taken.size() > room.corners
                       ? "a block changes more corners than it announces"
                       : nullptr;
        }
        live.gather_corners(star_.centre, star_.corners);
        std::sort(star_.corners.begin(), star_.corners.end());
    }
    // Any corners of the star. Vast stars pay a whole bit each, so that work stays in proportion to bytes.
    for (const std::uint32_t corner : star_.corners) {
        const bool is_taken = !Coder::kDecodes && std::binary_search(taken.begin(), taken.end(), corner);
        if (star_.size > 64 ? coder.raw(1, is_taken) != 0 : coder.bit(in_mask_, is_taken)) {
            if (Coder::kDecodes && out.taken.size() >= room.corners)
                return "a block changes more corners than it announces";
            if (Coder::kDecodes && is_batch() && is_locked(live.triangles[corner / 3]))
                return "a batch changes a triangle twice";
            out.taken.push_back(corner);
        }
    }
    return nullptr;
}

#define VSPLIT_INSTANTIATE(Coder)                                       \
    template const char* SplitCodec::code_head(Coder&, SweepHead&);     \
    template const char* SplitCodec::code_mark(Coder&, std::uint32_t&); \
    template const char* SplitCodec::code_split(Coder&, std::uint32_t, const SplitPlan&, SplitPlan&);
VSPLIT_INSTANTIATE(RangeDecoder)
#ifndef VSPLIT_READS_ONLY
VSPLIT_INSTANTIATE(RangeEncoder)
VSPLIT_INSTANTIATE(NoCoder)
#endif
#undef VSPLIT_INSTANTIATE

}  // namespace vsplit
