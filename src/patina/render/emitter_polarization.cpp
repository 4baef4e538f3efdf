#include "patina/render/emitter_polarization.h"

#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

#include "patina/core/constants.h"
#include "patina/core/error.h"

namespace patina::render {

namespace {

double number_in(const Properties& node, const char* name, double fallback, double low, double high) {
    const double value = node.number(name, fallback);
    if (value >= low && value <= high) return value;
    throw input_error(node.location_of(name), fmt::format("{} out of range", name), fmt::format("it is {}", value),
                      fmt::format("keep it within {} .. {}", low, high));
}

void expect_absent(const Properties& node, const std::string& state, std::initializer_list<const char*> names) {
    for (const char* name : names)
        if (node.has(name))
            throw input_error(node.location_of(name), fmt::format("\"{}\" says nothing about this light", name),
                              fmt::format("its polarization is \"{}\"", state));
}

// A direction of the emitter's own space in the world.
Vec3 world_direction(const Properties& node, const char* name, const Eigen::Vector3d& fallback,
                     const Eigen::Matrix4d& to_world) {
    const Eigen::Vector3d v = to_world.block<3, 3>(0, 0) * node.vector(name, fallback);
    if (!v.allFinite() || !(v.norm() > 1e-30))
        throw input_error(node.location_of(name), fmt::format("{} has length zero", name));
    return v.normalized().cast<float>();
}

// Q/I, U/I, V/I of "I, Q, U, V".
Eigen::Vector3d read_stokes(const Properties& node) {
    const std::string text = node.string("stokes");
    const SourceLocation where = node.location_of("stokes");
    Eigen::Vector4d s;
    const char* at = text.c_str();
    for (int i = 0; i < 4; ++i) {
        char* end = nullptr;
        s[i] = std::strtod(at, &end);
        if (end == at) throw input_error(where, "a Stokes vector has four numbers", "", "write \"1, 0.5, 0, 0\"");
        at = end + std::strspn(end, " \t\r\n,");
    }
    if (*at != '\0' || !s.allFinite())
        throw input_error(where, "a Stokes vector has four finite numbers", "", "write \"1, 0.5, 0, 0\"");
    if (!(s[0] > 0))
        throw input_error(where, "a Stokes vector needs a positive intensity", fmt::format("it is {}", s[0]));
    const Eigen::Vector3d quv = s.tail<3>() / s[0];
    // Decimal fractions of a fully polarized state may round up.
    if (quv.norm() > 1 + 1e-6)
        throw input_error(where, "no light has this Stokes vector",
                          fmt::format("its degree of polarization is {:.6g}", quv.norm()),
                          "keep Q^2 + U^2 + V^2 <= I^2");
    return quv / std::max(1.0, quv.norm());
}

Eigen::Vector3d ellipse(double degree, double psi_deg, double chi_deg) {
    const double psi = radians(psi_deg), chi = radians(chi_deg);
    return degree * Eigen::Vector3d(std::cos(2 * chi) * std::cos(2 * psi), std::cos(2 * chi) * std::sin(2 * psi),
                                    std::sin(2 * chi));
}

}  // namespace

EmitterPolarization EmitterPolarization::rayleigh(float degree, const Vec3& towards_sun) {
    EmitterPolarization p({degree, 0, 0}, towards_sun);
    p.kind_ = Kind::rayleigh;
    return p;
}

LightBeam EmitterPolarization::light(Float4 intensity, const Vec3& travel) const {
    if (!polarized()) return LightBeam::unpolarized(intensity, travel);
    const Vec3 x = Frame(travel, axis_).s;
    if (kind_ == Kind::uniform)
        return {make_stokes(intensity, intensity * quv_.x(), intensity * quv_.y(), intensity * quv_.z()), x, travel};
    const float cos2 = sqr(travel.dot(axis_));
    const Float4 q = intensity * (-quv_.x() * (1 - cos2) / (1 + cos2));
    return {make_stokes(intensity, q, splat(0), splat(0)), x, travel};
}

EmitterPolarization build_polarization(const Properties& node, const Eigen::Matrix4d& to_world) {
    const bool surroundings = node.type == "constant" || node.type == "envmap";
    const auto axis = [&] {
        const Eigen::Vector3d own = surroundings ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
        const Vec3 world = world_direction(node, "polarization_axis", own, to_world);
        if (node.type == "directional" &&
            world.cross(world_direction(node, "direction", Eigen::Vector3d::UnitZ(), to_world)).norm() < 1e-6f)
            throw input_error(node.location_of("polarization_axis"), "the light travels along its polarization_axis",
                              "angles of polarization have no meaning there", "give another polarization_axis");
        return world;
    };
    if (node.has("stokes")) {
        expect_absent(
            node, "given as a Stokes vector",
            {"polarization", "polarization_degree", "polarization_angle", "polarization_ellipticity", "sun_direction"});
        return {read_stokes(node).cast<float>(), axis()};
    }
    const std::string state = node.string("polarization", "unpolarized");
    if (state == "unpolarized") {
        expect_absent(node, state,
                      {"polarization_degree", "polarization_angle", "polarization_ellipticity", "polarization_axis",
                       "sun_direction"});
        return {};
    }
    const double degree = number_in(node, "polarization_degree", 1.0, 0.0, 1.0);
    if (state == "rayleigh") {
        if (!surroundings)
            throw input_error(node.location_of("polarization"), "only surroundings have the polarization of a sky",
                              fmt::format("this is a \"{}\" emitter", node.type), "use \"linear\"");
        expect_absent(node, state, {"polarization_angle", "polarization_ellipticity", "polarization_axis"});
        return EmitterPolarization::rayleigh(
            static_cast<float>(degree), world_direction(node, "sun_direction", Eigen::Vector3d::UnitY(), to_world));
    }
    const std::vector<std::string> states = {"unpolarized", "linear", "circular", "elliptical", "rayleigh"};
    if (state != "linear" && state != "circular" && state != "elliptical")
        throw input_error(node.location_of("polarization"), fmt::format("unknown polarization \"{}\"", state), "",
                          did_you_mean(state, states));
    expect_absent(node, state, {"sun_direction"});
    if (state == "linear") expect_absent(node, state, {"polarization_ellipticity"});
    if (state == "circular") expect_absent(node, state, {"polarization_angle"});
    const double psi_deg = number_in(node, "polarization_angle", 0.0, -360.0, 360.0);
    const double chi_deg =
        state == "linear" ? 0.0
                          : number_in(node, "polarization_ellipticity", state == "circular" ? 45.0 : 22.5, -45.0, 45.0);
    if (state == "circular" && std::abs(chi_deg) != 45.0)
        throw input_error(node.location_of("polarization_ellipticity"), "circular light has ellipticity 45 or -45",
                          fmt::format("it is {}", chi_deg), "use \"elliptical\"");
    return {ellipse(degree, psi_deg, chi_deg).cast<float>(), axis()};
}

}  // namespace patina::render
