#pragma once
// For tests and benchmarks: scene trees built in code.

#include <cmath>
#include <initializer_list>

#include "patina/core/constants.h"
#include "patina/render/render.h"

namespace patina::render::test {

using Node = std::shared_ptr<Properties>;

struct Value {
    std::string name;
    PropertyValue value;
};

inline Value rgb(std::string name, double r, double g, double b) {
    return {std::move(name), SpectrumSpec{SpectrumSpec::Kind::rgb, {}, {r, g, b}}};
}
inline Value uniform(std::string name, double value) {
    return {std::move(name), SpectrumSpec{SpectrumSpec::Kind::uniform, {}, {value}}};
}
inline Value sampled(std::string name, std::vector<double> wavelengths_nm, std::vector<double> values) {
    return {std::move(name), SpectrumSpec{SpectrumSpec::Kind::sampled, std::move(wavelengths_nm), std::move(values)}};
}

inline Node node(std::string category, std::string type, std::vector<Value> values = {},
                 std::vector<Node> children = {}) {
    auto result = std::make_shared<Properties>();
    result->category = std::move(category);
    result->type = std::move(type);
    for (Value& v : values) result->entries.push_back({std::move(v.name), std::move(v.value), {}});
    for (Node& child : children) result->children.push_back({"", std::move(child)});
    return result;
}

// Mitsuba's look-at: columns left, up, view direction, position.
inline Eigen::Matrix4d look_at(const Eigen::Vector3d& origin, const Eigen::Vector3d& target,
                               const Eigen::Vector3d& up) {
    const Eigen::Vector3d direction = (target - origin).normalized(), left = up.cross(direction).normalized();
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.block<3, 1>(0, 0) = left;
    m.block<3, 1>(0, 1) = direction.cross(left);
    m.block<3, 1>(0, 2) = direction;
    m.block<3, 1>(0, 3) = origin;
    return m;
}
inline Eigen::Matrix4d translate(const Eigen::Vector3d& by) {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.block<3, 1>(0, 3) = by;
    return m;
}
inline Eigen::Matrix4d scale(double x, double y, double z) {
    return Eigen::Vector4d(x, y, z, 1).asDiagonal().toDenseMatrix();
}
inline Eigen::Matrix4d rotate_x(double angle_deg) {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.block<3, 3>(0, 0) = Eigen::AngleAxisd(radians(angle_deg), Eigen::Vector3d::UnitX()).toRotationMatrix();
    return m;
}

inline Node perspective(const Eigen::Matrix4d& to_world, double fov_deg, int width, int height, int samples,
                        std::string filter = "box") {
    return node("sensor", "perspective", {{"to_world", to_world}, {"fov", fov_deg}},
                {node("film", "hdrfilm", {{"width", std::int64_t{width}}, {"height", std::int64_t{height}}},
                      {node("rfilter", std::move(filter))}),
                 node("sampler", "independent", {{"sample_count", std::int64_t{samples}}})});
}
inline Node path(int max_depth, std::vector<Value> values = {}) {
    values.push_back({"max_depth", std::int64_t{max_depth}});
    return node("integrator", "path", std::move(values));
}
inline Node scene(std::vector<Node> children) {
    return node("scene", "scene", {}, std::move(children));
}

}  // namespace patina::render::test
