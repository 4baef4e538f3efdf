#include "patina/render/sensor.h"

#include <fmt/format.h>

#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/render/plugins.h"
#include "patina/render/sampling.h"

namespace patina::render {

namespace {

// tan(half field of view) along x from `fov` and `fov_axis`, or `focal_length` on 36 x 24 mm film.
double tangent_along_x(const Properties& node, double aspect) {
    double fov_deg = 0;
    std::string axis = "x";
    if (node.has("focal_length")) {
        if (node.has("fov")) throw input_error(node.location_of("fov"), "give \"fov\" or \"focal_length\", not both");
        const std::string text = node.string("focal_length");
        char* end = nullptr;
        const double length_mm = std::strtod(text.c_str(), &end);
        if (!(length_mm > 0) || (std::string_view(end) != "mm" && *end != '\0'))
            throw input_error(node.location_of("focal_length"), "focal length out of range", "",
                              "write for instance \"50mm\"");
        fov_deg = degrees(2 * std::atan(0.5 * std::hypot(36.0, 24.0) / length_mm));
        axis = "diagonal";
    } else {
        fov_deg = node.number("fov", degrees(2 * std::atan(0.5 * 36.0 / 50.0)));
        axis = node.string("fov_axis", "x");
    }
    if (!(fov_deg > 0 && fov_deg < 180))
        throw input_error(node.location_of("fov"), "field of view out of range",
                          fmt::format("it is {} degrees", fov_deg), "keep it between 0 and 180");
    const double t = std::tan(radians(0.5 * fov_deg));
    if (axis == "smaller") axis = aspect > 1 ? "y" : "x";
    if (axis == "larger") axis = aspect > 1 ? "x" : "y";
    if (axis == "x") return t;
    if (axis == "y") return t * aspect;
    if (axis == "diagonal") return t * aspect / std::hypot(aspect, 1.0);
    throw input_error(node.location_of("fov_axis"), fmt::format("unknown fov_axis \"{}\"", axis), "",
                      did_you_mean(axis, {"x", "y", "diagonal", "smaller", "larger"}));
}

}  // namespace

void Sensor::refocus(const Vec3& direction, const Vec2& lens, Ray& ray) const {
    const Vec2 on_lens = aperture_radius * concentric_disk(lens);
    const Vec3 start(on_lens.x(), on_lens.y(), 0);
    ray.origin = origin + rotation * start;
    ray.direction = (rotation * (focus_distance * direction - start)).normalized();
}

bool Sensor::see(const Vec3& point, const Vec2& lens, Sight& sight) const {
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
    sight.importance = importance(sight.direction);
    sight.stokes_axis = sight.direction.cross(Vec3(rotation.col(1))).normalized();
    return true;
}

Sensor build_sensor(const Properties& node, int film_width, int film_height) {
    expect_plugin(node);
    Sensor sensor;
    const double aspect = static_cast<double>(film_width) / film_height;
    sensor.tan_half_x = static_cast<float>(tangent_along_x(node, aspect));
    sensor.tan_half_y = static_cast<float>(sensor.tan_half_x / aspect);

    // Take the camera's axes from the transform; scale along them has no meaning.
    const Eigen::Matrix4d to_world = node.transform("to_world");
    for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d column = to_world.block<3, 1>(0, axis);
        if (!(column.norm() > 1e-12) || !column.allFinite())
            throw input_error(node.location_of("to_world"), "the sensor's transform is degenerate");
        sensor.rotation.col(axis) = column.normalized().cast<float>();
    }
    if (std::abs(sensor.rotation.determinant()) < 0.5f)
        throw input_error(node.location_of("to_world"), "the sensor's axes are not perpendicular",
                          "the up vector may be parallel to the view");
    sensor.origin = to_world.block<3, 1>(0, 3).cast<float>();

    // Mitsuba clips at these planes; a path tracer has no need of them.
    node.number("near_clip", 0.01);
    node.number("far_clip", 1e4);
    if (node.type == "thinlens") {
        sensor.aperture_radius = static_cast<float>(node.number("aperture_radius"));
        sensor.focus_distance = static_cast<float>(node.number("focus_distance"));
        if (!(sensor.aperture_radius >= 0) || !(sensor.focus_distance > 0))
            throw input_error(node.where, "aperture_radius must be >= 0 and focus_distance > 0");
    }
    return sensor;
}

}  // namespace patina::render
