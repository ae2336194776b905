// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Where a child is born and where its parent moves: predicted from the ring around it with weights that the
// file brings, then coded as differences, first along the surface and then across it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cut_model.hpp"
#include "live_stars.hpp"
#include "number_models.hpp"

namespace vsplit {

/// What is predicted: the child of a parent that stays, of one that moves, and the parent's move.
enum class PlaceKind : std::uint8_t { kBirth, kBirthMoving, kMove };
inline constexpr std::size_t kPlaceKinds = 3;
inline constexpr std::size_t kPlaceClasses = 7;  ///< Of the ring: 2, 3, ... 6, 7 and more vertices; open.
inline constexpr std::size_t kPlaceGuides = 3;
inline constexpr std::uint32_t kRegularities = 5;  ///< Classes of how regular a ring of six corners is.

/// Weights of the guides in 1/64, along the surface and across it.
using PlaceWeights =
    std::array<std::array<std::array<std::array<std::int8_t, kPlaceGuides>, 2>, kPlaceClasses>, kPlaceKinds>;
/// What a writer starts from.
PlaceWeights default_place_weights();

/// Offsets from the parent's old place in 1/16 that the prediction mixes, and what to expect of its failure.
struct PlaceGuides {
    PlaceKind kind = PlaceKind::kBirth;
    std::uint32_t ring_class = 0;
    Lattice3 from{};  ///< The parent's old place.
    std::array<std::array<std::int32_t, 3>, kPlaceGuides> guide{};
    /// What the weights make of them: along the surface, and the point on the plane that it is coded across.
    std::array<std::int64_t, 3> along{}, beyond{};
    std::array<std::int64_t, 3>
        normal{};            ///< Of the ring's polygon; its largest component is that of `across`.
    std::size_t across = 2;  ///< The axis coded last.
    std::int32_t lean = 0;   ///< By how much the second axis follows the first, in 1/1024.
    /// Of a ring of six corners: how far apart the middles of the three pairs of opposite ones are along each
    /// axis, in 1/6.
    std::array<std::uint32_t, 3> skew{};
    std::array<std::uint32_t, 3> spread{};  ///< Mean distance of ring and prediction along each axis, in 1/4.
    std::int32_t rise =
        0;               ///< log2 of how high the point predicted is over the ring, in half octaves of 1/4.
    bool sinks = false;  ///< That is towards lesser numbers along `across`.
    std::uint32_t roughness = 0;  ///< How far the ring is from flat, along `across`, in 1/4.
};

/// `polygon` is the ring of the vertex to place, in order; `through` tells its first and last (the wings).
struct Ring {
    std::array<std::uint32_t, Star::kLargestFan + 3> vertex{};
    std::uint32_t size = 0;
    bool open = false;
};

class PlaceModel {
  public:
    explicit PlaceModel(const PlaceWeights& weights) : weights_(weights) {}

    /// For a child with this ring (its parent, still at its old place, not in it).
    PlaceGuides guide_birth(const LiveStars& mesh, std::uint32_t parent, const Ring& ring, bool moving) const;
    /// For the parent, whose child is now at `child`; the ring without the child.
    PlaceGuides guide_move(const LiveStars& mesh, std::uint32_t parent, const Ring& ring,
                           const Lattice3& child) const;

    template <class Coder>
    Lattice3 code(Coder& coder, PlaceGuides& guides, const Lattice3& place, bool rough);
    /// Without any guide: the difference to a place nearby.
    template <class Coder>
    Lattice3 code_free(Coder& coder, const Lattice3& near, const Lattice3& place);

  private:
    /// Scales whose digit counts have models of their own.
    static constexpr std::size_t kScaleRows = 15;
    struct Around;
    static void look_around(const LiveStars& mesh, const Ring& ring, const Lattice3& from, Around& around);
    void measure(const Around& around, std::uint32_t count, PlaceGuides& guides) const;

    PlaceWeights weights_;
    using Across = ResidualModel<kScaleRows, 4>;
    using First = ResidualModel<kScaleRows, 3 + kRegularities>;
    using Second = ResidualModel<kScaleRows, 3 + 3 * kRegularities>;
    First first_[kPlaceKinds] = {First(kAlongPriors[0]), First(kAlongPriors[1]), First(kAlongPriors[2])};
    Second second_[kPlaceKinds] = {Second(kAlongPriors[0]), Second(kAlongPriors[1]), Second(kAlongPriors[2])};
    Across third_[kPlaceKinds] = {Across(kAcrossPriors[0]), Across(kAcrossPriors[1]),
                                  Across(kAcrossPriors[2])};
    ResidualModel<1> free_;
};

inline std::int32_t within_reach(std::int64_t value) {
    return static_cast<std::int32_t>(value < -kLatticeReach  ? -kLatticeReach
                                     : value > kLatticeReach ? kLatticeReach
                                                             : value);
}

/// Classes of a difference against the scale that was expected of it, for those that follow it.
inline std::uint32_t departure_class(std::int32_t difference, std::uint32_t scale) {
    const std::uint32_t class_now =
        half_octave(static_cast<std::uint64_t>(4 * std::abs(std::int64_t{difference})));
    return class_now + 2 < scale ? 0 : class_now > scale + 1 ? 2 : 1;
}

/// How regular a ring of six corners is: the middles of opposite ones against the ring's extent.
inline std::uint32_t regularity_class(std::uint32_t skew, std::uint32_t spread) {
    const auto log = [](std::uint32_t x) { return static_cast<std::int32_t>(half_octave(x)); };
    return static_cast<std::uint32_t>(
        std::clamp((log(skew) - log(spread) + 5) >> 1, 0, static_cast<std::int32_t>(kRegularities) - 1));
}

/// What the sign of a difference along the surface goes by: how far the prediction is from the parent, and
/// from guide 1 (the middle between the wings) and on which side, both against the extent of the ring.
inline std::uint32_t side_class(std::int64_t from_parent, std::int64_t from_wings, std::uint32_t scale) {
    const auto size = [&](std::int64_t x) {
        const auto log = half_octave(static_cast<std::uint64_t>(x < 0 ? -x : x) >> 2);
        return static_cast<std::int32_t>(log) - static_cast<std::int32_t>(scale);
    };
    const std::int32_t far = std::clamp((size(from_parent) + 6) >> 1, 0, 4),
                       off = std::clamp((size(from_wings) + 4) >> 1, 0, 2);
    const bool opposite = (from_parent < 0) != (from_wings < 0);
    return static_cast<std::uint32_t>(6 * far + 2 * off) + std::uint32_t{opposite};
}

/// By how many digits a rough place is coarser along the surface: to an eighth of the ring's extent where it
/// is flat, to a thirty-second where it bends, not at all where it is creased.
inline std::uint32_t rough_shift(std::uint32_t scale, std::uint32_t bent) {
    const std::uint32_t digits = scale > 0 ? (scale - 1) / 2 : 0, keep = bent == 0 ? 4u : 6u;
    return bent == 2 || digits <= keep ? 0 : digits - keep;
}

template <class Coder>
Lattice3 PlaceModel::code(Coder& coder, PlaceGuides& g, const Lattice3& place, bool rough) {
    if (!Coder::kWrites && !Coder::kDecodes && !rough) return place;
    const std::size_t c = g.across, a = c == 0 ? 1 : 0, b = c == 2 ? 1 : 2,
                      kind = static_cast<std::size_t>(g.kind);
    const auto &along = g.along, &across = g.beyond;
    Lattice3 out{};
    const auto predicted = [&](std::size_t axis) {
        return within_reach(g.from[axis] + ((along[axis] + 8) >> 4));
    };
    const std::uint32_t scale_a = half_octave(g.spread[a]), scale_b = half_octave(g.spread[b]);
    const std::uint32_t flatness = std::min(half_octave(g.roughness), 55u);
    const std::uint32_t mean_scale = (scale_a + scale_b) / 2;
    const std::uint32_t bent = flatness + 6 < mean_scale ? 0 : flatness + 2 < mean_scale ? 1 : 2;
    const std::uint32_t shift_a = rough ? rough_shift(scale_a, bent) : 0,
                        shift_b = rough ? rough_shift(scale_b, bent) : 0;
    const auto in_steps = [](std::int32_t difference, std::uint32_t shift) {
        return shift == 0 ? difference : (difference + (1 << (shift - 1))) >> shift;
    };
    // A vertex of six neighbours is often of a regular part of the mesh, and where it is expected.
    const bool six = g.ring_class == 3;
    const std::uint32_t regular =
        six ? regularity_class(g.skew[a] + g.skew[b], g.spread[a] + g.spread[b]) : 0;
    const auto side_of = [&](std::size_t axis, std::uint32_t scale) {
        return side_class(along[axis], along[axis] - g.guide[1][axis], scale);
    };
    const std::int32_t at_a = predicted(a), unleant_b = predicted(b);
    const std::int32_t step_a =
        first_[kind].code(coder, scale_a - 2 * shift_a, six ? 3 + regular : bent,
                          in_steps(place[a] - at_a, shift_a), side_of(a, scale_a), along[a] < 0);
    out[a] = within_reach(at_a + std::int64_t{step_a} * (1 << shift_a));
    const std::uint32_t missed_a = departure_class(step_a, scale_a - 2 * shift_a);
    // Where the ring leans, the second axis goes with the first.
    const std::int32_t at_b =
        within_reach(unleant_b + ((std::int64_t{g.lean} * (out[a] - at_a) + 512) >> 10));
    const std::int32_t step_b =
        second_[kind].code(coder, scale_b - 2 * shift_b, missed_a + (six ? 3 + 3 * regular : 0),
                           in_steps(place[b] - at_b, shift_b), side_of(b, scale_b), along[b] < 0);
    out[b] = within_reach(at_b + std::int64_t{step_b} * (1 << shift_b));
    const std::uint32_t missed = std::max(missed_a, departure_class(step_b, scale_b - 2 * shift_b));
    // Along the plane of the ring, from the point that the second row of weights predicts.
    const auto slide = [&](std::int64_t along_a, std::int64_t along_b) -> std::int64_t {
        if (g.normal[c] == 0) return 0;
        const std::int64_t side = along_a * g.normal[a] + along_b * g.normal[b];
        const std::int64_t sign = g.normal[c] >> 63;  // either is as likely: no branch
        return rounded_quotient((side ^ sign) - sign, (g.normal[c] ^ sign) - sign);
    };
    const std::int64_t slid = slide(16 * (std::int64_t{out[a]} - g.from[a]) - across[a],
                                    16 * (std::int64_t{out[b]} - g.from[b]) - across[b]);
    const std::int32_t at_c = within_reach(g.from[c] + ((across[c] - slid + 8) >> 4));
    // Predictions go too far as a rule, or not far enough.
    const std::int32_t height = std::clamp(g.rise - static_cast<std::int32_t>(mean_scale) + 11, 0, 11);
    const std::uint32_t side = 2 * static_cast<std::uint32_t>(height) + std::uint32_t{g.sinks};
    std::int64_t wanted_c = place[c];
    if (!Coder::kDecodes && rough)  // as high over the plane as the place asked for
        wanted_c -= slide(std::int64_t{out[a]} - place[a], std::int64_t{out[b]} - place[b]);
    out[c] = within_reach(std::int64_t{at_c} +
                          third_[kind].code(coder, flatness, missed, within_reach(wanted_c) - at_c, side));
    return out;
}

template <class Coder>
Lattice3 PlaceModel::code_free(Coder& coder, const Lattice3& near, const Lattice3& place) {
    Lattice3 out{};
    for (std::size_t i = 0; i < 3; ++i)
        out[i] = within_reach(std::int64_t{near[i]} + free_.code(coder, 0, 0, place[i] - near[i]));
    return out;
}

}  // namespace vsplit
