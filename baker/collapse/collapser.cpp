// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "collapser.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

namespace vsplit::bake {
namespace {

/// No edge to a hub this large is priced: its star would be walked at each of thousands of collapses around
/// it. It shrinks as they go.
constexpr std::size_t kHub = 1000;

constexpr double kPaperCosine = 0.6;

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Float3 to_float(Double3 p) {
    return {float(p.x), float(p.y), float(p.z)};
}

std::uint32_t nearer_end(const EdgeStar& star, Double3 place) {
    return length2(place - star.pv) < length2(place - star.pu) ? star.v : star.u;
}

/// Visits each neighbour of `v`; those that two triangles name come once where the fan is closed and
/// consistently oriented.
template <class Visit>
void visit_neighbours(const StarMesh& mesh, std::uint32_t v, std::vector<Neighbour>& scratch,
                      const Visit& visit) {
    if (mesh.kind(v) == VertexKind::kInner) {
        for (const std::uint32_t t : mesh.star(v)) {
            const Triangle& c = mesh.triangle(t);
            visit(c[0] == v ? c[1] : c[1] == v ? c[2] : c[0]);
        }
        return;
    }
    neighbours_of(mesh, v, scratch);
    for (const Neighbour& n : scratch) visit(n.vertex);
}

}  // namespace

Collapser::Collapser(const Mesh& mesh, const CollapseOptions& options)
    : options_(options),
      mesh_(mesh),
      components_(mesh_),
      guards_(mesh_),
      queue_(mesh_.vertex_count() + std::size_t{components_.count()}),
      record_(!mesh.weights.empty()),
      // Cost `paper` has no limit on the deviation that would hold back what turns a triangle far.
      strictness_{options.cost == Cost::kPaper ? std::max(options.min_normal_cosine, kPaperCosine)
                                               : options.min_normal_cosine,
                  options.min_quality, 60, true},
      histories_(mesh_.vertex_count()),
      targets_(mesh_.vertex_count()) {
    unused_vertices_ = mesh_.vertex_count() - mesh_.live_vertices();
    if (!mesh.weights.empty()) {
        weights_.reserve(mesh_.vertex_count());
        for (const std::uint32_t v : mesh_.input_vertices()) weights_.push_back(mesh.weights[v]);
    }
    lock(mesh);
    for (std::uint32_t v = 0; v < mesh_.vertex_count() && components_.count() > 1; ++v)
        if (mesh_.kind(v) != VertexKind::kDead && !weights_.empty() && weights_[v] > 1)
            components_.keep(components_.of(v));
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, mesh_.vertex_count(), 4096),
                      [&](const tbb::blocked_range<std::uint32_t>& range) {
                          std::vector<Neighbour> scratch;
                          for (std::uint32_t v = range.begin(); v < range.end(); ++v) {
                              if (mesh_.kind(v) == VertexKind::kDead) continue;
                              rebuild_shape(mesh_, v, options_.boundary_weight, scratch);
                              std::copy_n(mesh_.vertex(v).area, 3, histories_[v].normal);
                              if (!weights_.empty() && std::isfinite(weights_[v]))
                                  mesh_.vertex(v).weight = weights_[v];
                              histories_[v].witness = to_float(mesh_.position(v));
                          }
                      });
    if (options.cost == Cost::kPaper) paper_ = std::make_unique<PaperCost>(mesh_);
}

void Collapser::lock(const Mesh&) {
    std::vector<std::uint32_t> locked;
    const double cosine = std::cos(options_.lock_features_degrees * std::numbers::pi / 180);
    for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v) {
        if (mesh_.kind(v) == VertexKind::kDead) continue;
        bool lock = !weights_.empty() && std::isinf(weights_[v]);
        if (options_.lock_boundary && mesh_.kind(v) != VertexKind::kInner) lock = true;
        if (options_.lock_features_degrees > 0 && !lock) {
            // Two triangles of the star that share an edge at v.
            const auto star = mesh_.star(v);
            for (std::size_t i = 0; i < star.size() && !lock; ++i)
                for (std::size_t j = 0; j < star.size() && !lock; ++j) {
                    const Triangle &a = mesh_.triangle(star[i]), &b = mesh_.triangle(star[j]);
                    const std::uint32_t next = a[0] == v ? a[1] : a[1] == v ? a[2] : a[0];
                    const std::uint32_t previous = b[0] == v ? b[2] : b[1] == v ? b[0] : b[1];
                    if (next != previous) continue;
                    const Double3 na = mesh_.normal(a), nb = mesh_.normal(b);
                    lock = dot(na, nb) < cosine * length(na) * length(nb);
                }
        }
        if (lock) locked.push_back(v);
    }
    for (const std::uint32_t v : locked) {
        mesh_.fix(v);
        components_.keep(components_.of(v));
    }
}

Candidate Collapser::evaluate(std::uint32_t u, std::uint32_t v, Fold fold) const {
    if (paper_) {
        thread_local EdgeStar star;
        star.gather(mesh_, u, v);
        return paper_->evaluate(mesh_, star, fold, options_.placement, double(mesh_.vertex(u).weight),
                                double(mesh_.vertex(v).weight));
    }
    const EdgeQuadric<double> edge(shape_of(mesh_, u), shape_of(mesh_, v), options_);
    const auto placed = fold == Fold::kIntoFirst                    ? edge.end(-1)
                        : fold == Fold::kIntoSecond                 ? edge.end(1)
                        : options_.placement == Placement::kOptimal ? edge.best()
                                                                    : edge.better_end();
    return {edge.middle() + placed.place, edge.price(placed.cost)};
}

void Collapser::price(std::uint32_t u, EdgeList& list) const {
    list.costs.resize(list.others.size());
    const bool optimal = !paper_ && options_.placement == Placement::kOptimal;
    const bool some =
        std::any_of(list.folds.begin(), list.folds.end(), [](Fold fold) { return fold == Fold::kAnywhere; });
    if (optimal && some) price_edges(mesh_, u, list.others, options_, list.costs.data());
    for (std::size_t i = 0; i < list.others.size(); ++i) {
        if (list.folds[i] == Fold::kNever)
            list.costs[i] = kNeverCost;
        else if (!optimal || list.folds[i] != Fold::kAnywhere)
            list.costs[i] = float(evaluate(u, list.others[i], list.folds[i]).cost);
    }
}

Fold Collapser::fold_of(std::uint32_t u, std::uint32_t v) const {
    // A hub's edges would break the limit; pricing them at each collapse near it would be quadratic.
    const bool hub = std::max(mesh_.star(u).size(), mesh_.star(v).size()) > strictness_.max_valence;
    return hub ? Fold::kNever : fold_rule(mesh_, u, v);
}

void Collapser::list_edges(std::uint32_t u, EdgeList& list) const {
    list.clear();
    if (mesh_.star(u).size() <= strictness_.max_valence)
        visit_neighbours(mesh_, u, list.scratch, [&](std::uint32_t v) {
            if (!owns(u, v)) return;
            if (const Fold fold = fold_of(u, v); fold != Fold::kNever) list.add(v, fold);
        });
    price(u, list);
}

bool Collapser::attempt(std::uint32_t u, const Option& option, Bucket bucket, float& cost) {
    cost = kNeverCost;
    star_.gather(mesh_, u, option.other);
    if (!guards_.keeps_topology(star_)) return false;
    // What will be stored decides: the guards look at the rounded place.
    const Float3 rounded = option.fold == Fold::kIntoFirst    ? mesh_.raw_position(u)
                           : option.fold == Fold::kIntoSecond ? mesh_.raw_position(option.other)
                           : options_.placement == Placement::kEndpoint
                               ? mesh_.raw_position(nearer_end(star_, option.candidate.place))
                               : mesh_.round(option.candidate.place);
    const Double3 place = mesh_.work(rounded);
    star_.place_at(place);
    if (!guards_.keeps_shape(star_, place, histories_, strictness_)) return false;
    const Deviation deviation = deviation_of(star_, place, histories_);
    const double d = deviation.largest;
    const double weight = 0.5 * (double(mesh_.vertex(u).weight) + double(mesh_.vertex(option.other).weight));
    // The same dimension as the cost, so that one factor serves every level: area^0.5 times distance^4.
    const double size = double(mesh_.vertex(u).size) + double(mesh_.vertex(option.other).size);
    const double limit = paper_ ? 0 : options_.deviation_limit * d * d * d * d * std::sqrt(size) * weight;
    cost = float(std::max(option.candidate.cost, limit));
    if (BucketQueue::bucket_of(cost) > bucket) return false;
    apply(star_, option, rounded, deviation);
    return true;
}

void Collapser::apply(const EdgeStar& star, const Option& option, Float3 place, const Deviation& deviation) {
    std::uint32_t parent = star.u, child = star.v;
    const bool may_swap = option.fold == Fold::kAnywhere && mesh_.kind(star.u) == mesh_.kind(star.v);
    if (option.fold == Fold::kIntoSecond ||
        (option.fold == Fold::kAnywhere && mesh_.kind(star.v) == VertexKind::kCurve && !may_swap) ||
        (may_swap && mesh_.star(star.v).size() > mesh_.star(star.u).size()))
        std::swap(parent, child);

    const TrianglePart<double> part = update_ring(mesh_, star);
    error_ = std::max(error_, float(deviation.largest));
    const std::uint32_t before = mesh_.live_triangles();
    const Float3 parent_position = mesh_.raw_position(parent);
    const float parent_weight = weights_.empty() ? 1 : weights_[parent];
    mesh_.fold(child, parent, record_.corners_changed, record_.removed);
    record_.add(child, parent, parent_position, parent_weight, error_);
    components_.lose(components_.of(parent), before - mesh_.live_triangles());
    mesh_.set_raw_position(parent, place);

    VertexHistory& history = histories_[parent];
    for (std::size_t i = 0; i < 3; ++i) history.normal[i] += histories_[child].normal[i];
    history.deviation = deviation.at_place;
    history.witness = deviation.witness;
    Vertex& shape = mesh_.vertex(parent);
    shape.weight = 0.5f * (shape.weight + mesh_.vertex(child).weight);
    if (!weights_.empty()) weights_[parent] = 0.5f * (weights_[parent] + weights_[child]);
    if (paper_) paper_->merge(parent, child);
    if (mesh_.kind(parent) == VertexKind::kInner)
        set_part(shape, part);
    else
        rebuild_shape(mesh_, parent, options_.boundary_weight, ring_);

    ring_edges_.clear();
    visit_neighbours(mesh_, parent, ring_, [&](std::uint32_t w) { ring_edges_.add(w, Fold::kNever); });
    for (const std::uint32_t w : ring_edges_.others)
        if (mesh_.kind(w) != VertexKind::kInner && mesh_.star(w).size() <= kHub)
            rebuild_shape(mesh_, w, options_.boundary_weight, ring_);
    queue_.remove(child);
    reprice(parent, child, BucketQueue::bucket_of(float(option.candidate.cost)));
}

void Collapser::reprice(std::uint32_t parent, std::uint32_t child, Bucket now) {
    for (std::size_t i = 0; i < ring_edges_.others.size(); ++i)
        ring_edges_.folds[i] = fold_of(parent, ring_edges_.others[i]);
    price(parent, ring_edges_);
    Target best;
    for (std::size_t i = 0; i < ring_edges_.others.size(); ++i) {
        const std::uint32_t w = ring_edges_.others[i];
        const float cost = ring_edges_.costs[i];
        Target& other = targets_[w];
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
            queue_.push(w, other.cost < kNeverCost ? BucketQueue::bucket_of(other.cost) : now);
    }
    targets_[parent] = best;
    if (best.vertex != kNoVertex)
        queue_.push(parent, BucketQueue::bucket_of(best.cost));
    else
        queue_.remove(parent);
}

void Collapser::prefetch() const {
    // A pipeline over the items to come: each step needs what the one before has fetched.
    const std::uint32_t vertices = mesh_.vertex_count();
    const auto later = [&](std::size_t ahead, const auto& of_vertex, const auto& of_target) {
        const std::uint32_t v = queue_.peek(ahead);
        if (v >= vertices) return;
        of_vertex(v);
        if (const std::uint32_t target = targets_[v].vertex; target < vertices) of_target(target);
    };
    const auto nothing = [](std::uint32_t) {};
    const auto neighbours = [&](std::uint32_t v) {
        fetch_ahead(&histories_[v]);
        if (mesh_.star(v).size() > kLargeStar) return;
        for (const std::uint32_t t : mesh_.star(v)) {
            // Of a closed fan, the next corner of every triangle is every neighbour.
            const Triangle& c = mesh_.triangle(t);
            const std::uint32_t w = c[0] == v ? c[1] : c[1] == v ? c[2] : c[0];
            mesh_.prefetch_vertex(w);
            fetch_ahead(&histories_[w]);
            fetch_ahead(&targets_[w]);
        }
    };
    if (const std::uint32_t v = queue_.peek(20); v < vertices) {
        mesh_.prefetch_vertex(v);
        fetch_ahead(&targets_[v]);
    }
    later(
        15, [&](std::uint32_t v) { mesh_.prefetch_star(v); },
        [&](std::uint32_t v) { mesh_.prefetch_vertex(v); });
    later(
        10, [&](std::uint32_t v) { mesh_.prefetch_triangles(v); },
        [&](std::uint32_t v) { mesh_.prefetch_star(v); });
    later(6, neighbours, [&](std::uint32_t v) { mesh_.prefetch_triangles(v); });
    later(3, nothing, neighbours);
}

void Collapser::process(std::uint32_t u, Bucket bucket) {
    if (mesh_.kind(u) == VertexKind::kDead) return;
    // Most often the target is still the best; its price is that of today.
    std::uint32_t tried = kNoVertex;
    float tried_cost = kNeverCost;
    Target& target = targets_[u];
    if (target.vertex != kNoVertex && mesh_.kind(target.vertex) != VertexKind::kDead) {
        if (const Fold fold = fold_of(u, target.vertex); fold != Fold::kNever) {
            const Option option{target.vertex, fold, evaluate(u, target.vertex, fold)};
            const float cost = float(option.candidate.cost);
            if (BucketQueue::bucket_of(cost) <= bucket) {
                tried = option.other;
                if (attempt(u, option, bucket, tried_cost)) return;
            } else if (cost <= target.runner_up) {
                target.cost = cost;
                queue_.push(u, BucketQueue::bucket_of(cost));
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
        if (next.vertex == kNoVertex || BucketQueue::bucket_of(next.cost) > bucket) break;
        const std::uint32_t at = next.vertex, v = listed_.others[at];
        const Fold fold = listed_.folds[at];
        float cost = tried_cost;
        if (v != tried && attempt(u, {v, fold, evaluate(u, v, fold)}, bucket, cost)) return;
        wait.offer(v, cost);
        listed_.costs[at] = kNeverCost;  // not again
    }
    for (std::size_t i = 0; i < listed_.others.size(); ++i) wait.offer(listed_.others[i], listed_.costs[i]);
    target = wait;
    if (wait.vertex != kNoVertex) queue_.push(u, BucketQueue::bucket_of(wait.cost));
}

void Collapser::process_component(std::uint32_t component, Bucket bucket) {
    if (!components_.may_vanish(component)) return;
    if (components_.live_triangles(component) > Components::kMaxVanishing) {
        // Not small enough yet; again when all costs have doubled.
        if (bucket + 16 < BucketQueue::bucket_of(kNeverCost))
            queue_.push(component_item(component), Bucket(bucket + 16));
        return;
    }
    const auto vertices = components_.live_vertices(mesh_, component);
    std::vector<std::uint32_t> triangles;
    for (const std::uint32_t v : vertices) {
        const auto star = mesh_.star(v);
        triangles.insert(triangles.end(), star.begin(), star.end());
        queue_.remove(v);
    }
    std::sort(triangles.begin(), triangles.end());
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
    mesh_.vanish(vertices, triangles);
    record_.removed.insert(record_.removed.end(), triangles.begin(), triangles.end());
    error_ = std::max(error_, float(components_.reach(component)));
    record_.add_vanished(vertices, error_);
    components_.vanish(component);
    ++vanished_;
}

bool Collapser::run(const Progress& progress) {
    if (mesh_.triangle_count() == 0) return true;
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, mesh_.vertex_count(), 2048),
                      [&](const tbb::blocked_range<std::uint32_t>& range) {
                          EdgeList list;
                          for (std::uint32_t v = range.begin(); v < range.end(); ++v) {
                              if (mesh_.kind(v) == VertexKind::kDead) continue;
                              list_edges(v, list);
                              for (std::size_t i = 0; i < list.others.size(); ++i)
                                  targets_[v].offer(list.others[i], list.costs[i]);
                          }
                      });
    for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v)
        if (targets_[v].vertex != kNoVertex) queue_.push(v, BucketQueue::bucket_of(targets_[v].cost));
    for (std::uint32_t c = 0; c < components_.count(); ++c)
        if (components_.may_vanish(c)) {
            const double reach = components_.reach(c);
            const double limit =
                paper_ ? reach
                       : std::max(options_.deviation_limit, 1.0) * reach * reach * reach * reach * reach;
            queue_.push(component_item(c), BucketQueue::bucket_of(float(limit)));
        }

    const double total = double(mesh_.triangle_count());
    double said = 0;
    // Later passes get past what a guard stopped; the shape of the coarsest levels counts less than that
    // there is one.
    const Strictness passes[] = {strictness_, {0.0, 1e-3, 1000, true}, {-0.2, 1e-5, 2 * kHub, true}};
    for (const Strictness& strictness : passes) {
        strictness_ = strictness;
        if (&strictness != passes) {
            if (mesh_.live_vertices() <= 64) break;
            for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v)
                if (mesh_.kind(v) != VertexKind::kDead) {
                    targets_[v].vertex = kNoVertex;
                    queue_.push(v, 0);
                }
        }
        std::uint32_t item = 0;
        Bucket bucket = 0;
        for (std::uint64_t count = 0; queue_.pop(item, bucket, [&] { prefetch(); }); ++count) {
            if (item < mesh_.vertex_count())
                process(item, bucket);
            else
                process_component(item - mesh_.vertex_count(), bucket);
            if (!progress || (count & 0x3F) != 0) continue;
            if (const double now = seconds_now(); now - said > 0.02) {
                said = now;
                if (!progress("collapse", 1 - double(mesh_.live_triangles()) / total)) return false;
            }
        }
    }
    return true;
}

ProgressiveMesh Collapser::finish(CollapseReport& report) {
    report.collapses = record_.size();
    report.components = components_.count();
    report.unused_vertices = unused_vertices_;
    report.components_vanished = vanished_;
    for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v)
        report.fixed_vertices += mesh_.kind(v) == VertexKind::kFixed;
    report.stopped_by = mesh_.triangle_count() == 0
                            ? "there is nothing to collapse"
                            : "every remaining edge is fixed, or its collapse would change the topology";
    // Only the mesh itself is needed from here on.
    std::vector<VertexHistory>().swap(histories_);
    std::vector<Target>().swap(targets_);
    paper_.reset();
    ProgressiveMesh mesh = record_.finish(mesh_, weights_, nullptr);
    // An error beyond the floats stays the largest of them, so that files hold finite numbers.
    const double unit = 1 / mesh_.scale();
    for (Split& split : mesh.splits)
        split.error = float(std::min(double(split.error) * unit, double(std::numeric_limits<float>::max())));
    return mesh;
}

}  // namespace vsplit::bake
