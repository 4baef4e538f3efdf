#include "patina/render/geometry.h"

#include "patina/render/plane_uv.h"

namespace patina::render {

namespace {

// Above this number a hierarchy beats testing every shape (measured: about 3 ns a shape against 100 ns a ray).
constexpr std::size_t most_tested_one_by_one = 24;

// Share of the coordinates' size that rounding may move a point off its surface: some sixteen units in the last place.
constexpr float relative_offset = 2e-6f;

void grow(Eigen::AlignedBox3f& box, const AnalyticShape& s) {
    if (s.kind == AnalyticShape::Kind::sphere) {
        box.extend(s.o - Vec3::Constant(s.radius));
        box.extend(s.o + Vec3::Constant(s.radius));
        return;
    }
    for (float u : {-1.0f, 1.0f})
        for (float v : {-1.0f, 1.0f}) box.extend(s.o + u * s.a + v * s.b);
}

// Completes a sample that was drawn uniformly over `area` with its normal; false: only its back is seen.
bool shows_its_front(const Vec3& to_point, float area, ShapeSample& sample) {
    const float distance2 = to_point.squaredNorm();
    sample.distance = std::sqrt(distance2);
    sample.direction = to_point * (1 / sample.distance);
    const float cos = -sample.direction.dot(sample.normal);
    sample.pdf = cos > 0 ? distance2 / (cos * area) : 0.0f;
    return sample.pdf > 0 && std::isfinite(sample.pdf);
}

}  // namespace

void Geometry::commit() {
    Eigen::AlignedBox3f box;
    for (ShapeGroup& group : groups)
        for (int i = group.first; i < group.first + group.count; ++i) {
            grow(group.box, group_analytic[i]);
            group_analytic[i].set_frame();
        }
    for (AnalyticShape& s : analytic) {
        grow(box, s);
        s.set_frame();
    }
    for (const MeshShape& m : meshes)
        for (const Vec3& p : m.mesh->positions) (m.group < 0 ? box : groups[m.group].box).extend(p);
    for (const Instance& instance : instances) {
        box.extend(instance.bounds(groups[instance.group].box));
        moves_ |= instance.to_world.size() > 1;
    }
    if (!box.isEmpty()) {
        centre_ = box.center();
        radius_ = std::max(0.5f * box.diagonal().norm(), 1e-6f);
    }
    brute_force_ = analytic.size() <= most_tested_one_by_one;
    if (!meshes.empty() || !instances.empty() || !brute_force_)
        embree_ = std::make_unique<EmbreeScene>(*this, brute_force_ ? std::span<const AnalyticShape>{} : analytic);
}

void Geometry::intersect(RayBlock& rays, int count, Hit* hits) const {
    // Meet the analytic shapes, all rays at once.
    const RayOf<WideFloat> wide = ray_components(rays);
    WideFloat nearest = rays.t.load(), best_u{}, best_v{};
    WideInt best = WideInt{} - 1;
    for (int i = 0; brute_force_ && i < static_cast<int>(analytic.size()); ++i) {
        WideFloat u{}, v{};
        const WideFloat t = analytic[i].distance(wide, u, v);
        const WideInt nearer = t < nearest;
        nearest = nearer ? t : nearest;
        best_u = nearer ? u : best_u;
        best_v = nearer ? v : best_v;
        best = nearer ? WideInt{} + i : best;
    }
    rays.t.store(nearest);
    rays.u.store(best_u);
    rays.v.store(best_v);
    rays.primitive.store(best);
    for (int k = 0; k < count; ++k) {
        const int primitive = rays.primitive[k];
        hits[k] = {rays.t[k], primitive < 0 ? -1 : analytic[primitive].shape, primitive, false, rays.u[k], rays.v[k]};
    }

    // Then what Embree holds, where it is nearer.
    for (int k = 0; embree_ && k < count; ++k) embree_->intersect(rays.ray(k), hits[k]);
}

std::uint32_t Geometry::occluded(RayBlock& rays, int count) const {
    const RayOf<WideFloat> wide = ray_components(rays);
    const WideFloat reach = rays.t.load();
    WideInt blocked{};
    for (int i = 0; brute_force_ && i < static_cast<int>(analytic.size()); ++i) {
        WideFloat u, v;
        blocked |= analytic[i].distance(wide, u, v) < reach;
    }
    std::uint32_t bits = set_lanes(blocked) & ((1u << count) - 1);
    for (int k = 0; embree_ && k < count; ++k)
        if (!(bits >> k & 1) && embree_->occluded(rays.ray(k))) bits |= 1u << k;
    return bits;
}

void Geometry::find_surface(const Ray& ray, const Hit& hit, SurfacePoint& point) const {
    point.shape = hit.shape;
    if (hit.instance >= 0)
        surface_of_instance(ray, hit, point);
    else if (hit.triangle)
        surface_of_triangle(hit, point);
    else
        surface_of_analytic(analytic[hit.primitive], ray, hit, point);
    point.offset = relative_offset * std::max(point.position.cwiseAbs().maxCoeff(), 0.1f * radius_);
}

void Geometry::surface_of_instance(const Ray& ray, const Hit& hit, SurfacePoint& point) const {
    // Find the point in the group's own space, and bring it to the world: normals by the inverse transpose.
    const Eigen::Matrix4f m = instances[hit.instance].at(ray.time);
    const Eigen::Matrix3f linear = m.block<3, 3>(0, 0), inverse = linear.inverse();
    const Vec3 place = m.block<3, 1>(0, 3);
    if (hit.triangle)
        surface_of_triangle(hit, point);
    else
        surface_of_analytic(group_analytic[hit.primitive],
                            {inverse * (ray.origin - place), inverse * ray.direction, ray.t_max}, hit, point);
    point.position = linear * point.position + place;
    point.geometric_normal = (inverse.transpose() * point.geometric_normal).normalized();
    point.frame = Frame((inverse.transpose() * point.frame.n).normalized(), linear * point.frame.s);
}

void Geometry::surface_of_analytic(const AnalyticShape& s, const Ray& ray, const Hit& hit, SurfacePoint& point) const {
    if (s.kind != AnalyticShape::Kind::sphere) {
        point.position = s.o + hit.u * s.a + hit.v * s.b;
        point.frame = s.frame;
        point.geometric_normal = s.frame.n;
        if (s.kind == AnalyticShape::Kind::disk) {
            point.uv = uv_of_plane(s, hit.u, hit.v);
            // The tangent is along u, the radius.
            point.frame = Frame(s.frame.n, hit.u * s.a + hit.v * s.b);
            return;
        }
        point.uv = {0.5f * (hit.u + 1), 0.5f * (hit.v + 1)};
        return;
    }
    // Put the point back on the sphere: the ray's own rounding grows with its length.
    const Vec3 outward = unit(ray.origin + hit.t * ray.direction - s.o);
    point.position = s.o + s.radius * outward;
    point.geometric_normal = s.flipped ? Vec3(-outward) : outward;
    // The tangent along the circle of latitude is perpendicular to the normal as it is.
    const float x = s.a.dot(outward), y = s.b.dot(outward), sin2 = x * x + y * y;
    if (sin2 > 1e-20f) {
        point.frame.n = point.geometric_normal;
        point.frame.s = (s.b * x - s.a * y) * (1 / std::sqrt(sin2));
        point.frame.t = point.frame.n.cross(point.frame.s);
    } else {
        point.frame = Frame(point.geometric_normal);
    }
    if (needs_uv) {
        point.uv = s.spherical(outward);
    }
}

void Geometry::surface_of_triangle(const Hit& hit, SurfacePoint& point) const {
    const MeshShape& m = meshes[shapes[hit.shape].first];
    const TriangleMesh& mesh = *m.mesh;
    const auto& [i0, i1, i2] = mesh.triangles[hit.primitive];
    const float u = hit.u, v = hit.v, w = 1 - u - v;
    const Vec3 e1 = mesh.positions[i1] - mesh.positions[i0], e2 = mesh.positions[i2] - mesh.positions[i0];
    point.position = w * mesh.positions[i0] + u * mesh.positions[i1] + v * mesh.positions[i2];
    point.geometric_normal = e1.cross(e2).normalized();
    Vec3 shading = point.geometric_normal;
    if (!mesh.normals.empty()) {
        const Vec3 n = w * mesh.normals[i0] + u * mesh.normals[i1] + v * mesh.normals[i2];
        if (n.squaredNorm() > 1e-12f) shading = n.normalized();
        // The file's normals say which side is outside, whatever the order of the corners.
        if (shading.dot(point.geometric_normal) < 0) point.geometric_normal = -point.geometric_normal;
    }
    Vec2 uv(u, v);
    Vec3 tangent = Vec3::Zero();
    if (!mesh.uvs.empty()) {
        const Vec2 &a = mesh.uvs[i0], &b = mesh.uvs[i1], &c = mesh.uvs[i2];
        uv = w * a + u * b + v * c;
        const Vec2 d1 = b - a, d2 = c - a;
        const float det = d1.x() * d2.y() - d1.y() * d2.x();
        if (det != 0) tangent = (e1 * d2.y() - e2 * d1.y()) / det;
    }
    point.uv = {uv, hit.primitive, u, v};
    if (m.flipped) {
        shading = -shading;
        point.geometric_normal = -point.geometric_normal;
    }
    point.frame = Frame(shading, tangent);
}

bool Geometry::sample_sphere(const AnalyticShape& sphere, const Vec3& from, const Vec2& u, ShapeSample& sample) const {
    const Vec3 to_centre = sphere.o - from;
    const float distance2 = to_centre.squaredNorm(), radius2 = sphere.radius * sphere.radius;
    if (distance2 <= radius2 * 1.0001f) {
        // From inside: uniform over the area.
        sample.normal = uniform_sphere(u);
        if (needs_uv) sample.uv = sphere.spherical(sample.normal);
        const Vec3 to_point = to_centre + sphere.radius * sample.normal;
        if (sphere.flipped) sample.normal = -sample.normal;
        return shows_its_front(to_point, sphere.area, sample);
    }
    // From outside: uniform over the cone the sphere fills.
    if (sphere.flipped) return false;
    const float sin2_max = radius2 / distance2;
    const float one_minus_cos_max = sin2_max / (1 + safe_sqrt(1 - sin2_max));
    const float one_minus_cos = u.x() * one_minus_cos_max, cos = 1 - one_minus_cos;
    const float sin2 = one_minus_cos * (2 - one_minus_cos), phi = 2 * pi_f * u.y();
    const Frame frame(to_centre / std::sqrt(distance2));
    sample.direction = frame.to_world({safe_sqrt(sin2) * std::cos(phi), safe_sqrt(sin2) * std::sin(phi), cos});
    sample.distance = std::sqrt(distance2) * cos - safe_sqrt(radius2 - distance2 * sin2);
    sample.normal = (sample.distance * sample.direction - to_centre).normalized();
    if (needs_uv) sample.uv = sphere.spherical(sample.normal);
    sample.pdf = 1 / (2 * pi_f * one_minus_cos_max);
    return true;
}

bool Geometry::sample_shape(int index, const Vec3& from, const Vec2& u, ShapeSample& sample) const {
    const Shape& shape = shapes[index];
    Vec3 position;
    if (shape.is_mesh) {
        const MeshShape& m = meshes[shape.first];
        const auto choice = m.by_area.sample(u.x());
        const auto& [i0, i1, i2] = m.mesh->triangles[choice.index];
        const Vec3 &p0 = m.mesh->positions[i0], &p1 = m.mesh->positions[i1], &p2 = m.mesh->positions[i2];
        const float root = std::sqrt(choice.remainder), b1 = root * (1 - u.y()), b2 = root * u.y();
        position = (1 - b1 - b2) * p0 + b1 * p1 + b2 * p2;
        sample.uv = {m.mesh->uv_at(choice.index, b1, b2), choice.index, b1, b2};
        sample.normal = (p1 - p0).cross(p2 - p0).normalized();
        if (!m.mesh->normals.empty() && sample.normal.dot(m.mesh->normals[i0]) < 0) sample.normal = -sample.normal;
        if (m.flipped) sample.normal = -sample.normal;
    } else {
        // Faces of a cube are drawn by area: they are parallelograms one and all.
        float rest = u.x();
        int face = shape.first;
        if (shape.count > 1) {
            float at = u.x() * shape.area;
            while (face + 1 < shape.first + shape.count && at >= analytic[face].area) at -= analytic[face++].area;
            rest = std::clamp(at / analytic[face].area, 0.0f, 0x1.fffffep-1f);
        }
        const AnalyticShape& s = analytic[face];
        if (s.kind == AnalyticShape::Kind::sphere) return sample_sphere(s, from, u, sample);
        const Vec2 p =
            s.kind == AnalyticShape::Kind::disk ? concentric_disk({rest, u.y()}) : Vec2(2 * rest - 1, 2 * u.y() - 1);
        position = s.o + p.x() * s.a + p.y() * s.b;
        if (needs_uv) sample.uv = uv_of_plane(s, p.x(), p.y());
        sample.normal = s.flipped ? Vec3(-s.n) : s.n;
    }
    return shows_its_front(position - from, shape.area, sample);
}

float Geometry::shape_pdf(const Hit& hit, const SurfacePoint& at, const Vec3& from) const {
    if (!hit.triangle && analytic[hit.primitive].kind == AnalyticShape::Kind::sphere) {
        const AnalyticShape& s = analytic[hit.primitive];
        const float distance2 = (s.o - from).squaredNorm(), radius2 = s.radius * s.radius;
        if (distance2 > radius2 * 1.0001f) {
            const float sin2_max = radius2 / distance2;
            return (1 + safe_sqrt(1 - sin2_max)) / (2 * pi_f * sin2_max);
        }
    }
    const Vec3 d = from - at.position;
    const float distance2 = d.squaredNorm(), cos = std::abs(d.dot(at.geometric_normal));
    return distance2 * std::sqrt(distance2) / (cos * shapes[hit.shape].area);
}

}  // namespace patina::render
