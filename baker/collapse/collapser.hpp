// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The loop: cheapest edge first, guarded, recorded.
#pragma once

#include <limits>
#include <memory>
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

namespace vsplit::bake {

class Collapser {
  public:
    Collapser(const Mesh& mesh, const CollapseOptions& options);

    /// False if `progress` asked to stop.
    bool run(const Progress& progress);

    /// After run(): the record as a progressive mesh; errors in object units, not yet calibrated.
    ProgressiveMesh finish(CollapseReport& report);

  private:
    using Bucket = BucketQueue::Bucket;
    static constexpr float kNeverCost = std::numeric_limits<float>::infinity();

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

    /// The edge for which a vertex waits, and its cost when it was last looked at.
    struct Target {
        std::uint32_t vertex = kNoVertex;
        float cost = kNeverCost;
        float runner_up =
            kNeverCost;  ///< The cost of the next best: above it, all edges have to be looked at again.
        void offer(std::uint32_t other, float price) {
            if (price < cost || (price == cost && price < kNeverCost && other < vertex))
                *this = {other, price, cost};
            else
                runner_up = std::min(runner_up, price);
        }
    };

    void lock(const Mesh& mesh);
    Candidate evaluate(std::uint32_t u, std::uint32_t v, Fold fold) const;
    /// Each edge is priced once: for the end that comes first, which waits in the queue with it.
    static bool owns(std::uint32_t u, std::uint32_t v) { return u < v; }
    /// How an edge may fold as strictly as things are now.
    Fold fold_of(std::uint32_t u, std::uint32_t v) const;
    /// Prices all edges of the list, which are those of `u`.
    void price(std::uint32_t u, EdgeList& list) const;
    /// The edges that `u` owns, with their costs.
    void list_edges(std::uint32_t u, EdgeList& list) const;
    void prefetch() const;
    void process(std::uint32_t u, Bucket bucket);
    void process_component(std::uint32_t component, Bucket bucket);
    /// True if it was done; false sets `cost` to what it has to wait for (infinity: never as things are).
    bool attempt(std::uint32_t u, const Option& option, Bucket bucket, float& cost);
    void apply(const EdgeStar& star, const Option& option, Float3 place, const Deviation& deviation);
    /// After a collapse: prices the new vertex's edges, and offers them to those neighbours who own them.
    void reprice(std::uint32_t parent, std::uint32_t child, Bucket now);
    std::uint32_t component_item(std::uint32_t component) const { return mesh_.vertex_count() + component; }

    const CollapseOptions& options_;
    StarMesh mesh_;
    Components components_;
    Guards guards_;
    BucketQueue queue_;
    Record record_;
    std::unique_ptr<PaperCost> paper_;
    Strictness strictness_;
    std::vector<VertexHistory> histories_;
    std::vector<float> weights_;   // empty: none painted
    std::vector<Target> targets_;  // kNoVertex: list all again
    float error_ = 0;              // the largest so far, working units
    std::uint64_t vanished_ = 0;
    std::uint64_t unused_vertices_ = 0;

    EdgeList listed_;
    std::vector<Neighbour> ring_;
    EdgeStar star_;
    EdgeList ring_edges_;  // of the new vertex
};

}  // namespace vsplit::bake
