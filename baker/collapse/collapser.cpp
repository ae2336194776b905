// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "collapser.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

namespace vsplit::bake {
namespace {

constexpr double kPaperCosine = 0.6;

/// Live vertices of a region: few enough for the cache, enough that most have no neighbours elsewhere.
constexpr std::uint32_t kRegionVertices = 1 << 13;

/// A round has an octave of costs, and more if that is less than this share of the vertices.
constexpr std::uint32_t kRounds = 32;

/// Clearly less than what a part's vanishing costs: a quarter of it.
constexpr Bucket kWellBelow = 2 * kBucketsPerOctave;

/// The share of the waiting vertices whose costs a batch spans: small meshes lose their shape sooner.
double batch_quantile(std::uint32_t vertices) {
    constexpr double kSmall = 1000, kLarge = 20000, kLeast = 0.35, kMost = 0.8;
    const double t = std::clamp(std::log(vertices / kSmall) / std::log(kLarge / kSmall), 0.0, 1.0);
    return kLeast + t * (kMost - kLeast);
}

/// What a painted weight multiplies costs by. Cost `quadric` falls with about the third power of how many
/// vertices there are for an area (squared distance, times an area), so that by its cube a weight tells how
/// many times as dense an area stays. Cost `paper` takes it as it is.
float cost_weight(const CollapseOptions& options, float painted) {
    constexpr float kMost = 1e6f;  // its cube is far from where floats end
    if (options.cost == Cost::kPaper) return painted;
    const float w = std::min(painted, kMost);
    return w * w * w;
}

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Float3 to_float(Double3 p) {
    return {float(p.x), float(p.y), float(p.z)};
}

/// Appends the corners of triangles around `v` that lie back on each other.
void find_folds(const StarMesh& mesh, std::uint32_t v, std::vector<std::uint32_t>& found) {
    for (const std::uint32_t t : mesh.star(v))
        for (const std::uint32_t other : mesh.star(v)) {
            const Triangle &a = mesh.triangle(t), &b = mesh.triangle(other);
            const std::uint32_t next = a[0] == v ? a[1] : a[1] == v ? a[2] : a[0];
            const std::uint32_t last = b[0] == v ? b[2] : b[1] == v ? b[0] : b[1];
            if (last == next && is_folded(mesh.normal(a), mesh.normal(b)))
                found.insert(found.end(), {a[0], a[1], a[2], b[0], b[1], b[2]});
        }
}

}  // namespace

CollapseState::CollapseState(StarMesh&& stars, const CollapseOptions& chosen,
                             std::span<const std::uint32_t> part_of)
    : options(chosen),
      mesh(std::move(stars)),
      components(mesh, part_of),
      // Cost `paper` has no limit on the deviation that would hold back what turns a triangle far.
      strictness{chosen.cost == Cost::kPaper ? std::max(chosen.min_normal_cosine, kPaperCosine)
                                             : chosen.min_normal_cosine,
                 chosen.min_quality, 60, true, true},
      histories(mesh.vertex_count()),
      targets(mesh.vertex_count()),
      slots(mesh.vertex_count() + std::size_t{components.count()}, kNoBucket) {}

CollapseState::CollapseState(const Mesh& source, const CollapseOptions& chosen)
    : CollapseState(StarMesh(source), chosen, {}) {}

CollapseState::CollapseState(const PointMesh& points, const Mesh& input, const CollapseOptions& chosen)
    : CollapseState(StarMesh(points.mesh, points.corners, points.groups), chosen, points.part_of) {
    wedges = std::make_unique<WedgeValues>(input, chosen.attribute_weights, chosen.poses);
}

Collapser::Collapser(const Mesh& mesh, const CollapseOptions& options)
    : state_(mesh, options), record_(!mesh.weights.empty()) {
    prepare(mesh);
}

Collapser::Collapser(const PointMesh& points, const Mesh& input, const CollapseOptions& options)
    : state_(points, input, options), input_(&input), record_(!input.weights.empty()) {
    prepare(points.mesh);
}

void Collapser::prepare(const Mesh& mesh) {
    const CollapseOptions& options = state_.options;
    unused_vertices_ = state_.mesh.vertex_count() - state_.mesh.live_vertices();
    if (!mesh.weights.empty()) {
        state_.weights.reserve(state_.mesh.vertex_count());
        for (const std::uint32_t v : state_.mesh.input_vertices()) state_.weights.push_back(mesh.weights[v]);
    }
    if (options.placement == Placement::kEndpoint && options.cost != Cost::kPaper)
        state_.batch_of.assign(state_.mesh.vertex_count(), 0);
    lock();
    for (std::uint32_t v = 0; v < state_.mesh.vertex_count() && state_.components.count() > 1; ++v)
        if (state_.mesh.kind(v) != VertexKind::kDead && !state_.weights.empty() && state_.weights[v] > 1)
            state_.components.keep(state_.components.of(v));
    shape_all();
    for (std::uint32_t v = 0; v < state_.mesh.vertex_count(); ++v)
        state_.area += double(state_.mesh.vertex(v).size) / 3;
    if (options.cost == Cost::kPaper) state_.paper = std::make_unique<PaperCost>(state_.mesh);
}

void Collapser::lock() {
    std::vector<std::uint32_t> locked;
    const double cosine = std::cos(state_.options.lock_features_degrees * std::numbers::pi / 180);
    for (std::uint32_t v = 0; v < state_.mesh.vertex_count(); ++v) {
        if (state_.mesh.kind(v) == VertexKind::kDead) continue;
        bool lock = !state_.weights.empty() && std::isinf(state_.weights[v]);
        const Vertex& vertex = state_.mesh.vertex(v);
        if (state_.options.lock_seams && (vertex.seam || vertex.junction)) lock = true;
        if (state_.options.lock_boundary && vertex.kind != VertexKind::kInner &&
            (!vertex.seam || vertex.open))
            lock = true;
        if (state_.options.lock_features_degrees > 0 && !lock) {
            // Two triangles of the star that share an edge at v.
            const auto star = state_.mesh.star(v);
            for (std::size_t i = 0; i < star.size() && !lock; ++i)
                for (std::size_t j = 0; j < star.size() && !lock; ++j) {
                    const Triangle &a = state_.mesh.triangle(star[i]), &b = state_.mesh.triangle(star[j]);
                    const std::uint32_t next = a[0] == v ? a[1] : a[1] == v ? a[2] : a[0];
                    const std::uint32_t previous = b[0] == v ? b[2] : b[1] == v ? b[0] : b[1];
                    if (next != previous) continue;
                    const Double3 na = state_.mesh.normal(a), nb = state_.mesh.normal(b);
                    lock = dot(na, nb) < cosine * length(na) * length(nb);
                }
        }
        if (lock) locked.push_back(v);
    }
    state_.locked.assign(state_.mesh.vertex_count(), false);
    for (const std::uint32_t v : locked) {
        state_.mesh.fix(v);
        state_.locked[v] = true;
        state_.components.keep(state_.components.of(v));
    }
}

void Collapser::shape_all() {
    StarMesh& mesh = state_.mesh;
    tbb::enumerable_thread_specific<std::vector<std::uint32_t>> folded;
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, mesh.vertex_count(), 4096),
                      [&](const tbb::blocked_range<std::uint32_t>& range) {
                          std::vector<Neighbour> scratch;
                          std::vector<std::uint32_t>& found = folded.local();
                          for (std::uint32_t v = range.begin(); v < range.end(); ++v) {
                              if (mesh.kind(v) == VertexKind::kDead) continue;
                              bool bends = false;
                              rebuild_shape(mesh, v, state_.options.boundary_weight, scratch, &bends);
                              std::copy_n(mesh.vertex(v).area, 3, state_.histories[v].normal);
                              if (!state_.weights.empty() && std::isfinite(state_.weights[v]))
                                  mesh.vertex(v).weight = cost_weight(state_.options, state_.weights[v]);
                              state_.histories[v].witness = to_float(mesh.position(v));
                              // Of two triangles that lie back on each other, one departs much from any
                              // direction.
                              if (bends) find_folds(mesh, v, found);
                          }
                      });
    for (const auto& found : folded)
        for (const std::uint32_t v : found) mesh.vertex(v).folded = 1;
}

void Collapser::price_all() {
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, state_.mesh.vertex_count(), 2048),
                      [&](const tbb::blocked_range<std::uint32_t>& range) {
                          Region region(state_);
                          for (std::uint32_t v = range.begin(); v < range.end(); ++v) {
                              if (state_.mesh.kind(v) == VertexKind::kDead) continue;
                              state_.targets[v] = region.best_of(v);
                              if (state_.targets[v].vertex != kNoVertex)
                                  state_.slots[v] = bucket_of(state_.targets[v].cost);
                          }
                      });
    for (std::uint32_t c = 0; c < state_.components.count(); ++c)
        if (state_.components.may_vanish(c))
            state_.slots[state_.mesh.vertex_count() + c] = bucket_of(vanishing_cost(state_, c));
}

std::pair<Bucket, Bucket> Collapser::next_window(Bucket limit) const {
    std::vector<std::uint32_t> waiting(kBuckets, 0);
    const auto count_one = [&](std::uint32_t item) {
        if (state_.slots[item] != kNoBucket) ++waiting[state_.slots[item]];
    };
    for (const std::uint32_t v : alive_) count_one(v);
    for (std::uint32_t c = state_.mesh.vertex_count(); c < state_.slots.size(); ++c) count_one(c);
    Bucket begin = 0;
    while (begin < limit && waiting[begin] == 0) ++begin;
    std::uint32_t count = 0;
    Bucket end = begin;
    while (end < limit && (end < begin + kBucketsPerOctave || count < state_.mesh.live_vertices() / kRounds))
        count += waiting[end++];
    if (state_.batch_of.empty()) return {begin, end};
    // A batch takes what is cheap now: what it does not reach will have other costs when it is done.
    const double q = batch_quantile(state_.mesh.live_vertices());
    std::uint64_t all = 0;
    for (Bucket b = begin; b < limit; ++b) all += waiting[b];
    std::uint64_t reached = 0;
    for (end = begin; end < limit && double(reached) < q * double(all);) reached += waiting[end++];
    return {begin, end};
}

void Collapser::take(const Region& region) {
    state_.mesh.lose(region.lost_vertices(), region.lost_triangles());
    vanished_ += region.vanished();
}

std::vector<std::uint32_t> Collapser::in_regions(const std::vector<std::uint32_t>& items, std::uint32_t size,
                                                 std::uint32_t shift, Bucket begin, Bucket end) {
    constexpr std::size_t kRoom = std::size_t{3} * kRegionVertices / 2;
    const std::uint32_t vertices = state_.mesh.vertex_count(), regions = vertices / size + 2;
    state_.mesh.make_room(regions * kRoom);
    while (parts_.size() < regions) parts_.push_back(std::make_unique<Region>(state_));
    const auto parts = std::span(parts_).first(regions);
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, regions, 1),
                      [&](const tbb::blocked_range<std::uint32_t>& range) {
                          for (std::uint32_t i = range.begin(); i < range.end(); ++i) {
                              const std::uint32_t low =
                                                      i == 0 ? 0 : std::min(vertices, (i - 1) * size + shift),
                                                  high = std::min(vertices, i * size + shift);
                              parts[i]->open(low, high, begin, end, kRoom);
                              auto v = std::lower_bound(items.begin(), items.end(), low);
                              for (; v != items.end() && *v < high; ++v)
                                  if (state_.slots[*v] < end) parts[i]->line_up(*v);
                              parts[i]->run([] { return true; });
                          }
                      });
    for (Bucket bucket = begin; bucket < end; ++bucket)
        for (const auto& part : parts) {
            const auto& ends = part->ends();
            const std::size_t at = std::size_t(bucket - begin);
            if (at >= ends.size()) continue;
            const std::size_t from = at == 0 ? 0 : ends[at - 1];
            record_.append(part->record(), from, ends[at]);
            if (input_) wedge_record_.append(part->wedge_record(), from, ends[at], state_.wedges->stride());
        }
    std::vector<std::uint32_t> left;
    for (const auto& part : parts) {
        take(*part);
        left.insert(left.end(), part->put_off().begin(), part->put_off().end());
        part->close();
    }
    return left;
}

template <class Between>
bool Collapser::round(Bucket begin, Bucket end, std::uint64_t number, const Between& between) {
    const std::uint32_t vertices = state_.mesh.vertex_count();
    const std::uint32_t regions = state_.mesh.live_vertices() / kRegionVertices;
    if (!whole_) whole_ = std::make_unique<Region>(state_);
    Region& whole = *whole_;
    whole.open(0, vertices, begin, end);
    if (regions < 2) {
        for (const std::uint32_t v : alive_)
            if (state_.slots[v] < end) whole.line_up(v);
    } else {
        // Every other round, regions begin elsewhere; what is put off comes up in regions that begin half a
        // region later, where most of it is not at the border.
        const std::uint32_t size = vertices / regions + 1, half = size / 2;
        auto left = in_regions(alive_, size, number % 2 == 0 ? size : half, begin, end);
        std::sort(left.begin(), left.end());
        left = in_regions(left, size, number % 2 == 0 ? half : size, begin, end);
        for (const std::uint32_t v : left)
            if (state_.slots[v] < end) whole.line_up(v);
    }
    for (std::uint32_t c = vertices; c < state_.slots.size(); ++c)
        if (state_.slots[c] < end) whole.line_up(c);
    if (!whole.run(between)) return false;
    record_.append(whole.record(), 0, whole.record().size());
    if (input_) wedge_record_.append(whole.wedge_record(), 0, whole.record().size(), state_.wedges->stride());
    take(whole);
    whole.close();
    return true;
}

Bucket Collapser::next_component() const {
    const auto first = state_.slots.begin() + std::ptrdiff_t(state_.mesh.vertex_count());
    return first == state_.slots.end() ? kNoBucket : *std::min_element(first, state_.slots.end());
}

void Collapser::retry_all() {
    for (std::uint32_t v = 0; v < state_.mesh.vertex_count(); ++v)
        if (state_.mesh.kind(v) != VertexKind::kDead) {
            state_.targets[v].vertex = kNoVertex;
            state_.slots[v] = 0;
        }
}

template <class Between>
bool Collapser::rounds(Bucket limit, const Between& between) {
    const StarMesh& mesh = state_.mesh;
    for (;; ++rounds_) {
        if (alive_.size() > 2 * std::size_t{mesh.live_vertices()})
            std::erase_if(alive_, [&](std::uint32_t v) { return mesh.kind(v) == VertexKind::kDead; });
        const auto [begin, end] = next_window(limit);
        if (begin == end) return true;
        ++state_.batch;
        state_.mean_star = 12 * state_.area / std::max(mesh.live_triangles(), 1u);
        if (!between() || !round(begin, end, rounds_, between)) return false;
    }
}

bool Collapser::run(const Progress& progress) {
    StarMesh& mesh = state_.mesh;
    if (mesh.triangle_count() == 0) return true;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
        if (mesh.kind(v) != VertexKind::kDead) alive_.push_back(v);
    record_.reserve(mesh.live_vertices(), mesh.triangle_count());
    price_all();
    const double total = double(mesh.triangle_count());
    double said = 0;
    const auto between = [&] {
        if (!progress) return true;
        const double now = seconds_now();
        if (now - said < 0.02) return true;
        said = now;
        return progress("collapse", 1 - double(mesh.live_triangles()) / total);
    };
    // Later passes get past what a guard stopped; the shape of the coarsest levels counts less than that
    // there is one.
    std::vector<Strictness> passes{
        state_.strictness, {0.0, 1e-3, kHub, false, true}, {-0.2, 1e-5, 2 * kHub, false, true}};
    // Parts with seams get stuck in more ways; there the last pass only asks for triangles with an area.
    if (mesh.has_wedges()) passes.push_back({-1, 0, 2 * kHub, false, false});
    if (mesh.has_wedges() && !state_.paper) {
        // What a guard holds back of other parts may be cheaper than a whole part: before one vanishes, the
        // last guards let through what costs clearly less.
        std::uint32_t asked = std::numeric_limits<std::uint32_t>::max();
        for (Bucket due = 0; (due = next_component()) < kBuckets;) {
            if (!rounds(due, between)) return false;
            // Again only when a tenth has gone: each time, all edges are priced anew.
            if (next_component() == due && due > kWellBelow && mesh.live_triangles() < 0.9 * asked) {
                asked = mesh.live_triangles();
                state_.strictness = passes.back();
                retry_all();
                if (!rounds(Bucket(due - kWellBelow), between)) return false;
                state_.strictness = passes.front();
            }
            if (!rounds(Bucket(due + 1), between)) return false;
        }
    }
    for (const Strictness& strictness : passes) {
        state_.strictness = strictness;
        if (&strictness != passes.data()) {
            if (mesh.live_vertices() <= 64) break;
            retry_all();
        }
        if (!rounds(kBuckets, between)) return false;
    }
    return true;
}

ProgressiveMesh Collapser::finish(CollapseReport& report, WedgeExtras& extras) {
    report.collapses = record_.size();
    report.components = state_.components.count();
    report.unused_vertices = unused_vertices_;
    report.components_vanished = vanished_;
    for (std::uint32_t v = 0; v < state_.mesh.vertex_count(); ++v)
        report.fixed_vertices += state_.mesh.kind(v) == VertexKind::kFixed;
    report.stopped_by = state_.mesh.triangle_count() == 0
                            ? "there is nothing to collapse"
                            : "every remaining edge is fixed, or its collapse would change the topology";
    // Only the mesh itself is needed from here on, without its stars.
    whole_.reset();
    parts_.clear();
    state_.mesh.drop_stars();
    std::vector<VertexHistory>().swap(state_.histories);
    std::vector<Target>().swap(state_.targets);
    state_.paper.reset();
    std::vector<std::uint32_t> born;
    ProgressiveMesh mesh =
        input_ ? finish_with_wedges(record_, wedge_record_, state_.mesh, *state_.wedges, *input_,
                                    state_.weights, extras)
               : record_.finish(state_.mesh, state_.weights, extras.wants_births ? &born : nullptr);
    if (!born.empty()) extras.births.assign(state_.mesh.vertex_count(), kNoVertex);
    for (std::uint32_t v = 0; v < born.size(); ++v) extras.births[state_.mesh.input_vertices()[born[v]]] = v;
    // An error beyond the floats stays the largest of them, so that files hold finite numbers.
    const double unit = 1 / state_.mesh.scale();
    for (Split& split : mesh.splits)
        split.error = float(std::min(double(split.error) * unit, double(std::numeric_limits<float>::max())));
    return mesh;
}

}  // namespace vsplit::bake
