#pragma once
// Sensors: cameras (`perspective`, `thinlens`, `orthographic`), meters of one place (`radiancemeter`,
// `irradiancemeter`, `radiositymeter`, `fluxmeter`) and of far away (`goniophotometer`, `distant`).
//
// A sensor is a distribution of rays over its film and a scale: what it measures at a place of the film is the scale
// times the mean radiance along the rays drawn there. Densities of rays are per solid angle at their origin; where all
// rays of a place are parallel (`orthographic`, far away) they are per area across the rays, which the distance turns
// into the same.
//
// In camera space +z is the view direction, +y up and +x to the LEFT of the picture. The Stokes frame of a camera ray
// has x to the right and y up in the picture, seen by the camera; that of a meter's ray has the x axis of its shape
// made perpendicular to the ray; that of a goniophotometer has x along growing azimuth.

#include "patina/core/properties.h"
#include "patina/render/geometry.h"
#include "patina/render/measurement.h"
#include "patina/render/vec.h"
#include "patina/render/wide.h"

namespace patina::render {

struct Sensor {
    enum class Kind { perspective, orthographic, ray, irradiance, radiosity, far_field, distant };
    Kind kind = Kind::perspective;
    Vec3 origin = Vec3::Zero();
    Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();  // camera to world
    // Perspective: tangents of the half field of view of the whole film; orthographic: half its size.
    float tan_half_x = 0.5f, tan_half_y = 0.5f;
    float aperture_radius = 0, focus_distance = 1;  // 0: pinhole
    const Geometry* geometry = nullptr;             // of meters on shapes and of far away
    int shape = -1;                                 // of meters on shapes
    bool targeted = false;                          // distant: rays pass through `origin`
    double exposure_s = 0;

    Quantity quantity = Quantity::radiance;
    double scale = 1;  // of the mean radiance

    struct CameraRay {
        Ray ray;
        Vec3 stokes_axis;
        Vec3 normal = Vec3::Zero();  // of the meter's surface
    };
    // film: position in the whole film, (0, 0) upper left, (1, 1) lower right; lens: in the unit square.
    CameraRay ray(const Vec2& film, const Vec2& lens) const {
        if (kind != Kind::perspective) return other_ray(film, lens);
        const Vec3 direction((1 - 2 * film.x()) * tan_half_x, (1 - 2 * film.y()) * tan_half_y, 1);
        CameraRay result;
        result.ray.origin = origin;
        result.ray.direction = unit(rotation * direction);
        if (aperture_radius > 0) refocus(direction, lens, result.ray);
        result.stokes_axis = unit(result.ray.direction.cross(Vec3(rotation.col(1))));
        return result;
    }
    // ray() for `count` places of the film side by side.
    void rays(const FloatLanes& film_x, const FloatLanes& film_y, const FloatLanes& lens_x, const FloatLanes& lens_y,
              int count, CameraRay* const* results) const;
    // ray() depends on `lens`.
    bool uses_lens() const { return aperture_radius > 0 || (kind >= Kind::irradiance && !targeted); }
    // A measuring instrument: its film has no filter.
    bool is_meter() const { return kind >= Kind::ray; }

    // How a point is seen from a point of the lens.
    struct Sight {
        Vec2 film;
        Vec3 from, direction;  // on the lens, and unit from there to the point
        float distance = 0;
        float importance = 0;  // density per solid angle of ray() for uniform places on the whole film
        Vec3 stokes_axis;      // as ray() gives it
    };
    // False: the point is neither on the film nor within half its size beside it, where filters may reach.
    bool see(const Vec3& point, const Vec2& lens, Sight& sight) const;
    // see() never does: no point of the scene can be joined with this sensor.
    bool blind() const { return kind == Kind::ray || kind == Kind::radiosity || targeted; }
    // Density per solid angle of a ray of ray()'s for uniform places on the whole film, at this distance.
    float importance(const CameraRay& camera, float distance) const;

  private:
    void refocus(const Vec3& direction, const Vec2& lens, Ray& ray) const;
    CameraRay other_ray(const Vec2& film, const Vec2& lens) const;
    CameraRay surface_ray(const Vec2& film, const Vec2& lens) const;
    CameraRay far_ray(const Vec2& film, const Vec2& lens) const;
    bool see_perspective(const Vec3& point, const Vec2& lens, Sight& sight) const;
    bool see_from_surface(const Vec3& point, const Vec2& lens, Sight& sight) const;
    bool see_from_far(const Vec3& point, const Vec2& lens, Sight& sight) const;
    float perspective_importance(const Vec3& direction) const {
        const float cos = direction.dot(Vec3(rotation.col(2)));
        return 1 / (4 * tan_half_x * tan_half_y * cos * cos * cos);
    }
    float film_area() const;  // across the parallel rays
    // Towards the goniophotometer's place on the film, and the Stokes axis there.
    void far_direction(const Vec2& film, Vec3& towards, Vec3& axis) const;
};

// The film's size decides the aspect; `shape` is the one the sensor stands in, -1 for none. The geometry must outlive
// the sensor. Throws Error(input) for unknown sensors and values out of range.
Sensor build_sensor(const Properties& node, int film_width, int film_height, const Geometry& geometry, int shape);

// tan(half the field of view) along x from `fov` and `fov_axis`, or `focal_length` on 36 x 24 mm film; of cameras, and
// of projectors. `aspect` is width over height.
double tangent_along_x(const Properties& node, double aspect);

// When light counts: `shutter_open` and `shutter_close` of a sensor.
struct Shutter {
    double open_s = 0, close_s = 0;
};
Shutter build_shutter(const Properties& node);

// The film of a sensor that names none: one pixel for a meter of one number.
std::pair<int, int> default_film_size(const Properties& node);

}  // namespace patina::render
