#include "patina/render/shape_area.h"

#include "patina/render/plane_uv.h"

namespace patina::render {

void point_of_shape(const Geometry& geometry, const Shape& shape, const Vec2& u, Vec3& position, Vec3& normal,
                    SurfaceUv& uv) {
    if (shape.is_mesh) {
        const MeshShape& m = geometry.meshes[shape.first];
        const auto choice = m.by_area.sample(u.x());
        const auto& [i0, i1, i2] = m.mesh->triangles[choice.index];
        const Vec3 &p0 = m.mesh->positions[i0], &p1 = m.mesh->positions[i1], &p2 = m.mesh->positions[i2];
        const float root = std::sqrt(choice.remainder), b1 = root * (1 - u.y()), b2 = root * u.y();
        position = (1 - b1 - b2) * p0 + b1 * p1 + b2 * p2;
        uv = {m.mesh->uv_at(choice.index, b1, b2), choice.index, b1, b2};
        normal = (p1 - p0).cross(p2 - p0).normalized();
        if (!m.mesh->normals.empty() && normal.dot(m.mesh->normals[i0]) < 0) normal = -normal;
        if (m.flipped) normal = -normal;
        return;
    }
    float at = u.x() * shape.area;
    int face = shape.first;
    while (face + 1 < shape.first + shape.count && at >= geometry.analytic[face].area)
        at -= geometry.analytic[face++].area;
    const AnalyticShape& s = geometry.analytic[face];
    const float rest = std::clamp(at / s.area, 0.0f, 0x1.fffffep-1f);
    if (s.kind == AnalyticShape::Kind::sphere) {
        normal = uniform_sphere({rest, u.y()});
        position = s.o + s.radius * normal;
        uv = geometry.needs_uv ? s.spherical(normal) : Vec2(0, 0);
    } else {
        const Vec2 p =
            s.kind == AnalyticShape::Kind::disk ? concentric_disk({rest, u.y()}) : Vec2(2 * rest - 1, 2 * u.y() - 1);
        position = s.o + p.x() * s.a + p.y() * s.b;
        uv = uv_of_plane(s, p.x(), p.y());
        normal = s.n;
    }
    if (s.flipped) normal = -normal;
}

void point_of_shape(const Geometry& geometry, const Shape& shape, const Vec2& u, Vec3& position, Vec3& normal) {
    SurfaceUv uv;
    point_of_shape(geometry, shape, u, position, normal, uv);
}

}  // namespace patina::render
