// The solver montecarlo against an independent Jones-vector Monte Carlo of the same paint, from the recipe's particles
// on.

#include "monte_carlo_paint_slab.h"

#include "patina/core/constants.h"
#include "patina/optics/scattering/particle_ensemble.h"
#include "patina/rt/solvers/monte_carlo.h"

namespace patina {
namespace {

using reference::PaintSlabRow;

rt::Problem paint_slab(double index_above) {
    // 1e-6 in F is below the systematic error of the reference.
    const auto particles = optics::scatter(2.75, 1.495, 550.0, {optics::LogNormal{0.125, 1.3}}, {.tolerance = 1e-6});
    return {index_above, {{1.0, 1.0, particles.expansion, 1.495}}, rt::BlackBase{}};
}

// Deviations in units of the joint error of both Monte Carlos, by Stokes component.
struct Deviations {
    Eigen::Array4d largest = Eigen::Array4d::Zero(), largest_in_sigma = Eigen::Array4d::Zero(),
                   sum_of_squares = Eigen::Array4d::Zero();
    Eigen::Array4d count = Eigen::Array4d::Zero();
    double relative_error = 0.0;  // largest standard error of I, relative
};

Deviations compare(char test_case, const rt::SolveOptions& options) {
    // The grid of the reference: theta 0, 20, 40, 60, 75 deg by phi 0, 45, 90, 135, 180 deg, row by row.
    rt::FieldRequest request{.mu_i = std::cos(radians(45.0)), .optical_depths = {0.0}};
    for (double theta : {0.0, 20.0, 40.0, 60.0, 75.0}) request.mu_o.push_back(std::cos(radians(theta)));
    for (double phi : {0.0, 45.0, 90.0, 135.0, 180.0}) request.phi.push_back(radians(phi));
    const rt::Field field =
        rt::make_monte_carlo_solver()->field(paint_slab(test_case == 'A' ? 1.495 : 1.0), request, options);

    // Divide by the irradiance on the slab, pi cos 45 deg, to get a BRDF.
    Deviations d;
    const double irradiance = pi * request.mu_i;
    std::size_t row = 0;
    for (const PaintSlabRow& expected : reference::paint_slab_rows) {
        if (expected.test_case != test_case) continue;
        const std::size_t o = row / 5, p = row % 5;
        ++row;
        EXPECT_NEAR(request.mu_o[o], std::cos(radians(expected.theta_o_deg)), 1e-15);
        EXPECT_NEAR(request.phi[p], radians(expected.phi_deg), 1e-15);
        const Eigen::Array4d value = field.upward[0][o][p] / irradiance,
                             error = field.upward_error[0][o][p] / irradiance;
        const Eigen::Array4d sigma = (error.square() + expected.sigma.array().square()).sqrt();
        const Eigen::Array4d off = (value - expected.value.array()).abs();
        d.largest = d.largest.max(off);
        d.largest_in_sigma = d.largest_in_sigma.max(off / sigma);
        d.sum_of_squares += (off / sigma).square();
        d.count += 1.0;
        d.relative_error = std::max(d.relative_error, error[0] / value[0]);
    }
    EXPECT_EQ(row, 25u);
    return d;
}

// 100 values, each normal: the largest of them exceeds 4.5 sigma with probability 100 x 7e-6 = 7e-4 in a fresh seed;
// the seed is fixed. Power: with b2 of the wrong sign, V of case B would be off by 2 V, hundreds of sigma.
class PaintSlab : public testing::TestWithParam<char> {};

TEST_P(PaintSlab, AllStokesComponentsAgreeWithTheReference) {
    const Deviations d = compare(GetParam(), {.samples = 300'000, .seed = 7});
    for (int c = 0; c < 4; ++c) {
        EXPECT_LT(d.largest_in_sigma[c], 4.5) << "component "
                                              << "IQUV"[c];
        RecordProperty(std::string("rms_sigma_") + "IQUV"[c],
                       std::to_string(std::sqrt(d.sum_of_squares[c] / d.count[c])));
    }
    EXPECT_LT(d.relative_error, 4e-3);  // else the comparison says nothing
}

INSTANTIATE_TEST_SUITE_P(Cases, PaintSlab, testing::Values('A', 'B'));

}  // namespace
}  // namespace patina
