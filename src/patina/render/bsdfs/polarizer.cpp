#include "patina/render/bsdfs/polarizer.h"

#include <fmt/format.h>

#include "patina/core/error.h"

namespace patina::render {

namespace {

// Fills [column][row] from a matrix written row by row.
void set_general(ScatteringMatrix& m, const float (&rows)[4][4], Float4 scale) {
    m.form = ScatteringMatrix::Form::general;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) m.m[4 * column + row] = rows[row][column] * scale;
}

const ParameterDescriptor theta_parameter = {
    "theta", "number or texture", "degree", "0", "", "turns the axis about the normal"};
const ParameterDescriptor transmittance_parameter = {
    "transmittance", "spectrum or texture", "", "1", "0 .. 1", "of the polarization that passes"};

ScalarTexture angle(const Properties& node, const char* name, double fallback_deg, const BsdfBuilder& builder) {
    ScalarTexture texture = ScalarTexture::read(node, name, fallback_deg, *builder.resources);
    for (float value : texture.values())
        if (!(std::abs(value) < 1e6f))
            throw input_error(node.location_of(name), fmt::format("{} out of range", name),
                              fmt::format("it is {}", value), "give an angle in degrees");
    return texture;
}

}  // namespace

bool PolarizationElement::sample(const ShadingPoint& point, const Vec3& outgoing, float, const Vec2&,
                                 BsdfSample& sample) const {
    sample.incident = -outgoing;
    sample.pdf = 1;
    sample.delta = true;

    // The axis across the ray; light travels along `outgoing` before and after.
    const auto in_rad = [&](const ScalarTexture& angle_deg) { return angle_deg.at(point.uv) * (pi_f / 180); };
    const float theta = in_rad(theta_deg), delta = in_rad(delta_deg);
    const Vec3 axis(std::cos(theta), std::sin(theta), 0);
    const Frame frame(outgoing, axis);
    sample.weight.x_in = sample.weight.x_out = frame.s;

    const Float4 t = transmittance.at(*point.wavelengths, point.uv);
    const float c = std::cos(delta), s = std::sin(delta), h = kind == Kind::left_circular ? -1.0f : 1.0f;
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
    e.theta_deg = angle(node, "theta", 0, builder);
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
             {"delta", "number or texture", "degree", "90", "", "phase between slow and fast axis"}}};
}
Retarder Retarder::build(const Properties& node, const BsdfBuilder& builder) {
    Retarder r{common(Kind::retarder, node, builder)};
    r.delta_deg = angle(node, "delta", 90, builder);
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
