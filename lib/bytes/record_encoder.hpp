// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A record in whole numbers, given to the codec in the canonical order.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "base_mesh.hpp"
#include "details.hpp"
#include "schedule.hpp"
#include "split_codec.hpp"

namespace vsplit {

/// How much places that will be replaced may add to the error: an eighth of it, a sixteenth in the coarsest
/// levels, where few bytes are saved.
class Roughness {
  public:
    Roughness() = default;  ///< None.
    explicit Roughness(const ProgressiveMesh& mesh);
    /// Never falls with the error, so that what may be added until a place is replaced is no more before.
    double of(double error) const { return std::min(error / 8, std::max(error / 16, most_fine_)); }
    /// What a file tells of a mesh that is off by `error`.
    float raised(float error) const;

  private:
    double most_fine_ = 0;
    bool none_ = true;
};

/// Every place and value of a progressive mesh as the stream has it.
struct WholeNumbers {
    Lattice lattice;
    Details details;
    bool weights = false, lossless = false;
    std::uint32_t largest_group = 0;
    std::vector<Lattice3> birth_at, move_at;
    std::vector<std::array<std::uint32_t, 3>> birth_finer, move_finer;  ///< Empty unless lossless.
    std::vector<std::int32_t> birth_values, move_values;
    std::size_t stride = 0;
    /// Per vertex: it is born where its only parent was, and the parent moves away with it alone. Then the
    /// two change names, and nothing moves.
    std::vector<bool> traded;
    /// Per move: it changes no number, or is not its vertex's last in the split; the file does not have it.
    std::vector<bool> idle;
    /// Per birth and move: how far from the planes around it, in steps, the place may be until it is
    /// replaced.
    std::vector<double> birth_tolerance, move_tolerance;
    Roughness roughness;  ///< None if no place may be rough.

    StreamShape shape() const { return shape_of(details, weights, lossless, largest_group); }
};
WholeNumbers whole_numbers(const ProgressiveMesh& mesh, const Lattice& lattice, const WriteOptions& options);

/// Walks a record sweep by sweep, keeping track of how the canonical order renumbers it.
class RecordEncoder {
  public:
    RecordEncoder(const ProgressiveMesh& mesh, const WholeNumbers& numbers, const std::vector<Sweep>& sweeps);

    SplitCodec& codec() { return codec_; }
    BaseMesh base() const;
    /// Codes the base mesh: whole, or what Draco leaves.
    template <class Coder>
    void code_base(Coder& coder, bool whole);
    /// Codes all splits; `done` is told of each after it was made, with its sweep's error and, if it was the
    /// sweep's last, the sweep; it says whether it was its block's last. Null, or how record and sweeps
    /// contradict each other.
    template <class Coder>
    [[nodiscard]] const char* code_splits(
        Coder& coder, const std::function<bool(const SplitPlan&, float, const Sweep*)>& done);

  private:
    /// A vertex born in the split being planned.
    struct Born {
        std::uint32_t vertex, parent;      ///< In the record; canonical.
        std::uint32_t traded_move;         ///< The parent's move if the two change names, else kNoVertex.
        std::vector<std::uint32_t> taken;  ///< Canonical triangles, ascending.
    };

    void plan(std::uint32_t split, SplitPlan& out);
    /// Has the memory read ahead that the steps after this one need.
    void fetch(const Sweep& sweep, std::size_t step) const;
    std::uint32_t last_move(std::uint32_t vertex, const Split& from, const Split& to) const;
    void learn_numbers(const SplitPlan& wanted, const SplitPlan& coded);
    Split before(std::uint32_t split) const;

    const ProgressiveMesh& mesh_;
    const WholeNumbers& numbers_;
    const std::vector<Sweep>& sweeps_;
    SplitCodec codec_;
    std::vector<std::uint32_t> vertex_, triangle_;  ///< The record's numbers to the canonical ones.
    std::vector<Born> births_;
    std::vector<std::uint32_t> recorded_triangles_, corners_;
    SplitPlan wanted_, coded_;
};

}  // namespace vsplit
