#pragma once
// Cameras: pinhole (`perspective`) and thin lens (`thinlens`), with Mitsuba's geometry.
//
// In camera space +z is the view direction, +y up and +x to the LEFT of the picture. The Stokes frame of a camera ray
// has x to the right and y up in the picture, seen by the camera.

#include "patina/core/properties.h"
#include "patina/render/vec.h"

namespace patina::render {

struct Sensor {
    Vec3 origin = Vec3::Zero();
    Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();  // camera to world
    float tan_half_x = 0.5f, tan_half_y = 0.5f;              // of the field of view of the whole film
    float aperture_radius = 0, focus_distance = 1;           // 0: pinhole

    struct CameraRay {
        Ray ray;
        Vec3 stokes_axis;
    };
    // film: position in the whole film, (0, 0) upper left, (1, 1) lower right; lens: in the unit square.
    CameraRay ray(const Vec2& film, const Vec2& lens) const {
        const Vec3 direction((1 - 2 * film.x()) * tan_half_x, (1 - 2 * film.y()) * tan_half_y, 1);
        CameraRay result;
        result.ray.origin = origin;
        result.ray.direction = unit(rotation * direction);
        if (aperture_radius > 0) refocus(direction, lens, result.ray);
        result.stokes_axis = unit(result.ray.direction.cross(Vec3(rotation.col(1))));
        return result;
    }

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
    // Density per solid angle of ray() in this direction for uniform places on the whole film (a ray of the camera's).
    float importance(const Vec3& direction) const {
        const float cos = direction.dot(Vec3(rotation.col(2)));
        return 1 / (4 * tan_half_x * tan_half_y * cos * cos * cos);
    }

  private:
    void refocus(const Vec3& direction, const Vec2& lens, Ray& ray) const;
};

// The film's size decides the aspect. Throws Error(input) for unknown sensors and values out of range.
Sensor build_sensor(const Properties& node, int film_width, int film_height);

}  // namespace patina::render
