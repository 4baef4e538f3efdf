#pragma once
// Powers of a cosine about an axis: density (n + 1) / (2 pi) cos^n, for Phong's and Lafortune's lobes. A cosine near 1
// says little about a small angle, so both work with 1 - cos.

#include "patina/render/vec.h"

namespace patina::render {

inline Vec3 sample_cosine_lobe(const Vec3& axis, float exponent, const Vec2& u) {
    const float less = -std::expm1(std::log1p(-u.x()) / (exponent + 1));  // 1 - cos
    const float z = 1 - less, r = safe_sqrt(less * (2 - less)), phi = 2 * pi_f * u.y();
    Vec3 s, t;
    orthonormal_basis(axis, s, t);
    return (s * (r * std::cos(phi)) + t * (r * std::sin(phi)) + axis * z).normalized();
}
inline float cosine_lobe_density(const Vec3& axis, float exponent, const Vec3& direction) {
    const float less = 0.5f * (axis - direction).squaredNorm();  // 1 - cos
    return less < 1 ? (exponent + 1) * 0.5f * inv_pi_f * std::exp(exponent * std::log1p(-less)) : 0.0f;
}

}  // namespace patina::render
