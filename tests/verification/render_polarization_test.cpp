// The path tracer against closed forms of polarization optics, worked out here from electric fields in space.

#include "electric_fields.h"
#include "render_scenes.h"
#include <gtest/gtest.h>

#include "patina/brdf/tabulate.h"

namespace patina::render::test {
namespace {

Node mirror(Node bsdf) {
    return node("shape", "rectangle", {}, {std::move(bsdf)});
}
Vector3d above(double theta_deg) {
    return {0, -std::sin(radians(theta_deg)), std::cos(radians(theta_deg))};
}

// Unpolarized surroundings seen in a metal or in glass at an angle: (R_s + R_p)/2, and polarized across the plane of
// incidence, which for a level camera is horizontal: S1 > 0. A rolled camera sees it turned.
TEST(PolarizedReflection, HasFresnelsStokesVectorInLevelAndRolledCameras) {
    for (double roll_deg : {0.0, 30.0, -70.0}) {
        const Vector3d from = 3 * above(70), view = -from.normalized();
        const Vector3d level = (Vector3d::UnitZ() - Vector3d::UnitZ().dot(view) * view).normalized();
        // Turn the camera's up vector counter-clockwise as the camera sees it.
        const Vector3d up = Eigen::AngleAxisd(radians(-roll_deg), view) * level;
        const Complex index(0.8, 5.3);
        const auto image = render_tree(
            scene({path(3), needle(from, {0, 0, 0}, up, 4),
                   mirror(node("bsdf", "conductor", {uniform("eta", index.real()), uniform("k", index.imag())})),
                   constant_light()}));
        Eigen::Vector4d expected = Eigen::Vector4d::Zero();
        const Vector3d travelling(0, -std::sin(radians(70)), -std::cos(radians(70)));
        for (const Vector3d& e : {Vector3d(1, 0, 0), Vector3d(travelling.cross(Vector3d(1, 0, 0)))})
            expected += 0.5 * measured(reflected(e.cast<Complex>(), travelling, {0, 0, 1}, index), view, up);
        // The needle's 1e-4 of angle times the derivative of R_p at 70 degrees, and single precision.
        EXPECT_LT((mean_stokes(image) - expected).norm(), 1e-4)
            << mean_stokes(image).transpose() << " roll " << roll_deg;
    }
}

TEST(PolarizedReflection, IsCompleteAtBrewstersAngle) {
    const double brewster_deg = degrees(std::atan(1.5));
    const auto image = render_tree(
        scene({path(3), needle(3 * above(brewster_deg), {0, 0, 0}, {0, 0, 1}, 16),
               mirror(node("bsdf", "dielectric", {{"int_ior", 1.5}, {"ext_ior", 1.0}})),
               node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(translate({0, 0, -0.01}) * scale(40, 40, 40))}},
                    {node("bsdf", "diffuse", {uniform("reflectance", 0)})}),
               constant_light()}));
    const Eigen::Vector4d s = mean_stokes(image);
    const double r_s = std::pow((1.5 * 1.5 - 1) / (1.5 * 1.5 + 1), 2);
    // 256 samples stratify the choice between reflection (7 %) and refraction: 4 sqrt(0.07 * 0.93 / 256) of R at worst.
    EXPECT_NEAR(s[0], 0.5 * r_s, 0.2 * r_s);
    // DoLP is free of that noise; R_p grows with the square of the needle's angle.
    EXPECT_NEAR(s[1] / s[0], 1.0, 1e-5);
    EXPECT_NEAR(s[2] / s[0], 0.0, 1e-4);
    EXPECT_NEAR(s[3] / s[0], 0.0, 1e-5);
}

Node element(const char* type, double height, double theta_deg, std::vector<Value> values = {}) {
    values.push_back({"theta", theta_deg});
    values.push_back({"transmittance", SpectrumSpec{SpectrumSpec::Kind::uniform, {}, {1.0}}});
    return node("shape", "rectangle", {{"to_world", translate({0, 0, height})}},
                {node("bsdf", type, std::move(values))});
}
Eigen::Vector4d through(std::vector<Node> elements) {
    elements.push_back(path(8, {{"rr_depth", std::int64_t{100}}}));
    elements.push_back(needle({0, 0, 9}, {0, 0, 0}, {0, 1, 0}, 4));
    elements.push_back(constant_light());
    return mean_stokes(render_tree(scene(std::move(elements))));
}

// Malus (1809): two polarizers pass cos^2 of the angle between them, and the light vibrates along the second.
TEST(Polarizers, ObeyMalusLaw) {
    for (double angle_deg : {0.0, 20.0, 45.0, 90.0, 130.0}) {
        const Eigen::Vector4d s = through({element("polarizer", 0, 0), element("polarizer", 1, angle_deg)});
        const double passed = 0.5 * std::pow(std::cos(radians(angle_deg)), 2);
        const Eigen::Vector4d expected =
            passed * Eigen::Vector4d(1, std::cos(2 * radians(angle_deg)), std::sin(2 * radians(angle_deg)), 0);
        EXPECT_LT((s - expected).norm(), 1e-6) << s.transpose() << " at " << angle_deg;  // single precision
    }
}

// A film of polarizers crossed in neighbouring squares, as in a polarization camera, before a polarizer.
TEST(Polarizers, MayTurnTheirAxisFromPlaceToPlace) {
    for (const char* angle : {"theta", "delta"}) {
        // A half-wave plate at 45 degrees turns the axis by 90 degrees where there is one.
        const bool polarizes = std::string(angle) == "theta";
        Node model = polarizes ? node("bsdf", "polarizer") : node("bsdf", "retarder", {{"theta", 45.0}});
        const Node board = node("texture", "checkerboard", {{"color0", 0.0}, {"color1", polarizes ? 90.0 : 180.0}});
        model->children.push_back({angle, board});
        for (const auto& [x, passed] : {std::pair{-0.5, 0.5}, {0.5, 0.0}}) {
            const Node film = node("shape", "rectangle", {{"to_world", translate({x, -0.5, 1})}}, {model});
            EXPECT_NEAR(through({element("polarizer", 0, 0), film, element("polarizer", 2, 0)})[0], passed, 1e-6)
                << angle << " " << x;
        }
    }
}

// A quarter-wave plate with its fast axis at +45 degrees between crossed polarizers passes half of the light; what
// leaves it is circular: the field along the slow axis lags by a quarter period, so it turns clockwise for the camera:
// V > 0.
TEST(Polarizers, QuarterWavePlateMakesRightCircularLight) {
    const Node first = element("polarizer", 0, 0), plate = element("retarder", 1, 45, {{"delta", 90.0}});
    const Eigen::Vector4d circular = through({first, plate});
    const Complex i(0, 1);
    const Vector3d fast = Vector3d(1, 1, 0).normalized(), slow = Vector3d(-1, 1, 0).normalized();
    const Vector3cd field = std::sqrt(0.5) * (fast.x() * fast.cast<Complex>() + i * slow.x() * slow.cast<Complex>());
    EXPECT_LT((circular - measured(field, {0, 0, -1}, {0, 1, 0})).norm(), 1e-6) << circular.transpose();
    EXPECT_NEAR(circular[3], 0.5, 1e-6);
    EXPECT_NEAR(through({first, plate, element("circular", 2, 0)})[0], 0.5, 1e-6);
    EXPECT_NEAR(through({first, plate, element("circular", 2, 0, {{"left_handed", true}})})[0], 0.0, 1e-6);
    EXPECT_NEAR(through({first, plate, element("polarizer", 2, 90)})[0], 0.25, 1e-6);
}

// Light polarized at an angle to the plane of incidence becomes elliptic on a metal: the sense of rotation, from
// fields.
TEST(PolarizedReflection, TurnsDiagonalLightIntoEllipticLightOfTheRightSense) {
    const Vector3d from = 3 * above(60), view = -from.normalized();
    const Complex index(0.2, 3.4);
    // A polarizer between the mirror and the light, across the mirrored ray, its axis tilted out of the plane of
    // incidence.
    const Vector3d to_light(0, std::sin(radians(60)), std::cos(radians(60)));
    Eigen::Matrix4d placement = Eigen::Matrix4d::Identity();
    placement.block<3, 1>(0, 0) = Vector3d::UnitX();
    placement.block<3, 1>(0, 1) = to_light.cross(Vector3d::UnitX());
    placement.block<3, 1>(0, 2) = to_light;
    placement.block<3, 1>(0, 3) = 3 * to_light;
    const Node metal = node("bsdf", "conductor", {uniform("eta", index.real()), uniform("k", index.imag())});
    const Vector3d axis = std::cos(radians(35)) * Vector3d(placement.block<3, 1>(0, 0)) +
                          std::sin(radians(35)) * Vector3d(placement.block<3, 1>(0, 1));
    const Eigen::Vector4d expected = measured(
        reflected(std::sqrt(0.5) * axis.cast<Complex>(), -to_light, {0, 0, 1}, index), view, Vector3d::UnitZ());
    EXPECT_GT(std::abs(expected[3]), 0.1);  // the test would see a wrong sign
    // The front of a mirror, and the back of a two-sided one.
    const Node seen[] = {mirror(metal), node("shape", "rectangle", {{"to_world", rotate_x(180)}},
                                             {node("bsdf", "twosided", {}, {metal})})};
    for (const Node& surface : seen) {
        const auto image = render_tree(scene(
            {path(4), needle(from, {0, 0, 0}, {0, 0, 1}, 4), surface,
             node("shape", "rectangle", {{"to_world", placement}}, {node("bsdf", "polarizer", {{"theta", 35.0}})}),
             constant_light()}));
        EXPECT_LT((mean_stokes(image) - expected).norm(), 1e-4) << mean_stokes(image).transpose() << "\n"
                                                                << expected.transpose();
    }
}

// A layer that scatters once, as a table in closed form.
constexpr double scattering_tau = 0.5;

SceneResources single_rayleigh_resources() {
    SceneResources resources;
    resources.load_brdf_table = [](const std::string&) {
        return std::make_shared<brdf::MuellerTable>(
            brdf::tabulate(brdf::single_rayleigh_body(scattering_tau), {.nodes = 24, .orders = 3}));
    };
    return resources;
}

Node single_rayleigh_paint() {
    return node("bsdf", "paint", {{"table", std::string("layer.h5")}});
}

// What the camera measures at the origin for a lamp of unit intensity: the table's closed form, and the polarization of
// the scattered field, E - k (k.E) of a dipole for both incident polarizations; 3/2 normalizes to a mean of one over
// the sphere.
Eigen::Vector4d scattered_from(const Vector3d& lamp, const Vector3d& view, const Vector3d& up) {
    const Vector3d k_in = -lamp.normalized(), k_out = -view;
    const double mu_o = k_out.z(), mu_i = -k_in.z();
    const Vector3d e1 = k_in.unitOrthogonal(), e2 = k_in.cross(e1);
    Eigen::Vector4d phase = Eigen::Vector4d::Zero();
    for (const Vector3d& e : {e1, e2})
        phase += 0.5 * 1.5 * measured((e - k_out.dot(e) * k_out).cast<Complex>(), view, up);
    const double f = (1 - std::exp(-scattering_tau * (1 / mu_o + 1 / mu_i))) / (4 * pi * (mu_o + mu_i));
    return phase * f * mu_i / lamp.squaredNorm();
}

TEST(PaintUnderAPointLight, ShowsItsTable) {
    for (const Vector3d& lamp : {Vector3d(2, 1, 2), Vector3d(-1, 2.5, 1.5), Vector3d(0.3, -0.2, 3)}) {
        const Vector3d from = Vector3d(2, -3, 3), view = -from.normalized(), up(0, 0, 1);
        const auto image = render_tree(scene({path(2), needle(from, {0, 0, 0}, up, 16), mirror(single_rayleigh_paint()),
                                              node("emitter", "point", {{"position", lamp}, uniform("intensity", 1)})}),
                                       {}, single_rayleigh_resources());
        const Eigen::Vector4d expected = scattered_from(lamp, view, up);
        // Interpolation of the compact table: its own test allows 6e-3.
        EXPECT_LT((mean_stokes(image) - expected).norm(), 6e-3 * expected[0]) << mean_stokes(image).transpose() << "\n"
                                                                              << expected.transpose();
    }
}

// The same under a rectangle of light against the integral over its area by the midpoint rule: 4 standard errors, from
// the spread of the pixels, beside the compact table's interpolation.
TEST(PaintUnderAnAreaLight, ShowsTheIntegralOfItsTable) {
    const Vector3d centre(1.2, 0.9, 1.6), from(2, -3, 3), view = -from.normalized(), up(0, 0, 1);
    const double half_size = 0.7, radiance = 2.0;
    const Vector3d normal = -centre.normalized(), side = normal.unitOrthogonal(), other = normal.cross(side);
    Eigen::Matrix4d placement = Eigen::Matrix4d::Identity();
    placement.block<3, 1>(0, 0) = half_size * side;
    placement.block<3, 1>(0, 1) = half_size * other;
    placement.block<3, 1>(0, 2) = normal;
    placement.block<3, 1>(0, 3) = centre;
    const auto image = render_tree(scene({path(2), needle(from, {0, 0, 0}, up, 256), mirror(single_rayleigh_paint()),
                                          node("shape", "rectangle", {{"to_world", placement}},
                                               {node("emitter", "area", {uniform("radiance", radiance)})})}),
                                   {}, single_rayleigh_resources());

    constexpr int cells = 60;  // the integrand is smooth: 1e-4
    Eigen::Vector4d expected = Eigen::Vector4d::Zero();
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j) {
            const double u = half_size * (2 * (i + 0.5) / cells - 1), v = half_size * (2 * (j + 0.5) / cells - 1);
            const Vector3d lamp = centre + u * side + v * other;
            const double cos_lamp = normal.dot(-lamp.normalized());
            expected += radiance * cos_lamp * std::pow(2 * half_size / cells, 2) * scattered_from(lamp, view, up);
        }

    const Eigen::Vector4d mean = mean_stokes(image);
    Eigen::Vector4d squares = Eigen::Vector4d::Zero();
    for (std::size_t p = 0; p < image.pixel_count(); ++p) {
        Eigen::Vector4d pixel = Eigen::Vector4d::Zero();
        for (int b = 0; b < image.bin_count(); ++b)
            pixel += Eigen::Map<const Eigen::Vector4f>(image.stokes(p, b)).cast<double>() / image.bin_count();
        squares += (pixel - mean).cwiseAbs2();
    }
    const double pixels = static_cast<double>(image.pixel_count());
    for (int s = 0; s < 4; ++s) {
        const double standard_error = std::sqrt(squares[s] / (pixels * (pixels - 1)));
        EXPECT_NEAR(mean[s], expected[s], 4 * standard_error + 6e-3 * expected[0]) << "component " << s;
    }
    EXPECT_GT(std::abs(expected[1]) + std::abs(expected[2]), 0.05 * expected[0]);  // a wrong frame would be seen
}

}  // namespace
}  // namespace patina::render::test
