// Polarized emitters: what a camera sees of them directly, through optics and in mirrors, against closed forms.

#include "render_scenes.h"
#include <gtest/gtest.h>

#include "patina/optics/fresnel.h"

namespace patina::render::test {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

// What single precision leaves of a radiance of one.
constexpr double tolerance = 3e-6;

std::vector<Value> linear(double angle_deg, double degree = 1) {
    return {
        {"polarization", std::string("linear")}, {"polarization_angle", angle_deg}, {"polarization_degree", degree}};
}
Node lamp(std::vector<Value> state) {
    state.push_back(uniform("radiance", 1));
    return node("shape", "rectangle", {}, {node("emitter", "area", std::move(state))});
}
// Looks down at the lamp: the lamp's x to the right, its y up.
Node camera() {
    return needle({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 4, 1);
}
Vector4d seen(const Node& tree, const std::string& integrator = "path") {
    RenderOptions options;
    options.integrator = integrator;
    return mean_stokes(render_tree(tree, options));
}

TEST(PolarizedLight, IsSeenAsItIsSent) {
    EXPECT_LT((seen(scene({camera(), lamp({})})) - Vector4d(1, 0, 0, 0)).norm(), tolerance);
    EXPECT_LT((seen(scene({camera(), lamp(linear(0))})) - Vector4d(1, 1, 0, 0)).norm(), tolerance);
    EXPECT_LT((seen(scene({camera(), lamp(linear(45, 0.5))})) - Vector4d(1, 0, 0.5, 0)).norm(), tolerance);
    const Node right = lamp({{"polarization", std::string("circular")}});
    const Node left = lamp({{"polarization", std::string("circular")}, {"polarization_ellipticity", -45.0}});
    EXPECT_LT((seen(scene({camera(), right})) - Vector4d(1, 0, 0, 1)).norm(), tolerance);
    EXPECT_LT((seen(scene({camera(), left})) - Vector4d(1, 0, 0, -1)).norm(), tolerance);
    // tan chi = 1/2 is the ratio of the axes: the powers along them are as 4 to 1, V^2 = 1 - (3/5)^2.
    const double chi_deg = degrees(std::atan(0.5));
    const Node ellipse = lamp({{"polarization", std::string("elliptical")}, {"polarization_ellipticity", chi_deg}});
    EXPECT_LT((seen(scene({camera(), ellipse})) - Vector4d(1, 0.6, 0, 0.8)).norm(), tolerance);
    const Node given = lamp({{"stokes", std::string("2, -1, 0.5 0.25")}});
    EXPECT_LT((seen(scene({camera(), given})) - Vector4d(1, -0.5, 0.25, 0.125)).norm(), tolerance);
    // The axis is the emitter's own: turned with the shape, or given.
    std::vector<Value> along_y = linear(0);
    along_y.push_back({"polarization_axis", Vector3d(0, 3, 0)});
    EXPECT_LT((seen(scene({camera(), lamp(along_y)})) - Vector4d(1, -1, 0, 0)).norm(), tolerance);
}

// Malus (1809): I = (1 - p)/2 + p cos^2 of the angle between light and polarizer, by every integrator that follows
// delta functions.
TEST(PolarizedLight, ObeysMalusLaw) {
    for (const char* integrator : {"path", "whitted", "distribution", "bidirectional"})
        for (double angle_deg : {0.0, 20.0, 65.0, 90.0, 140.0}) {
            const Node sheet = node("shape", "rectangle", {{"to_world", translate({0, 0, 1})}},
                                    {node("bsdf", "polarizer", {{"theta", 20.0}})});
            const double p = 0.8, cos = std::cos(radians(angle_deg - 20));
            const Node whole = node("integrator", integrator, {{"hide_emitters", false}});
            const Vector4d s = seen(scene({whole, camera(), lamp(linear(angle_deg, p)), sheet}), integrator);
            EXPECT_NEAR(s[0], 0.5 * (1 - p) + p * cos * cos, tolerance) << integrator << " " << angle_deg;
        }
}

// Brewster (1815): glass does not reflect light polarized in the plane of incidence; across it R_s.
TEST(PolarizedLight, IsNotReflectedAtBrewstersAngleWhenInThePlane) {
    const double angle = std::atan(1.5);
    const Vector3d from(0, -std::sin(angle), std::cos(angle));
    const auto reflected = [&](const Vector3d& axis) {
        std::vector<Value> values = linear(0);
        values.push_back({"polarization_axis", axis});
        values.push_back(uniform("radiance", 1));
        const Node glass =
            node("shape", "rectangle", {}, {node("bsdf", "dielectric", {{"int_ior", 1.5}, {"ext_ior", 1.0}})});
        // No light from below: the reflection alone.
        const Node dark =
            node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(translate({0, 0, -1}) * scale(9, 9, 1))}},
                 {node("bsdf", "diffuse", {uniform("reflectance", 0)})});
        return seen(
            scene({node("integrator", "whitted", {{"hide_emitters", false}}),
                   needle(3 * from, {0, 0, 0}, {0, 0, 1}, 1, 1), glass, dark, node("emitter", "constant", values)}),
            "whitted");
    };
    const Vector3d out_of_plane(1, 0, 0), in_plane(0, 0, 1);
    // The needle is 1.7e-4 wide: R_p grows quadratically there, R_s by some 0.4 a radian.
    EXPECT_LT(reflected(in_plane)[0], 1e-6);
    const double r_s = std::norm(optics::fresnel_amplitudes(std::cos(angle), 1.0, 1.5).r_s);
    const Vector4d s = reflected(out_of_plane);
    EXPECT_NEAR(s[0], r_s, 1e-4);
    EXPECT_NEAR(s[1], r_s, 1e-4);
}

// A metal mirror at 45 degrees turns light polarized at 45 degrees to the plane into elliptic light: V by the
// difference of the phases of r_s and r_p.
TEST(PolarizedLight, BecomesEllipticInAMetalMirror) {
    const std::complex<double> index(0.8, 5.3);
    const Node metal = node("shape", "rectangle", {{"to_world", rotate_x(-45)}},
                            {node("bsdf", "conductor", {uniform("eta", 0.8), uniform("k", 5.3)})});
    // The camera looks down at the mirror, which shows it the lamp along +y.
    std::vector<Value> state = linear(0);
    state.push_back({"polarization_axis", Vector3d(1, 0, 1)});
    state.push_back(uniform("radiance", 1));
    const Vector4d s = seen(
        scene({path(3), needle({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 1, 1), metal, node("emitter", "constant", state)}));
    const auto r = optics::fresnel_amplitudes(std::sqrt(0.5), 1.0, index);
    const double rs = std::norm(r.r_s), rp = std::norm(r.r_p);
    EXPECT_NEAR(s[0], 0.5 * (rs + rp), 1e-4);
    EXPECT_NEAR(s[1], 0.5 * (rs - rp), 1e-4);  // s is the camera's x
    EXPECT_NEAR(std::hypot(s[2], s[3]), std::sqrt(rs * rp), 1e-4);
    EXPECT_NEAR(std::abs(s[3]), std::abs((r.r_p * std::conj(r.r_s)).imag()), 1e-4);
}

// A clear sky's degree of polarization is sin^2 g / (1 + cos^2 g), largest across the sun, polarized across the plane
// through it.
TEST(PolarizedLight, SkyIsPolarizedAcrossThePlaneOfTheSun) {
    for (double angle_deg : {0.5, 40.0, 90.0, 130.0}) {
        const Node sky = node("emitter", "constant",
                              {{"polarization", std::string("rayleigh")},
                               {"polarization_degree", 0.9},
                               {"sun_direction", Vector3d(0, 0, 1)},
                               uniform("radiance", 1)});
        // The camera turns from the sun towards y, level: the plane through the sun is upright in its picture.
        const double g = radians(angle_deg);
        const Vector3d view(0, std::sin(g), std::cos(g));
        const Vector4d s = seen(scene({path(2), needle({0, 0, 0}, view, {0, -std::cos(g), std::sin(g)}, 1, 1), sky}));
        const double expected = 0.9 * std::sin(g) * std::sin(g) / (1 + std::cos(g) * std::cos(g));
        EXPECT_LT((s - Vector4d(1, expected, 0, 0)).norm(), 1e-4) << angle_deg;
    }
}

// A depolarizing surface knows the intensity alone.
TEST(PolarizedLight, DoesNotMatterToADiffuseSurface) {
    const Node floor = node("shape", "rectangle", {}, {node("bsdf", "diffuse", {uniform("reflectance", 0.5)})});
    std::vector<Value> values = linear(30);
    values.push_back({"position", Vector3d(0, 0, 2)});
    values.push_back(uniform("intensity", 1));
    const Vector4d s = seen(scene({path(2), camera(), floor, node("emitter", "point", values)}));
    EXPECT_LT((s - Vector4d(0.5 / (4 * pi), 0, 0, 0)).norm(), tolerance);
}

TEST(PolarizedLight, RefusesImpossibleStates) {
    const auto message = [&](std::vector<Value> values, const char* type = "constant") {
        try {
            build_scene(*scene({camera(), node("emitter", type, std::move(values))}), {});
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const auto has = [&](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
    const Value circular{"polarization", std::string("circular")}, rayleigh{"polarization", std::string("rayleigh")};
    EXPECT_PRED2(has, message({{"stokes", std::string("1, 1, 1, 0")}}), "no light has this Stokes vector");
    EXPECT_PRED2(has, message({{"stokes", std::string("1, 0, 0")}}), "four numbers");
    EXPECT_PRED2(has, message({{"stokes", std::string("1, 0, 0, nan")}}), "four finite numbers");
    EXPECT_PRED2(has, message({{"stokes", std::string("0, 0, 0, 0")}}), "positive intensity");
    EXPECT_PRED2(has, message({{"polarization", std::string("circulr")}}), "circular");
    EXPECT_PRED2(has, message({circular, {"polarization_degree", 1.5}}), "out of range");
    EXPECT_PRED2(has, message({circular, {"polarization_angle", 10.0}}), "says nothing");
    EXPECT_PRED2(has, message({circular, {"polarization_axis", Vector3d(0, 0, 0)}}), "length zero");
    EXPECT_PRED2(has, message({{"polarization_angle", 10.0}}), "says nothing");
    EXPECT_PRED2(has, message({rayleigh}, "point"), "only surroundings");
    EXPECT_PRED2(has,
                 message({{"polarization", std::string("linear")}, {"direction", Vector3d(1, 0, 0)}}, "directional"),
                 "give another polarization_axis");
}

}  // namespace
}  // namespace patina::render::test
