#pragma once
// Vectors of floats in registers: four wavelengths (Float4), and four Stokes components of four wavelengths
// (StokesPacket).
//
// The compiler's vector types are used, so arithmetic operators work lane by lane and a scalar is broadcast. None is
// wider than a register: GCC 12 takes wider ones apart lane by lane, in memory.

#include <cmath>
#include <cstdint>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace patina::render {

inline constexpr int wavelengths_per_path = 4;

using Float4 = float __attribute__((vector_size(16)));        // one value for each of the path's wavelengths
using Mask4 = std::int32_t __attribute__((vector_size(16)));  // 0 or -1 for each

// [stokes][wavelength]: lane 4 s + w.
#if defined(__AVX512F__)
using StokesPacket = float __attribute__((vector_size(64)));
#else
using Float8 = float __attribute__((vector_size(32)));
struct StokesPacket {
    Float8 iq, uv;

    StokesPacket() = default;
    StokesPacket(Float8 i_and_q, Float8 u_and_v) : iq(i_and_q), uv(u_and_v) {}
    // GCC 12 copies structures sixteen bytes at a time by itself, and loads of thirty-two behind that stall.
    StokesPacket(const StokesPacket& other) : iq(other.iq), uv(other.uv) {}
    StokesPacket& operator=(const StokesPacket& other) {
        iq = other.iq;
        uv = other.uv;
        return *this;
    }

    float operator[](int lane) const { return lane < 8 ? iq[lane] : uv[lane - 8]; }
};
inline StokesPacket operator+(const StokesPacket& a, const StokesPacket& b) {
    return {a.iq + b.iq, a.uv + b.uv};
}
inline StokesPacket operator-(const StokesPacket& a, const StokesPacket& b) {
    return {a.iq - b.iq, a.uv - b.uv};
}
inline StokesPacket operator-(const StokesPacket& a) {
    return {-a.iq, -a.uv};
}
inline StokesPacket operator*(const StokesPacket& a, const StokesPacket& b) {
    return {a.iq * b.iq, a.uv * b.uv};
}
inline StokesPacket operator*(const StokesPacket& a, float b) {
    return {a.iq * b, a.uv * b};
}
inline StokesPacket operator*(float a, const StokesPacket& b) {
    return b * a;
}
inline StokesPacket& operator+=(StokesPacket& a, const StokesPacket& b) {
    return a = a + b;
}
template <class Factor>
StokesPacket& operator*=(StokesPacket& a, const Factor& b) {
    return a = a * b;
}
#endif

inline Float4 splat(float x) {
    return Float4{x, x, x, x};
}

// GCC 12 widens a vector by a detour through memory, which stalls the loads that follow; hence the intrinsics below.
#if defined(__AVX512F__)

// The same four wavelengths' factors for each of the four Stokes components.
inline StokesPacket spread(Float4 x) {
    return (StokesPacket)_mm512_broadcast_f32x4((__m128)x);
}

// Four lanes from 4 `index` on.
inline Float4 quarter(const StokesPacket& s, int index) {
    switch (index) {
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

inline StokesPacket make_stokes(Float4 i, Float4 q, Float4 u, Float4 v) {
    __m512 s = _mm512_castps128_ps512((__m128)i);
    s = _mm512_insertf32x4(s, (__m128)q, 1);
    s = _mm512_insertf32x4(s, (__m128)u, 2);
    return (StokesPacket)_mm512_insertf32x4(s, (__m128)v, 3);
}

// [wavelength][stokes]: the Stokes vector of each wavelength in four lanes beside each other.
inline StokesPacket by_wavelength(const StokesPacket& s) {
    return __builtin_shufflevector(s, s, 0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15);
}

// Each of the four lanes from `first` on, four times.
template <int first>
StokesPacket repeated(const StokesPacket& s) {
    constexpr int i = first, q = i + 1, u = i + 2, v = i + 3;
    return __builtin_shufflevector(s, s, i, i, i, i, q, q, q, q, u, u, u, u, v, v, v, v);
}

#else

inline Float8 join(Float4 low, Float4 high) {
#if defined(__AVX__)
    return (Float8)_mm256_set_m128((__m128)high, (__m128)low);
#else
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
#endif
}

inline StokesPacket spread(Float4 x) {
    return {join(x, x), join(x, x)};
}

inline Float4 quarter(const StokesPacket& s, int index) {
    const Float8& half = index < 2 ? s.iq : s.uv;
    return index % 2 ? __builtin_shufflevector(half, half, 4, 5, 6, 7)
                     : __builtin_shufflevector(half, half, 0, 1, 2, 3);
}

inline StokesPacket make_stokes(Float4 i, Float4 q, Float4 u, Float4 v) {
    return {join(i, q), join(u, v)};
}

inline StokesPacket by_wavelength(const StokesPacket& s) {
    return {__builtin_shufflevector(s.iq, s.uv, 0, 4, 8, 12, 1, 5, 9, 13),
            __builtin_shufflevector(s.iq, s.uv, 2, 6, 10, 14, 3, 7, 11, 15)};
}

template <int first>
StokesPacket repeated(const StokesPacket& s) {
    constexpr int i = first % 8, q = i + 1, u = i + 2, v = i + 3;
    const Float8& half = first < 8 ? s.iq : s.uv;
    return {__builtin_shufflevector(half, half, i, i, i, i, q, q, q, q),
            __builtin_shufflevector(half, half, u, u, u, u, v, v, v, v)};
}

#endif

inline Float4 stokes_row(const StokesPacket& s, int component) {
    return quarter(s, component);
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
// The largest of those that are numbers; -infinity if none is.
inline float largest(Float4 x) {
    const Float4 numbers = x == x ? x : splat(-INFINITY);
    const Float4 pairs = max(numbers, __builtin_shufflevector(numbers, numbers, 2, 3, 0, 1));
    return pairs[0] > pairs[1] ? pairs[0] : pairs[1];
}

}  // namespace patina::render
