#pragma once
// Paths side by side: one number of each path in one lane, as many as a register holds. Kernels written as templates
// over the scalar type serve one path (float) as well as many (WideFloat).

#include <cmath>
#include <cstdint>

#include "patina/render/packet.h"
#include "patina/render/vec.h"

namespace patina::render {

#if defined(__AVX512F__)
inline constexpr int wide_lanes = 16;
#elif defined(__AVX__)
inline constexpr int wide_lanes = 8;
#else
inline constexpr int wide_lanes = 4;
#endif

using WideFloat = float __attribute__((vector_size(4 * wide_lanes)));
using WideInt = std::int32_t __attribute__((vector_size(4 * wide_lanes)));
using WideBits = std::uint32_t __attribute__((vector_size(4 * wide_lanes)));

// An array of one number a path, as vector registers load and store it.
template <class T, class Wide>
struct alignas(4 * wide_lanes) LanesOf {
    T values[wide_lanes]{};

    T& operator[](int lane) { return values[lane]; }
    const T& operator[](int lane) const { return values[lane]; }
    Wide load() const { return *reinterpret_cast<const Wide*>(values); }
    void store(Wide wide) { *reinterpret_cast<Wide*>(values) = wide; }
};

using FloatLanes = LanesOf<float, WideFloat>;
using IntLanes = LanesOf<std::int32_t, WideInt>;
using BitLanes = LanesOf<std::uint32_t, WideBits>;

inline float sqrt_of(float x) {
    return std::sqrt(x);
}
inline WideFloat sqrt_of(WideFloat x) {
#if defined(__AVX512F__)
    return (WideFloat)_mm512_sqrt_ps((__m512)x);
#elif defined(__AVX__)
    return (WideFloat)_mm256_sqrt_ps((__m256)x);
#else
    WideFloat root;
    for (int lane = 0; lane < wide_lanes; ++lane) root[lane] = std::sqrt(x[lane]);
    return root;
#endif
}
inline float with_sign_of(float size, float sign) {
    return std::copysign(size, sign);
}
inline WideFloat with_sign_of(WideFloat size, WideFloat sign) {
    constexpr std::int32_t sign_bit = INT32_MIN;
    return (WideFloat)(((WideInt)size & ~sign_bit) | ((WideInt)sign & sign_bit));
}
inline float broadcast(float x, float) {
    return x;
}
inline WideFloat broadcast(float x, WideFloat) {
    return WideFloat{} + x;
}

// Bit k of the result: is lane k of the mask set?
inline unsigned set_lanes(WideInt mask) {
#if defined(__AVX512DQ__)
    return _mm512_movepi32_mask((__m512i)mask);
#elif defined(__AVX__) && !defined(__AVX512F__)
    return static_cast<unsigned>(_mm256_movemask_ps((__m256)mask));
#else
    unsigned bits = 0;
    for (int lane = 0; lane < wide_lanes; ++lane) bits |= mask[lane] ? 1u << lane : 0u;
    return bits;
#endif
}

// A vector in space of one path or of many.
template <class F>
struct Vec3Of {
    F x, y, z;
};
using WideVec3 = Vec3Of<WideFloat>;

template <class F, class G>
auto dot(const Vec3Of<F>& a, const Vec3Of<G>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class F, class G>
auto cross(const Vec3Of<F>& a, const Vec3Of<G>& b) {
    return Vec3Of<F>{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class F>
Vec3Of<F> unit(const Vec3Of<F>& v) {
    const F scale = 1 / sqrt_of(dot(v, v));
    return {v.x * scale, v.y * scale, v.z * scale};
}
inline Vec3Of<float> components(const Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

}  // namespace patina::render
