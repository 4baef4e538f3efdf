#pragma once
// Shapes given by formulas: spheres, parallelograms (rectangles, faces of cubes) and elliptic disks. Exact, not meshed.

#include "patina/render/vec.h"

namespace patina::render {

// What a ray met.
struct Hit {
    float t = INFINITY;
    int shape = -1;      // index into the scene's shapes
    int primitive = -1;  // of the shape's kind: analytic shape or triangle
    bool triangle = false;
    float u = 0, v = 0;  // barycentric coordinates in a triangle, parameters in a parallelogram
    int instance = -1;   // through which the shape is seen; then analytic shapes are those of its group
};

struct AnalyticShape {
    enum class Kind { sphere, parallelogram, disk };
    Kind kind = Kind::sphere;
    int shape = -1;
    // Sphere: centre o, rows of the rotation to its own axes in a, b, n. Planes: o + u a + v b with |u|, |v| <= 1 or
    // u^2 + v^2 <= 1, normal n = a x b normalized.
    Vec3 o, a, b, n;
    Vec3 dual_a, dual_b;  // u = dual_a . (p - o)
    float radius = 0;
    float area = 0;
    bool flipped = false;  // the normal points the other way

    static AnalyticShape sphere(const Vec3& centre, float radius, const Eigen::Matrix3f& rotation);
    // Null area is the caller's error.
    static AnalyticShape plane(Kind kind, const Vec3& centre, const Vec3& half_u, const Vec3& half_v);

    // Nearest intersection in (0, t_max); updates hit (shape, primitive, u, v, t) when there is one.
    bool intersect(const Ray& ray, int primitive, Hit& hit) const {
        return kind == Kind::sphere ? intersect_sphere(ray, primitive, hit) : intersect_plane(ray, primitive, hit);
    }

  private:
    // Haines et al. (2019), Precision improvements for ray/sphere intersection, Ray Tracing Gems ch. 7.
    bool intersect_sphere(const Ray& ray, int primitive, Hit& hit) const {
        const Vec3 f = ray.origin - o;
        const float b_half = -f.dot(ray.direction);
        const Vec3 nearest = f + b_half * ray.direction;
        const float discriminant = radius * radius - nearest.squaredNorm();
        if (discriminant < 0) return false;
        const float q = b_half + std::copysign(std::sqrt(discriminant), b_half);
        const float c = f.squaredNorm() - radius * radius;
        const float t0 = q != 0 ? c / q : 0.0f, t1 = q;
        const float near = std::min(t0, t1), far = std::max(t0, t1);
        const float t = near > 0 ? near : far;
        if (!(t > 0 && t < hit.t)) return false;
        hit.t = t;
        hit.shape = shape;
        hit.primitive = primitive;
        hit.triangle = false;
        return true;
    }
    bool intersect_plane(const Ray& ray, int primitive, Hit& hit) const {
        const float slope = n.dot(ray.direction);
        const float t = n.dot(o - ray.origin) / slope;
        if (!(t > 0 && t < hit.t)) return false;
        const Vec3 p = ray.origin + t * ray.direction - o;
        const float u = dual_a.dot(p), v = dual_b.dot(p);
        if (kind == Kind::disk ? u * u + v * v > 1 : std::max(std::abs(u), std::abs(v)) > 1) return false;
        hit = {t, shape, primitive, false, u, v};
        return true;
    }
};

}  // namespace patina::render
