#include "patina/render/shapes.h"

namespace patina::render {

AnalyticShape AnalyticShape::sphere(const Vec3& centre, float radius, const Eigen::Matrix3f& rotation) {
    AnalyticShape s;
    s.kind = Kind::sphere;
    s.o = centre;
    s.radius = radius;
    s.a = rotation.col(0);
    s.b = rotation.col(1);
    s.n = rotation.col(2);
    s.area = 4 * pi_f * radius * radius;
    return s;
}

AnalyticShape AnalyticShape::plane(Kind kind, const Vec3& centre, const Vec3& half_u, const Vec3& half_v) {
    AnalyticShape s;
    s.kind = kind;
    s.o = centre;
    s.a = half_u;
    s.b = half_v;
    const Vec3 cross = half_u.cross(half_v);
    s.n = cross.normalized();
    // The dual basis of (a, b) in their plane.
    const float scale = 1 / cross.squaredNorm();
    s.dual_a = half_v.cross(cross) * scale;
    s.dual_b = cross.cross(half_u) * scale;
    s.area = (kind == Kind::disk ? pi_f : 4.0f) * cross.norm();
    return s;
}

}  // namespace patina::render
