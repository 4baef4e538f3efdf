#pragma once
// Shapes given by formulas: spheres, parallelograms (rectangles, faces of cubes) and elliptic disks. Exact, not meshed.

#include "patina/render/wide.h"

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

// What the rays of a block met. Rays that reach nowhere (t_max < 0) meet nothing.
struct RayBlock {
    FloatLanes origin_x, origin_y, origin_z, direction_x, direction_y, direction_z;
    FloatLanes t;  // as far as the ray reaches; after a query as far as the hit
    FloatLanes u, v;
    FloatLanes time;     // of each ray, for what moves
    IntLanes primitive;  // analytic shape, -1: none

    void set(int lane, const Ray& ray) {
        origin_x[lane] = ray.origin.x(), origin_y[lane] = ray.origin.y(), origin_z[lane] = ray.origin.z();
        direction_x[lane] = ray.direction.x(), direction_y[lane] = ray.direction.y();
        direction_z[lane] = ray.direction.z();
        t[lane] = ray.t_max;
        time[lane] = ray.time;
    }
    Ray ray(int lane) const {
        return {{origin_x[lane], origin_y[lane], origin_z[lane]},
                {direction_x[lane], direction_y[lane], direction_z[lane]},
                t[lane],
                time[lane]};
    }
};

// The rays of a block, or one ray, in registers.
template <class F>
struct RayOf {
    Vec3Of<F> origin, direction;
};
inline RayOf<float> ray_components(const Ray& ray) {
    return {components(ray.origin), components(ray.direction)};
}
inline RayOf<WideFloat> ray_components(const RayBlock& rays) {
    return {{rays.origin_x.load(), rays.origin_y.load(), rays.origin_z.load()},
            {rays.direction_x.load(), rays.direction_y.load(), rays.direction_z.load()}};
}

struct AnalyticShape {
    enum class Kind { sphere, parallelogram, disk };
    Kind kind = Kind::sphere;
    int shape = -1;
    // Sphere: centre o, rows of the rotation to its own axes in a, b, n. Planes: o + u a + v b with |u|, |v| <= 1 or
    // u^2 + v^2 <= 1, normal n = a x b normalized.
    Vec3 o, a, b, n;
    Vec3 dual_a, dual_b;  // u = dual_a . (p - o)
    Frame frame;          // of planes, on their outside, tangent along a; Geometry::commit() sets it
    float radius = 0;
    float area = 0;
    bool flipped = false;  // the normal points the other way

    static AnalyticShape sphere(const Vec3& centre, float radius, const Eigen::Matrix3f& rotation);
    // Null area is the caller's error.
    static AnalyticShape plane(Kind kind, const Vec3& centre, const Vec3& half_u, const Vec3& half_v);

    void set_frame() {
        if (kind != Kind::sphere) frame = Frame(flipped ? Vec3(-n) : n, a);
    }

    // Texture coordinates of a sphere: azimuth and polar angle.
    Vec2 spherical(const Vec3& outward) const {
        const float phi = std::atan2(b.dot(outward), a.dot(outward));
        return {(phi < 0 ? phi + 2 * pi_f : phi) * (0.5f * inv_pi_f),
                std::acos(std::clamp(n.dot(outward), -1.0f, 1.0f)) * inv_pi_f};
    }

    // Distance to the nearest intersection beyond 0, infinite when there is none; u, v of planes.
    template <class F>
    F distance(const RayOf<F>& ray, F& u, F& v) const {
        return kind == Kind::sphere ? sphere_distance(ray) : plane_distance(ray, u, v);
    }

    // Nearest intersection in (0, hit.t); updates hit (shape, primitive, u, v, t) when there is one.
    bool intersect(const Ray& ray, int primitive, Hit& hit) const {
        float u = 0, v = 0;
        const float t = distance(ray_components(ray), u, v);
        if (!(t < hit.t)) return false;
        hit = {t, shape, primitive, false, u, v};
        return true;
    }

  private:
    template <class F>
    Vec3Of<F> from_centre(const RayOf<F>& ray) const {
        return {ray.origin.x - o.x(), ray.origin.y - o.y(), ray.origin.z - o.z()};
    }
    // Haines et al. (2019), Precision improvements for ray/sphere intersection, Ray Tracing Gems ch. 7.
    template <class F>
    F sphere_distance(const RayOf<F>& ray) const {
        const Vec3Of<F> f = from_centre(ray);
        const Vec3Of<F>& d = ray.direction;
        const F b_half = -dot(f, d);
        const Vec3Of<F> nearest{f.x + b_half * d.x, f.y + b_half * d.y, f.z + b_half * d.z};
        const F zero = broadcast(0.0f, b_half), none = broadcast(INFINITY, b_half);
        const F discriminant = radius * radius - dot(nearest, nearest);
        const F q = b_half + with_sign_of(sqrt_of(discriminant > zero ? discriminant : zero), b_half);
        // Where q is 0 the ray touches the surface it starts on, and no comparison below holds.
        const F other = (dot(f, f) - radius * radius) / q;
        const F near = q < other ? q : other, far = q < other ? other : q;
        const F t = near > zero ? near : far;
        return discriminant >= zero ? (t > zero ? t : none) : none;
    }
    template <class F>
    F plane_distance(const RayOf<F>& ray, F& u, F& v) const {
        const Vec3Of<F> f = from_centre(ray);
        const Vec3Of<float> normal = components(n), along_u = components(dual_a), along_v = components(dual_b);
        const F t = -dot(normal, f) / dot(normal, ray.direction);
        u = dot(along_u, f) + t * dot(along_u, ray.direction);
        v = dot(along_v, f) + t * dot(along_v, ray.direction);
        const F u2 = u * u, v2 = v * v, one = broadcast(1.0f, t), none = broadcast(INFINITY, t);
        const F reach = kind == Kind::disk ? u2 + v2 : (u2 > v2 ? u2 : v2);
        return reach <= one ? (t > broadcast(0.0f, t) ? t : none) : none;
    }
};

}  // namespace patina::render
