#include "patina/brdf/half_angle_table.h"

#include <gtest/gtest.h>

#include "patina/brdf/meridian_frame.h"
#include "patina/brdf/tabulate.h"
#include "patina/core/constants.h"
#include "patina/optics/fresnel.h"

namespace patina::brdf {
namespace {

using Eigen::Vector3d;
using optics::Mueller;

Mueller rayleigh(double, double mu_o, double mu_i, double phi) {
    return rayleigh_phase_matrix(mu_o, mu_i, phi) / (4 * pi);
}

DirectionPair pair_of(const Vector3d& i, const Vector3d& o) {
    return {i, o, i.cross(o).normalized()};
}

Vector3d direction(double theta_deg, double phi_deg) {
    const double sine = std::sin(radians(theta_deg));
    return {sine * std::cos(radians(phi_deg)), sine * std::sin(radians(phi_deg)), std::cos(radians(theta_deg))};
}

TEST(HalfAngles, AreThoseOfTheirDirections) {
    for (double theta_h : {0.1, 0.7, 1.3})
        for (double theta_d : {0.05, 0.6, 1.2})
            for (double phi_d : {-3.0, -1.0, 0.2, 2.4}) {
                const DirectionPair pair = directions({theta_h, theta_d, phi_d});
                const HalfAngles back = half_angles(pair.i, pair.o);
                EXPECT_NEAR(back.theta_h, theta_h, 1e-12);
                EXPECT_NEAR(back.theta_d, theta_d, 1e-12);
                EXPECT_NEAR(back.phi_d, phi_d, 1e-11);
                EXPECT_LT((pair.i.cross(pair.o).normalized() - pair.stokes_x).norm(), 1e-12);
            }
}

// In frames tied to the scattering plane, scattering depends on the scattering angle alone: with x across that plane,
// Rayleigh's matrix is 3/4 [[1 + c^2, 1 - c^2, 0, 0], [1 - c^2, 1 + c^2, 0, 0], [0, 0, 2c, 0], [0, 0, 0, 2c]]: light is
// polarized across the plane, Q > 0 along x = i x o.
TEST(HalfAngleFrames, RayleighScatteringTakesItsScatteringPlaneForm) {
    for (auto [i, o] : {std::pair{direction(50, 20), direction(35, 140)},
                        {direction(80, -70), direction(10, 10)},
                        {direction(0, 0), direction(60, 45)},
                        {direction(30, 200), direction(0, 0)}}) {
        const DirectionPair pair = pair_of(i, o);
        const Mueller found = to_half_angle_frames(rayleigh_phase_matrix(o.z(), i.z(), relative_azimuth(pair)), pair);
        const double c = -i.dot(o);
        Mueller expected = Mueller::Zero();
        expected.topLeftCorner<2, 2>() << 1 + c * c, 1 - c * c, 1 - c * c, 1 + c * c;
        expected(2, 2) = expected(3, 3) = 2 * c;
        EXPECT_LT((found - 0.75 * expected).norm(), 1e-14) << found;
        EXPECT_LT(
            (to_meridian_frames(found, pair) - rayleigh_phase_matrix(o.z(), i.z(), relative_azimuth(pair))).norm(),
            1e-14);
    }
}

// The signs of U and V, from electric fields in space. The field Re(E exp(-i w t)) of each ray is written in the
// solver's frame (p, s) and in the frame (x, y = k x x); V > 0 must be clockwise for who looks into the source in both.
TEST(HalfAngleFrames, KeepTheSenseOfRotationAndTheDirectionOfVibration) {
    using Complex = std::complex<double>;
    const DirectionPair pair = pair_of(direction(50, 20), direction(35, 140));
    const MeridianFrame frame = meridian_frame(pair.o.z(), radians(140));
    const Vector3d x = pair.stokes_x, y = pair.o.cross(x);
    const auto stokes = [](Complex along, Complex across, double sense) -> optics::Stokes {
        const Complex product = along * std::conj(across);
        return {std::norm(along) + std::norm(across), std::norm(along) - std::norm(across), 2 * product.real(),
                sense * 2 * product.imag()};
    };
    for (const auto& [p, s] : {std::pair<Complex, Complex>{1.0, {0.0, 1.0}}, {{0.3, 0.1}, {-0.7, 0.9}}}) {
        const Complex ex = p * frame.p.dot(x) + s * frame.s.dot(x), ey = p * frame.p.dot(y) + s * frame.s.dot(y);
        // In (p, s), s x p = k: V = -2 Im(Ep Es*). In (x, y), x x y = k: the mirror image, V = +2 Im(Ex Ey*).
        const optics::Stokes meridian = stokes(p, s, -1), table = stokes(ex, ey, +1);
        // Tensor product with a fixed incident column: only the outgoing frame matters for the first column.
        Mueller column = Mueller::Zero();
        column.col(0) = meridian;
        EXPECT_LT((to_half_angle_frames(column, pair).col(0) - table).norm(), 1e-14);
    }

    // Ep = 1, Es = i: the field is along +p at first and along +s a quarter of a period later. For who looks into the
    // source (k towards him) p up has s to the right, as s x p = k: clockwise, and V = +2.
    EXPECT_NEAR(stokes(1.0, {0.0, 1.0}, -1)[3], 2.0, 1e-15);
    EXPECT_GT(frame.s.cross(frame.p).dot(frame.propagation), 0.999);
}

// The mirror reflection of a metal: the solver's Fresnel matrix has its plane of incidence in the meridian plane, Q > 0
// in the plane; across it Q changes sign, V <- U keeps the sign of Im(r_p r_s*) once U has turned.
TEST(HalfAngleFrames, FresnelReflectionChangesTheSignOfQ) {
    const Mueller fresnel = optics::fresnel_reflection(std::cos(radians(60)), 1.0, {0.8, 5.0});
    const DirectionPair pair = pair_of(direction(60, 180), direction(60, 0));
    const Mueller found = to_half_angle_frames(fresnel, pair);
    EXPECT_NEAR(found(0, 1), -fresnel(0, 1), 1e-15);
    EXPECT_GT(found(0, 1), 0.0);  // s is reflected more, and s is along x
    EXPECT_NEAR(found(2, 2), fresnel(2, 2), 1e-15);
    EXPECT_NEAR(found(2, 3), fresnel(2, 3), 1e-15);
}

TEST(HalfAngleTable, LambertianSurfaceHasOnlyM00) {
    const HalfAngleTable table = to_half_angles(tabulate(lambertian_body(0.5), {.nodes = 3, .orders = 1}),
                                                {.theta_h = 5, .theta_d = 6, .phi_d = 7});
    table.validate();
    for (std::size_t k = 0; k < table.mueller.size(); ++k)
        EXPECT_NEAR(table.mueller[k], k % 16 == 0 ? 0.5 / pi : 0.0, 1e-8);
}

// Interpolation on the grid errs by the square of its steps: two grids, one twice as fine, must differ by a factor of
// about four, and both hold the BRDF to a few times h^2 f''/8 with f'' of the order of 4 f.
TEST(HalfAngleTable, RoundTripErrsByTheSquareOfTheStep) {
    const MuellerTable table = tabulate(rayleigh, {.wavelengths_nm = {500}, .nodes = 6, .orders = 3});
    const auto largest_error = [&](int steps) {
        const HalfAngleTable grid = to_half_angles(
            table, {.theta_h = steps + 1, .theta_d = steps + 1, .phi_d = 4 * steps + 1, .wavelengths_nm = {500}});
        double largest = 0;
        for (double mu_o : {0.35, 0.8, 0.97})
            for (double mu_i : {0.4, 0.77, 1.0})
                for (double phi : {0.3, 1.9, 3.0, -2.0})
                    largest = std::max(
                        largest,
                        (grid.evaluate_meridian(500, mu_o, mu_i, phi) - rayleigh(500, mu_o, mu_i, phi)).norm());
        return largest / (1.5 / (4 * pi));
    };
    const double coarse = largest_error(16), fine = largest_error(32), step = pi / 2 / 16;
    EXPECT_LT(coarse, 3 * step * step);
    EXPECT_NEAR(coarse / fine, 4.0, 1.5);
}

TEST(HalfAngleTable, RetroreflectionHasTheLimitOfItsNeighbours) {
    const MuellerTable table = tabulate(rayleigh, {.wavelengths_nm = {500}, .nodes = 6, .orders = 3});
    const HalfAngleTable grid = to_half_angles(table, {.theta_h = 33, .theta_d = 33, .phi_d = 65});
    for (double mu : {0.3, 0.7, 1.0})
        EXPECT_LT((grid.evaluate_meridian(500, mu, mu, pi) - rayleigh(500, mu, mu, pi)).norm(), 2e-3) << mu;
}

TEST(HalfAngleTable, FiveWavelengthsAreDistinctAndWithinWideTables) {
    MuellerTable table;
    for (const auto& [range, expected] :
         {std::pair<std::vector<double>, std::vector<double>>{{380, 780}, {450, 500, 550, 600, 650}},
          {{500, 600}, {500, 525, 550, 575, 600}},
          {{550}, {548, 549, 550, 551, 552}}}) {
        table.wavelengths_nm = range;
        EXPECT_EQ(five_wavelengths(table), expected);
    }
}

TEST(HalfAngleTable, NanNeighboursGiveZeroAndM00IsNotNegative) {
    HalfAngleTable table{{0, 1.5}, {0, 1.5}, {-pi, pi}, {550}, std::vector<float>(8 * 16, -0.25f)};
    EXPECT_EQ(table.evaluate(550, {0.5, 0.5, 0.5})(0, 0), 0.0);
    EXPECT_NEAR(table.evaluate(550, {0.5, 0.5, 0.5})(2, 1), -0.25, 1e-12);
    table.mueller[16 * 3 + 5] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(table.evaluate(550, {0.5, 0.5, 0.5}).norm(), 0.0);
}

}  // namespace
}  // namespace patina::brdf
