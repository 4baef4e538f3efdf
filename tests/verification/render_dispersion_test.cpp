// A prism spreads the spectrum: where each band of a distant slit is seen through it, against Snell's law at its faces.

#include <cmath>

#include "render_scenes.h"
#include <gtest/gtest.h>

#include "patina/optics/materials.h"

namespace patina::render::test {
namespace {

constexpr double apex_deg = 12, view_deg = 4;
constexpr int columns = 64, samples = 4096;

// Angles from z towards x. A ray of the camera at angle `theta` meets the front face, whose normal is -z, and leaves by
// the back face, whose normal is at the prism's angle.
double leaving_angle(double theta, double n) {
    const double inside = std::asin(std::sin(theta) / n), apex = radians(apex_deg);
    return apex + std::asin(n * std::sin(inside - apex));
}

// The angle at which the camera sees what is at `target` through the prism.
double apparent_angle(double target, double n) {
    double low = radians(-view_deg), high = radians(view_deg);
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (leaving_angle(middle, n) < target ? low : high) = middle;
    }
    return low;
}

Eigen::Matrix4d rotate_y(double angle_deg) {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.block<3, 3>(0, 0) = Eigen::AngleAxisd(radians(angle_deg), Eigen::Vector3d::UnitY()).toRotationMatrix();
    return m;
}

TEST(Dispersion, APrismSpreadsTheSpectrumBySnellsLaw) {
    const optics::OpticalConstants glass = optics::builtin_material("ZnS");
    const auto index = [&](double nm) { return glass.at(nm, optics::Extrapolation::hold).real(); };
    const double target = leaving_angle(0, index(540));

    const auto face = [&](double z, double turn_deg) {
        return node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(translate({0, 0, z}) * rotate_y(turn_deg))}},
                    {node("bsdf", "dielectric", {{"int_ior", std::string("ZnS")}, {"ext_ior", 1.0}})});
    };
    // So far away that the prism is a point, and as narrow as 0.2 degrees.
    constexpr double distance = 1e5;
    const double half_width = distance * std::tan(radians(0.1));
    const Eigen::Matrix4d slit = translate({distance * std::sin(target), 0, distance * std::cos(target)}) *
                                 rotate_y(180 + degrees(target)) * scale(half_width, 0.2 * distance, 1);
    const auto image = render_tree(scene(
        {path(4), perspective(look_at({0, 0, -0.1}, {0, 0, 0}, {0, 1, 0}), view_deg, columns, 1, samples), face(0, 180),
         face(0.4, apex_deg), node("shape", "rectangle", {{"to_world", slit}}, {node("emitter", "area")})}));

    double before = -INFINITY;
    for (int b = 0; b < image.bin_count(); ++b) {
        double light = 0, column = 0;
        for (int x = 0; x < columns; ++x) {
            const double s0 = image.stokes(image.pixel_index(x, 0), b)[0];
            light += s0;
            column += (x + 0.5) * s0;
        }
        double expected = 0;
        constexpr int steps = 25;
        for (int i = 0; i < steps; ++i) {
            const double angle = apparent_angle(target, index(380 + 25 * b + i + 0.5));
            expected += 0.5 * columns * (1 - std::tan(angle) / std::tan(radians(view_deg / 2))) / steps;
        }
        ASSERT_GT(light, 0) << b;
        // A path keeps one wavelength behind glass: some 800 of a band see the slit, 3.2 columns wide and in the violet
        // smeared over 4 more, and find its middle to sqrt((3.2^2 + 4^2) / 12 / 800) = 0.05 columns. Four times that
        // are 0.013 degrees; bands lie more than a column apart.
        EXPECT_NEAR(column / light, expected, 0.2) << b;
        // The prism bends towards -x, blue most: it is seen farthest towards +x, the picture's left.
        EXPECT_GT(column / light, before) << b;
        before = column / light;
    }
}

}  // namespace
}  // namespace patina::render::test
