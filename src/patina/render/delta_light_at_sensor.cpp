#include "patina/render/delta_light_at_sensor.h"

#include "patina/render/arriving_light.h"

namespace patina::render {

namespace {

// On a surface: irradiance is pi times the mean radiance over rays drawn by the cosine.
StokesPacket on_surface(const Scene& scene, const Sensor& sensor, const Sensor::CameraRay& camera,
                        const Wavelengths& w) {
    StokesPacket sum{};
    for (int emitter = 0; emitter < static_cast<int>(scene.lights.all().size()); ++emitter) {
        LightSample light;
        if (!scene.lights.is_delta(emitter) ||
            !scene.lights.sample_emitter(emitter, scene.geometry, camera.ray.origin, w, Vec2::Zero(), light))
            continue;
        const float cos = light.direction.dot(camera.normal);
        if (cos <= 0 || scene.geometry.occluded(
                            {camera.ray.origin, light.direction, light.distance * (1 - 1e-4f), camera.ray.time}))
            continue;
        const Throughput ray(Frame(light.direction, sensor.rotation.col(0)).s);
        sum += arriving(ray, scene.lights, emitter, light.radiance * (cos * inv_pi_f), -light.direction);
    }
    return sum;
}

// Far away: intensity is the mean radiance over a disk as wide as the scene, times its area.
StokesPacket far_away(const Scene& scene, const Sensor::CameraRay& camera, const Wavelengths& w) {
    StokesPacket sum{};
    const Vec3 towards = -camera.ray.direction;
    const auto add = [&](int emitter, const Vec3& position, Float4 intensity) {
        if (largest(intensity) <= 0 || scene.geometry.occluded({position, towards, INFINITY, camera.ray.time})) return;
        const float share = inv_pi_f / sqr(scene.geometry.radius());
        sum += arriving(Throughput(camera.stokes_axis), scene.lights, emitter, intensity * share, towards);
    };
    for (int emitter = 0; emitter < static_cast<int>(scene.lights.all().size()); ++emitter) {
        const Emitter& e = scene.lights.all()[emitter];
        if (const auto* point = std::get_if<PointEmitter>(&e)) add(emitter, point->position, point->intensity.at(w));
        if (const auto* spot = std::get_if<SpotEmitter>(&e))
            add(emitter, spot->position, spot->intensity_along(w, towards));
    }
    return sum;
}

}  // namespace

StokesPacket delta_light_at_sensor(const Scene& scene, const Sensor& sensor, const Sensor::CameraRay& camera,
                                   const Wavelengths& w) {
    if (sensor.kind == Sensor::Kind::irradiance) return on_surface(scene, sensor, camera, w);
    const bool whole_scene = sensor.kind == Sensor::Kind::far_field || sensor.kind == Sensor::Kind::distant;
    return whole_scene && !sensor.targeted ? far_away(scene, camera, w) : StokesPacket{};
}

}  // namespace patina::render
