// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// One vertex split after the other, to bits and back: encoder and decoder run the same code over the same
// live mesh (formats/spec/pmesh-1.md, section Splits).
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "ask_list.hpp"
#include "ask_priors.hpp"
#include "cut_model.hpp"
#include "live_stars.hpp"
#include "normal_model.hpp"
#include "number_models.hpp"
#include "place_model.hpp"
#include "schedule.hpp"
#include "sweep_order.hpp"

namespace vsplit {

/// A split in whole numbers: what the stream says of it.
struct SplitPlan {
    struct Birth {
        std::uint32_t parent = kNoVertex;
        Lattice3 at{};
        std::array<std::uint32_t, 3>
            finer{};  ///< zigzag of the float's distance from its lattice point's, if lossless.
        std::uint32_t taken_end = 0;  ///< In `taken`.
        /// Encoder: how far from its triangles' planes the place may be, in steps; 0: it must be exact.
        double tolerance = 0;
    };
    struct Move {
        std::uint32_t vertex = 0;
        Lattice3 at{};
        std::array<std::uint32_t, 3> finer{};
        double tolerance = 0;  ///< As of a birth.
    };
    std::vector<Birth> births;
    std::vector<std::uint32_t> taken;  ///< Corners that go over to the births, ascending within each.
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> groups;   ///< Of the new triangles, if the mesh has groups.
    std::vector<std::uint32_t> sources;  ///< Encoder: the place of each new triangle in the plan asked for.
    std::vector<Move> moves;
    std::vector<std::int32_t> birth_values,
        move_values;  ///< Attributes (and weight) of each, if there are any.

    void clear();
};

/// Is it the same triangle, named from another corner on?
inline bool is_rotation(const Triangle& a, const Triangle& b) {
    for (std::size_t k = 0; k < 3; ++k)
        if (a[0] == b[k] && a[1] == b[(k + 1) % 3] && a[2] == b[(k + 2) % 3]) return true;
    return false;
}

/// What of a mesh the stream holds.
struct StreamShape {
    bool lossless = false;
    std::uint32_t group_bits = 0;               ///< Digits of the largest group; 0: no groups.
    std::vector<std::uint32_t> direction_bits;  ///< Per number: of the direction that begins with it, else 0.
    std::vector<bool> mixes;  ///< Per number of a vertex beside its place: may neighbours be averaged?
    std::size_t stride() const { return mixes.size(); }
};

/// The beginning of a sweep: every vertex in turn, those just born too, is asked whether it splits, and again
/// after it did.
struct SweepHead {
    SweepKind kind = SweepKind::kRounds;
    std::uint32_t marked = 0;    ///< Splits found by their first parent, in its order.
    std::uint32_t unmarked = 0;  ///< Splits without parents, after them.
    /// Whether no split of its block precedes it: then the table has told the error, and the decoder too
    /// gives it.
    bool begins_block = false;
    std::uint32_t error_bits = 0;
};

/// How much a stream may still make: what the table announces of its block, less what is made.
struct StreamRoom {
    std::uint64_t vertices = 0, triangles = 0, corners = 0, moves = 0;
};

/// Learns what weights predict best; the encoder's first pass.
class PlaceFit;

class SplitCodec {
  public:
    SplitCodec(const StreamShape& shape, const PlaceWeights& weights);

    LiveStars live;
    std::vector<std::int32_t> values;  ///< stride numbers a vertex, as they are now.
    std::vector<std::uint32_t> groups;
    std::vector<std::array<std::uint32_t, 3>> finer;  ///< One a vertex, if lossless.
    StreamRoom room;                                  ///< Decoder: what is left of the block.
    PlaceFit* fit = nullptr;                          ///< Encoder: told of places that were predicted, of
    std::uint32_t fit_every = 1;  ///< every so manieth split; a NoCoder leaves the others where they are.

    /// What Draco's bytes do not hold of the base mesh. `live` has its vertices; and its triangles too,
    /// unless places and triangles come here (`whole`) and this is a decoder: then so many are added.
    /// `values`, `finer` and `groups` are filled in order. The reason if the stream contradicts itself.
    template <class Coder>
    const char* code_base(Coder& coder, bool whole, std::uint32_t triangles);

    template <class Coder>
    const char* code_head(Coder& coder, SweepHead& head);
    /// The first parent of the next marked split.
    template <class Coder>
    const char* code_mark(Coder& coder, std::uint32_t& primary);
    /// A split as asked for in `wanted` (encoder) or as the stream has it; `out` is what was coded, in the
    /// canonical order. The reason if the stream contradicts itself.
    template <class Coder>
    const char* code_split(Coder& coder, std::uint32_t primary, const SplitPlan& wanted, SplitPlan& out);
    /// Makes the split that was just coded in the live mesh.
    void apply(const SplitPlan& plan);

    const StreamShape& shape() const { return shape_; }
    /// Bytes that the models of a vertex's numbers take.
    static std::uint64_t model_bytes(const StreamShape& shape);

  private:
    static constexpr std::size_t kValueScales = 14;
    struct ValueModel {
        std::array<NumberModel, kValueScales> by_scale;
    };

    template <class Coder>
    const char* code_birth(Coder& coder, std::uint32_t primary, std::size_t index, const SplitPlan& wanted,
                           SplitPlan& out);
    template <class Coder>
    const char* code_parent(Coder& coder, std::uint32_t primary, const SplitPlan& wanted, std::size_t index,
                            SplitPlan& out);
    template <class Coder>
    const char* code_taken(Coder& coder, const SplitPlan& wanted, std::size_t index, SplitPlan& out);
    /// Encoder: is the rough place near enough to the planes around the one asked for? `ring` is the
    /// vertex's, `partner` where the child or the parent will be.
    bool may_be_rough(PlaceGuides& guides, const Lattice3& place, double tolerance, const Ring& ring,
                      const Lattice3& partner);
    template <class Coder>
    void code_birth_place(Coder& coder, const SplitPlan& wanted, std::size_t index, bool moving,
                          SplitPlan& out);
    template <class Coder>
    void code_move(Coder& coder, const SplitPlan& wanted, std::size_t which, std::uint32_t vertex,
                   bool guided, SplitPlan& out);
    template <class Coder>
    const char* code_extra_moves(Coder& coder, const SplitPlan& wanted, SplitPlan& out);
    template <class Coder>
    const char* code_triangles(Coder& coder, const SplitPlan& wanted, SplitPlan& out);
    template <class Coder>
    const char* code_triangle(Coder& coder, const SplitPlan& out, const Triangle& wanted, Triangle& triangle);
    template <class Coder>
    void code_group(Coder& coder, std::uint32_t predicted, std::uint32_t wanted, SplitPlan& out);
    template <class Coder>
    void code_finer(Coder& coder, const std::array<std::uint32_t, 3>& wanted,
                    std::array<std::uint32_t, 3>& out);
    template <class Coder>
    void code_values(Coder& coder, const std::int32_t* wanted, std::vector<std::int32_t>& out);

    template <class Coder>
    bool ask(Coder& coder, std::uint32_t v, bool splits);
    /// Is the place at hand one to predict? A NoCoder skips most.
    template <class Coder>
    bool looks_at() const {
        return Coder::kWrites || Coder::kDecodes || fits_ == 0;
    }
    /// Of a batch.
    template <class Coder>
    bool ask_batch(Coder& coder, std::uint32_t v, bool splits);
    bool is_batch() const { return kind_ != SweepKind::kRounds; }
    /// Triangles of the star that a batch has not changed.
    std::uint32_t unlocked(const LiveVertex& v) const {
        return v.star - (v.touched == sweep_ ? v.locked : 0);
    }
    /// A triangle that the batch has changed has a corner that it bore.
    bool is_locked(const Triangle& t) const { return t[0] >= older_ || t[1] >= older_ || t[2] >= older_; }
    void ask_again(std::uint32_t v) { asks_.add(v < older_ ? live.vertices[v].row : v); }
    /// Has the memory read ahead that asking, and then splitting, needs: at this place of asked_ soon.
    void fetch_ahead(std::uint32_t place) const;
    /// A vertex whose star changes: it is to be asked again, or has no triangle locked yet.
    LiveVertex& touch(std::uint32_t v) {
        LiveVertex& vertex = live.vertices[v];
        vertex.touch(sweep_);
        if (!is_batch()) ask_again(v);
        return vertex;
    }
    /// The run that a set of corners is, if it is one that CutModel codes.
    bool find_cut(std::span<const std::uint32_t> taken, const SplitPlan& wanted, std::uint32_t child,
                  Cut& cut) const;
    void take_run(std::uint32_t child, SplitPlan& out);
    /// The ring around what the parent of the run at hand keeps, without the child.
    void find_parent_ring();
    /// Encoder: is this split a run of its parent's fan and nothing else? Then also which of its triangles
    /// the run implies, in order.
    bool find_plain(std::uint32_t primary, const SplitPlan& wanted, Cut& cut,
                    std::vector<std::uint32_t>& sources) const;
    template <class Coder>
    const char* code_plain(Coder& coder, std::uint32_t primary, const Cut& cut, const SplitPlan& wanted,
                           SplitPlan& out);
    void apply_plain(const SplitPlan& plan);
    template <class Coder>
    void code_implied(Coder& coder, const SplitPlan& wanted, SplitPlan& out);
    /// Of a batch: what a split has changed.
    void count_locked(std::uint32_t first);
    /// Guesses of the directions of a child whose corners were a run.
    void guess_directions(std::uint32_t parent, const Lattice3& child);
    void predict_values(std::uint32_t parent, const SplitPlan& out);
    std::uint32_t birth_id(std::size_t index) const {
        return live.vertex_count() + static_cast<std::uint32_t>(index);
    }

    StreamShape shape_;
    CutModel cut_;
    PlaceModel place_;

    // Sweeps.
    AskList asks_;      ///< Of rounds: places in asked_, then what the sweep bears, by number.
    SweepOrder order_;  ///< Of all vertices,
    std::vector<std::uint32_t> asked_;  ///< as they were at the sweep's beginning.
    SweepKind kind_ = SweepKind::kRounds;
    SymbolModel<2> kinds_;
    std::uint32_t sweep_ = 0, cursor_ = 0;
    std::uint32_t older_ = 0;  ///< Vertices at the sweep's beginning.
    bool sparse_ = false;
    static constexpr int kErrorShift = 15;
    std::uint32_t error_bits_;
    std::int32_t split_size_ = 0;
    std::array<BitModel, 8 * 18 * 10> mark_ = round_answers();
    std::array<BitModel, 10 * 7 * 3 * 10> batch_mark_ = batch_answers();
    NumberModel marked_, unmarked_, error_, gap_;

    // Splits.
    std::array<BitModel, 2> plain_, one_birth_, regular_, implied_, place_moves_, same_move_, same_place_,
        group_stays_;
    std::array<BitModel, 3> moved_;
    std::array<BitModel, 2> twin_moved_, rough_;
    BitModel in_mask_;
    NumberModel births_, twin_, far_, moves_, moved_far_, extra_, corner_birth_, corner_parent_, corner_ring_,
        corner_far_;
    std::array<NumberModel, 3> base_corner_;
    SymbolModel<2> parent_kind_, corner_kind_;
    std::array<NumberModel, 3> finer_;
    std::vector<ValueModel> value_;
    std::vector<NormalModel> normal_;  ///< One for each direction.
    bool guesses_ = false;             ///< At the birth at hand: are directions guessed?

    // The birth at hand.
    Star star_;
    Cut run_;
    bool is_run_ = false, is_plain_ = false;
    std::uint32_t fits_ = 0;  ///< Splits so far, modulo fit_every.
    Ring child_ring_, parent_ring_;
    PlaceGuides guides_;
    std::vector<Triangle> implied_triangles_;
    std::vector<std::uint32_t> implied_groups_, near_, scratch_, touched_;
    std::vector<std::int32_t> predicted_;
    std::vector<std::uint32_t> scales_;
    std::vector<bool> used_;
    Lattice3 last_place_{};
    std::uint32_t last_group_ = 0;
};

}  // namespace vsplit
