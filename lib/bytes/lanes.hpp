// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Eight numbers of 16 bits at once, where the processor has that.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace vsplit {

#if defined(__SSE2__)

struct Lanes {
    __m128i v;

    static Lanes load(const std::uint16_t* p) {
        return {_mm_loadu_si128(reinterpret_cast<const __m128i*>(p))};
    }
    static Lanes of(std::uint16_t x) { return {_mm_set1_epi16(static_cast<short>(x))}; }
    void store(std::uint16_t* p) const { _mm_storeu_si128(reinterpret_cast<__m128i*>(p), v); }
    /// The product, >> 16.
    friend Lanes operator*(Lanes a, Lanes b) { return {_mm_mulhi_epu16(a.v, b.v)}; }
    friend Lanes operator+(Lanes a, Lanes b) { return {_mm_add_epi16(a.v, b.v)}; }
    friend Lanes operator&(Lanes a, Lanes b) { return {_mm_and_si128(a.v, b.v)}; }
    Lanes operator>>(int count) const { return {_mm_srl_epi16(v, _mm_cvtsi32_si128(count))}; }
    std::uint32_t sum() const {
        __m128i s = _mm_add_epi32(_mm_srli_epi32(v, 16), _mm_and_si128(v, _mm_set1_epi32(0xFFFF)));
        s = _mm_add_epi32(s, _mm_shuffle_epi32(s, 0x4E));
        s = _mm_add_epi32(s, _mm_shuffle_epi32(s, 0xB1));
        return static_cast<std::uint32_t>(_mm_cvtsi128_si32(s));
    }
};

#else

struct Lanes {
    std::array<std::uint16_t, 8> v;

    static Lanes load(const std::uint16_t* p) {
        Lanes out;
        for (std::size_t i = 0; i < 8; ++i) out.v[i] = p[i];
        return out;
    }
    static Lanes of(std::uint16_t x) {
        Lanes out;
        out.v.fill(x);
        return out;
    }
    void store(std::uint16_t* p) const {
        for (std::size_t i = 0; i < 8; ++i) p[i] = v[i];
    }
    /// The product, >> 16.
    friend Lanes operator*(Lanes a, Lanes b) {
        for (std::size_t i = 0; i < 8; ++i)
            a.v[i] = static_cast<std::uint16_t>((std::uint32_t{a.v[i]} * b.v[i]) >> 16);
        return a;
    }
    friend Lanes operator+(Lanes a, Lanes b) {
        for (std::size_t i = 0; i < 8; ++i) a.v[i] = static_cast<std::uint16_t>(a.v[i] + b.v[i]);
        return a;
    }
    friend Lanes operator&(Lanes a, Lanes b) {
        for (std::size_t i = 0; i < 8; ++i) a.v[i] = static_cast<std::uint16_t>(a.v[i] & b.v[i]);
        return a;
    }
    Lanes operator>>(int count) const {
        Lanes out;
        for (std::size_t i = 0; i < 8; ++i) out.v[i] = static_cast<std::uint16_t>(v[i] >> count);
        return out;
    }
    std::uint32_t sum() const {
        std::uint32_t s = 0;
        for (const std::uint16_t x : v) s += x;
        return s;
    }
};

#endif

}  // namespace vsplit
