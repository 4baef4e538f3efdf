// Sensors from their nodes of the scene file.

#include <fmt/format.h>

#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/render/plugins.h"
#include "patina/render/sensor.h"

namespace patina::render {

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

namespace {

// The sensor's place and axes.
void place(const Properties& node, const Eigen::Matrix4d& to_world, Sensor& sensor) {
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
    if (!sensor.origin.allFinite()) throw input_error(node.location_of("to_world"), "the sensor's place is not finite");
}

void build_camera(const Properties& node, double aspect, Sensor& sensor) {
    const Eigen::Matrix4d to_world = node.transform("to_world");
    place(node, to_world, sensor);
    // Mitsuba clips at these planes; a path tracer has no need of them.
    node.number("near_clip", 0.01);
    node.number("far_clip", 1e4);
    // A pinhole has everything in focus; Mitsuba's own Cornell box names a distance nevertheless.
    if (node.type == "perspective") node.number("focus_distance", 1.0);
    if (node.type == "orthographic") {
        // The film is -1 .. 1 along x of the sensor's own space, whose scale counts.
        sensor.kind = Sensor::Kind::orthographic;
        sensor.tan_half_x = static_cast<float>(to_world.block<3, 1>(0, 0).norm());
        sensor.tan_half_y = static_cast<float>(to_world.block<3, 1>(0, 1).norm() / aspect);
        return;
    }
    sensor.tan_half_x = static_cast<float>(tangent_along_x(node, aspect));
    sensor.tan_half_y = static_cast<float>(sensor.tan_half_x / aspect);
    if (node.type == "thinlens") {
        sensor.aperture_radius = static_cast<float>(node.number("aperture_radius"));
        sensor.focus_distance = static_cast<float>(node.number("focus_distance"));
        if (!(sensor.aperture_radius >= 0) || !(sensor.focus_distance > 0))
            throw input_error(node.where, "aperture_radius must be >= 0 and focus_distance > 0");
    }
}

// A direction in place of a transform: z along it, any x across.
Eigen::Matrix4d looking_along(const Properties& node) {
    const Eigen::Vector3d direction = node.vector("direction", Eigen::Vector3d::UnitZ());
    if (!direction.allFinite() || !(direction.norm() > 0))
        throw input_error(node.location_of("direction"), "a direction of length zero");
    const Vec3 z = direction.normalized().cast<float>();
    const Frame frame(z);
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.block<3, 3>(0, 0) << frame.s.cast<double>(), frame.t.cast<double>(), frame.n.cast<double>();
    return m;
}

void build_meter_of_shape(const Properties& node, const Geometry& geometry, int shape, Sensor& sensor) {
    if (shape < 0)
        throw input_error(node.where, fmt::format("a {} needs a surface", node.type), "",
                          "put it inside the shape whose light it measures");
    const bool sends = node.type == "radiositymeter";
    sensor.kind = sends ? Sensor::Kind::radiosity : Sensor::Kind::irradiance;
    sensor.shape = shape;
    sensor.scale = pi;
    sensor.quantity = sends ? Quantity::radiosity : Quantity::irradiance;
    if (node.type == "fluxmeter") {
        sensor.quantity = Quantity::flux;
        sensor.scale *= geometry.shapes[shape].area;
    }
    sensor.rotation.setIdentity();
}

void build_far_meter(const Properties& node, Sensor& sensor) {
    if (node.type == "goniophotometer") {
        place(node, node.transform("to_world"), sensor);
        sensor.kind = Sensor::Kind::far_field;
        sensor.quantity = Quantity::intensity;
        sensor.scale = pi * sqr(sensor.geometry->radius());
        return;
    }
    if (node.has("direction") && node.has("to_world"))
        throw input_error(node.location_of("direction"), "give \"direction\" or \"to_world\", not both");
    place(node, node.has("direction") ? looking_along(node) : node.transform("to_world"), sensor);
    sensor.kind = Sensor::Kind::distant;
    sensor.targeted = node.has("target");
    if (sensor.targeted) sensor.origin = node.vector("target", Eigen::Vector3d::Zero()).cast<float>();
    if (!sensor.origin.allFinite()) throw input_error(node.location_of("target"), "the target is not finite");
}

}  // namespace

Shutter build_shutter(const Properties& node) {
    const double open_s = node.number("shutter_open", 0.0), close_s = node.number("shutter_close", open_s);
    if (!std::isfinite(open_s) || !std::isfinite(close_s) || close_s < open_s)
        throw input_error(node.location_of("shutter_close"), "the shutter closes before it opens",
                          fmt::format("open {}, close {}", open_s, close_s));
    return {open_s, close_s};
}

Sensor build_sensor(const Properties& node, int film_width, int film_height, const Geometry& geometry, int shape) {
    expect_plugin(node);
    Sensor sensor;
    sensor.geometry = &geometry;
    const Shutter shutter = build_shutter(node);
    sensor.exposure_s = shutter.close_s - shutter.open_s;
    if (node.type == "perspective" || node.type == "thinlens" || node.type == "orthographic") {
        build_camera(node, static_cast<double>(film_width) / film_height, sensor);
    } else if (node.type == "radiancemeter") {
        place(node, node.transform("to_world"), sensor);
        sensor.kind = Sensor::Kind::ray;
    } else if (node.type == "goniophotometer" || node.type == "distant") {
        build_far_meter(node, sensor);
    } else {
        build_meter_of_shape(node, geometry, shape, sensor);
    }
    return sensor;
}

std::pair<int, int> default_film_size(const Properties& node) {
    if (node.type == "perspective" || node.type == "thinlens" || node.type == "orthographic") return {768, 576};
    if (node.type == "goniophotometer") return {72, 36};
    // The mean counts: pixels share the work between threads and stratify it.
    return {16, 16};
}

}  // namespace patina::render
