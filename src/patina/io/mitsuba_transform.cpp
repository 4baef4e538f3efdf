#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "patina/core/constants.h"
#include "patina/io/mitsuba_values.h"

namespace patina::io {

namespace {

// x, y, z attributes or a value of 1 or 3 numbers; what is absent is `fallback`.
Eigen::Vector3d read_components(const Element& element, double fallback) {
    Eigen::Vector3d vector = Eigen::Vector3d::Constant(fallback);
    if (element.has("value")) {
        const LocatedText value = element.text("value");
        const std::vector<double> numbers = parse_floats(value.text, value.where);
        if (numbers.size() == 1) return Eigen::Vector3d::Constant(numbers[0]);
        if (numbers.size() == 3) return {numbers[0], numbers[1], numbers[2]};
        throw input_error(value.where, fmt::format("{} has {} numbers", in_quotes(value.text), numbers.size()),
                          fmt::format("<{}> takes 1 or 3", element.tag()));
    }
    const char* names[] = {"x", "y", "z"};
    for (int axis = 0; axis < 3; ++axis) {
        if (!element.has(names[axis])) continue;
        const LocatedText text = element.text(names[axis]);
        vector[axis] = parse_float(text.text, text.where);
    }
    return vector;
}

Eigen::Matrix4d affine(const Eigen::Matrix3d& linear, const Eigen::Vector3d& offset) {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = linear;
    matrix.topRightCorner<3, 1>() = offset;
    return matrix;
}

Eigen::Matrix4d read_rotate(const Element& element) {
    element.expect_attributes({"value", "x", "y", "z", "angle"});
    const Eigen::Vector3d axis = read_components(element, 0.0);
    const LocatedText angle = element.text("angle");
    const double angle_deg = parse_float(angle.text, angle.where, "angle");
    if (!(axis.stableNorm() > 0))
        throw input_error(element.where(), "the axis of <rotate> has no length", "", "set x, y or z, as in y=\"1\"");
    return affine(Eigen::AngleAxisd(radians(angle_deg), axis.stableNormalized()).toRotationMatrix(),
                  Eigen::Vector3d::Zero());
}

Eigen::Matrix4d read_scale(const Element& element) {
    element.expect_attributes({"value", "x", "y", "z"});
    return affine(read_components(element, 1.0).asDiagonal(), Eigen::Vector3d::Zero());
}

Eigen::Matrix4d read_translate(const Element& element) {
    element.expect_attributes({"value", "x", "y", "z"});
    return affine(Eigen::Matrix3d::Identity(), read_components(element, 0.0));
}

Eigen::Vector3d read_point_attribute(const Element& element, const char* name) {
    const LocatedText text = element.text(name);
    const std::vector<double> numbers = parse_floats(text.text, text.where, 3);
    return {numbers[0], numbers[1], numbers[2]};
}

// Camera frame at `origin`: +z towards `target`, +x to the left, +y up, as Mitsuba has it.
Eigen::Matrix4d read_lookat(const Element& element) {
    element.expect_attributes({"origin", "target", "up"});
    const Eigen::Vector3d origin = read_point_attribute(element, "origin");
    const Eigen::Vector3d target = read_point_attribute(element, "target");
    const Eigen::Vector3d view = target - origin;
    if (!(view.stableNorm() > 0) || !view.allFinite())
        throw input_error(element.where(), "<lookat> looks nowhere", "origin and target are the same point");
    const Eigen::Vector3d forward = view.stableNormalized();

    const bool up_given = element.has("up");
    const Eigen::Vector3d up = up_given ? read_point_attribute(element, "up") : forward.unitOrthogonal();
    if (!(up.stableNorm() > 0)) throw input_error(element.where(), "<lookat> has an up vector without length");
    // Below this sine the frame would be rounding errors of the up vector.
    constexpr double smallest_sine = 1e-9;
    const Eigen::Vector3d left = up.stableNormalized().cross(forward);
    if (left.norm() < smallest_sine)
        throw input_error(element.where(), "<lookat> looks along its up vector", "the camera's roll is undefined",
                          "choose another up");

    Eigen::Matrix3d frame;
    frame << left.normalized(), forward.cross(left.normalized()), forward;
    return affine(frame, origin);
}

Eigen::Matrix4d read_matrix(const Element& element) {
    element.expect_attributes({"value"});
    const LocatedText value = element.text("value");
    const std::vector<double> numbers = parse_floats(value.text, value.where);
    using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    using RowMajor4 = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
    if (numbers.size() == 9) return affine(Eigen::Map<const RowMajor3>(numbers.data()), Eigen::Vector3d::Zero());
    if (numbers.size() == 16) return Eigen::Map<const RowMajor4>(numbers.data());
    throw input_error(value.where, fmt::format("<matrix> has {} numbers", numbers.size()),
                      "16 or 9 are expected, row by row");
}

Eigen::Matrix4d read_operation(const Element& element) {
    element.expect_no_children();
    const std::string tag = element.tag();
    if (tag == "translate") return read_translate(element);
    if (tag == "rotate") return read_rotate(element);
    if (tag == "scale") return read_scale(element);
    if (tag == "lookat" || tag == "look_at") return read_lookat(element);
    if (tag == "matrix") return read_matrix(element);
    throw input_error(element.where(), fmt::format("unknown transform {}", in_quotes(tag)), "",
                      did_you_mean(tag, {"translate", "rotate", "scale", "lookat", "matrix"}));
}

}  // namespace

Eigen::Matrix4d read_transform(const Element& element) {
    element.expect_attributes({"name", "time"});
    Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();
    for (const Element& operation : element.children()) {
        const Eigen::Matrix4d step = read_operation(operation);
        if (step.topLeftCorner<3, 3>().determinant() == 0)
            throw input_error(operation.where(), fmt::format("<{}> flattens space", operation.tag()),
                              "its determinant is zero", "a scale must not be 0");
        transform = step * transform;
        if (!transform.allFinite())
            throw input_error(operation.where(), "the transform overflows", "its numbers are too large");
    }
    return transform;
}

std::shared_ptr<Properties> read_animation(const Element& element) {
    element.expect_attributes({"name"});
    auto animation = std::make_shared<Properties>();
    animation->category = "animation";
    animation->type = "transform";
    animation->where = element.where();
    double before = -INFINITY;
    for (const Element& key : element.children()) {
        if (key.tag() != "transform")
            throw input_error(key.where(), fmt::format("<animation> takes no {}", in_quotes("<" + key.tag() + ">")), "",
                              "write <transform time=\"0\">");
        const LocatedText time = key.text("time");
        const double time_s = parse_float(time.text, time.where, "time");
        if (!(time_s > before)) throw input_error(time.where, "the times of an animation must ascend");
        before = time_s;
        const std::string number = std::to_string(animation->entries.size() / 2);
        animation->entries.push_back({"time_" + number, time_s, time.where});
        animation->entries.push_back({"transform_" + number, read_transform(key), key.where()});
    }
    if (animation->entries.empty()) throw input_error(element.where(), "an animation needs transforms");
    return animation;
}

}  // namespace patina::io
