#pragma once
// Directions, points and local frames of the rendering kernels, in single precision.

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace patina::render {

using Vec2 = Eigen::Vector2f;
using Vec3 = Eigen::Vector3f;

inline constexpr float pi_f = 3.14159265358979323846f;
inline constexpr float inv_pi_f = 0.31830988618379067154f;

inline float sqr(float x) {
    return x * x;
}
inline float safe_sqrt(float x) {
    return std::sqrt(std::max(x, 0.0f));
}

// v made a unit vector; v must not vanish.
inline Vec3 unit(const Vec3& v) {
    return v * (1 / std::sqrt(v.squaredNorm()));
}
// A vector that is a unit vector but for rounding made one: a step of Newton's iteration for 1 / sqrt(v.v).
inline Vec3 straightened(const Vec3& v) {
    return v * (1.5f - 0.5f * v.squaredNorm());
}

// Two unit vectors that complete the unit vector n to a right-handed frame (s, t, n).
// Duff et al. (2017), Building an orthonormal basis, revisited, J. Computer Graphics Techniques 6(1), listing 3.
inline void orthonormal_basis(const Vec3& n, Vec3& s, Vec3& t) {
    const float sign = std::copysign(1.0f, n.z());
    const float a = -1.0f / (sign + n.z());
    const float b = n.x() * n.y() * a;
    s = Vec3(1.0f + sign * n.x() * n.x() * a, sign * b, -sign * n.x());
    t = Vec3(b, sign + n.y() * n.y() * a, -n.y());
}

// A right-handed frame (s, t, n); local z is the normal.
struct Frame {
    Vec3 s, t, n;

    Frame() = default;
    explicit Frame(const Vec3& normal) : n(normal) { orthonormal_basis(n, s, t); }
    // s is `tangent` made perpendicular to the normal; any perpendicular when the two are parallel.
    Frame(const Vec3& normal, const Vec3& tangent) : n(normal) {
        const Vec3 along = tangent - n * n.dot(tangent);
        const float length2 = along.squaredNorm();
        if (length2 > 1e-20f) {
            s = along * (1 / std::sqrt(length2));
            t = n.cross(s);
        } else {
            orthonormal_basis(n, s, t);
        }
    }
    Vec3 to_local(const Vec3& v) const { return {s.dot(v), t.dot(v), n.dot(v)}; }
    Vec3 to_world(const Vec3& v) const { return s * v.x() + t * v.y() + n * v.z(); }
};

// A unit vector perpendicular to both unit vectors; any vector perpendicular to a where they are parallel.
inline Vec3 common_perpendicular(const Vec3& a, const Vec3& b) {
    const Vec3 cross = a.cross(b);
    const float length2 = cross.squaredNorm();
    if (length2 > 1e-12f) return cross * (1 / std::sqrt(length2));
    Vec3 s, t;
    orthonormal_basis(a, s, t);
    return s;
}

// The same for a local normal (0, 0, 1) and a local direction.
inline Vec3 perpendicular_to_normal(const Vec3& v) {
    const float length2 = v.x() * v.x() + v.y() * v.y();
    if (!(length2 > 1e-12f)) return Vec3::UnitX();
    const float scale = 1 / std::sqrt(length2);
    return {-v.y() * scale, v.x() * scale, 0};
}

struct Ray {
    Vec3 origin, direction;
    float t_max = INFINITY;
    float time = 0;  // 0: the shutter opens, 1: it closes
};

}  // namespace patina::render
