#include "patina/rt/rough_interface.h"

#include <cmath>

#include <gtest/gtest.h>

#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/math/quadrature.h"
#include "patina/optics/fresnel.h"
#include "patina/rt/solver.h"
#include "patina/rt/test_laws.h"
#include "patina/rt/test_problems.h"

namespace patina::rt {
namespace {

using testing_problems::physical_expansion;
using testing_problems::reciprocity_error;
using testing_problems::reflectance;

constexpr double rounding = 1e-12;
const RoughSurface ggx{0.3, FacetDistribution::ggx}, beckmann{0.15, FacetDistribution::beckmann};

Reflection solve(const Problem& problem, const SolveOptions& options) {
    return solver_named("doubling").reflection(problem, options);
}

TEST(RoughInterface, LosesNothingAndIsReciprocal) {
    for (const RoughSurface& surface : {ggx, beckmann}) {
        const Problem problem{1.0, {{0.5, 1.0, physical_expansion(1), 1.5}}, LambertianBase{1.0}, surface};
        const Reflection r = solve(problem, {.streams = 8, .most_fourier_orders = 3});
        EXPECT_LT((reflectance(problem, r).array() - 1.0).abs().maxCoeff(), rounding);
        EXPECT_LT(reciprocity_error(r), rounding);
        EXPECT_EQ(specular_surface(problem, 0.5).norm(), 0.0);
        EXPECT_EQ(specular_coherent(problem, 0.5).norm(), 0.0);
    }
}

// Intensity stays positive: lobes are averages of facets and what is given back is a product of losses.
TEST(RoughInterface, SendsNoNegativeLight) {
    const Problem problem{1.0, {{0.0, 0.0, physical_expansion(1), 1.5}}, BlackBase{}, RoughSurface{0.1}};
    const std::vector<Ray> rays = quadrature_rays(problem, 12);
    const Medium upper = medium_of(rays, 1.0), lower = medium_of(rays, 1.5);
    const RoughInterface interface(*problem.top_roughness, rays, upper, lower, 12);
    const RoughInterface::Operators mean = interface.operators(0, {0, 1});
    for (const Eigen::MatrixXd* flux :
         {&mean.reflection_above, &mean.reflection_below, &mean.transmission_down, &mean.transmission_up})
        EXPECT_GT(flux->minCoeff(), -1e-15);  // rounding
}

// The facets of a vanishing slope are the smooth interface: what leaves in all directions differs by the square of the
// slopes, and by the mean of Fresnel's laws over a ray's cell, both below a hundredth away from grazing.
TEST(RoughInterface, TendsToTheSmoothInterface) {
    Problem problem{1.0, {{0.8, 0.95, physical_expansion(4), 1.5}}, LambertianBase{0.6}};
    const SolveOptions options{.streams = 16, .most_fourier_orders = 1};
    const Reflection a = solve(problem, options);
    const Eigen::VectorXd expected = reflectance(problem, a);
    problem.top_roughness = RoughSurface{0.04, FacetDistribution::beckmann};
    const Eigen::VectorXd found = reflectance(problem, solve(problem, options));
    for (std::size_t i = 0; i < a.mu.size(); ++i)
        if (a.mu[i] > 0.3) {
            EXPECT_NEAR(found[i], expected[i], 0.01) << a.mu[i];
        }
}

// A facet reflects or refracts all light: its two albedos, the first by facets, the second by directions, and what is
// shadowed add up to 1. At normal incidence on slopes of 0.1 shadowing takes less than a few 1e-3.
TEST(RoughInterface, FacetsShareTheLightBetweenBothSides) {
    const Microfacets facets({0.1, FacetDistribution::beckmann}, 1.0, 1.5);
    const double reflected = facets.reflectance(-0.95);
    const math::Quadrature mu = math::gauss_legendre(200, 0.85, 1.0), turn = math::gauss_legendre(200, 0.0, 1.0);
    double refracted = 0.0;
    for (int o = 0; o < mu.size(); ++o)
        for (int p = 0; p < turn.size(); ++p) {
            const double phi = pi * std::pow(turn.nodes[p], 2);
            // Microfacets leave out n_o/n_i.
            refracted += 2.0 * mu.weights[o] * mu.nodes[o] * 1.5 * facets(-0.95, -mu.nodes[o], phi)(0, 0) * 2.0 * pi *
                         turn.nodes[p] * turn.weights[p];
        }
    EXPECT_NEAR(reflected + refracted, 1.0, 2e-3);
    EXPECT_LE(reflected + refracted, 1.0 + 1e-6);
    // Fresnel's law at 18 deg, moved by the square of the slopes.
    EXPECT_NEAR(reflected, optics::fresnel_reflection(0.95, 1.0, 1.5)(0, 0), 2e-4);
}

TEST(RoughInterface, RefusesSlopesOutsideItsRange) {
    Problem problem{1.0, {{0.5, 1.0, physical_expansion(1), 1.5}}, BlackBase{}, RoughSurface{0.0}};
    EXPECT_THROW(validate(problem), Error);
    problem.top_roughness->alpha = 1.5;
    EXPECT_THROW(validate(problem), Error);
}

}  // namespace
}  // namespace patina::rt
