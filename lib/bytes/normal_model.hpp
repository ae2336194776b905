// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Directions on an octahedron (Meyer et al., On Floating-Point Normal Vectors, EGSR 2010): guessed from the
// child's own triangles and from its neighbours' directions, whichever has been better of late, and coded as
// differences on the unfolded octahedron, over its seams too.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "fixed_point.hpp"
#include "number_models.hpp"

namespace vsplit {

/// Whole numbers of any length, each within 2^60.
using Direction = std::array<std::int64_t, 3>;

/// |x| + |y| + |z|.
inline std::int64_t octahedral_size(const Direction& d) {
    return (d[0] < 0 ? -d[0] : d[0]) + (d[1] < 0 ? -d[1] : d[1]) + (d[2] < 0 ? -d[2] : d[2]);
}

class NormalModel {
  public:
    /// Both numbers of a direction are within +-most.
    explicit NormalModel(std::uint32_t bits)
        : most_((1 << (bits - 1)) - 1), size_(16 * std::int64_t{most_}) {}

    /// The direction of two numbers of the file, of size `most`.
    Direction direction(const std::int32_t* numbers) const;
    /// `geometric`: of the triangles around the child, twice their area; `mean`: the sum of the directions
    /// around it. The guess is 0, 0, 1 for what is zero.
    void guess(const Direction& geometric, const Direction& mean);

    template <class Coder>
    void code(Coder& coder, const std::int32_t* wanted, std::int32_t* out) {
        std::array<std::uint32_t, 2> difference{};
        if (!Coder::kDecodes) difference = nearest(wanted);
        std::array<std::int32_t, 2> told;
        std::uint32_t far = 0;  // how far the first number was off
        for (std::size_t i = 0; i < 2; ++i) {
            const auto from = static_cast<std::uint32_t>(at_[i]);
            NumberModel& model = i == 0 ? first_[scale_] : second_[far][scale_];
            const std::uint32_t read = model.code(coder, difference[i]);
            told[i] = static_cast<std::int32_t>(from + ((read >> 1) ^ (0u - (read & 1))));
            far = std::min<std::uint32_t>(static_cast<std::uint32_t>(std::bit_width(read)), kFar - 1);
        }
        unfold(told);
        out[0] = told[0], out[1] = told[1];
        learn(out);
    }

  private:
    static constexpr std::size_t kScales = 24, kClasses = 16, kFar = 4;
    Direction sized(const Direction& d) const;
    void unfold(std::array<std::int32_t, 2>& numbers) const;
    std::array<std::uint32_t, 2> nearest(const std::int32_t* wanted) const;
    void learn(const std::int32_t* numbers);

    std::int32_t most_;
    std::int64_t size_;
    Direction geometric_{}, mean_{};
    std::array<std::int32_t, 2> at_{};
    std::uint32_t scale_ = 0, class_ = 0;
    /// Squared errors of late, of the two guesses, by how far they are apart.
    std::array<std::array<std::int64_t, 2>, kClasses> missed_{};
    std::array<NumberModel, kScales> first_;
    std::array<std::array<NumberModel, kScales>, kFar> second_;
};

}  // namespace vsplit
