#include "patina/rt/rough_boundary.h"

#include <cmath>

#include <gtest/gtest.h>

#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/optics/fresnel.h"
#include "patina/rt/solver.h"
#include "patina/rt/test_laws.h"
#include "patina/rt/test_problems.h"

namespace patina::rt {
namespace {

using optics::Mueller;
using testing_problems::physical_expansion;
using testing_problems::reciprocity_error;
using testing_problems::reflectance;

constexpr double rounding = 1e-12;
const RoughSurface ggx{0.3, FacetDistribution::ggx}, beckmann{0.25, FacetDistribution::beckmann};

TEST(Microfacets, AreReciprocal) {
    for (const RoughSurface& surface : {ggx, beckmann}) {
        const Microfacets glass(surface, 1.0, 1.5), metal(surface, 1.5, {0.96, 6.69});
        const auto reversed = [](const Mueller& m) {
            return Mueller(optics::reversal() * m.transpose() * optics::reversal());
        };
        for (double phi : {0.4, 2.0}) {
            EXPECT_LT((metal(-0.4, 0.7, phi) - reversed(metal(-0.7, 0.4, -phi))).norm(), 1e-13);
            EXPECT_LT((glass(-0.4, 0.7, phi) - reversed(glass(-0.7, 0.4, -phi))).norm(), 1e-13);
            EXPECT_LT((glass(-0.8, -0.7, phi) - reversed(glass(0.7, 0.8, -phi))).norm(), 1e-13);
            EXPECT_GT(glass(-0.8, -0.95, 0.1)(0, 0), 0.1);
        }
    }
}

// The facets seen from any direction have the projected area of the surface: int G1 D max(0, w.h) dh = cos. A perfect
// mirror's lobe integrates to less than 1 by what other facets shadow, nothing as the slopes vanish.
TEST(Microfacets, ReflectEverythingAsTheSlopesVanish) {
    const Microfacets mirror({0.02, FacetDistribution::beckmann}, 1.0, {1.0, 5.0});
    const math::Quadrature rule = math::gauss_legendre(400, 0.5, 0.9);
    double total = 0.0;
    for (int o = 0; o < rule.size(); ++o)
        for (int p = 0; p < 800; ++p)
            total += rule.weights[o] * rule.nodes[o] *
                     mirror(-0.7, rule.nodes[o], 0.4 * (p + 0.5) / 800 - 0.2, true)(0, 0) * 0.4 / 800;
    // Slopes of 0.02 leave a few of their squares, and the tails beyond the integrated range.
    EXPECT_NEAR(total, 1.0, 2e-3);
}

TEST(RoughBoundary, PerfectMetalLosesNothing) {
    for (const RoughSurface& surface : {ggx, beckmann}) {
        const Problem problem{1.0, {{0.5, 1.0, physical_expansion(1), 1.5}}, MetalBase{{1.0, 1e9}, surface}};
        const Reflection r = solver_named("doubling").reflection(problem, {.streams = 10});
        // k = 1e9 absorbs 4 n/k^2 cos and at grazing 4 cos/...: below 1e-8.
        EXPECT_LT((reflectance(problem, r).array() - 1.0).abs().maxCoeff(), 1e-7);
        EXPECT_LT(reciprocity_error(r), rounding);
    }
}

// As the slopes vanish, the light reflected in all directions is that of the smooth surface. Lobes of alpha move it by
// alpha^2 times the second derivative in angle, which is of the order of 1 away from grazing.
TEST(RoughBoundary, TendsToTheSmoothSurface) {
    const RoughSurface slight{0.08, FacetDistribution::beckmann};
    const auto x = physical_expansion(4);
    const Problem smooth{1.0, {{0.8, 0.95, x, 1.5}}, MetalBase{{0.96, 6.69}}};
    Problem rough_metal = smooth;
    rough_metal.base = MetalBase{{0.96, 6.69}, slight};
    const SolveOptions options{.streams = 30, .most_fourier_orders = 1};
    const auto solve = [&](const Problem& p) { return solver_named("doubling").reflection(p, options); };
    const Reflection a = solve(smooth);
    const Eigen::VectorXd expected = reflectance(smooth, a);
    const Eigen::VectorXd found = reflectance(rough_metal, solve(rough_metal));
    for (std::size_t i = 0; i < a.mu.size(); ++i)
        if (a.mu[i] > 0.4) {
            EXPECT_NEAR(found[i], expected[i], 0.02) << a.mu[i];
        }
}

TEST(RoughBoundary, FieldAgreesWithReflection) {
    const Problem problem{1.0, {{0.8, 0.95, physical_expansion(4), 1.5}}, MetalBase{{0.96, 6.69}, ggx}};
    const SolveOptions options{.streams = 10, .fourier_tolerance = 0.0};
    const Reflection r = solver_named("doubling").reflection(problem, options);
    EXPECT_LT(reciprocity_error(r), rounding);
    for (int column : {0, 3}) {
        const FieldRequest request{r.mu[6], optics::Stokes::Unit(column), {0.0}, {r.mu[4]}, {0.7}};
        const Field field = solver_named("doubling").field(problem, request, options);
        optics::Stokes expected = optics::Stokes::Zero();
        for (std::size_t m = 0; m < r.modes.size(); ++m) {
            const double c = (m ? 2 : 1) * std::cos(0.7 * m), s = (m ? 2 : 1) * std::sin(0.7 * m);
            const optics::Stokes f = r.modes[m].block<4, 1>(4 * 4, 4 * 6 + column);
            expected += column < 2 ? optics::Stokes(c * f[0], c * f[1], s * f[2], s * f[3])
                                   : optics::Stokes(-s * f[0], -s * f[1], c * f[2], c * f[3]);
        }
        EXPECT_LT((field.upward[0][0][0] - pi * r.mu[6] * expected).cwiseAbs().maxCoeff(), 1e-11);
    }
}

TEST(RoughBoundary, SaysWhenTheStreamsDoNotResolveTheLobes) {
    const auto on_metal_of = [](double alpha) {
        return Problem{1.0,
                       {{1.0, 0.9, physical_expansion(1), 1.5}},
                       MetalBase{{0.96, 6.69}, RoughSurface{alpha, FacetDistribution::ggx}}};
    };
    const Problem problem = on_metal_of(0.05);
    const SolveOptions few{.streams = 3, .most_fourier_orders = 1}, many{.streams = 48, .most_fourier_orders = 1};
    EXPECT_FALSE(solver_named("doubling").reflection(problem, few).diagnostics.converged);
    EXPECT_TRUE(solver_named("doubling").reflection(problem, many).diagnostics.converged);
    EXPECT_THROW(validate(on_metal_of(0.0)), Error);
}

}  // namespace
}  // namespace patina::rt
