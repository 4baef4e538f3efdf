// Once scattered light in closed form beside the modes, against the modes that hold it all.

#include <gtest/gtest.h>

#include "patina/coating/optical_problem.h"
#include "patina/core/constants.h"
#include "patina/jobs/body_solution.h"
#include "patina/math/quadrature.h"

namespace patina {
namespace {

// Particles of size parameter 8 and 16 with all six functions, in two layers of different index over a mirror or over
// nothing.
rt::Problem coarse(const char* base) {
    return coating::optical_problem(coating::parse_recipe(std::string(R"([interface]
type = "smooth"
[[layers]]
thickness_um = 1.5
binder = { n = 1.45 }
[[layers.pigments]]
material = { n = 1.75, k = 0.003 }
volume_fraction = 0.2
size = { distribution = "lognormal", median_radius_um = 1.0, sigma_g = 1.2 }
[[layers]]
thickness_um = 2
binder = { n = 1.6 }
[[layers.pigments]]
material = { n = 2.7 }
volume_fraction = 0.1
size = { distribution = "lognormal", median_radius_um = 0.4, sigma_g = 1.2 }
)") + base,
                                                          "coarse.toml", "."),
                                    550.0, 1e-4)
        .problem;
}

brdf::MuellerTable table_of(const jobs::BodySolution& body) {
    brdf::MuellerTable table;
    table.wavelengths_nm = {550.0};
    table.mu = body.reflection.mu;
    table.mu_weights = body.reflection.weights;
    table.body = {{body.reflection.modes}};
    table.specular_theta_deg = jobs::specular_angles_deg();
    table.specular_surface.assign(
        1, std::vector<optics::Mueller>(table.specular_theta_deg.size(), optics::Mueller::Zero()));
    table.specular_coherent = table.specular_surface;
    table.once_scattered = {body.once_scattered};
    table.validate();
    return table;
}

// At the nodes, where nothing is interpolated, both are the same sum: Fourier series of the correction of Nakajima &
// Tanaka (1988), or its closed form.
TEST(OnceScattered, ClosedFormIsTheSumOfItsModes) {
    const rt::Solver& solver = rt::solver_named("doubling");
    const char* bases[] = {"", "[base]\ntype = \"metal\"\nmaterial = { n = 1.0, k = 6.6 }\n"};
    for (const char* base : bases) {
        const rt::Problem problem = coarse(base);
        const rt::SolveOptions options{.streams = 5, .fourier_tolerance = 0.0};
        constexpr double tolerance = 1e-4;
        ASSERT_TRUE(jobs::is_sharp(solver, problem, tolerance));
        const brdf::MuellerTable whole = table_of({solver.reflection(problem, options), {}});
        const brdf::MuellerTable apart = table_of(jobs::solve_body(solver, problem, options, tolerance));
        ASSERT_EQ(apart.once_scattered[0].size(), 2u);
        EXPECT_LE(apart.body[0].modes.size(), 10u);  // 2N terms
        EXPECT_GT(whole.body[0].modes.size(), 25u);

        std::vector<double> mu;
        for (const double node : whole.mu)
            if (node > 0.1) mu.push_back(node);  // nearer to grazing light changes much within half a degree
        const std::vector<double> phi{0.0, 0.4, 1.7, pi, 4.0};
        const brdf::MuellerGrid expected = whole.evaluate_grid(550.0, mu, mu, phi),
                                found = apart.evaluate_grid(550.0, mu, mu, phi);
        double scale = 0.0, largest = 0.0;
        for (std::size_t k = 0; k < expected.values.size(); ++k) {
            scale = std::max(scale, expected.values[k](0, 0));
            largest = std::max(largest, (expected.values[k] - found.values[k]).cwiseAbs().maxCoeff());
        }
        // Light and scattering matrix come from cubics through tables: 1e-5 of the largest value.
        EXPECT_LT(largest, 1e-5 * scale) << base;

        // What it reflects in all, by a quadrature of its own; the halo of the mirror is narrow.
        const math::Quadrature rule = math::gauss_legendre(50, 0.0, 1.0);
        std::vector<double> around;
        for (int p = 0; p < 150; ++p) around.push_back(2 * pi * p / 150);
        const brdf::MuellerGrid all = apart.evaluate_grid(550.0, rule.nodes, mu, around);
        for (int i = 0; i < all.incident; ++i) {
            double flux = 0.0;
            for (int o = 0; o < all.outgoing; ++o)
                for (int p = 0; p < all.azimuths; ++p)
                    flux += 2 * pi / 150 * rule.weights[o] * rule.nodes[o] * all.at(o, i, p)(0, 0);
            EXPECT_NEAR(apart.body_albedo(550.0, mu[i]), flux, 1e-3 * flux) << base << mu[i];
        }
        const optics::Mueller one = apart.evaluate(550.0, mu[0], mu[1], 1.7);
        EXPECT_LT((one - expected.at(0, 1, 2)).cwiseAbs().maxCoeff(), 1e-5 * scale);
    }
}

}  // namespace
}  // namespace patina
