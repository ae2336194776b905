// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "place_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vsplit {

void PlaceFit::add(const PlaceGuides& g, const Lattice3& place) {
    auto& rows = sums_[static_cast<std::size_t>(g.kind)][g.ring_class];
    const auto take = [](Normal& n, const std::array<double, kPlaceGuides>& x, double y, double weight) {
        for (std::size_t i = 0; i < kPlaceGuides; ++i) {
            for (std::size_t j = 0; j < kPlaceGuides; ++j) n.a[i][j] += weight * x[i] * x[j];
            n.b[i] += weight * x[i] * y;
        }
    };
    std::array<double, 3> offset;
    for (std::size_t a = 0; a < 3; ++a) offset[a] = 16.0 * (double(place[a]) - double(g.from[a]));
    const std::size_t c = g.across;
    double spread = 16;
    for (std::size_t a = 0; a < 3; ++a)
        if (a != c) spread += 4.0 * double(g.spread[a]);
    for (std::size_t a = 0; a < 3; ++a) {
        if (a == c) continue;
        std::array<double, kPlaceGuides> x;
        for (std::size_t i = 0; i < kPlaceGuides; ++i) x[i] = double(g.guide[i][a]);
        take(rows[0], x, offset[a], 1 / (spread * spread));
    }
    if (g.normal[c] == 0) return;
    const auto height = [&](double x, double y, double z) {
        return (x * double(g.normal[0]) + y * double(g.normal[1]) + z * double(g.normal[2])) /
               double(g.normal[c]);
    };
    std::array<double, kPlaceGuides> x;
    for (std::size_t i = 0; i < kPlaceGuides; ++i)
        x[i] = height(double(g.guide[i][0]), double(g.guide[i][1]), double(g.guide[i][2]));
    const double rough = 16 + 4.0 * double(g.roughness);
    take(rows[1], x, height(offset[0], offset[1], offset[2]), 1 / (rough * rough));
}

PlaceWeights PlaceFit::solve() const {
    PlaceWeights out = default_place_weights();
    for (std::size_t kind = 0; kind < kPlaceKinds; ++kind)
        for (std::size_t ring = 0; ring < kPlaceClasses; ++ring)
            for (std::size_t row = 0; row < 2; ++row) {
                Normal n = sums_[kind][ring][row];
                auto& weights = out[kind][ring][row];
                double trace = 0;
                for (std::size_t i = 0; i < kPlaceGuides; ++i) trace += n.a[i][i];
                if (!(trace > 0)) continue;
                for (std::size_t i = 0; i < kPlaceGuides; ++i) {
                    n.a[i][i] += 1e-3 * trace;
                    n.b[i] += 1e-3 * trace * double(weights[i]) / 64;
                }
                // Gauss with pivots; the matrix is positive definite by the ridge.
                std::array<double, kPlaceGuides> x{};
                for (std::size_t i = 0; i < kPlaceGuides; ++i)
                    for (std::size_t j = i + 1; j < kPlaceGuides; ++j) {
                        const double f = n.a[j][i] / n.a[i][i];
                        for (std::size_t k = i; k < kPlaceGuides; ++k) n.a[j][k] -= f * n.a[i][k];
                        n.b[j] -= f * n.b[i];
                    }
                for (std::size_t i = kPlaceGuides; i-- > 0;) {
                    double sum = n.b[i];
                    for (std::size_t j = i + 1; j < kPlaceGuides; ++j) sum -= n.a[i][j] * x[j];
                    x[i] = sum / n.a[i][i];
                    weights[i] =
                        static_cast<std::int8_t>(std::clamp(std::nearbyint(64 * x[i]), -127.0, 127.0));
                }
            }
    return out;
}

}  // namespace vsplit
