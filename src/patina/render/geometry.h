#pragma once
// Everything rays can meet: analytic shapes and triangle meshes in world coordinates.
//
// A handful of analytic shapes is tested one by one, which is faster than any hierarchy; more of them, and all meshes,
// go through Embree (embree_scene.h).

#include <memory>
#include <vector>

#include "patina/core/mesh.h"
#include "patina/render/embree_scene.h"
#include "patina/render/instances.h"
#include "patina/render/sampling.h"
#include "patina/render/shapes.h"
#include "patina/render/surface_uv.h"

namespace patina::render {

// One <shape> of the scene.
struct Shape {
    int bsdf = -1;
    int emitter = -1;                  // -1: does not emit
    int interior = -1, exterior = -1;  // media inside and outside, -1: none
    int first = 0, count = 0;          // its analytic shapes, or the one mesh
    bool is_mesh = false;
    int group = -1;  // of a group: in its own space, seen through instances only
    float area = 0;

    bool bounds_media() const { return interior >= 0 || exterior >= 0; }
};

struct MeshShape {
    int shape = -1;
    int group = -1;
    std::shared_ptr<const TriangleMesh> mesh;  // world coordinates; normals empty for flat shading
    bool flipped = false;
    DiscreteDistribution by_area;  // of its triangles
};

// A point on a surface, ready for shading.
struct SurfacePoint {
    Vec3 position, geometric_normal;
    Frame frame;  // shading normal, tangent along u
    SurfaceUv uv;
    int shape = -1;
    float offset = 0;  // how far a ray must start from the surface not to meet it again

    // A ray from here into `direction` starts on the side it leaves to.
    Vec3 origin(const Vec3& direction) const {
        return position + geometric_normal * std::copysign(offset, geometric_normal.dot(direction));
    }
};

// A point drawn on a shape as seen from another.
struct ShapeSample {
    Vec3 normal, direction;  // of the shape there; from the other point to it
    float distance = 0;
    SurfaceUv uv;
    float pdf = 0;  // per solid angle at the other point
};

class Geometry {
  public:
    std::vector<Shape> shapes;
    std::vector<AnalyticShape> analytic;
    std::vector<MeshShape> meshes;
    std::vector<AnalyticShape> group_analytic;  // of all groups, each in its own space
    std::vector<ShapeGroup> groups;
    std::vector<Instance> instances;
    bool needs_uv = true;  // false when nothing in the scene varies over surfaces: spares spheres their angles

    // Builds the acceleration structure and the bounds; call once, when all shapes are in.
    void commit();

    bool intersect(const Ray& ray, Hit& hit) const {
        hit.t = ray.t_max;
        bool found = false;
        if (brute_force_)
            for (int i = 0; i < static_cast<int>(analytic.size()); ++i) found |= analytic[i].intersect(ray, i, hit);
        if (embree_) found |= embree_->intersect(ray, hit);
        return found;
    }
    bool occluded(const Ray& ray) const {
        Hit hit;
        hit.t = ray.t_max;
        if (brute_force_)
            for (int i = 0; i < static_cast<int>(analytic.size()); ++i)
                if (analytic[i].intersect(ray, i, hit)) return true;
        return embree_ && embree_->occluded(ray);
    }

    // The same for the first `count` rays of a block, one result a ray; occluded() sets bit k for ray k.
    void intersect(RayBlock& rays, int count, Hit* hits) const;
    std::uint32_t occluded(RayBlock& rays, int count) const;

    SurfacePoint surface(const Ray& ray, const Hit& hit) const {
        SurfacePoint point;
        find_surface(ray, hit, point);
        return point;
    }
    // The same written where it is kept: what has just been written is slow to copy.
    void find_surface(const Ray& ray, const Hit& hit, SurfacePoint& point) const;

    // Draws a point of a shape's outside; false when none is drawn that can be seen from `from`.
    bool sample_shape(int shape, const Vec3& from, const Vec2& u, ShapeSample& sample) const;
    // Density per solid angle with which sample_shape() finds what `hit` is, for a ray from `from`.
    float shape_pdf(const Hit& hit, const SurfacePoint& at, const Vec3& from) const;

    // Does anything move while the shutter is open?
    bool moves() const { return moves_; }
    const Vec3& centre() const { return centre_; }
    float radius() const { return radius_; }  // of a sphere about the centre that holds everything

  private:
    void surface_of_instance(const Ray& ray, const Hit& hit, SurfacePoint& point) const;
    void surface_of_analytic(const AnalyticShape& shape, const Ray& ray, const Hit& hit, SurfacePoint& point) const;
    void surface_of_triangle(const Hit& hit, SurfacePoint& point) const;
    bool sample_sphere(const AnalyticShape& sphere, const Vec3& from, const Vec2& u, ShapeSample& sample) const;

    std::unique_ptr<EmbreeScene> embree_;
    bool brute_force_ = true, moves_ = false;
    Vec3 centre_ = Vec3::Zero();
    float radius_ = 1;
};

}  // namespace patina::render
