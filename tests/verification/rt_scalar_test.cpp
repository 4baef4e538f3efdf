// Intensity-only problems: van de Hulst's, DISORT's and Siewert's IIA without polarization.

#include "rt_problems.h"
#include "rt_scalar_data.h"

#include "patina/core/constants.h"
#include "patina/math/quadrature.h"

namespace patina::rt {
namespace {

optics::ExpansionCoefficients expansion_of(scalar_slabs::Phase phase) {
    switch (phase) {
        case scalar_slabs::Phase::isotropic:
            return testing_problems::unpolarizing({1.0});
        case scalar_slabs::Phase::rayleigh:
            return testing_problems::unpolarizing({1.0, 0.0, 0.5});
        case scalar_slabs::Phase::henyey_greenstein_075:
            return testing_problems::henyey_greenstein(0.75, 80);
        default:
            return testing_problems::unpolarizing(scalar_slabs::haze_l);
    }
}

class ScalarSolvers : public testing::TestWithParam<std::string> {};

TEST_P(ScalarSolvers, ReproduceDisortsTestProblems) {
    const Solver& solver = solver_named(GetParam());
    for (const auto& c : scalar_slabs::cases) {
        const Problem problem{
            1.0, {{c.optical_thickness, c.single_scattering_albedo, expansion_of(c.phase), 1.0}}, BlackBase{}};
        if (!solver.unsupported(problem).empty()) continue;
        FieldRequest request{c.mu_i, {1, 0, 0, 0}, c.optical_depths, {}, {0.0}};
        for (double mu : c.mu) request.mu_o.push_back(std::abs(mu));
        const Field field = solver.field(problem, request, {.streams = 8, .scalar = true});
        for (std::size_t d = 0; d < c.optical_depths.size(); ++d)
            for (std::size_t o = 0; o < c.mu.size(); ++o) {
                const double value = c.flux * (c.mu[o] > 0 ? field.upward : field.downward)[d][o][0][0];
                // Six printed digits; transmission below 1e-12 is light that double precision cannot tell from none.
                const double expected = c.intensities[d][o];
                EXPECT_NEAR(value, expected, 1e-5 * expected + 1e-12)
                    << "test " << c.test << " case " << c.number << " depth " << c.optical_depths[d] << " mu "
                    << c.mu[o];
            }
    }
}

TEST_P(ScalarSolvers, ReproduceDisortsFluxesOfForwardScattering) {
    const Solver& solver = solver_named(GetParam());
    const math::Quadrature rule = math::gauss_legendre(40, 0.0, 1.0);
    for (const auto& c : scalar_slabs::fluxes) {
        const Problem problem{
            1.0, {{c.optical_thickness, c.single_scattering_albedo, expansion_of(c.phase), 1.0}}, BlackBase{}};
        if (!solver.unsupported(problem).empty()) continue;
        const Field field = solver.field(problem, {1.0, {1, 0, 0, 0}, c.optical_depths, rule.nodes, {0.0}},
                                         {.streams = 42, .scalar = true});
        for (std::size_t d = 0; d < c.optical_depths.size(); ++d) {
            double up = 0.0, down = 0.0;
            for (int o = 0; o < rule.size(); ++o) {
                up += 2 * pi * rule.weights[o] * rule.nodes[o] * field.upward[d][o][0][0];
                down += 2 * pi * rule.weights[o] * rule.nodes[o] * field.downward[d][o][0][0];
            }
            // The reference's 8 or 16 nodes a hemisphere leave some 1e-4 of the reflected part.
            EXPECT_NEAR(up, c.up[d], 1e-4)
                << "test " << c.test << " case " << c.number << " depth " << c.optical_depths[d];
            EXPECT_NEAR(down, c.down[d], 1e-4)
                << "test " << c.test << " case " << c.number << " depth " << c.optical_depths[d];
        }
    }
}

TEST_P(ScalarSolvers, ReproduceVanDeHulstsIsotropicSlab) {
    const Problem problem{1.0, {{2.0, 0.8, testing_problems::unpolarizing({1.0}), 1.0}}, BlackBase{}};
    for (const auto& row : scalar_slabs::isotropic_slab) {
        const FieldRequest request{row.mu_i, {1, 0, 0, 0}, {0.0, 2.0}, {row.mu_o}, {0.0}};
        const Field field = solver_named(GetParam()).field(problem, request, {.streams = 20, .scalar = true});
        const double radiance = row.reflection ? field.upward[0][0][0][0] : field.downward[1][0][0][0];
        EXPECT_NEAR(radiance / row.mu_i, row.value, 1e-5) << row.reflection << " " << row.mu_o << " " << row.mu_i;
    }
}

TEST_P(ScalarSolvers, ReproduceProblemIIAWithoutPolarization) {
    for (const auto& row : scalar_slabs::problem_iia) {
        const FieldRequest request{siewert2000::mu_i, {1, 0, 0, 0}, {0.0}, {row.mu_o}, {radians(row.phi_deg)}};
        const Field field =
            solver_named(GetParam()).field(testing_problems::siewert(), request, {.streams = 30, .scalar = true});
        EXPECT_NEAR(field.upward[0][0][0][0], row.intensity, 2e-9) << row.mu_o << " " << row.phi_deg;
    }
}

INSTANTIATE_TEST_SUITE_P(Solvers, ScalarSolvers, testing::ValuesIn(testing_problems::solver_names()));

// What ignoring polarization costs on Siewert's problem: per cents of the intensity, far above the digits of the
// tables.
TEST(Polarization, ChangesTheIntensityOfProblemIIA) {
    const FieldRequest request{siewert2000::mu_i, {1, 0, 0, 0}, {0.0}, {0.5}, {pi / 2}};
    const Field vector = solver_named("doubling").field(testing_problems::siewert(), request, {.streams = 20});
    const Field scalar =
        solver_named("doubling").field(testing_problems::siewert(), request, {.streams = 20, .scalar = true});
    const double error = std::abs(scalar.upward[0][0][0][0] / vector.upward[0][0][0][0] - 1.0);
    EXPECT_GT(error, 1e-3);
    EXPECT_LT(error, 1e-1);
}

}  // namespace
}  // namespace patina::rt
