#pragma once
// Vectors of floats in registers: four wavelengths (Float4), and four Stokes components of four wavelengths
// (StokesPacket).
//
// The compiler's vector types are used, so arithmetic operators work lane by lane and a scalar is broadcast.

#include <cmath>
#include <cstdint>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace patina::render {

inline constexpr int wavelengths_per_path = 4;

using Float4 = float __attribute__((vector_size(16)));        // one value for each of the path's wavelengths
using Mask4 = std::int32_t __attribute__((vector_size(16)));  // 0 or -1 for each
using StokesPacket = float __attribute__((vector_size(64)));  // [stokes][wavelength]: lane 4 s + w

inline Float4 splat(float x) {
    return Float4{x, x, x, x};
}

// GCC 12 widens a vector by a detour through memory, which stalls the loads that follow; hence the intrinsics below.

// The same four wavelengths' factors for each of the four Stokes components.
inline StokesPacket spread(Float4 x) {
#if defined(__AVX512F__)
    return (StokesPacket)_mm512_broadcast_f32x4((__m128)x);
#else
    return __builtin_shufflevector(x, x, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3);
#endif
}

inline Float4 stokes_row(const StokesPacket& s, int component) {
    switch (component) {
        case 0:
            return __builtin_shufflevector(s, s, 0, 1, 2, 3);
        case 1:
            return __builtin_shufflevector(s, s, 4, 5, 6, 7);
        case 2:
            return __builtin_shufflevector(s, s, 8, 9, 10, 11);
        default:
            return __builtin_shufflevector(s, s, 12, 13, 14, 15);
    }
}

// [wavelength][stokes]: the Stokes vector of each wavelength in four lanes beside each other.
inline StokesPacket by_wavelength(const StokesPacket& s) {
    return __builtin_shufflevector(s, s, 0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15);
}

inline StokesPacket make_stokes(Float4 i, Float4 q, Float4 u, Float4 v) {
#if defined(__AVX512F__)
    __m512 s = _mm512_castps128_ps512((__m128)i);
    s = _mm512_insertf32x4(s, (__m128)q, 1);
    s = _mm512_insertf32x4(s, (__m128)u, 2);
    return (StokesPacket)_mm512_insertf32x4(s, (__m128)v, 3);
#else
    using Float8 = float __attribute__((vector_size(32)));
    const Float8 iq = __builtin_shufflevector(i, q, 0, 1, 2, 3, 4, 5, 6, 7);
    const Float8 uv = __builtin_shufflevector(u, v, 0, 1, 2, 3, 4, 5, 6, 7);
    return __builtin_shufflevector(iq, uv, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#endif
}

inline Float4 sqrt(Float4 x) {
#if defined(__SSE2__)
    return (Float4)_mm_sqrt_ps((__m128)x);
#else
    return Float4{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3])};
#endif
}
inline Float4 max(Float4 a, Float4 b) {
    return a > b ? a : b;
}
inline Float4 min(Float4 a, Float4 b) {
    return a < b ? a : b;
}
inline Float4 select(Mask4 where, Float4 yes, Float4 no) {
    return where ? yes : no;
}
inline float sum(Float4 x) {
    return (x[0] + x[1]) + (x[2] + x[3]);
}
inline float mean(Float4 x) {
    return 0.25f * sum(x);
}
inline float largest(Float4 x) {
    return std::fmax(std::fmax(x[0], x[1]), std::fmax(x[2], x[3]));
}

}  // namespace patina::render
