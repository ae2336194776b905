// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The loop: cheapest edge first, guarded, recorded; within a range of vertices, so that several ranges may be
// worked on at once.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "components.hpp"
#include "deviation.hpp"
#include "guards.hpp"
#include "paper_cost.hpp"
#include "quadric_cost.hpp"
#include "queue.hpp"
#include "record.hpp"
#include "star_mesh.hpp"
#include "vsplit/bake/collapse.hpp"
#include "wedge_record.hpp"
#include "wedges.hpp"

namespace vsplit::bake {

/// Around a hub as large as this nothing is shaped anew: its star would be walked at each of thousands of
/// collapses. It shrinks as they go.
inline constexpr std::size_t kHub = 1000;

inline constexpr float kNeverCost = std::numeric_limits<float>::infinity();

/// The edge for which a vertex waits, and its cost when it was last looked at.
struct Target {
    std::uint32_t vertex = kNoVertex;
    float cost = kNeverCost;
    /// The cost of the next best: above it, all edges have to be looked at again.
    float runner_up = kNeverCost;
    void offer(std::uint32_t other, float price) {
        if (price < cost || (price == cost && price < kNeverCost && other < vertex))
            *this = {other, price, cost};
        else
            runner_up = std::min(runner_up, price);
    }
};

/// What all regions work on.
struct CollapseState {
    CollapseState(const Mesh& mesh, const CollapseOptions& options);
    /// Of a mesh with attributes or groups; `input` is the one that `points` was made of.
    CollapseState(StarMesh&& stars, const CollapseOptions& options, std::span<const std::uint32_t> part_of);
    CollapseState(const PointMesh& points, const Mesh& input, const CollapseOptions& options);

    const CollapseOptions& options;
    StarMesh mesh;
    Components components;
    std::unique_ptr<WedgeValues> wedges;  ///< Of a mesh with wedges.
    std::unique_ptr<PaperCost> paper;
    Strictness strictness;
    double area = 0;       ///< Of all triangles of the input; working units.
    double mean_star = 0;  ///< Area around an edge of the mesh as it is now, if triangles were all alike.
    std::vector<VertexHistory> histories;
    std::vector<bool> locked;     ///< Never move nor go.
    std::vector<float> weights;   ///< Empty: none painted.
    std::vector<Target> targets;  ///< kNoVertex: list all again.
    std::vector<Bucket> slots;    ///< Where each vertex waits, then each component.
    /// With placement at endpoints, rounds are batches, in which no triangle changes twice: a vertex whose
    /// star has changed may not go until the next. So splits of one batch do not depend on each other, and a
    /// file need not tell their order. Per vertex, the last batch that changed its star; empty: no batches.
    std::vector<std::uint32_t> batch_of;
    std::uint32_t batch = 0;
    bool locks(std::uint32_t v) const { return batch_of[v] == batch; }
};

/// What it costs now that a component vanishes, working units.
float vanishing_cost(const CollapseState& state, std::uint32_t component);

/// Collapses the edges of a range of vertices. Touches and reads nothing beyond, so that regions that share
/// no vertex may run at once: a vertex whose edge has neighbours elsewhere is put off.
class Region {
  public:
    explicit Region(CollapseState& state)
        : state_(state), mesh_(state.mesh), guards_(state.mesh), queue_(state.slots), record_(false) {}

    /// Gets ready for vertices `low` to `high` - 1 and costs of buckets `begin` to `end` - 1.
    /// May take `room` entries of the mesh's arena, which are there; the whole mesh makes its own room.
    void open(std::uint32_t low, std::uint32_t high, Bucket begin, Bucket end, std::size_t room = 0);
    /// Frees the record.
    void close();
    /// Lines up an item of the range that waits within the window.
    void line_up(std::uint32_t item) { queue_.line_up(item); }
    /// Collapses until nothing in the window waits. `between` is called now and then, and stops if false.
    template <class Between>
    bool run(const Between& between);

    /// Items that were put off, with neighbours elsewhere.
    const std::vector<std::uint32_t>& put_off() const { return put_off_; }
    const Record& record() const { return record_; }
    const WedgeRecord& wedge_record() const { return wedge_record_; }
    /// Where in the record the steps of each bucket of the window end.
    const std::vector<std::size_t>& ends() const { return ends_; }
    std::uint32_t lost_vertices() const { return lost_vertices_; }
    std::uint32_t lost_triangles() const { return lost_triangles_; }
    std::uint64_t vanished() const { return vanished_; }

    /// The best of the edges that `u` owns; changes nothing.
    Target best_of(std::uint32_t u);

  private:
    /// An edge of the vertex at hand, placed and priced.
    struct Option {
        std::uint32_t other;
        Fold fold;
        Candidate candidate;
    };

    /// Edges of one vertex with their costs.
    struct EdgeList {
        std::vector<std::uint32_t> others;
        std::vector<Fold> folds;
        std::vector<float> costs;
        std::vector<Neighbour> scratch;
        void clear() {
            others.clear();
            folds.clear();
        }
        void add(std::uint32_t other, Fold fold) {
            others.push_back(other);
            folds.push_back(fold);
        }
    };

    enum class Outcome : std::uint8_t { kDone, kWaits, kElsewhere, kNextBatch };

    /// Each edge is priced once: for the end that comes first, which waits in the queue with it.
    static bool owns(std::uint32_t u, std::uint32_t v) { return u < v; }
    bool is_whole() const { return low_ == 0 && high_ == mesh_.vertex_count(); }
    bool inside(std::uint32_t v) const { return v - low_ < high_ - low_; }
    /// All neighbours of `v` are in the range.
    bool star_inside(std::uint32_t v) const;

    Candidate evaluate(std::uint32_t u, std::uint32_t v, Fold fold) const;
    /// How an edge may fold as strictly as things are now.
    Fold fold_of(std::uint32_t u, std::uint32_t v) const;
    /// How one may that the rules of topology and seams forbid: holes close, seams end. Of plain meshes only
    /// where may_untie().
    Fold relaxed_fold(std::uint32_t u, std::uint32_t v) const;
    /// Prices all edges of the list, which are those of `u`.
    void price(std::uint32_t u, EdgeList& list) const;
    /// The edges that `u` owns, with their costs.
    void list_edges(std::uint32_t u, EdgeList& list) const;
    void prefetch() const;
    void fetch_around(const EdgeStar& star) const;
    void process(std::uint32_t u, Bucket bucket);
    void process_component(std::uint32_t component, Bucket bucket);
    /// kWaits sets `cost` to what it has to wait for (infinity: never as things are); kNextBatch to what it
    /// costs.
    Outcome attempt(std::uint32_t u, const Option& option, Bucket bucket, float& cost);
    /// What the valences that it makes count on top of a collapse's cost, as a factor from 1 on.
    double irregularity(const EdgeStar& star, std::uint32_t parent) const;
    /// Which end stays.
    std::uint32_t parent_of(const EdgeStar& star, const Option& option) const;
    void apply(const EdgeStar& star, const Option& option, std::uint32_t parent, Float3 place,
               const Deviation& deviation, bool relaxed);
    /// After a relaxed fold: the kinds of vertices are others now.
    void classify_around(const EdgeStar& star);
    /// After a collapse: prices the new vertex's edges, and offers them to those neighbours who own them.
    void fold_wedges(const EdgeStar& star, Double3 place);
    void reprice(std::uint32_t parent, std::uint32_t child, Bucket now);
    void put_off(std::uint32_t u, Bucket bucket);
    void lose_of(std::uint32_t component, std::uint32_t triangles);
    void flush();

    CollapseState& state_;
    StarMesh& mesh_;
    Guards guards_;
    BucketQueue queue_;
    Record record_;
    WedgeRecord wedge_record_;
    std::uint32_t low_ = 0, high_ = 0;
    Bucket begin_ = 0, end_ = 0;
    std::size_t room_ = 0;
    std::vector<std::uint32_t> put_off_;
    std::vector<std::size_t> ends_;
    std::uint32_t lost_vertices_ = 0, lost_triangles_ = 0;
    std::uint32_t losing_ = kNoVertex, losing_triangles_ = 0;  // a component, and what it has not been told
    std::uint64_t vanished_ = 0;

    EdgeList listed_;
    std::vector<Neighbour> ring_;
    EdgeStar star_;
    WedgeStar wedge_star_;
    StarMesh::ClassifyScratch classify_scratch_;
    EdgeList ring_edges_;  // of the new vertex
};

template <class Between>
bool Region::run(const Between& between) {
    std::uint32_t item = 0;
    Bucket bucket = begin_, reached = begin_;
    for (std::uint64_t count = 0; queue_.pop(item, bucket, [&] { prefetch(); }); ++count) {
        for (; reached < bucket; ++reached) ends_.push_back(record_.size());
        if (item < mesh_.vertex_count())
            process(item, bucket);
        else
            process_component(item - mesh_.vertex_count(), bucket);
        if ((count & 0xFFF) == 0xFFF && !between()) return false;
    }
    for (; reached < end_; ++reached) ends_.push_back(record_.size());
    flush();
    return true;
}

}  // namespace vsplit::bake
