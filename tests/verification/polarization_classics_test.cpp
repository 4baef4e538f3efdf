// The classics of polarization optics as scenes: every path is a chain of mirrors, panes and plates, and both ways are
// followed at each interface (`whitted`), so that a picture has no noise.

#include "electric_fields.h"
#include "render_scenes.h"
#include <gtest/gtest.h>

namespace patina::render::test {
namespace {

// Columns: x and y of the element, its normal.
Eigen::Matrix4d facing(const Vector3d& centre, const Vector3d& normal, const Vector3d& x, double half_size) {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.block<3, 1>(0, 0) = half_size * x;
    m.block<3, 1>(0, 1) = half_size * normal.cross(x);
    m.block<3, 1>(0, 2) = normal;
    m.block<3, 1>(0, 3) = centre;
    return m;
}
Vector3d across(const Vector3d& normal) {
    return std::abs(normal.x()) < 0.9 ? Vector3d((Vector3d::UnitX() - normal.x() * normal).normalized())
                                      : Vector3d::UnitY();
}
Node plate(const Vector3d& centre, const Vector3d& normal, Node bsdf, double half_size = 0.3,
           const Vector3d& x = Vector3d::Zero()) {
    return node("shape", "rectangle",
                {{"to_world", facing(centre, normal, x.isZero() ? across(normal) : x, half_size)}}, {std::move(bsdf)});
}
// Radiance 1 towards `direction`.
Node lamp_towards(const Vector3d& centre, const Vector3d& direction, double half_size = 0.3) {
    return node(
        "shape", "rectangle", {{"to_world", facing(centre, direction, across(direction), half_size)}},
        {node("bsdf", "diffuse", {uniform("reflectance", 0)}), node("emitter", "area", {uniform("radiance", 1)})});
}
Node optic(const char* type, std::vector<Value> values) {
    values.push_back({"transmittance", SpectrumSpec{SpectrumSpec::Kind::uniform, {}, {1.0}}});
    return node("bsdf", type, std::move(values));
}
Node glass(double index) {
    return node("bsdf", "dielectric", {{"int_ior", index}, {"ext_ior", 1.0}});
}
Eigen::Vector4d seen(std::vector<Node> nodes, const Vector3d& from, const Vector3d& to, const Vector3d& up) {
    nodes.push_back(node("integrator", "whitted", {{"hide_emitters", false}, {"max_depth", std::int64_t{12}}}));
    nodes.push_back(needle(from, to, up, 1));
    return mean_stokes(render_tree(scene(std::move(nodes))));
}

// A retarder between crossed polarizers passes sin^2(2 theta) sin^2(delta/2) of the half that the first one passes
// (Hecht 2017, section 8.7), vibrating along the second.
TEST(PolarizationClassics, RetarderBetweenCrossedPolarizers) {
    const Vector3d up(0, 1, 0), z = Vector3d::UnitZ(), x = Vector3d::UnitX();
    for (double theta_deg : {0.0, 15.0, 45.0, 70.0})
        for (double delta_deg : {30.0, 90.0, 180.0, 250.0}) {
            const Eigen::Vector4d s =
                seen({lamp_towards({0, 0, 0}, z), plate({0, 0, 1}, z, optic("polarizer", {{"theta", 0.0}}), 0.3, x),
                      plate({0, 0, 2}, z, optic("retarder", {{"theta", theta_deg}, {"delta", delta_deg}}), 0.3, x),
                      plate({0, 0, 3}, z, optic("polarizer", {{"theta", 90.0}}), 0.3, x)},
                     {0, 0, 9}, {0, 0, 0}, up);
            const double passed =
                0.5 * std::pow(std::sin(2 * radians(theta_deg)) * std::sin(0.5 * radians(delta_deg)), 2);
            // Single precision, and the needle's angle of 1e-4.
            EXPECT_LT((s - passed * Eigen::Vector4d(1, -1, 0, 0)).norm(), 2e-6) << theta_deg << " " << delta_deg;
        }
}

// Two windows at Brewster's angle, tilted against each other: all of p passes, and of s (1 - R)/(1 + R) at each, its
// returns within the pane summed. With the second turned by a right angle about the beam both windows polarize alike,
// and nothing is left of it.
TEST(PolarizationClassics, PairOfBrewsterWindows) {
    const double n = 1.5, brewster = std::atan(n), r_s = std::pow((n * n - 1) / (n * n + 1), 2);
    const double t_s = (1 - r_s) / (1 + r_s);
    const auto window = [&](double z, const Vector3d& tilt) {
        return plate({0, 0, z}, std::cos(brewster) * Vector3d::UnitZ() + std::sin(brewster) * tilt,
                     node("bsdf", "thindielectric", {{"int_ior", n}, {"ext_ior", 1.0}}));
    };
    const Node source = lamp_towards({0, 0, 0}, Vector3d::UnitZ());
    const Vector3d from(0, 0, 9), to(0, 0, 0), up(0, 1, 0);
    const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY();
    // Tilted about the horizontal axis, the windows pass what vibrates upright: S1 < 0.
    const Eigen::Vector4d pair = seen({source, window(2, y), window(5, -y)}, from, to, up);
    EXPECT_LT((pair - 0.5 * Eigen::Vector4d(1 + t_s * t_s, t_s * t_s - 1, 0, 0)).norm(), 1e-5) << pair.transpose();
    const Eigen::Vector4d crossed = seen({source, window(2, y), window(5, x)}, from, to, up);
    EXPECT_LT((crossed - Eigen::Vector4d(t_s, 0, 0, 0)).norm(), 1e-5) << crossed.transpose();
}

// Malus' own experiment: two glass mirrors at Brewster's angle, the second turned about the ray between them
// (Noerremberg's polariscope). What arrives is R_s^2/2 cos^2 of the angle, vibrating in the second's plane.
TEST(PolarizationClassics, TwoMirrorsAtBrewstersAngle) {
    const double n = 1.5, brewster = std::atan(n), r_s = std::pow((n * n - 1) / (n * n + 1), 2);
    const Vector3d z = Vector3d::UnitZ();
    const Vector3d first = std::cos(brewster) * z + std::sin(brewster) * Vector3d::UnitX();
    const Vector3d arriving = z - 2 * z.dot(first) * first;  // travels so before the first mirror, along z after it
    for (double angle_deg : {0.0, 30.0, 60.0, 90.0, 200.0}) {
        const Vector3d side(std::cos(radians(angle_deg)), std::sin(radians(angle_deg)), 0);
        const Vector3d second = -std::cos(brewster) * z + std::sin(brewster) * side;
        const Vector3d leaving = z - 2 * z.dot(second) * second, corner(0, 0, 2);
        const Vector3d s_axis = side.cross(z);  // across the second plane of incidence
        const Eigen::Vector4d s = seen({lamp_towards(-3 * arriving, arriving, 0.2), plate({0, 0, 0}, first, glass(n)),
                                        plate(corner, second, glass(n))},
                                       corner + 3 * leaving, corner, s_axis.cross(leaving));
        // The camera's up lies in the plane of incidence, so the light vibrates level: S1 > 0.
        const double passed = 0.5 * r_s * r_s * std::pow(std::cos(radians(angle_deg)), 2);
        EXPECT_LT((s - passed * Eigen::Vector4d(1, 1, 0, 0)).norm(), 2e-6) << angle_deg << ": " << s.transpose();
    }
}

// Fresnel (1817): two total reflections at 54.6 degrees in glass of 1.51 retard by an eighth of a period each and make
// circular light of linear light at 45 degrees to the plane of incidence. The sense of rotation is that of the fields.
TEST(PolarizationClassics, FresnelsRhombMakesCircularLight) {
    const double n = 1.51, theta = radians(54.6);
    const Vector3d z = Vector3d::UnitZ(), x = Vector3d::UnitX();
    const Vector3d outward(0, std::sin(theta), std::cos(theta));  // of the first long face, at the origin
    const Vector3d between = z - 2 * z.dot(outward) * outward;
    const Vector3d second = 3 * between, exit = second + 1.5 * z;
    for (double axis_deg : {45.0, -45.0}) {
        const Eigen::Vector4d s =
            seen({lamp_towards({0, 0, -4}, z), plate({0, 0, -3}, z, optic("polarizer", {{"theta", axis_deg}}), 0.3, x),
                  plate({0, 0, -1.5}, -z, glass(n)), plate({0, 0, 0}, outward, glass(n)),
                  plate(second, -outward, glass(n)), plate(exit, z, glass(n))},
                 exit + 4 * z, exit, Vector3d::UnitY());
        Vector3cd field =
            std::sqrt(0.5) *
            (std::cos(radians(axis_deg)) * x + std::sin(radians(axis_deg)) * Vector3d::UnitY()).cast<Complex>();
        field = reflected(field, z, -outward, 1 / n);
        field = reflected(field, between, outward, 1 / n);
        const double faces = std::pow(4 * n / ((n + 1) * (n + 1)), 2);
        const Eigen::Vector4d expected = faces * measured(field, -z, Vector3d::UnitY());
        // Light that returned inside the rhomb from both end faces is in the picture too: R^2 of the rest.
        const double returned = std::pow((n - 1) / (n + 1), 4);
        EXPECT_LT((s - expected).norm(), 2 * returned * expected[0] + 2e-6) << s.transpose() << "\n"
                                                                            << expected.transpose();
        EXPECT_GT(std::abs(s[3] / s[0]), 0.999);
        EXPECT_EQ(s[3] > 0, expected[3] > 0);
    }
}

}  // namespace
}  // namespace patina::render::test
