// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Floats to whole numbers and back: places on one lattice, attributes by what they mean.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "live_stars.hpp"
#include "vsplit/mesh.hpp"
#include "vsplit/write.hpp"

namespace vsplit {

/// Neighbouring floats as neighbouring numbers: the order of the reals, -0 just below 0.
std::int32_t ordered_number(float value);
float ordered_float(std::int32_t number);

/// The lattice of places: origin + step * n along each axis. A finite float for every n within kLatticeReach.
struct Lattice {
    std::array<double, 3> origin{};
    double step = 0;

    /// Of 2^bits points along the longest side of the box.
    static Lattice of(const Float3& low, const Float3& high, std::uint32_t bits);
    Lattice3 nearest(const Float3& p) const;
    Float3 point(const Lattice3& at) const;
    /// How to come from the lattice's point to a float exactly, and back.
    std::array<std::uint32_t, 3> finer(const Lattice3& at, const Float3& p) const;
    Float3 exact(const Lattice3& at, const std::array<std::uint32_t, 3>& finer) const;
};

/// How the values of one attribute are numbers in the stream.
enum class ValueCoding : std::uint8_t {
    kFloat,       ///< Every float exactly, as ordered_number().
    kGrid,        ///< origin + step * n for each component.
    kWhole,       ///< Whole numbers of 0 and more.
    kShares,      ///< Four parts of 255 that keep their sum.
    kOctahedral,  ///< A unit vector as two numbers on an octahedron.
    kTangent,     ///< The same, then 1 if the handedness is -1.
};

struct ValueRule {
    std::string name;
    Semantic semantic = Semantic::kOther;
    std::uint32_t components = 1;
    ValueCoding coding = ValueCoding::kFloat;
    std::uint32_t bits = 0;            ///< kOctahedral, kTangent.
    std::vector<double> origin, step;  ///< kGrid, for each component.

    /// Numbers in the stream, at most 16.
    std::uint32_t numbers() const;
    /// May number i be guessed as the mean of the neighbours'?
    bool mixes(std::uint32_t i) const;
    void quantise(const float* values, std::int32_t* numbers) const;
    /// Finite for every number unless the coding is kFloat.
    void restore(const std::int32_t* numbers, float* values) const;
};

/// The rule for an attribute with these values (at birth, and after moves).
ValueRule rule_for(const Attribute& attribute, std::span<const float> moved, const WriteOptions& options,
                   double lattice_step);

}  // namespace vsplit
