// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The writer's side of prediction: which weights of the guides come closest to the places of a mesh. Floats
// are allowed here, because the weights travel in the file.
#pragma once

#include <array>

#include "place_model.hpp"

namespace vsplit {

class PlaceFit {
  public:
    void add(const PlaceGuides& guides, const Lattice3& place);
    /// Least squares, each sample relative to the scale expected of it, drawn a little to the defaults.
    PlaceWeights solve() const;

  private:
    struct Normal {
        std::array<std::array<double, kPlaceGuides>, kPlaceGuides> a{};
        std::array<double, kPlaceGuides> b{};
    };
    std::array<std::array<std::array<Normal, 2>, kPlaceClasses>, kPlaceKinds> sums_{};
};

}  // namespace vsplit
