// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The part between header and base mesh: what the stream was coded with.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "place_model.hpp"
#include "quantise.hpp"
#include "split_codec.hpp"

namespace vsplit {

struct Details {
    PlaceWeights weights{};
    std::array<double, 3> origin{};  ///< As ProgressiveMesh::origin; finite.
    std::vector<ValueRule> rules;
};

std::vector<std::byte> encode_details(const Details& details);
/// Nothing if the bytes contradict the format; `fault` and `at` (in the bytes) then say why and where.
std::optional<Details> decode_details(std::span<const std::byte> bytes, const char*& fault, std::size_t& at);

StreamShape shape_of(const Details& details, bool weights, bool lossless, std::uint32_t largest_group);

/// Turns splits in whole numbers into those of a progressive mesh.
class MeshOutput {
  public:
    /// Copies of both; `mesh` gets the attributes' names, and must outlive this.
    MeshOutput(ProgressiveMesh& mesh, const Lattice& lattice, const Details& details, bool weights,
               bool lossless, bool groups);

    void reserve(std::size_t vertices, std::size_t triangles, std::size_t splits, std::size_t corners,
                 std::size_t moves);
    /// The base mesh, from the codec's state.
    void add_base(const SplitCodec& codec);
    void add(const SplitPlan& plan, float error);
    /// Whether all places, weights and values so far are finite, and no weight negative: floats that are
    /// stored as they are may be anything.
    bool sound() const { return sound_; }

  private:
    void add_values(const std::int32_t* numbers, bool birth);
    Float3 place(const Lattice3& at, const std::array<std::uint32_t, 3>& finer);

    ProgressiveMesh* mesh_;
    Lattice lattice_;
    std::vector<ValueRule> rules_;
    std::size_t stride_ = 0;
    bool weights_, lossless_, groups_, sound_ = true;
};

}  // namespace vsplit
