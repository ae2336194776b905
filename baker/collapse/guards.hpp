// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Which collapses are allowed: those that keep the topology and turn no triangle over.
#pragma once

#include <cstdint>
#include <vector>

#include "edge_star.hpp"
#include "star_mesh.hpp"

namespace vsplit::bake {

/// How an edge may fold.
enum class Fold : std::uint8_t {
    kNever,
    kAnywhere,    ///< The remaining vertex may be put anywhere.
    kIntoFirst,   ///< Only onto the first vertex's place.
    kIntoSecond,  ///< Only onto the second's.
};

/// By the kinds of the ends, and whether the edge is special.
Fold fold_rule(const StarMesh& mesh, std::uint32_t u, std::uint32_t v);

/// Whether a plain mesh's edge that fold_rule() forbids may fold if the link condition holds: at least one
/// end is where sheets meet, and no boundary comes to touch another. Locked vertices are fixed for good.
bool may_untie(const StarMesh& mesh, std::uint32_t u, std::uint32_t v, bool u_locked, bool v_locked);

/// Two triangles of these normals, with a common edge, lie back on each other.
inline bool is_folded(Double3 a, Double3 b) {
    const double along = dot(a, b);
    return along < 0 && along * along > 0.85 * 0.85 * length2(a) * length2(b);
}

/// How strict the guards are; later passes get past what stops the first.
struct Strictness {
    double min_normal_cosine;
    double min_quality;
    std::size_t max_valence;
    bool mend_folds;        ///< A triangle that lay back on another may change only if it does not after.
    bool keep_orientation;  ///< No triangle may oppose the input's normals around two of its corners.
};

class Guards {
  public:
    explicit Guards(const StarMesh& mesh) : mesh_(mesh) {}

    /// From now on only stars whose vertices are `low` to `high` - 1 are asked about.
    void open(std::uint32_t low, std::uint32_t high) {
        low_ = low;
        // Old stamps are below all that come.
        if (stamps_.size() < high - low) stamps_.resize(high - low, 0);
    }

    /// The link condition, and what else collapsing the edge would do to the topology.
    bool keeps_topology(const EdgeStar& star);
    /// Whether anything is left at all, topology or not.
    static bool leaves_something(const EdgeStar& star) { return star.size != 0; }
    /// No triangle flips, folds over or becomes a sliver when the remaining vertex goes where `star` is
    /// placed.
    bool keeps_shape(const EdgeStar& star, Double3 place, const std::vector<VertexHistory>& histories,
                     const Strictness& strictness) const;

  private:
    /// The link condition for few triangles, of which at most two are on the edge.
    static bool links_meet_across(const EdgeStar& star);
    /// Whether triangle `i` of the new fan, of this normal, lies back on one beside it. `keeps_folds`: those
    /// that were there before do not count.
    bool folds_back(const EdgeStar& star, std::size_t i, Double3 normal, bool keeps_folds) const;

    const StarMesh& mesh_;
    std::uint32_t low_ = 0;
    std::vector<std::uint32_t> stamps_;  // of low_ and up
    std::uint32_t stamp_ = 0;
};

}  // namespace vsplit::bake
