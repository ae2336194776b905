// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
#include "quadric_cost.hpp"

namespace vsplit::bake {

VSPLIT_CLONES void price_edges(const StarMesh& mesh, std::uint32_t u, std::span<const std::uint32_t> others,
                               const CollapseOptions& options, float* prices) {
    const Shape<double> from = shape_of(mesh, u);
    Shape<Lanes> first{lanes(from.position), lanes(from.weight), {}, lanes(from.area), lanes(from.size)};
    for (std::size_t i = 0; i < 6; ++i) first.quadric[i] = lanes(from.quadric[i]);
    for (std::size_t begin = 0; begin < others.size(); begin += 4) {
        const std::size_t last = others.size() - 1;
        const float* four[4];
        for (std::size_t i = 0; i < 4; ++i)
            four[i] = &mesh.vertex(others[std::min(begin + i, last)]).position.x;
        Lanes rows[4][4];
        for (std::size_t row = 0; row < 4; ++row)
            transpose(four[0] + 4 * row, four[1] + 4 * row, four[2] + 4 * row, four[3] + 4 * row, rows[row]);
        const Shape<Lanes> second{mesh.work(rows[0]),
                                  rows[0][3],
                                  {{rows[1][0], rows[1][1], rows[1][2], rows[1][3], rows[2][0], rows[2][1]}},
                                  {rows[2][2], rows[2][3], rows[3][0]},
                                  rows[3][1]};
        const EdgeQuadric<Lanes> edges(first, second, options);
        const Lanes price = edges.price(edges.best().cost);
        for (std::size_t i = 0; i < 4 && begin + i < others.size(); ++i) prices[begin + i] = float(price[i]);
    }
}

}  // namespace vsplit::bake
