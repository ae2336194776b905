// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What moves change, forth and back. Vertices lie anywhere and are fetched ahead. Private to this room.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "prefetch.hpp"
#include "vsplit/live_buffers.hpp"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace vsplit {

inline constexpr std::size_t kVerticesAhead = 64;
inline constexpr std::ptrdiff_t kBytesAhead = 1024;  // of what is read in order

/// Flips the bits in which `kComponents` (or, if that is 0, `components`) floats of each vertex differ before
/// and after its move.
template <std::size_t kComponents>
void flip_values(std::span<const std::uint32_t> vertices, float* alive, const std::uint32_t* moved,
                 std::size_t components) {
    const std::size_t n = kComponents != 0 ? kComponents : components;
    for (std::size_t i = 0; i < vertices.size(); ++i, moved += n) {
        if (i + kVerticesAhead < vertices.size()) prefetch(alive + n * vertices[i + kVerticesAhead], n);
        prefetch_once(moved, kBytesAhead);
        float* const a = alive + n * vertices[i];
        for (std::size_t k = 0; k < n; ++k)
            a[k] = std::bit_cast<float>(std::bit_cast<std::uint32_t>(a[k]) ^ moved[k]);
    }
}

inline void flip_any(std::span<const std::uint32_t> vertices, float* alive, const std::uint32_t* moved,
                     std::size_t components) {
    switch (components) {
        case 1:
            return flip_values<1>(vertices, alive, moved, 1);
        case 2:
            return flip_values<2>(vertices, alive, moved, 2);
        case 3:
            return flip_values<3>(vertices, alive, moved, 3);
        case 4:
            return flip_values<4>(vertices, alive, moved, 4);
        default:
            return flip_values<0>(vertices, alive, moved, components);
    }
}

inline constexpr double kRounds = 6755399441055744;  // 1.5 * 2^52: a double next to it is a whole number

/// Moves one place by a step of the grid.
template <bool kForward>
void step_place(Float3& place, const std::array<std::int16_t, 3>& step, const PlaceGrid& grid,
                double inverse) {
    float* const a = &place.x;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // Rounded by what a double cannot hold: whole numbers, without a way through integers.
        const double at = ((double(a[axis]) - grid.origin[axis]) * inverse + kRounds) - kRounds;
        const double by = step[axis];
        a[axis] = float(grid.origin[axis] + grid.step * (kForward ? at + by : at - by));
    }
}

#if defined(__SSE2__)
/// step_place() of two coordinates.
template <bool kForward>
__m128d step_pair(__m128d place, __m128d by, __m128d origin, __m128d step, __m128d inverse) {
    const __m128d rounds = _mm_set1_pd(kRounds);
    const __m128d at = _mm_sub_pd(_mm_add_pd(_mm_mul_pd(_mm_sub_pd(place, origin), inverse), rounds), rounds);
    return _mm_add_pd(origin, _mm_mul_pd(step, kForward ? _mm_add_pd(at, by) : _mm_sub_pd(at, by)));
}
#endif

/// Moves places by steps of the grid.
template <bool kForward>
void step_places(std::span<const std::uint32_t> vertices, Float3* alive,
                 const std::array<std::int16_t, 3>* steps, const PlaceGrid& grid) {
    const double inverse = 1 / grid.step;
    std::size_t i = 0;
#if defined(__SSE2__)
    // Two vertices at a time: three pairs of coordinates. A load of a step reads two bytes of the next one.
    const __m128d xy_origin = _mm_set_pd(grid.origin[1], grid.origin[0]),
                  z_origin = _mm_set1_pd(grid.origin[2]), step = _mm_set1_pd(grid.step),
                  inverses = _mm_set1_pd(inverse);
    const auto load_step = [](const std::array<std::int16_t, 3>& s) {
        const __m128i packed = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(s.data()));
        return _mm_srai_epi32(_mm_unpacklo_epi16(packed, packed), 16);
    };
    const auto load_xy = [](const Float3& place) {
        return _mm_cvtps_pd(_mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(&place.x))));
    };
    const auto store_xy = [](Float3& place, __m128d xy) {
        _mm_storel_epi64(reinterpret_cast<__m128i*>(&place.x), _mm_castps_si128(_mm_cvtpd_ps(xy)));
    };
    for (; i + 2 < vertices.size(); i += 2) {
        if (i + 1 + kVerticesAhead < vertices.size()) {
            prefetch(&alive[vertices[i + kVerticesAhead]].x, 3);
            prefetch(&alive[vertices[i + 1 + kVerticesAhead]].x, 3);
        }
        prefetch_once(&steps[i], kBytesAhead);
        Float3 &a = alive[vertices[i]], &b = alive[vertices[i + 1]];
        if (&a == &b) {
            step_place<kForward>(a, steps[i], grid, inverse);
            step_place<kForward>(a, steps[i + 1], grid, inverse);
            continue;
        }
        const __m128i by_a = load_step(steps[i]), by_b = load_step(steps[i + 1]);
        const __m128d z =
            step_pair<kForward>(_mm_cvtps_pd(_mm_unpacklo_ps(_mm_load_ss(&a.z), _mm_load_ss(&b.z))),
                                _mm_cvtepi32_pd(_mm_unpackhi_epi32(by_a, by_b)), z_origin, step, inverses);
        store_xy(a, step_pair<kForward>(load_xy(a), _mm_cvtepi32_pd(by_a), xy_origin, step, inverses));
        store_xy(b, step_pair<kForward>(load_xy(b), _mm_cvtepi32_pd(by_b), xy_origin, step, inverses));
        const __m128 z_floats = _mm_cvtpd_ps(z);
        _mm_store_ss(&a.z, z_floats);
        _mm_store_ss(&b.z, _mm_shuffle_ps(z_floats, z_floats, 1));
    }
#endif
    for (; i < vertices.size(); ++i) {
        if (i + kVerticesAhead < vertices.size()) prefetch(&alive[vertices[i + kVerticesAhead]].x, 3);
        step_place<kForward>(alive[vertices[i]], steps[i], grid, inverse);
    }
}

}  // namespace vsplit
