// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Cost `paper`, formula by formula, on triangles worked out by hand.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "../../baker/collapse/paper_cost.hpp"

using namespace vsplit;
using namespace vsplit::bake;

namespace {

const Double3 kUp{0, 0, 1}, kDown{0, 0, -1}, kSide{1, 0, 0}, kBack{0, 1, 0};

double curvature(std::initializer_list<Double3> at_end, std::initializer_list<Double3> on_edge) {
    return edge_curvature({at_end.begin(), at_end.size()}, {on_edge.begin(), on_edge.size()});
}

/// A roof with a wall, lengths in sixteenths so that the working scale is 1:
///
///         p (0,3,0)                 triangles on the edge u v:  (u v p) (v u q), flat, normal +z
///       / | \  .                    at u:  (u p r) (u r q), the wall x = 0, normal -x
///    r /  u---v---s                 at v:  (v s p) (v q s), flat, normal +z
///       \ | /  .                    all of area 6, but for those with s
///         q (0,-3,0)                u (0,0,0)  v (4,0,0)  s (8,0,0)  r (0,0,-4), below u
struct Roof {
    static constexpr float k = 1.0f / 16;
    Mesh mesh{{{0, 0, 0}, {4 * k, 0, 0}, {0, 3 * k, 0}, {0, -3 * k, 0}, {0, 0, -4 * k}, {8 * k, 0, 0}},
              {{0, 1, 2}, {1, 0, 3}, {0, 2, 4}, {0, 4, 3}, {1, 5, 2}, {1, 3, 5}},
              {}};
    StarMesh star_mesh{mesh};
    PaperCost cost{star_mesh};
    EdgeStar star;

    Roof() { star.gather(star_mesh, number(0), number(1)); }
    std::uint32_t number(std::uint32_t input) const {
        const auto& numbers = star_mesh.input_vertices();
        return std::uint32_t(std::find(numbers.begin(), numbers.end(), input) - numbers.begin());
    }
    /// A place in sixteenths, as the stage sees it.
    Double3 at(float x, float y, float z) const { return star_mesh.work({x * k, y * k, z * k}); }
};

double root(double x) {
    return std::sqrt(x);
}

}  // namespace

TEST_CASE("Paper, formula 6: regularity is (l1 + l2 - l3) / l2, edges ascending") {
    REQUIRE(regularity({0, 0, 0}, {1, 0, 0}, {0.5, root(3) / 2, 0}) == Approx(1));
    REQUIRE(regularity({0, 0, 0}, {3, 0, 0}, {0, 4, 0}) == Approx(0.5));          // (3 + 4 - 5) / 4
    REQUIRE(regularity({0, 4, 0}, {0, 0, 0}, {3, 0, 0}) == Approx(0.5));          // whatever the order
    REQUIRE(regularity({0, 0, 0}, {0, 3, 0}, {0, 0, 4}) == Approx(0.5));          // wherever
    REQUIRE(regularity({0, 0, 0}, {30, 0, 0}, {0, 40, 0}) == Approx(0.5));        // whatever the size
    REQUIRE(regularity({0, 0, 0}, {1, 0, 0}, {0, 1, 0}) == Approx(2 - root(2)));  // (1 + 1 - sqrt 2) / 1
    REQUIRE(regularity({0, 0, 0}, {5, 0, 0}, {5, 12, 0}) == Approx(4.0 / 12));    // 5 12 13
    REQUIRE(regularity({0, 0, 0}, {1, 0, 0}, {2, 0, 0}) == Approx(0).margin(1e-15));
    REQUIRE(regularity({0, 0, 0}, {0, 0, 0}, {2, 0, 0}) == Approx(0).margin(1e-15));  // (0 + 2 - 2) / 2
    REQUIRE(regularity({1, 1, 1}, {1, 1, 1}, {1, 1, 1}) == 0);
}

TEST_CASE("Paper, Cur: the largest over the end's triangles of the smallest turn to the edge's") {
    REQUIRE(curvature({kUp, kUp}, {kUp, kUp}) == 0);
    REQUIRE(curvature({kSide}, {kUp}) == Approx(0.5));
    REQUIRE(curvature({kDown}, {kUp}) == Approx(1));
    const Double3 sixty{root(3) / 2, 0, 0.5};
    REQUIRE(curvature({sixty}, {kUp}) == Approx(0.25));  // (1 - cos 60) / 2
    // The smallest over the edge's: a triangle like one of them turns nothing, however far it is from the
    // other.
    REQUIRE(curvature({kUp, kDown}, {kUp, kDown}) == 0);
    REQUIRE(curvature({kSide}, {kUp, kSide}) == 0);
    // The largest over the end's: (down: min(1, 0.5) = 0.5; side: min(0.5, 0) = 0; sixty: min(0.25, 0.067)).
    REQUIRE(curvature({kDown, kSide, sixty}, {kUp, kSide}) == Approx(0.5));
    // The mean of the turns, or the largest of all, would be another number.
    REQUIRE(curvature({kBack, kDown}, {kUp, kBack}) == Approx(0.5));
    REQUIRE(curvature({kUp}, {}) == 0);
    REQUIRE(curvature({}, {kUp}) == 0);
}

TEST_CASE("Paper, Q: the root mean square distance to the planes, by area") {
    PlaneQuadric one;
    one.add_plane({7, -3, 2}, {0, 0, 8});  // z = 2, area 4
    REQUIRE(one.area == Approx(4));
    REQUIRE(one.value({0, 0, 5}) == Approx(36));  // 4 * 3 * 3
    REQUIRE(one.distance({0, 0, 5}) == Approx(3));
    REQUIRE(one.distance({100, 50, 5}) == Approx(3));
    REQUIRE(one.distance({1, 1, 2}) == Approx(0).margin(1e-12));

    PlaneQuadric two = one;
    two.add_plane({-1, 0, 0}, {2, 0, 0});  // x = -1, area 1
    // (4 * 3^2 + 1 * 2^2) / 5 = 8
    REQUIRE(two.distance({1, 9, 5}) == Approx(root(8)));
    PlaneQuadric again;
    again.add_plane({-1, 0, 0}, {2, 0, 0});
    again.add(one);
    REQUIRE(again.area == Approx(5));
    REQUIRE(again.distance({1, 9, 5}) == Approx(root(8)));
    // Orientation does not matter, a triangle without area adds nothing.
    PlaneQuadric flipped;
    flipped.add_plane({7, -3, 2}, {0, 0, -8});
    flipped.add_plane({1, 1, 1}, {0, 0, 0});
    REQUIRE(flipped.area == Approx(4));
    REQUIRE(flipped.distance({0, 0, 5}) == Approx(3));
    REQUIRE(PlaneQuadric{}.distance({1, 2, 3}) == 0);
    // A slanted plane: x + y + z = 3, from the origin sqrt 3.
    PlaneQuadric slanted;
    slanted.add_plane({1, 1, 1}, {2, 2, 2});
    REQUIRE(slanted.distance({0, 0, 0}) == Approx(root(3)));
}

TEST_CASE("Paper: the cost of an edge, worked out by hand") {
    const Roof roof;
    REQUIRE(roof.star_mesh.scale() == 1);
    REQUIRE(roof.star.size == 4);
    REQUIRE(roof.star.opposite.size() == 2);
    const double k = 1.0 / 16;
    // Cur(u): the wall's normals turn by 90 degrees from both of the edge's: 0.5. Cur(v): 0, all flat. Len =
    // 4 k.
    const double fu = 4 * k * 0.5, fv = 0;
    struct Place {
        Double3 at;
        double qu, qv, re;
    };
    // Q at u: planes z = 0 and x = 0 of area 12 each: sqrt((x^2 + z^2) / 2). Q at v: z = 0 alone: |z|.
    // Re: the mean over (u p r), (u r q), (v s p), (v q s) with the place for u and v; by symmetry the first
    // and third suffice.
    const Place places[] = {
        // middle (2,0,0): sides sqrt13 5 sqrt20 of (. p r), 6 sqrt73 sqrt13 of (. s p)
        {roof.at(2, 0, 0), root(2) * k, 0,
         ((root(13) + root(20) - 5) / root(20) + (root(13) + 6 - root(73)) / 6) / 2},
        // v (4,0,0): 5 5 sqrt32; 4 5 sqrt73
        {roof.at(4, 0, 0), root(8) * k, 0, ((5 + 5 - root(32)) / 5 + (4 + 5 - root(73)) / 5) / 2},
        // above u (0,0,2): sqrt13 5 6; sqrt68 sqrt73 sqrt13
        {roof.at(0, 0, 2), root(2) * k, 2 * k,
         ((root(13) + 5 - 6) / 5 + (root(13) + root(68) - root(73)) / root(68)) / 2},
    };
    for (const Place& place : places) {
        const double eu = place.qu / place.re + fu, ev = place.qv / place.re + fv;
        REQUIRE(roof.cost.cost_at(roof.star, place.at, 1, 1) == Approx(eu + ev));
        // Cost = w_u E(u) + w_v E(v): each end by its own weight.
        REQUIRE(roof.cost.cost_at(roof.star, place.at, 10, 1) == Approx(10 * eu + ev));
        REQUIRE(roof.cost.cost_at(roof.star, place.at, 1, 10) == Approx(eu + 10 * ev));
        REQUIRE(roof.cost.cost_at(roof.star, place.at, 0, 3) == Approx(3 * ev).margin(1e-12));
        REQUIRE(roof.cost.cost_at(roof.star, place.at, 0, 0) == Approx(0).margin(1e-12));
    }
    // Seen from the other end the cost is the same.
    EdgeStar turned;
    turned.gather(roof.star_mesh, roof.number(1), roof.number(0));
    for (const Place& place : places)
        REQUIRE(roof.cost.cost_at(turned, place.at, 2, 7) ==
                Approx(roof.cost.cost_at(roof.star, place.at, 7, 2)));
}

TEST_CASE("Paper: the place chosen is no worse than the ends") {
    const Roof roof;
    const double at_u = roof.cost.cost_at(roof.star, roof.at(0, 0, 0), 1, 2),
                 at_v = roof.cost.cost_at(roof.star, roof.at(4, 0, 0), 1, 2);
    const Candidate ends =
        roof.cost.evaluate(roof.star_mesh, roof.star, Fold::kAnywhere, Placement::kEndpoint, 1, 2);
    REQUIRE(ends.cost == Approx(std::min(at_u, at_v)));
    const Candidate best =
        roof.cost.evaluate(roof.star_mesh, roof.star, Fold::kAnywhere, Placement::kOptimal, 1, 2);
    REQUIRE(best.cost <= ends.cost);
    REQUIRE(best.cost == Approx(roof.cost.cost_at(roof.star, best.place, 1, 2)));
    // u is on all planes: no place is cheaper than it but for regularity, which does not count where Q is 0.
    REQUIRE(best.cost == Approx(at_u).margin(1e-9));
    REQUIRE(
        roof.cost.evaluate(roof.star_mesh, roof.star, Fold::kIntoSecond, Placement::kOptimal, 1, 2).cost ==
        Approx(at_v));
    REQUIRE(roof.cost.evaluate(roof.star_mesh, roof.star, Fold::kIntoFirst, Placement::kOptimal, 1, 2).cost ==
            Approx(at_u));
}

TEST_CASE("Paper: after a merge the parent answers for the child's planes") {
    Roof roof;
    roof.cost.merge(roof.number(1), roof.number(0));
    // v now has z = 0 (24 + 12 by area 6s: four of its own, two of u's) and x = 0 (two of u's): sqrt((36 z^2
    // + 12 x^2) / 48).
    const double k = 1.0 / 16;
    const double re = ((5 + 5 - root(32)) / 5 + (4 + 5 - root(73)) / 5) / 2;
    const double qv = root(12.0 * 16 / 48) * k;
    REQUIRE(roof.cost.cost_at(roof.star, roof.at(4, 0, 0), 0, 1) == Approx(qv / re));
}
