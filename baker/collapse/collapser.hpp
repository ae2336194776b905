// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The loop: cheapest edge first, guarded, recorded.
#pragma once

#include <memory>
#include <vector>

#include "components.hpp"
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

    /// An edge of the vertex at hand, placed and priced.
    struct Option {
        std::uint32_t other;
        Fold fold;
        Candidate candidate;
    };

    void lock(const Mesh& mesh);
    Candidate evaluate(std::uint32_t u, std::uint32_t v, Fold fold) const;
    void list_options(std::uint32_t u);
    float cheapest(std::uint32_t u);
    void prefetch() const;
    void process(std::uint32_t u, Bucket bucket);
    void process_component(std::uint32_t component, Bucket bucket);
    /// True if it was done; false sets `cost` to what it has to wait for (infinity: never as things are).
    bool attempt(std::uint32_t u, const Option& option, Bucket bucket, float& cost);
    double deviation(const EdgeStar& star, Double3 place, Float3& witness, float& place_deviation) const;
    void apply(const EdgeStar& star, const Option& option, Float3 place, Float3 witness, float place_deviation, float error);
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
    std::vector<float> weights_;          // empty: none painted
    std::vector<std::uint32_t> targets_;  // cheapest edge, or kNoVertex: list all again
    float error_ = 0;                     // the largest so far, working units
    std::uint64_t vanished_ = 0;

    std::vector<Option> listed_;
    std::vector<Neighbour> ring_;
    EdgeStar star_;
    std::vector<std::uint32_t> touched_;
};

}  // namespace vsplit::bake
