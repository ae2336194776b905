// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "record_encoder.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>

namespace vsplit {

namespace {

void find_trades_and_idle(const ProgressiveMesh& mesh, WholeNumbers& numbers) {
    // Where each vertex is as the record goes: its birth, or its last move.
    std::vector<std::uint32_t> move_of(mesh.positions.size(), kNoVertex);
    const auto stride = static_cast<std::ptrdiff_t>(numbers.stride);
    numbers.traded.assign(mesh.positions.size(), false);
    numbers.idle.assign(mesh.moves.size(), false);
    // Is a vertex, as it is now, what row `to` of the births or moves makes of it?
    const auto stays = [&](std::uint32_t vertex, bool to_move, std::uint32_t to) {
        const bool moved = move_of[vertex] != kNoVertex;
        const std::uint32_t row = moved ? move_of[vertex] : vertex;
        const auto at = [&](bool move, std::uint32_t i) {
            return (move ? numbers.move_at : numbers.birth_at)[i];
        };
        const auto finer = [&](bool move, std::uint32_t i) {
            return (move ? numbers.move_finer : numbers.birth_finer)[i];
        };
        const auto values = [&](bool move, std::uint32_t i) {
            return (move ? numbers.move_values : numbers.birth_values).begin() + i * stride;
        };
        return at(to_move, to) == at(moved, row) &&
               (!numbers.lossless || finer(to_move, to) == finer(moved, row)) &&
               std::equal(values(to_move, to), values(to_move, to) + stride, values(moved, row));
    };
    std::uint32_t begin = mesh.base_vertices, move = 0;
    for (const Split& split : mesh.splits) {
        for (std::uint32_t v = begin; v < split.vertices_end; ++v) {
            const std::uint32_t parent = mesh.parents[v];
            if (parent == kNoVertex) continue;
            std::uint32_t children = 0, moves = 0;
            for (std::uint32_t w = begin; w < split.vertices_end; ++w) children += mesh.parents[w] == parent;
            for (std::uint32_t m = move; m < split.moves_end; ++m) moves += mesh.moves[m].vertex == parent;
            if (children != 1 || moves == 0) continue;
            numbers.traded[v] = stays(parent, false, v);
        }
        for (std::uint32_t m = move; m < split.moves_end; ++m) {
            const std::uint32_t v = mesh.moves[m].vertex;
            numbers.idle[m] = stays(v, true, m);
            for (std::uint32_t later = m + 1; later < split.moves_end; ++later)
                if (mesh.moves[later].vertex == v) numbers.idle[m] = true;
        }
        for (; move < split.moves_end; ++move) move_of[mesh.moves[move].vertex] = move;
        begin = split.vertices_end;
    }
}

/// Places that a move of their vertex alone replaces later on, in plain splits: nothing else refers to them.
/// They live until then, so the error just before says how exact they need to be.
void find_rough(const ProgressiveMesh& mesh, WholeNumbers& numbers) {
    numbers.birth_tolerance.assign(mesh.positions.size(), 0);
    numbers.move_tolerance.assign(mesh.moves.size(), 0);
    if (numbers.lossless) return;
    std::vector<std::uint32_t> move_of(mesh.positions.size(), kNoVertex);
    std::vector<bool> plain(mesh.positions.size(), false);  // is the place at hand of a plain split?
    const Roughness roughness(mesh);
    Split from{mesh.base_vertices, mesh.base_triangles, 0, 0, 0};
    for (const Split& to : mesh.splits) {
        const bool is_plain = to.vertices_end == from.vertices_end + 1 &&
                              to.moves_end == from.moves_end + 1 &&
                              mesh.parents[from.vertices_end] == mesh.moves[from.moves_end].vertex;
        const bool replaces = is_plain && !numbers.traded[from.vertices_end] && !numbers.idle[from.moves_end];
        for (std::uint32_t m = from.moves_end; m < to.moves_end; ++m) {
            if (numbers.idle[m]) continue;  // replaces nothing
            const std::uint32_t v = mesh.moves[m].vertex;
            if (replaces && plain[v]) {
                const double tolerance = roughness.of(double(to.error)) / numbers.lattice.step;
                if (tolerance > 0) numbers.roughness = roughness;
                (move_of[v] == kNoVertex ? numbers.birth_tolerance[v] : numbers.move_tolerance[move_of[v]]) =
                    tolerance;
            }
            move_of[v] = m;
            plain[v] = replaces;
        }
        for (std::uint32_t v = from.vertices_end; v < to.vertices_end; ++v) plain[v] = replaces;
        from = to;
    }
}

}  // namespace

Roughness::Roughness(const ProgressiveMesh& mesh) : none_(false) {
    constexpr std::size_t kCoarsest = 16;  // so many times fewer vertices than the whole
    most_fine_ = error_at(mesh, level_for_vertices(mesh, mesh.positions.size() / kCoarsest)) / 8;
}

float Roughness::raised(float error) const {
    if (none_) return error;
    return static_cast<float>(std::min(error + of(error), double(std::numeric_limits<float>::max())));
}

WholeNumbers whole_numbers(const ProgressiveMesh& mesh, const Lattice& lattice, const WriteOptions& options) {
    WholeNumbers out;
    out.lattice = lattice;
    out.weights = !mesh.weights.empty();
    out.lossless = options.position_bits == 0;
    for (const std::uint32_t group : mesh.groups) out.largest_group = std::max(out.largest_group, group);
    for (std::size_t i = 0; i < mesh.attributes.size(); ++i)
        out.details.rules.push_back(
            rule_for(mesh.attributes[i], mesh.moved_values[i], options, lattice.step));
    out.stride = out.shape().stride();

    const std::size_t vertices = mesh.positions.size(), moves = mesh.moves.size();
    out.birth_at.reserve(vertices);
    out.move_at.reserve(moves);
    for (const Float3& p : mesh.positions) out.birth_at.push_back(lattice.nearest(p));
    for (const VertexMove& move : mesh.moves) out.move_at.push_back(lattice.nearest(move.position));
    if (out.lossless) {
        for (std::size_t v = 0; v < vertices; ++v)
            out.birth_finer.push_back(lattice.finer(out.birth_at[v], mesh.positions[v]));
        for (std::size_t m = 0; m < moves; ++m)
            out.move_finer.push_back(lattice.finer(out.move_at[m], mesh.moves[m].position));
    }
    out.birth_values.resize(vertices * out.stride);
    out.move_values.resize(moves * out.stride);
    std::size_t column = 0;
    for (std::size_t i = 0; i < mesh.attributes.size(); ++i) {
        const ValueRule& rule = out.details.rules[i];
        for (std::size_t v = 0; v < vertices; ++v)
            rule.quantise(mesh.attributes[i].values.data() + v * rule.components,
                          out.birth_values.data() + v * out.stride + column);
        for (std::size_t m = 0; m < moves; ++m)
            rule.quantise(mesh.moved_values[i].data() + m * rule.components,
                          out.move_values.data() + m * out.stride + column);
        column += rule.numbers();
    }
    if (out.weights) {
        for (std::size_t v = 0; v < vertices; ++v)
            out.birth_values[v * out.stride + column] = ordered_number(mesh.weights[v]);
        for (std::size_t m = 0; m < moves; ++m)
            out.move_values[m * out.stride + column] = ordered_number(mesh.moves[m].weight);
    }
    find_trades_and_idle(mesh, out);
    find_rough(mesh, out);
    return out;
}

RecordEncoder::RecordEncoder(const ProgressiveMesh& mesh, const WholeNumbers& numbers,
                             const std::vector<Sweep>& sweeps)
    : mesh_(mesh), numbers_(numbers), sweeps_(sweeps), codec_(numbers.shape(), numbers.details.weights) {
    vertex_.assign(mesh.positions.size(), kNoVertex);
    triangle_.assign(mesh.triangles.size(), kNoVertex);
    codec_.live.reserve(mesh.positions.size(), mesh.triangles.size());
    for (std::uint32_t v = 0; v < mesh.base_vertices; ++v) {
        vertex_[v] = v;
        codec_.live.add_vertex(numbers.birth_at[v]);
        if (numbers.lossless) codec_.finer.push_back(numbers.birth_finer[v]);
    }
    codec_.values.assign(
        numbers.birth_values.begin(),
        numbers.birth_values.begin() + static_cast<std::ptrdiff_t>(mesh.base_vertices * numbers.stride));
    for (std::uint32_t t = 0; t < mesh.base_triangles; ++t) {
        triangle_[t] = t;
        codec_.live.add_triangle(mesh.triangles[t]);
        if (numbers.largest_group > 0) codec_.groups.push_back(mesh.groups[t]);
    }
}

BaseMesh RecordEncoder::base() const {
    return {{numbers_.birth_at.begin(), numbers_.birth_at.begin() + mesh_.base_vertices},
            {mesh_.triangles.begin(), mesh_.triangles.begin() + mesh_.base_triangles}};
}

Split RecordEncoder::before(std::uint32_t split) const {
    return split == 0 ? Split{mesh_.base_vertices, mesh_.base_triangles, 0, 0, 0} : mesh_.splits[split - 1];
}

std::uint32_t RecordEncoder::last_move(std::uint32_t vertex, const Split& from, const Split& to) const {
    for (std::uint32_t m = to.moves_end; m-- > from.moves_end;)
        if (mesh_.moves[m].vertex == vertex) return m;
    return kNoVertex;
}

void RecordEncoder::plan(std::uint32_t number, SplitPlan& out) {
    out.clear();
    const Split from = before(number), to = mesh_.splits[number];
    births_.resize(to.vertices_end - from.vertices_end);  // lists keep their memory
    for (std::uint32_t v = from.vertices_end; v < to.vertices_end; ++v) {
        Born& born = births_[v - from.vertices_end];
        born.vertex = v;
        born.parent = mesh_.parents[v] == kNoVertex ? kNoVertex : vertex_[mesh_.parents[v]];
        born.traded_move = numbers_.traded[v] ? last_move(mesh_.parents[v], from, to) : kNoVertex;
        born.taken.clear();
        for (std::uint32_t c = from.corners_end; c < to.corners_end; ++c)
            if (mesh_.corner_changes[c].vertex == v)
                born.taken.push_back(triangle_[mesh_.corner_changes[c].corner / 3]);
    }
    if (births_.size() > 1)
        std::stable_sort(births_.begin(), births_.end(),
                         [](const Born& a, const Born& b) { return a.parent < b.parent; });

    const auto stride = static_cast<std::ptrdiff_t>(numbers_.stride);
    const std::uint32_t alive = codec_.live.vertex_count();
    for (std::uint32_t i = 0; i < births_.size(); ++i) {
        Born& born = births_[i];
        const bool traded = born.traded_move != kNoVertex;
        SplitPlan::Birth birth;
        birth.parent = born.parent;
        const std::vector<std::int32_t>& values = traded ? numbers_.move_values : numbers_.birth_values;
        const std::uint32_t from_row = traded ? born.traded_move : born.vertex;
        birth.at = traded ? numbers_.move_at[from_row] : numbers_.birth_at[from_row];
        if (numbers_.lossless)
            birth.finer = traded ? numbers_.move_finer[from_row] : numbers_.birth_finer[from_row];
        const auto row = values.begin() + static_cast<std::ptrdiff_t>(from_row) * stride;
        out.birth_values.insert(out.birth_values.end(), row, row + stride);
        // The one that stays where it is keeps the number; the one that goes gets the new one.
        vertex_[born.vertex] = traded ? born.parent : alive + i;
        if (traded) vertex_[mesh_.parents[born.vertex]] = alive + i;
        const auto begin = static_cast<std::ptrdiff_t>(out.taken.size());
        if (birth.parent != kNoVertex) {
            std::sort(born.taken.begin(), born.taken.end());
            codec_.live.gather_corners(birth.parent, corners_);
            for (const std::uint32_t corner : corners_)
                if (std::binary_search(born.taken.begin(), born.taken.end(), corner / 3) != traded)
                    out.taken.push_back(corner);
        }
        std::sort(out.taken.begin() + begin, out.taken.end());
        birth.taken_end = static_cast<std::uint32_t>(out.taken.size());
        birth.tolerance = numbers_.birth_tolerance[born.vertex];
        out.births.push_back(birth);
    }
    recorded_triangles_.clear();
    for (std::uint32_t t = from.triangles_end; t < to.triangles_end; ++t) {
        const Triangle& c = mesh_.triangles[t];
        recorded_triangles_.push_back(t);
        out.triangles.push_back({vertex_[c[0]], vertex_[c[1]], vertex_[c[2]]});
        if (numbers_.largest_group > 0) out.groups.push_back(mesh_.groups[t]);
    }
    for (std::uint32_t m = from.moves_end; m < to.moves_end; ++m) {
        if (numbers_.idle[m]) continue;
        const bool traded =
            std::any_of(births_.begin(), births_.end(), [&](const Born& b) { return b.traded_move == m; });
        if (traded) continue;
        SplitPlan::Move move;
        move.vertex = vertex_[mesh_.moves[m].vertex];
        move.at = numbers_.move_at[m];
        move.tolerance = numbers_.move_tolerance[m];
        if (numbers_.lossless) move.finer = numbers_.move_finer[m];
        const auto values = numbers_.move_values.begin() + static_cast<std::ptrdiff_t>(m) * stride;
        // A rough place may be where the exact one comes to lie.
        if (move.at == codec_.live.vertices[move.vertex].at &&
            (!numbers_.lossless || move.finer == codec_.finer[move.vertex]) &&
            std::equal(values, values + stride,
                       codec_.values.begin() + static_cast<std::ptrdiff_t>(move.vertex) * stride))
            continue;
        out.moves.push_back(move);
        out.move_values.insert(out.move_values.end(), values, values + stride);
    }
}

void RecordEncoder::learn_numbers(const SplitPlan& wanted, const SplitPlan& coded) {
    const auto first = static_cast<std::uint32_t>(codec_.live.triangles.size() - coded.triangles.size());
    assert(wanted.triangles.size() == coded.triangles.size() && wanted.taken == coded.taken &&
           wanted.moves.size() == coded.moves.size());
    static_cast<void>(wanted);
    for (std::uint32_t i = 0; i < coded.sources.size(); ++i)
        triangle_[recorded_triangles_[coded.sources[i]]] = first + i;
}

template <class Coder>
void RecordEncoder::code_base(Coder& coder, bool whole) {
    const char* fault = codec_.code_base(coder, whole, mesh_.base_triangles);
    assert(!fault);
    static_cast<void>(fault);
}

// Inlined: GCC 12 takes a function of prefetches alone for one without effects, and drops the calls.
VSPLIT_INLINE void RecordEncoder::fetch(const Sweep& sweep, std::size_t step) const {
    const auto at = [&](std::size_t ahead) {
        return step + ahead < sweep.steps.size() ? &sweep.steps[step + ahead] : nullptr;
    };
    if (const Sweep::Step* far = at(12)) __builtin_prefetch(&mesh_.splits[far->split]);
    if (const Sweep::Step* far = at(8)) {
        const Split from = before(far->split);
        __builtin_prefetch(numbers_.birth_at.data() + from.vertices_end);
        __builtin_prefetch(mesh_.parents.data() + from.vertices_end);
        __builtin_prefetch(mesh_.triangles.data() + from.triangles_end);
        __builtin_prefetch(mesh_.corner_changes.data() + from.corners_end);
        __builtin_prefetch(numbers_.move_at.data() + from.moves_end);
        if (far->primary < codec_.live.vertex_count())
            __builtin_prefetch(&codec_.live.vertices[far->primary]);
    }
    if (const Sweep::Step* near = at(6)) {
        const Split from = before(near->split), to = mesh_.splits[near->split];
        for (std::uint32_t c = from.corners_end; c < to.corners_end; ++c)
            __builtin_prefetch(&triangle_[mesh_.corner_changes[c].corner / 3]);
        for (std::uint32_t t = from.triangles_end; t < to.triangles_end; ++t)
            for (const std::uint32_t v : mesh_.triangles[t]) __builtin_prefetch(&vertex_[v]);
        if (near->primary < codec_.live.vertex_count()) codec_.live.fetch(near->primary, 0);
    }
    if (const Sweep::Step* next = at(3); next && next->primary < codec_.live.vertex_count())
        codec_.live.fetch(next->primary, 1);
}

template <class Coder>
const char* RecordEncoder::code_splits(
    Coder& coder, const std::function<bool(const SplitPlan&, float, const Sweep*)>& done) {
    bool block_ends = true;
    for (const Sweep& sweep : sweeps_) {
        const auto marked = std::count_if(sweep.steps.begin(), sweep.steps.end(),
                                          [](const Sweep::Step& step) { return step.primary != kNoVertex; });
        SweepHead head{sweep.kind, static_cast<std::uint32_t>(marked),
                       static_cast<std::uint32_t>(sweep.steps.size()) - static_cast<std::uint32_t>(marked),
                       block_ends, std::bit_cast<std::uint32_t>(sweep.error)};
        const char* fault = codec_.code_head(coder, head);
        for (std::size_t i = 0; i < sweep.steps.size(); ++i) {
            const Sweep::Step& step = sweep.steps[i];
            fetch(sweep, i);
            std::uint32_t primary = step.primary;
            if (!fault && primary != kNoVertex) fault = codec_.code_mark(coder, primary);
            if (fault) return fault;
            plan(step.split, wanted_);
            assert(primary == kNoVertex || wanted_.births[0].parent == primary);
            fault = codec_.code_split(coder, primary, wanted_, coded_);
            if (fault) return fault;
            codec_.apply(coded_);
            learn_numbers(wanted_, coded_);
            block_ends = done(coded_, std::bit_cast<float>(head.error_bits),
                              &step == &sweep.steps.back() ? &sweep : nullptr);
        }
        if (fault) return fault;
    }
    return nullptr;
}

template void RecordEncoder::code_base(RangeEncoder&, bool);
template void RecordEncoder::code_base(NoCoder&, bool);
template const char* RecordEncoder::code_splits(
    RangeEncoder&, const std::function<bool(const SplitPlan&, float, const Sweep*)>&);
template const char* RecordEncoder::code_splits(
    NoCoder&, const std::function<bool(const SplitPlan&, float, const Sweep*)>&);

}  // namespace vsplit
