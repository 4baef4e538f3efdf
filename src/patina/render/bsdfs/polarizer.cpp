#include "patina/render/bsdfs/polarizer.h"

#include "patina/core/constants.h"

namespace patina::render {

namespace {

// Fills [column][row] from a matrix written row by row.
void set_general(ScatteringMatrix& m, const float (&rows)[4][4], Float4 scale) {
    m.form = ScatteringMatrix::Form::general;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) m.m[4 * column + row] = rows[row][column] * scale;
}

const ParameterDescriptor theta_parameter = {"theta", "number", "degree", "0", "", "turns the axis about the normal"};
const ParameterDescriptor transmittance_parameter = {
    "transmittance", "spectrum or texture", "", "1", "0 .. 1", "of the polarization that passes"};

}  // namespace

bool PolarizationElement::sample(const ShadingPoint& point, const Vec3& outgoing, float, const Vec2&,
                                 BsdfSample& sample) const {
    sample.incident = -outgoing;
    sample.pdf = 1;
    sample.delta = true;

    // The axis across the ray; light travels along `outgoing` before and after.
    const Vec3 axis(std::cos(theta_rad), std::sin(theta_rad), 0);
    const Frame frame(outgoing, axis);
    sample.weight.x_in = sample.weight.x_out = frame.s;

    const Float4 t = transmittance.at(*point.wavelengths, point.uv);
    const float c = cos_delta, s = sin_delta, h = kind == Kind::left_circular ? -1.0f : 1.0f;
    switch (kind) {
        case Kind::linear_polarizer:
            set_general(sample.weight, {{1, 1, 0, 0}, {1, 1, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}}, 0.5f * t);
            break;
        case Kind::retarder:
            set_general(sample.weight, {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, c, s}, {0, 0, -s, c}}, t);
            break;
        case Kind::right_circular:
        case Kind::left_circular:
            set_general(sample.weight, {{1, 0, 0, h}, {0, 0, 0, 0}, {0, 0, 0, 0}, {h, 0, 0, 1}}, 0.5f * t);
            break;
    }
    return true;
}

PolarizationElement PolarizationElement::common(Kind kind, const Properties& node, const BsdfBuilder& builder) {
    PolarizationElement e;
    e.kind = kind;
    e.theta_rad = static_cast<float>(radians(node.number("theta", 0.0)));
    e.transmittance = Texture::reflectance(node, "transmittance", 1.0f, *builder.resources);
    return e;
}

PluginDescriptor LinearPolarizer::describe() {
    return {"bsdf",
            "polarizer",
            "Ideal linear polarizer; passes the field along its axis.",
            {theta_parameter, transmittance_parameter}};
}
LinearPolarizer LinearPolarizer::build(const Properties& node, const BsdfBuilder& builder) {
    return {common(Kind::linear_polarizer, node, builder)};
}

PluginDescriptor Retarder::describe() {
    return {"bsdf",
            "retarder",
            "Ideal linear retarder, fast axis along its axis.",
            {theta_parameter,
             transmittance_parameter,
             {"delta", "number", "degree", "90", "", "phase between slow and fast axis"}}};
}
Retarder Retarder::build(const Properties& node, const BsdfBuilder& builder) {
    Retarder r{common(Kind::retarder, node, builder)};
    const double delta = radians(node.number("delta", 90.0));
    r.cos_delta = static_cast<float>(std::cos(delta));
    r.sin_delta = static_cast<float>(std::sin(delta));
    return r;
}

PluginDescriptor CircularPolarizer::describe() {
    return {"bsdf",
            "circular",
            "Ideal circular polarizer, right-handed by default.",
            {theta_parameter,
             transmittance_parameter,
             {"left_handed", "boolean", "", "false", "", "passes left circular light"}}};
}
CircularPolarizer CircularPolarizer::build(const Properties& node, const BsdfBuilder& builder) {
    return {common(node.boolean("left_handed", false) ? Kind::left_circular : Kind::right_circular, node, builder)};
}

}  // namespace patina::render
