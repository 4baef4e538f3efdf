#pragma once
// Powers of a cosine about an axis: density (n + 1) / (2 pi) cos^n, for Phong's and Lafortune's lobes.

#include "patina/render/vec.h"

namespace patina::render {

inline Vec3 sample_cosine_lobe(const Vec3& axis, float exponent, const Vec2& u) {
    const float z = std::pow(1 - u.x(), 1 / (exponent + 1)), r = safe_sqrt(1 - z * z), phi = 2 * pi_f * u.y();
    Vec3 s, t;
    orthonormal_basis(axis, s, t);
    return (s * (r * std::cos(phi)) + t * (r * std::sin(phi)) + axis * z).normalized();
}
inline float cosine_lobe_density(const Vec3& axis, float exponent, const Vec3& direction) {
    const float z = axis.dot(direction);
    return z > 0 ? (exponent + 1) * 0.5f * inv_pi_f * std::pow(z, exponent) : 0.0f;
}

}  // namespace patina::render
