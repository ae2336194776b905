// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The second half of SplitCodec: places, moves, new triangles, attributes.
#include <algorithm>

#include "place_fit.hpp"
#include "split_codec.hpp"

namespace vsplit {
namespace {

std::uint32_t zigzag(std::uint32_t difference) {
    return (difference << 1) ^ (0u - (difference >> 31));
}
std::uint32_t unzigzag(std::uint32_t code) {
    return (code >> 1) ^ (0u - (code & 1));
}

}  // namespace

// ---- Places

template <class Coder>
void SplitCodec::code_finer(Coder& coder, const std::array<std::uint32_t, 3>& wanted,
                            std::array<std::uint32_t, 3>& out) {
    if (shape_.lossless)
        for (std::size_t i = 0; i < 3; ++i) out[i] = finer_[i].code(coder, wanted[i]);
}

template <class Coder>
void SplitCodec::code_birth_place(Coder& coder, const SplitPlan& wanted, std::size_t index, bool moving,
                                  SplitPlan& out) {
    static const SplitPlan::Birth kNothing;
    const SplitPlan::Birth& asked = Coder::kDecodes ? kNothing : wanted.births[index];
    SplitPlan::Birth& birth = out.births[index];
    const SplitPlan::Birth& first = out.births[0];
    const bool has_parent = birth.parent != kNoVertex;
    if (index > 0 && coder.bit(same_place_[has_parent], asked.at == first.at && asked.finer == first.finer)) {
        birth.at = first.at;
        birth.finer = first.finer;
    } else {
        if (is_run_ && !looks_at<Coder>()) {
            birth.at = asked.at;
        } else if (is_run_) {
            guides_ = place_.guide_birth(live, birth.parent, child_ring_, moving);
            bool rough = false;
            if (!Coder::kDecodes && moving && asked.tolerance > 0) {
                const auto move =
                    std::find_if(wanted.moves.begin(), wanted.moves.end(),
                                 [&](const SplitPlan::Move& m) { return m.vertex == birth.parent; });
                rough = may_be_rough(guides_, asked.at, asked.tolerance, child_ring_, move->at);
            }
            if (moving && !shape_.lossless) rough = coder.bit(rough_[0], rough);
            birth.at = place_.code(coder, guides_, asked.at, rough);
            if (!Coder::kDecodes && fit) fit->add(guides_, birth.at);
        } else {
            birth.at =
                place_.code_free(coder, has_parent ? live.vertices[birth.parent].at : last_place_, asked.at);
        }
        code_finer(coder, asked.finer, birth.finer);
    }
    last_place_ = birth.at;
    if (shape_.stride() > 0) {
        predict_values(birth.parent, out);
        guesses_ = is_run_ && has_parent && !normal_.empty();
        if (guesses_ && (Coder::kWrites || Coder::kDecodes)) guess_directions(birth.parent, birth.at);
        code_values(coder, Coder::kDecodes ? nullptr : wanted.birth_values.data() + index * shape_.stride(),
                    out.birth_values);
        guesses_ = false;
    }
}

template <class Coder>
void SplitCodec::code_move(Coder& coder, const SplitPlan& wanted, std::size_t which, std::uint32_t vertex,
                           bool guided, SplitPlan& out) {
    static const SplitPlan::Move kNothing;
    const SplitPlan::Move& asked = Coder::kDecodes ? kNothing : wanted.moves[which];
    SplitPlan::Move move;
    move.vertex = vertex;
    const Lattice3& now = live.vertices[vertex].at;
    const std::array<std::uint32_t, 3> finer_now = shape_.lossless ? finer[vertex] : move.finer;
    const bool again =
        !out.moves.empty() &&
        coder.bit(same_move_[guided], asked.at == out.moves[0].at && asked.finer == out.moves[0].finer);
    if (again) {
        move.at = out.moves[0].at;
        move.finer = out.moves[0].finer;
    } else if (coder.bit(place_moves_[guided], asked.at != now || asked.finer != finer_now)) {
        if (guided && !looks_at<Coder>()) {
            move.at = asked.at;
        } else if (guided) {
            find_parent_ring();
            PlaceGuides guides = place_.guide_move(live, vertex, parent_ring_, out.births.back().at);
            bool rough = !Coder::kDecodes && asked.tolerance > 0 &&
                         may_be_rough(guides, asked.at, asked.tolerance, parent_ring_, out.births.back().at);
            if (!shape_.lossless) rough = coder.bit(rough_[1], rough);
            move.at = place_.code(coder, guides, asked.at, rough);
            if (!Coder::kDecodes && fit) fit->add(guides, move.at);
        } else {
            move.at = place_.code_free(coder, now, asked.at);
        }
        code_finer(coder, asked.finer, move.finer);
    } else {
        move.at = now;
        move.finer = finer_now;
    }
    out.moves.push_back(move);
    const std::size_t stride = shape_.stride();
    if (stride > 0) {
        for (std::size_t i = 0; i < stride; ++i) predicted_[i] = values[vertex * stride + i], scales_[i] = 0;
        code_values(coder, Coder::kDecodes ? nullptr : wanted.move_values.data() + which * stride,
                    out.move_values);
    }
}

template <class Coder>
const char* SplitCodec::code_extra_moves(Coder& coder, const SplitPlan& wanted, SplitPlan& out) {
    const auto place_of = [&](std::uint32_t vertex) {
        std::size_t i = 0;
        while (i < wanted.moves.size() && wanted.moves[i].vertex != vertex) ++i;
        return i;
    };
    // Twins of the first parent usually go where it goes.
    const std::uint32_t primary = out.births.empty() ? kNoVertex : out.births[0].parent;
    if (primary != kNoVertex) {
        const bool moves = !out.moves.empty() && out.moves[0].vertex == primary;
        std::uint32_t twin = live.vertices[primary].twin;
        for (int i = 0; i < 64 && twin != primary; ++i, twin = live.vertices[twin].twin) {
            const bool parent = std::any_of(out.births.begin(), out.births.end(),
                                            [&](const SplitPlan::Birth& b) { return b.parent == twin; });
            if (parent) continue;
            const std::size_t which = Coder::kDecodes ? 0 : place_of(twin);
            if (coder.bit(twin_moved_[moves], which < wanted.moves.size()))
                code_move(coder, wanted, which, twin, false, out);
            if (Coder::kDecodes && out.moves.size() > room.moves)
                return "a block moves more vertices than it announces";
        }
    }
    const std::uint32_t more = moves_.code(
        coder,
        static_cast<std::uint32_t>(wanted.moves.size() - std::min(wanted.moves.size(), out.moves.size())));
    if (Coder::kDecodes && out.moves.size() + std::uint64_t{more} > room.moves)
        return "a block moves more vertices than it announces";
    const std::uint32_t alive = live.vertex_count();
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < more; ++i, ++next) {
        const auto coded = [&](std::uint32_t vertex) {
            return std::any_of(out.moves.begin(), out.moves.end(),
                               [&](const SplitPlan::Move& m) { return m.vertex == vertex; });
        };
        std::uint32_t vertex = 0;
        if (!Coder::kDecodes) {
            while (coded(wanted.moves[next].vertex)) ++next;
            vertex = wanted.moves[next].vertex;
        }
        vertex = alive - 1 - moved_far_.code(coder, alive - 1 - vertex);
        if (vertex >= alive) return "a move names a vertex that does not exist";
        code_move(coder, wanted, next, vertex, false, out);
        if (coder.overrun()) return "a block ends within a split";
    }
    return nullptr;
}

// ---- Triangles

template <class Coder>
void SplitCodec::code_group(Coder& coder, std::uint32_t predicted, std::uint32_t wanted, SplitPlan& out) {
    if (shape_.group_bits == 0) return;
    if (!coder.bit(group_stays_[0], wanted == predicted)) predicted = coder.raw(shape_.group_bits, wanted);
    last_group_ = predicted;
    out.groups.push_back(predicted);
}

template <class Coder>
void SplitCodec::code_implied(Coder& coder, const SplitPlan& wanted, SplitPlan& out) {
    out.triangles.assign(implied_triangles_.begin(), implied_triangles_.end());
    if (shape_.group_bits == 0) return;
    for (std::size_t i = 0; i < implied_groups_.size(); ++i)
        code_group(coder, implied_groups_[i], Coder::kDecodes ? 0 : wanted.groups[out.sources[i]], out);
}

template <class Coder>
const char* SplitCodec::code_triangle(Coder& coder, const SplitPlan& out, const Triangle& wanted,
                                      Triangle& triangle) {
    enum : std::uint32_t { kBorn, kParent, kNear, kFar };
    const std::uint32_t alive = live.vertex_count(), births = static_cast<std::uint32_t>(out.births.size());
    for (std::size_t k = 0; k < 3; ++k) {
        std::uint32_t kind = kFar, which = 0;
        if (!Coder::kDecodes) {
            const std::uint32_t v = wanted[k];
            const auto parent = std::find_if(out.births.begin(), out.births.end(),
                                             [&](const SplitPlan::Birth& b) { return b.parent == v; });
            const auto near = std::lower_bound(near_.begin(), near_.end(), v);
            if (v >= alive) {
                kind = kBorn, which = births - 1 - (v - alive);
            } else if (parent != out.births.end()) {
                kind = kParent, which = static_cast<std::uint32_t>(parent - out.births.begin());
            } else if (near != near_.end() && *near == v) {
                kind = kNear, which = static_cast<std::uint32_t>(near - near_.begin());
            } else {
                which = alive - 1 - v;
            }
        }
        kind = corner_kind_.code(coder, kind);
        if (kind == kBorn) {
            which = corner_birth_.code(coder, which);
            if (which >= births) return "a new triangle names a birth that does not exist";
            triangle[k] = alive + births - 1 - which;
        } else if (kind == kParent) {
            which = corner_parent_.code(coder, which);
            if (which >= births || out.births[which].parent == kNoVertex)
                return "a new triangle names a parent that does not exist";
            triangle[k] = out.births[which].parent;
        } else if (kind == kNear) {
            which = corner_ring_.code(coder, which);
            if (which >= near_.size()) return "a new triangle names a neighbour that does not exist";
            triangle[k] = near_[which];
        } else {
            which = corner_far_.code(coder, which);
            if (which >= alive) return "a new triangle names a vertex that does not exist";
            triangle[k] = alive - 1 - which;
        }
    }
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0])
        return "a new triangle names a vertex twice";
    return nullptr;
}

template <class Coder>
const char* SplitCodec::code_triangles(Coder& coder, const SplitPlan& wanted, SplitPlan& out) {
    // Encoder: which of the triangles asked for are the implied ones?
    used_.assign(wanted.triangles.size(), false);
    bool all = true;
    if (!Coder::kDecodes)
        for (const Triangle& implied : implied_triangles_) {
            std::uint32_t i = 0;
            while (i < wanted.triangles.size() && (used_[i] || !is_rotation(wanted.triangles[i], implied)))
                ++i;
            if (i == wanted.triangles.size()) {
                all = false;
                break;
            }
            used_[i] = true;
            out.sources.push_back(i);
        }
    if (!implied_triangles_.empty()) {
        all = coder.bit(implied_[0], all);
        if (!Coder::kDecodes && !all) {
            out.sources.clear();
            used_.assign(wanted.triangles.size(), false);
        }
        if (all) code_implied(coder, wanted, out);
    }
    const std::uint32_t more = extra_.code(
        coder,
        static_cast<std::uint32_t>(wanted.triangles.size() - (Coder::kDecodes ? 0 : out.triangles.size())));
    if (Coder::kDecodes && out.triangles.size() + std::uint64_t{more} > room.triangles)
        return "a block bears more triangles than it announces";
    if (more == 0) return nullptr;
    near_.clear();
    if (!out.births.empty() && out.births[0].parent != kNoVertex) {
        live.gather_corners(out.births[0].parent, scratch_);
        for (const std::uint32_t corner : scratch_)
            for (const std::uint32_t v : live.triangles[corner / 3])
                if (v != out.births[0].parent) near_.push_back(v);
        std::sort(near_.begin(), near_.end());
        near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
    }
    std::uint32_t next = 0;
    for (std::uint32_t i = 0; i < more; ++i, ++next) {
        Triangle asked{}, triangle{};
        std::uint32_t group = 0;
        if (!Coder::kDecodes) {
            while (used_[next]) ++next;
            asked = wanted.triangles[next];
            if (!wanted.groups.empty()) group = wanted.groups[next];
            out.sources.push_back(next);
        }
        if (const char* fault = code_triangle(coder, out, asked, triangle)) return fault;
        out.triangles.push_back(triangle);
        code_group(coder, last_group_, group, out);
        if (coder.overrun()) return "a block ends within a split";
    }
    return nullptr;
}

// ---- Attributes

void SplitCodec::predict_values(std::uint32_t parent, const SplitPlan& out) {
    const std::size_t stride = shape_.stride();
    for (std::size_t i = 0; i < stride; ++i) {
        scales_[i] = 0;
        if (parent == kNoVertex) {
            const auto& before = out.birth_values.empty() ? values : out.birth_values;
            predicted_[i] = before.empty() ? 0 : before[before.size() - stride + i];
            continue;
        }
        const std::int64_t own = values[parent * stride + i];
        predicted_[i] = static_cast<std::int32_t>(own);
        if (!is_run_ || !shape_.mixes[i]) continue;
        std::int64_t sum = 0, spread = 0;
        for (std::uint32_t j = 0; j < child_ring_.size; ++j) {
            const std::int64_t d = values[child_ring_.vertex[j] * stride + i] - own;
            sum += d;
            spread += std::abs(d);
        }
        const std::uint32_t count = child_ring_.size + 1;
        predicted_[i] = static_cast<std::int32_t>(own + ((mean16(sum, count) + 8) >> 4));
        scales_[i] = std::min<std::uint32_t>(
            (half_octave(static_cast<std::uint64_t>(mean16(spread, count))) + 1) / 2 + 1, kValueScales - 1);
    }
}

void SplitCodec::guess_directions(std::uint32_t parent, const Lattice3& child) {
    const std::size_t stride = shape_.stride();
    // The triangles around the child: between neighbours of the ring, and the wings.
    Direction geometric{};
    const auto to = [&](std::uint32_t v) {
        const Lattice3& at = live.vertices[v].at;
        return Direction{at[0] - child[0], at[1] - child[1], at[2] - child[2]};
    };
    const auto add = [&](const Direction& a, const Direction& b) {
        geometric[0] += a[1] * b[2] - a[2] * b[1];
        geometric[1] += a[2] * b[0] - a[0] * b[2];
        geometric[2] += a[0] * b[1] - a[1] * b[0];
    };
    const Direction p = to(parent);
    Direction before{};
    for (std::uint32_t i = 0; i < child_ring_.size; ++i) {
        const Direction here = to(child_ring_.vertex[i]);
        if (i > 0) add(before, here);
        if (i == 0 && run_.first_wing) add(p, here);
        before = here;
    }
    if (child_ring_.size > 0 && run_.last_wing) add(before, p);
    std::size_t direction = 0;
    for (std::size_t i = 0; i < stride; ++i) {
        if (shape_.direction_bits[i] == 0) continue;
        NormalModel& model = normal_[direction++];
        Direction mean = model.direction(values.data() + parent * stride + i);
        for (std::uint32_t j = 0; j < child_ring_.size; ++j) {
            const Direction near = model.direction(values.data() + child_ring_.vertex[j] * stride + i);
            for (std::size_t k = 0; k < 3; ++k) mean[k] += near[k];
        }
        model.guess(geometric, mean);
    }
}

template <class Coder>
void SplitCodec::code_values(Coder& coder, const std::int32_t* wanted, std::vector<std::int32_t>& out) {
    std::size_t direction = 0;
    for (std::size_t i = 0; i < shape_.stride(); ++i) {
        if (guesses_ && (Coder::kWrites || Coder::kDecodes) && shape_.direction_bits[i] > 0) {
            std::int32_t numbers[2];
            normal_[direction++].code(coder, Coder::kDecodes ? nullptr : wanted + i, numbers);
            out.insert(out.end(), numbers, numbers + 2);
            ++i;
            continue;
        }
        const auto from = static_cast<std::uint32_t>(predicted_[i]);
        const std::uint32_t difference =
            Coder::kDecodes ? 0 : zigzag(static_cast<std::uint32_t>(wanted[i]) - from);
        const std::uint32_t read = value_[i].by_scale[scales_[i]].code(coder, difference);
        out.push_back(static_cast<std::int32_t>(from + unzigzag(read)));
    }
}

template <class Coder>
const char* SplitCodec::code_base(Coder& coder, bool whole, std::uint32_t triangles) {
    const std::size_t stride = shape_.stride();
    const std::uint32_t count = live.vertex_count();
    std::vector<std::int32_t> row;
    for (std::uint32_t v = 0; v < count && !coder.overrun(); ++v) {
        if (whole)
            live.vertices[v].at =
                place_.code_free(coder, v == 0 ? Lattice3{} : live.vertices[v - 1].at, live.vertices[v].at);
        if (shape_.lossless) code_finer(coder, std::array<std::uint32_t, 3>(finer[v]), finer[v]);
        for (std::size_t i = 0; i < stride; ++i) {
            predicted_[i] = v == 0 ? 0 : values[(v - 1) * stride + i];
            scales_[i] = 1;
        }
        row.clear();
        code_values(coder, values.data() + v * stride, row);
        std::copy(row.begin(), row.end(), values.begin() + static_cast<std::ptrdiff_t>(v * stride));
    }
    // Corners count back from the vertex that none before has named.
    std::uint32_t unnamed = 0;
    for (std::uint32_t t = 0; whole && t < triangles && !coder.overrun(); ++t) {
        Triangle triangle{};
        if (!Coder::kDecodes) triangle = live.triangles[t];
        for (std::size_t k = 0; k < 3; ++k) {
            triangle[k] = unnamed - unzigzag(base_corner_[k].code(coder, zigzag(unnamed - triangle[k])));
            if (triangle[k] >= count) return "a triangle of the base mesh names a vertex that does not exist";
            unnamed = std::max(unnamed, triangle[k] + 1);
        }
        if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0])
            return "a triangle of the base mesh names a vertex twice";
        if (Coder::kDecodes) live.add_triangle(triangle);
    }
    for (std::uint32_t v = 0; v < count; ++v) order_.add(kNoVertex);
    if (shape_.group_bits > 0) {
        SplitPlan plan;
        for (std::uint32_t& group : groups) {
            if (coder.overrun()) break;
            plan.groups.clear();
            code_group(coder, last_group_, group, plan);
            group = last_group_;
        }
    }
    live.link_twins(0);
    return nullptr;
}

#define VSPLIT_INSTANTIATE(Coder)                                                                        \
    template const char* SplitCodec::code_base(Coder&, bool, std::uint32_t);                             \
    template void SplitCodec::code_birth_place(Coder&, const SplitPlan&, std::size_t, bool, SplitPlan&); \
    template void SplitCodec::code_move(Coder&, const SplitPlan&, std::size_t, std::uint32_t, bool,      \
                                        SplitPlan&);                                                     \
    template void SplitCodec::code_implied(Coder&, const SplitPlan&, SplitPlan&);                        \
    template const char* SplitCodec::code_extra_moves(Coder&, const SplitPlan&, SplitPlan&);             \
    template const char* SplitCodec::code_triangles(Coder&, const SplitPlan&, SplitPlan&);
VSPLIT_INSTANTIATE(RangeDecoder)
#ifndef VSPLIT_READS_ONLY
VSPLIT_INSTANTIATE(RangeEncoder)
VSPLIT_INSTANTIATE(NoCoder)
#endif
#undef VSPLIT_INSTANTIATE

}  // namespace vsplit
