// Where Mitsuba 3 puts u and v on its shapes, so that its pictures land where they do there. Numbers from its
// documentation and its tables of vertices.

#include "render_scenes.h"
#include <gtest/gtest.h>

#include "patina/render/scene.h"

namespace patina::render::test {
namespace {

using Eigen::Vector3d;

// A ray from `from` to `to`, which lies on the shape.
SurfacePoint met(const Node& shape, const Vector3d& from, const Vector3d& to) {
    const Node texture = node("texture", "checkerboard");
    const auto built =
        build_scene(*scene({shape, texture, constant_light(), needle({9, 9, 9}, {0, 0, 0}, {0, 1, 0}, 1)}), {});
    const Vec3 origin = from.cast<float>(), direction = (to - from).normalized().cast<float>();
    const Ray ray{origin, direction};
    Hit hit;
    EXPECT_TRUE(built->geometry.intersect(ray, hit));
    const SurfacePoint point = built->geometry.surface(ray, hit);
    EXPECT_LT((point.position - to.cast<float>()).norm(), 1e-3);
    return point;
}
void expect_uv(const SurfacePoint& point, double u, double v) {
    // Single precision; the facets of a cylinder (2 pi / 512) are interpolated linearly.
    EXPECT_NEAR(point.uv.x(), u, 2e-5);
    EXPECT_NEAR(point.uv.y(), v, 2e-5);
}

TEST(TextureCoordinates, OfADiskArePolar) {
    const Node disk = node("shape", "disk");
    for (double angle_deg : {10.0, 100.0, 190.0, 350.0})
        for (double r : {0.2, 0.9}) {
            const double phi = radians(angle_deg);
            const Vector3d at(r * std::cos(phi), r * std::sin(phi), 0);
            const SurfacePoint point = met(disk, at + Vector3d(0.3, 0.1, 2), at);
            expect_uv(point, r, angle_deg / 360);
            // The tangent is along u.
            EXPECT_NEAR(point.frame.s.dot(at.normalized().cast<float>()), 1, 1e-5);
        }
}

TEST(TextureCoordinates, OfARectangleAreCartesian) {
    expect_uv(met(node("shape", "rectangle"), {0, 0, 3}, {-0.5, 0.8, 0}), 0.25, 0.9);
}

TEST(TextureCoordinates, OfASphereAreAzimuthAndPolarAngle) {
    const Vector3d at(-0.6 * std::sin(0.7), 0.6 * std::cos(0.7), 0.8);  // azimuth 90 deg + 0.7
    expect_uv(met(node("shape", "sphere"), 3 * at, at), 0.25 + 0.7 / (2 * pi), std::acos(0.8) / pi);
}

TEST(TextureCoordinates, OfACylinderAreAzimuthAndHeight) {
    const auto cylinder = [](const Vector3d& p1) {
        return node("shape", "cylinder", {{"p0", Vector3d(0, 0, 0)}, {"p1", p1}});
    };
    // At a corner of the facets.
    const double phi = 2 * pi * 100 / 512;
    const Vector3d round(std::cos(phi), std::sin(phi), 0);
    expect_uv(met(cylinder({0, 0, 2}), 4 * round + Vector3d(0, 0, 0.5), round + Vector3d(0, 0, 0.5)), 100.0 / 512,
              0.25);
    // Along x its frame is (Duff et al. 2017) s = -z, t = y.
    expect_uv(met(cylinder({3, 0, 0}), {1.5, 4, 0}, {1.5, 1, 0}), 0.25, 0.5);
    expect_uv(met(cylinder({3, 0, 0}), {1.5, 1e-4, -4}, {1.5, 1e-4, -1}), 1e-4 / (2 * pi), 0.5);
}

// Mitsuba's mesh of a cube: of each face the corners with (u, v) = (0, 0), (1, 0) and (0, 1).
TEST(TextureCoordinates, OfACubeAreThoseOfMitsubasMesh) {
    struct Face {
        Vector3d origin, u_end, v_end;
    };
    for (const Face& face :
         {Face{{-1, -1, -1}, {-1, -1, 1}, {1, -1, -1}}, Face{{1, 1, 1}, {-1, 1, 1}, {1, 1, -1}},
          Face{{1, -1, 1}, {1, 1, 1}, {1, -1, -1}}, Face{{-1, -1, 1}, {-1, 1, 1}, {1, -1, 1}},
          Face{{-1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, Face{{-1, 1, -1}, {-1, -1, -1}, {1, 1, -1}}}) {
        const Vector3d at = face.origin + 0.2 * (face.u_end - face.origin) + 0.7 * (face.v_end - face.origin);
        const Vector3d outside = -(face.u_end - face.origin).cross(face.v_end - face.origin).normalized();
        const SurfacePoint point = met(node("shape", "cube"), at + 2 * outside, at);
        expect_uv(point, 0.2, 0.7);
        EXPECT_GT(point.geometric_normal.dot(outside.cast<float>()), 0.999f);
        EXPECT_GT(point.frame.s.dot((face.u_end - face.origin).normalized().cast<float>()), 0.999f);
    }
}

}  // namespace
}  // namespace patina::render::test
