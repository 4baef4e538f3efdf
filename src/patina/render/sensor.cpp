#include "patina/render/sensor.h"

#include "patina/render/concentric_disk.h"
#include "patina/render/sampling.h"
#include "patina/render/shape_area.h"

namespace patina::render {

void Sensor::rays(const FloatLanes& film_x, const FloatLanes& film_y, const FloatLanes& lens_x,
                  const FloatLanes& lens_y, int count, CameraRay* const* results) const {
    if (kind != Kind::perspective || aperture_radius > 0) {
        for (int k = 0; k < count; ++k) *results[k] = ray({film_x[k], film_y[k]}, {lens_x[k], lens_y[k]});
        return;
    }
    // A pinhole: as ray() does it, lane by lane.
    const WideFloat x = (1 - 2 * film_x.load()) * tan_half_x, y = (1 - 2 * film_y.load()) * tan_half_y;
    const auto to_world = [&](int row) { return rotation(row, 0) * x + rotation(row, 1) * y + rotation(row, 2); };
    const WideVec3 direction = unit(WideVec3{to_world(0), to_world(1), to_world(2)});
    const WideVec3 axis = unit(cross(direction, components(Vec3(rotation.col(1)))));
    FloatLanes d[3], a[3];
    d[0].store(direction.x), d[1].store(direction.y), d[2].store(direction.z);
    a[0].store(axis.x), a[1].store(axis.y), a[2].store(axis.z);
    for (int k = 0; k < count; ++k)
        *results[k] = {{origin, {d[0][k], d[1][k], d[2][k]}}, {a[0][k], a[1][k], a[2][k]}, Vec3::Zero()};
}

void Sensor::refocus(const Vec3& direction, const Vec2& lens, Ray& ray) const {
    const Vec2 on_lens = aperture_radius * concentric_disk(lens);
    const Vec3 start(on_lens.x(), on_lens.y(), 0);
    ray.origin = origin + rotation * start;
    ray.direction = (rotation * (focus_distance * direction - start)).normalized();
}

Sensor::CameraRay Sensor::other_ray(const Vec2& film, const Vec2& lens) const {
    if (kind == Kind::irradiance || kind == Kind::radiosity) return surface_ray(film, lens);
    if (kind == Kind::far_field || kind == Kind::distant) return far_ray(film, lens);
    // One direction: of parallel rays over the film, or a single one.
    CameraRay result;
    result.ray.origin = origin;
    if (kind == Kind::orthographic)
        result.ray.origin += rotation * Vec3((1 - 2 * film.x()) * tan_half_x, (1 - 2 * film.y()) * tan_half_y, 0);
    result.ray.direction = rotation.col(2);
    result.stokes_axis = -rotation.col(0);
    return result;
}

Sensor::CameraRay Sensor::surface_ray(const Vec2& film, const Vec2& lens) const {
    // A point by area, a direction of its outside by the cosine.
    CameraRay result;
    Vec3 position;
    point_of_shape(*geometry, geometry->shapes[shape], lens, position, result.normal);
    const Vec3 outward = Frame(result.normal, rotation.col(0)).to_world(cosine_hemisphere(film));
    const float reach = 4e-6f * std::max(position.cwiseAbs().maxCoeff(), 0.1f * geometry->radius());
    result.ray.origin = position + result.normal * reach;
    result.ray.direction = outward;
    if (kind == Kind::radiosity) {
        // Look at the point from just before it.
        result.ray.origin = position + outward * (reach / std::max(outward.dot(result.normal), 1e-3f));
        result.ray.direction = -outward;
    }
    result.stokes_axis = Frame(result.ray.direction, rotation.col(0)).s;
    return result;
}

void Sensor::far_direction(const Vec2& film, Vec3& towards, Vec3& axis) const {
    if (kind == Kind::distant) {
        towards = -rotation.col(2);
        axis = -rotation.col(0);
        return;
    }
    const float cos = 1 - 2 * film.y(), sin = safe_sqrt(1 - cos * cos), phi = 2 * pi_f * film.x();
    towards = rotation * Vec3(sin * std::cos(phi), sin * std::sin(phi), cos);
    axis = rotation * Vec3(-std::sin(phi), std::cos(phi), 0);
}

Sensor::CameraRay Sensor::far_ray(const Vec2& film, const Vec2& lens) const {
    CameraRay result;
    Vec3 towards;
    far_direction(film, towards, result.stokes_axis);
    const float radius = geometry->radius();
    Vec3 through = origin;
    if (!targeted) {
        const Vec2 on_disk = concentric_disk(lens) * radius;
        through = geometry->centre() + Frame(towards).to_world({on_disk.x(), on_disk.y(), 0});
    }
    // Begin outside of everything.
    const float out = 1.01f * radius + std::abs((geometry->centre() - through).dot(towards));
    result.ray.origin = through + towards * out;
    result.ray.direction = -towards;
    return result;
}

bool Sensor::see(const Vec3& point, const Vec2& lens, Sight& sight) const {
    switch (kind) {
        case Kind::perspective:
            return see_perspective(point, lens, sight);
        case Kind::irradiance:
            return see_from_surface(point, lens, sight);
        case Kind::far_field:
        case Kind::distant:
            return !targeted && see_from_far(point, lens, sight);
        case Kind::ray:
        case Kind::radiosity:
            return false;
        case Kind::orthographic:
            break;
    }
    const Vec3 local = rotation.transpose() * (point - origin);
    if (!(local.z() > 0)) return false;
    sight.film = {0.5f * (1 - local.x() / tan_half_x), 0.5f * (1 - local.y() / tan_half_y)};
    if (sight.film.minCoeff() < -0.5f || sight.film.maxCoeff() > 1.5f) return false;
    sight.direction = rotation.col(2);
    sight.distance = local.z();
    sight.from = point - sight.direction * sight.distance;
    sight.importance = sqr(sight.distance) / film_area();
    sight.stokes_axis = -rotation.col(0);
    return true;
}

bool Sensor::see_perspective(const Vec3& point, const Vec2& lens, Sight& sight) const {
    Vec3 start = Vec3::Zero();
    if (aperture_radius > 0) start.head<2>() = aperture_radius * concentric_disk(lens);
    const Vec3 towards = rotation.transpose() * (point - origin) - start;
    if (!(towards.z() > 0)) return false;

    // All lens points see a place of the film at the same point of the plane in focus.
    const Vec3 in_focus = start / focus_distance + towards / towards.z();
    sight.film = {0.5f * (1 - in_focus.x() / tan_half_x), 0.5f * (1 - in_focus.y() / tan_half_y)};
    // A reconstruction filter reaches over the film's edge.
    if (sight.film.minCoeff() < -0.5f || sight.film.maxCoeff() > 1.5f) return false;
    sight.from = origin + rotation * start;
    sight.distance = towards.norm();
    sight.direction = rotation * (towards / sight.distance);
    sight.importance = perspective_importance(sight.direction);
    sight.stokes_axis = sight.direction.cross(Vec3(rotation.col(1))).normalized();
    return true;
}

bool Sensor::see_from_surface(const Vec3& point, const Vec2& lens, Sight& sight) const {
    Vec3 normal;
    point_of_shape(*geometry, geometry->shapes[shape], lens, sight.from, normal);
    const Vec3 d = point - sight.from;
    sight.distance = d.norm();
    if (!(sight.distance > 0)) return false;
    sight.direction = d / sight.distance;
    const Vec3 local = Frame(normal, rotation.col(0)).to_local(sight.direction);
    if (!(local.z() > 0)) return false;
    sight.film = square_of_disk(local.head<2>());
    sight.importance = local.z() * inv_pi_f;
    sight.stokes_axis = Frame(sight.direction, rotation.col(0)).s;
    return true;
}

bool Sensor::see_from_far(const Vec3& point, const Vec2& lens, Sight& sight) const {
    Vec3 towards;
    far_direction(lens, towards, sight.stokes_axis);
    sight.film = lens;
    sight.direction = -towards;
    sight.distance = 1.01f * geometry->radius() - (point - geometry->centre()).dot(towards);
    sight.from = point + towards * sight.distance;
    sight.importance = sqr(sight.distance) / film_area();
    return sight.distance > 0;
}

float Sensor::film_area() const {
    return kind == Kind::orthographic ? 4 * tan_half_x * tan_half_y : pi_f * sqr(geometry->radius());
}

float Sensor::importance(const CameraRay& camera, float distance) const {
    switch (kind) {
        case Kind::perspective:
            return perspective_importance(camera.ray.direction);
        case Kind::irradiance:
            return std::max(camera.normal.dot(camera.ray.direction), 0.0f) * inv_pi_f;
        case Kind::ray:
        case Kind::radiosity:
            return 1;
        default:
            break;
    }
    // Nothing is joined with what lies at infinity.
    return std::isfinite(distance) ? sqr(distance) / film_area() : 1.0f;
}

}  // namespace patina::render
