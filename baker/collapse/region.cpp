// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "region.hpp"

#include <algorithm>
#include <cmath>

#include "wedge_cost.hpp"

namespace vsplit::bake {
namespace {

/// What a fold costs more that the rules of topology or seams forbid.
constexpr double kRelaxed = 4;

/// What the square of a valence's excess counts in batches.
constexpr double kIrregular = 0.4;

}  // namespace

float vanishing_cost(const CollapseState& state, std::uint32_t component) {
    const double reach = state.components.reach(component), cube = reach * reach * reach;
    if (state.paper) return float(reach);
    // Not before other collapses deviate as far; and what is large against the triangles of the time is
    // kept for longer still.
    return float(std::max(std::max(state.options.deviation_limit, 1.0) * cube * reach * reach,
                          state.options.deviation_limit * cube * state.mean_star));
}

void Region::open(std::uint32_t low, std::uint32_t high, Bucket begin, Bucket end, std::size_t room) {
    room_ = room;
    low_ = low;
    high_ = high;
    begin_ = begin;
    end_ = end;
    guards_.open(low, high);
    queue_.open(begin, end);
    record_ = Record(!state_.weights.empty());
    wedge_record_ = {};
    put_off_.clear();
    ends_.clear();
    lost_vertices_ = lost_triangles_ = 0;
    losing_ = kNoVertex;
    losing_triangles_ = 0;
    vanished_ = 0;
}

void Region::close() {
    record_ = Record(false);
    wedge_record_ = {};
}

Target Region::best_of(std::uint32_t u) {
    list_edges(u, listed_);
    Target best;
    for (std::size_t i = 0; i < listed_.others.size(); ++i) best.offer(listed_.others[i], listed_.costs[i]);
    return best;
}

bool Region::star_inside(std::uint32_t v) const {
    if (mesh_.kind(v) == VertexKind::kInner) {
        for (const std::uint32_t t : mesh_.star(v)) {
            const Triangle& c = mesh_.triangle(t);
            if (!inside(c[0] == v ? c[1] : c[1] == v ? c[2] : c[0])) return false;
        }
        return true;
    }
    for (const std::uint32_t t : mesh_.star(v))
        for (const std::uint32_t w : mesh_.triangle(t))
            if (!inside(w)) return false;
    return true;
}

void Region::put_off(std::uint32_t u, Bucket bucket) {
    state_.slots[u] = bucket;
    put_off_.push_back(u);
}

void Region::lose_of(std::uint32_t component, std::uint32_t triangles) {
    lost_triangles_ += triangles;
    if (component != losing_) {
        flush();
        losing_ = component;
    }
    losing_triangles_ += triangles;
}

void Region::flush() {
    if (losing_triangles_ != 0) state_.components.lose(losing_, losing_triangles_);
    losing_triangles_ = 0;
}

Candidate Region::evaluate(std::uint32_t u, std::uint32_t v, Fold fold) const {
    if (state_.paper) {
        thread_local EdgeStar star;
        star.gather(mesh_, u, v);
        return state_.paper->evaluate(mesh_, star, fold, state_.options.placement,
                                      double(mesh_.vertex(u).weight), double(mesh_.vertex(v).weight));
    }
    const auto placed = [&](const EdgeQuadric<double>& edge) {
        return fold == Fold::kIntoFirst                          ? edge.end(-1)
               : fold == Fold::kIntoSecond                       ? edge.end(1)
               : state_.options.placement == Placement::kOptimal ? edge.best()
                                                                 : edge.better_end();
    };
    const EdgeQuadric<double> edge(shape_of(mesh_, u), shape_of(mesh_, v), state_.options);
    const auto at = placed(edge);
    if (at.cost >= edge.noise()) return {edge.middle() + at.place, edge.price(at.cost)};
    // Nearly flat: only the triangles themselves tell how nearly.
    thread_local std::vector<Neighbour> scratch;
    const double boundary = state_.options.boundary_weight;
    const EdgeQuadric<double> exact(exact_shape(mesh_, u, boundary, scratch),
                                    exact_shape(mesh_, v, boundary, scratch), state_.options);
    const auto exact_at = placed(exact);
    return {exact.middle() + exact_at.place, exact.price(exact_at.cost)};
}

void Region::price(std::uint32_t u, EdgeList& list) const {
    list.costs.resize(list.others.size());
    const bool optimal = !state_.paper && state_.options.placement == Placement::kOptimal;
    const bool some =
        std::any_of(list.folds.begin(), list.folds.end(), [](Fold fold) { return fold == Fold::kAnywhere; });
    if (optimal && some) price_edges(mesh_, u, list.others, state_.options, list.costs.data());
    for (std::size_t i = 0; i < list.others.size(); ++i) {
        if (list.folds[i] == Fold::kNever)
            list.costs[i] = kNeverCost;
        else if (!optimal || list.folds[i] != Fold::kAnywhere || list.costs[i] == kUnsurePrice)
            list.costs[i] = float(evaluate(u, list.others[i], list.folds[i]).cost);
    }
}

Fold Region::fold_of(std::uint32_t u, std::uint32_t v) const {
    // A hub's edges would break the limit; pricing them at each collapse near it would be quadratic.
    const bool hub = std::max(mesh_.star(u).size(), mesh_.star(v).size()) > state_.strictness.max_valence;
    if (hub) return Fold::kNever;
    if (!mesh_.has_wedges() && mesh_.kind(u) == VertexKind::kInner && mesh_.kind(v) == VertexKind::kInner)
        return Fold::kAnywhere;
    const Fold fold = fold_rule(mesh_, u, v);
    if (fold != Fold::kNever || state_.paper) return fold;
    if (!mesh_.has_wedges() && !may_untie(mesh_, u, v, state_.locked[u], state_.locked[v])) return fold;
    return relaxed_fold(u, v);
}

Fold Region::relaxed_fold(std::uint32_t u, std::uint32_t v) const {
    const bool open_u = mesh_.vertex(u).open, open_v = mesh_.vertex(v).open;
    if (state_.locked[u] && state_.locked[v]) return Fold::kNever;
    if (state_.locked[u] || state_.locked[v]) return state_.locked[u] ? Fold::kIntoFirst : Fold::kIntoSecond;
    // Boundaries stay where they are, and apart from each other, until nothing else is left.
    if (state_.strictness.keep_orientation && (mesh_.has_wedges() || open_u != open_v)) {
        if (open_u && open_v) return Fold::kNever;
        if (open_u || open_v) return open_u ? Fold::kIntoFirst : Fold::kIntoSecond;
    }
    const EdgeQuadric<double> edge(shape_of(mesh_, u), shape_of(mesh_, v), state_.options);
    return edge.end(1).cost < edge.end(-1).cost ? Fold::kIntoSecond : Fold::kIntoFirst;
}

void Region::list_edges(std::uint32_t u, EdgeList& list) const {
    list.clear();
    if (mesh_.star(u).size() <= state_.strictness.max_valence)
        visit_neighbours(mesh_, u, list.scratch, [&](std::uint32_t v) {
            if (!owns(u, v)) return;
            if (const Fold fold = fold_of(u, v); fold != Fold::kNever) list.add(v, fold);
        });
    price(u, list);
}

double Region::irregularity(const EdgeStar& star, std::uint32_t parent) const {
    const std::uint32_t child = star.u + star.v - parent;
    const auto excess = [](std::size_t is, std::size_t most) {
        const double more = is > most ? double(is - most) : 0;
        return more * more;
    };
    double sum = excess(mesh_.star(parent).size() + mesh_.star(child).size(), 12);
    for (const std::uint32_t w : star.opposite)
        if (mesh_.kind(w) == VertexKind::kInner) sum += excess(6, mesh_.star(w).size());
    return 1 + kIrregular * sum;
}

Region::Outcome Region::attempt(std::uint32_t u, const Option& option, Bucket bucket, float& cost) {
    cost = kNeverCost;
    if (!is_whole() && !star_inside(option.other)) return Outcome::kElsewhere;
    star_.gather(mesh_, u, option.other);
    fetch_around(star_);
    bool relaxed = false;
    if (mesh_.has_wedges() && !state_.paper) {
        if (!Guards::leaves_something(star_)) return Outcome::kWaits;
        relaxed = !guards_.keeps_topology(star_) || fold_rule(mesh_, u, option.other) == Fold::kNever;
    } else if (!guards_.keeps_topology(star_)) {
        return Outcome::kWaits;
    } else {
        relaxed = !state_.paper && fold_rule(mesh_, u, option.other) == Fold::kNever;
    }
    std::uint32_t parent = parent_of(star_, option);
    if (!state_.batch_of.empty()) {
        const std::uint32_t child = star_.u + star_.v - parent;
        if (state_.locks(child)) {
            cost = float(option.candidate.cost);
            return Outcome::kNextBatch;
        }
    }
    const double weight = 0.5 * (double(mesh_.vertex(u).weight) + double(mesh_.vertex(option.other).weight));
    if (mesh_.has_wedges()) wedge_star_.gather(mesh_, star_, parent);
    Deviation deviation;
    const double irregular = state_.batch_of.empty() ? 1 : irregularity(star_, parent);
    // What will be stored decides: the guards look at the rounded place.
    const auto judge = [&](const Float3& rounded, double geometric) {
        const Double3 place = mesh_.work(rounded);
        star_.place_at(place);
        if (!guards_.keeps_shape(star_, place, state_.histories, state_.strictness)) return kNeverCost;
        deviation = deviation_of(star_, place, state_.histories);
        AttributeCost attributes;
        if (mesh_.has_wedges()) attributes = attribute_cost(mesh_, star_, wedge_star_, *state_.wedges, place);
        if (attributes.turns_over && state_.strictness.keep_orientation) return kNeverCost;
        const double d = std::max(double(deviation.largest), attributes.posed);
        // The same dimension as the cost, so that one factor serves every level: area times distance^3.
        const double limit =
            state_.paper ? 0 : state_.options.deviation_limit * d * d * d * state_.mean_star * weight;
        float total = float(std::max(geometric, limit) * (relaxed ? kRelaxed : 1) * irregular);
        return total + float(weight * attributes.cost);
    };
    Float3 rounded = option.fold == Fold::kIntoFirst    ? mesh_.raw_position(u)
                     : option.fold == Fold::kIntoSecond ? mesh_.raw_position(option.other)
                     : state_.options.placement == Placement::kEndpoint
                         ? mesh_.raw_position(nearer_end(star_, option.candidate.place))
                         : mesh_.round(option.candidate.place);
    cost = judge(rounded, option.candidate.cost);
    if (mesh_.has_wedges() && !state_.paper && option.fold == Fold::kAnywhere && bucket_of(cost) <= bucket) {
        // At either end the attributes may be kept so much better that it makes up for the place.
        const EdgeQuadric<double> edge(shape_of(mesh_, u), shape_of(mesh_, option.other), state_.options);
        const Deviation best = deviation;
        Deviation chosen = best;
        Float3 place = rounded;
        bool moved = false;
        // In a batch, the end whose place is kept is the parent.
        const bool keeps_ends = !state_.batch_of.empty();
        for (const double side : {-1.0, 1.0}) {
            const auto end = edge.end(side);
            const std::uint32_t end_vertex = side < 0 ? u : option.other;
            const Float3& there = mesh_.raw_position(end_vertex);
            if (keeps_ends) {
                if (state_.locks(u + option.other - end_vertex)) continue;
                wedge_star_.gather(mesh_, star_, end_vertex);
            }
            const float price = judge(there, edge.price(end.cost));
            moved = true;
            if (price >= cost) continue;
            cost = price;
            place = there;
            if (keeps_ends) parent = end_vertex;
            chosen = deviation;
        }
        rounded = place;
        deviation = chosen;
        if (moved) star_.place_at(mesh_.work(rounded));
        if (keeps_ends) wedge_star_.gather(mesh_, star_, parent);
    }
    if (bucket_of(cost) > bucket) return Outcome::kWaits;
    if (!is_whole()) {
        if (star_.size > room_) return Outcome::kElsewhere;
        // What is not inner is shaped anew, and its neighbours are read for it.
        for (std::size_t i = 0; i < star_.size; ++i)
            for (const std::uint32_t w : {star_.a[i], star_.b[i]})
                if ((relaxed || mesh_.kind(w) != VertexKind::kInner) && !star_inside(w))
                    return Outcome::kElsewhere;
    } else {
        mesh_.make_room(star_.size);
    }
    apply(star_, option, parent, rounded, deviation, relaxed);
    return Outcome::kDone;
}

void Region::fetch_around(const EdgeStar& star) const {
    // What guards, fold and repricing read beyond the star's places.
    fetch_ahead(&state_.histories[star.u]);
    fetch_ahead(&state_.histories[star.v]);
    for (std::size_t i = 0; i < star.size; ++i) {
        const std::uint32_t w = star.a[i];
        fetch_ahead(&state_.histories[w]);
        fetch_ahead(&state_.targets[w]);
        fetch_ahead(&state_.slots[w]);
    }
    for (const std::uint32_t w : star.opposite) {
        mesh_.prefetch_star(w);
        fetch_ahead(&state_.histories[w]);
        fetch_ahead(&state_.targets[w]);
        fetch_ahead(&state_.slots[w]);
    }
}

void Region::prefetch() const {
    // A pipeline over the items to come: each step needs what the one before has fetched.
    const std::uint32_t vertices = mesh_.vertex_count();
    const auto later = [&](std::size_t ahead, const auto& of_vertex, const auto& of_target) {
        const std::uint32_t v = queue_.peek(ahead);
        if (v >= vertices) return;
        of_vertex(v);
        if (const std::uint32_t target = state_.targets[v].vertex; inside(target)) of_target(target);
    };
    const auto nothing = [](std::uint32_t) {};
    const auto neighbours = [&](std::uint32_t v) {
        if (mesh_.star(v).size() > kLargeStar) return;
        for (const std::uint32_t t : mesh_.star(v)) {
            // Of a closed fan, the next corner of every triangle is every neighbour.
            const Triangle& c = mesh_.triangle(t);
            mesh_.prefetch_vertex(c[0] == v ? c[1] : c[1] == v ? c[2] : c[0]);
        }
    };
    if (const std::uint32_t v = queue_.peek(5); v < vertices) {
        mesh_.prefetch_vertex(v);
        fetch_ahead(&state_.targets[v]);
    }
    later(
        4, [&](std::uint32_t v) { mesh_.prefetch_star(v); },
        [&](std::uint32_t v) { mesh_.prefetch_vertex(v); });
    later(
        3, [&](std::uint32_t v) { mesh_.prefetch_triangles(v); },
        [&](std::uint32_t v) { mesh_.prefetch_star(v); });
    later(2, neighbours, [&](std::uint32_t v) { mesh_.prefetch_triangles(v); });
    later(1, nothing, neighbours);
}

void Region::process(std::uint32_t u, Bucket bucket) {
    if (mesh_.kind(u) == VertexKind::kDead) return;
    if (!is_whole() && !star_inside(u)) return put_off(u, bucket);
    // Most often the target is still the best; its price is that of today.
    std::uint32_t tried = kNoVertex;
    float tried_cost = kNeverCost;
    bool next_batch = false;
    Target& target = state_.targets[u];
    if (target.vertex != kNoVertex && mesh_.kind(target.vertex) != VertexKind::kDead) {
        if (const Fold fold = fold_of(u, target.vertex); fold != Fold::kNever) {
            const Option option{target.vertex, fold, evaluate(u, target.vertex, fold)};
            const float cost = float(option.candidate.cost);
            if (bucket_of(cost) <= bucket) {
                tried = option.other;
                const Outcome outcome = attempt(u, option, bucket, tried_cost);
                if (outcome == Outcome::kDone) return;
                if (outcome == Outcome::kElsewhere) return put_off(u, bucket);
                next_batch = outcome == Outcome::kNextBatch;
            } else if (cost <= target.runner_up) {
                target.cost = cost;
                queue_.push(u, bucket_of(cost));
                return;
            }
        }
    }
    list_edges(u, listed_);
    Target wait;
    for (;;) {
        Target next;
        for (std::size_t i = 0; i < listed_.others.size(); ++i)
            next.offer(std::uint32_t(i), listed_.costs[i]);
        if (next.vertex == kNoVertex || bucket_of(next.cost) > bucket) break;
        const std::uint32_t at = next.vertex, v = listed_.others[at];
        const Fold fold = listed_.folds[at];
        float cost = tried_cost;
        if (v != tried) {
            const Outcome outcome = attempt(u, {v, fold, evaluate(u, v, fold)}, bucket, cost);
            if (outcome == Outcome::kDone) return;
            if (outcome == Outcome::kElsewhere) return put_off(u, bucket);
            next_batch |= outcome == Outcome::kNextBatch;
        }
        wait.offer(v, cost);
        listed_.costs[at] = kNeverCost;  // not again
    }
    for (std::size_t i = 0; i < listed_.others.size(); ++i) wait.offer(listed_.others[i], listed_.costs[i]);
    target = wait;
    if (wait.vertex != kNoVertex)
        queue_.push(u, std::max(bucket_of(wait.cost), next_batch ? end_ : Bucket{0}));
}

void Region::process_component(std::uint32_t component, Bucket bucket) {
    if (!state_.components.may_vanish(component)) return;
    if (const Bucket due = bucket_of(vanishing_cost(state_, component)); due > bucket)
        return queue_.push(mesh_.vertex_count() + component, due);
    flush();
    const std::uint32_t most = Components::kMaxVanishing;
    if (state_.components.live_triangles(component) > most) {
        // Not small enough yet; again when all costs have doubled.
        if (bucket + kBucketsPerOctave < bucket_of(kNeverCost))
            queue_.push(mesh_.vertex_count() + component, Bucket(bucket + kBucketsPerOctave));
        return;
    }
    const auto vertices = state_.components.live_vertices(mesh_, component);
    if (!state_.batch_of.empty() &&
        std::any_of(vertices.begin(), vertices.end(), [&](std::uint32_t v) { return state_.locks(v); }))
        return queue_.push(mesh_.vertex_count() + component, std::max(bucket, end_));
    std::vector<std::uint32_t> triangles;
    for (const std::uint32_t v : vertices) {
        const auto star = mesh_.star(v);
        triangles.insert(triangles.end(), star.begin(), star.end());
        queue_.remove(v);
    }
    std::sort(triangles.begin(), triangles.end());
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
    mesh_.vanish(vertices);
    record_.removed.insert(record_.removed.end(), triangles.begin(), triangles.end());
    lost_vertices_ += std::uint32_t(vertices.size());
    lost_triangles_ += std::uint32_t(triangles.size());
    record_.add_vanished(vertices, float(state_.components.reach(component)));
    if (mesh_.has_wedges()) wedge_record_.close();
    state_.components.vanish(component);
    ++vanished_;
}

}  // namespace vsplit::bake
