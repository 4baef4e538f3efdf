#include <random>

#include <gtest/gtest.h>

#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/core/parallel.h"
#include "patina/optics/fresnel.h"
#include "patina/rt/solver.h"
#include "patina/rt/test_laws.h"
#include "patina/rt/test_problems.h"

namespace patina::rt {
namespace {

using testing_problems::physical_expansion;
using testing_problems::reciprocity_error;
using testing_problems::reflectance;

// Rounding in a few hundred dependent operations on matrices of order 100; 1e-12 is what the design promises.
constexpr double rounding = 1e-12;

TEST(Reflection, WhiteFurnaceIsClosedWithInterfaceAndWhiteBase) {
    for (double n : {1.0, 1.33, 1.5, 2.0})
        for (double tau : {0.0, 0.01, 1.0, 1000.0}) {
            const Problem problem{1.0, {{tau, 1.0, physical_expansion(1), n}}, LambertianBase{1.0}};
            const Reflection r = solver_named("doubling").reflection(problem, {.streams = 16});
            EXPECT_LT((reflectance(problem, r).array() - 1.0).abs().maxCoeff(), rounding)
                << "n " << n << " tau " << tau;
            EXPECT_LT(r.diagnostics.energy_balance, rounding);
        }
}

TEST(Reflection, WhiteFurnaceIsClosedForStacksOfDifferentIndices) {
    const Problem problem{1.0,
                          {{0.7, 1.0, physical_expansion(1), 1.5},
                           {2.0, 1.0, physical_expansion(2), 1.33},
                           {0.3, 1.0, physical_expansion(3), 1.6}},
                          LambertianBase{1.0}};
    const Reflection r = solver_named("doubling").reflection(problem, {.streams = 16});
    EXPECT_LT((reflectance(problem, r).array() - 1.0).abs().maxCoeff(), rounding);
}

TEST(Reflection, ConservativeSemiInfiniteLayerReflectsEverything) {
    for (double n : {1.0, 1.5}) {
        const Problem problem{
            1.0, {{std::numeric_limits<double>::infinity(), 1.0, physical_expansion(1), n}}, BlackBase{}};
        const Reflection r = solver_named("doubling").reflection(problem, {.streams = 12});
        EXPECT_LT((reflectance(problem, r).array() - 1.0).abs().maxCoeff(), rounding) << n;
    }
}

TEST(Reflection, IsReciprocal) {
    const std::vector<Problem> problems{
        {1.0, {{0.8, 0.99, physical_expansion(4), 1.0}}, BlackBase{}},
        {1.0, {{0.8, 0.99, physical_expansion(4), 1.5}}, MetalBase{{0.96, 6.69}}},
        {1.0, {{0.8, 1.0, physical_expansion(4), 1.5}, {2.0, 0.9, physical_expansion(5), 1.4}}, LambertianBase{0.4}},
        {1.0, {{0.1, 1.0, physical_expansion(4), 1.4}, {3.0, 0.9, physical_expansion(5), 1.7}}, MetalBase{{0.2, 3.0}}}};
    for (const Problem& problem : problems) {
        const Reflection r = solver_named("doubling").reflection(problem, {.streams = 10});
        EXPECT_LT(reciprocity_error(r), rounding);
        EXPECT_GT(r.modes.size(), 3u);
    }
}

// Without scattering light meets the interface, Beer's law and the base only: a Lambertian base of reflectance a under
// an interface gives f = t(mu_o) e(mu_o) a / (1 - a r) e(mu_i) t(mu_i) / (pi n^2), r = 2 int R_internal e^2 mu d mu.
TEST(Reflection, AbsorbingLayerFollowsBeerLambertAndFresnel) {
    const double n = 1.5, tau = 0.3, a = 0.6;
    const Problem problem{1.0, {{tau, 0.0, physical_expansion(1), n}}, LambertianBase{a}};
    const Reflection r = solver_named("doubling").reflection(problem, {.streams = 24});
    // A composite rule split at the critical angle, where the internal reflectance has a root: mu = mu_c + (1-mu_c)
    // s^2.
    const double mu_c = std::sqrt(1 - 1 / (n * n));
    double internal = 0.0;
    const int points = 400000;
    for (int k = 0; k < points; ++k) {
        const double s = (k + 0.5) / points;
        const double below = mu_c * s, above = mu_c + (1 - mu_c) * s * s;
        internal += 2 * below * std::exp(-2 * tau / below) * mu_c / points;
        internal += 2 * above * std::exp(-2 * tau / above) * optics::fresnel_reflection(above, n, 1.0)(0, 0) * 2 * s *
                    (1 - mu_c) / points;
    }
    for (std::size_t o = 0; o < r.mu.size(); ++o)
        for (std::size_t i = 0; i < r.mu.size(); ++i) {
            const auto through = [&](double mu) {
                const double inside = optics::refracted_cosine(mu, 1.0, n);
                return optics::fresnel_transmission(mu, 1.0, n)(0, 0) * std::exp(-tau / inside);
            };
            const double expected = through(r.mu[o]) * a / (1 - a * internal) * through(r.mu[i]) / (pi * n * n);
            // 1e-8: 24 Gauss points on (0, mu_c) for e^(-2 tau/mu), and the midpoint rule above.
            EXPECT_NEAR(r.modes[0](4 * o, 4 * i), expected, 1e-8);
        }
    EXPECT_EQ(r.modes.size(), 1u);
}

TEST(Reflection, OfAMetalUnderAnAbsorbingLayerIsCoherentOnly) {
    const Problem problem{1.0, {{0.3, 0.0, physical_expansion(1), 1.5}}, MetalBase{{0.96, 6.69}}};
    const Reflection r = solver_named("doubling").reflection(problem, {.streams = 8});
    // The difference of equal operators, divided by 2 pi mu w >= 1e-3: rounding only.
    EXPECT_LT(r.modes[0].cwiseAbs().maxCoeff(), 1e-12);
    // At normal incidence the closed form is Airy's sum of intensities: t^2 R e^(-2 tau)/(1 - r R e^(-2 tau)).
    const double interface = 0.04, metal = optics::fresnel_reflection(1.0, 1.5, {0.96, 6.69})(0, 0), e = std::exp(-0.6);
    EXPECT_NEAR(specular_coherent(problem, 1.0)(0, 0), 0.96 * 0.96 * metal * e / (1 - interface * metal * e), 1e-14);
}

// The diffuse orders of a scattering layer over a mirror end with the expansion: beyond it nothing but the coherent
// beam is azimuth dependent.
TEST(Reflection, OrdersFallWithTheExpansionOverAMirror) {
    const Problem problem{1.0, {{0.5, 0.9, physical_expansion(1), 1.5}}, MetalBase{{0.96, 6.69}}};
    const Reflection r = solver_named("doubling").reflection(problem, {.streams = 12, .fourier_tolerance = 0.0});
    EXPECT_EQ(static_cast<int>(r.modes.size()), physical_expansion(1).order() + 1);
}

TEST(Reflection, DoesNotDependOnHowALayerIsCut) {
    const auto x = physical_expansion(6);
    for (double n : {1.0, 1.5}) {
        const auto solve = [&](int slices) {
            Problem problem{1.0, {}, LambertianBase{0.3}};
            for (int k = 0; k < slices; ++k) problem.layers.push_back({2.0 / slices, 0.95, x, n});
            return solver_named("doubling").reflection(problem, {.streams = 12, .fourier_tolerance = 0.0});
        };
        const Reflection whole = solve(1), halves = solve(2), tenths = solve(10);
        for (std::size_t m = 0; m < whole.modes.size(); ++m) {
            EXPECT_LT((whole.modes[m] - halves.modes[m]).cwiseAbs().maxCoeff(), rounding);
            EXPECT_LT((whole.modes[m] - tenths.modes[m]).cwiseAbs().maxCoeff(), rounding);
        }
    }
}

// As the index approaches that of the medium above, the interface vanishes. At the most grazing node, mu = 0.009,
// refraction by n - 1 = 1e-9 still changes mu by (n-1)/mu^2 = 1e-5 of itself, and the BRDF there is of the order of
// 1/(4 mu).
TEST(Reflection, TendsToTheIndexMatchedOneAsTheInterfaceVanishes) {
    const auto x = physical_expansion(2);
    const auto solve = [&](double n) {
        return solver_named("doubling").reflection({1.0, {{1.0, 0.98, x, n}}, BlackBase{}}, {.streams = 12});
    };
    const Reflection matched = solve(1.0), nearly = solve(1.0 + 1e-9);
    for (std::size_t m = 0; m < std::min(matched.modes.size(), nearly.modes.size()); ++m)
        EXPECT_LT((matched.modes[m] - nearly.modes[m]).cwiseAbs().maxCoeff(), 1e-3);
}

// Whatever is legal gives finite numbers that conserve energy, at the edges of the input space too.
TEST(Reflection, IsFiniteAndConservesEnergyEverywhere) {
    std::mt19937 random(5);
    const auto pick = [&](const std::vector<double>& from) { return from[random() % from.size()]; };
    const double infinite = std::numeric_limits<double>::infinity();
    for (int trial = 0; trial < 60; ++trial) {
        Problem problem{pick({1.0, 1.0, 1.33}), {}, BlackBase{}};
        const int layers = 1 + static_cast<int>(random() % 3);
        for (int k = 0; k < layers; ++k) {
            const double tau = pick(k + 1 == layers ? std::vector{0.0, 1e-300, 1e-9, 0.3, 40.0, 1e6, infinite}
                                                    : std::vector{0.0, 1e-9, 0.3, 40.0});
            problem.layers.push_back({tau, pick({0.0, 0.5, 0.999, 1 - 1e-10, 1 - 1e-15, 1.0}),
                                      physical_expansion(trial + k, 6), pick({1.0, 1.0001, 1.5, 2.5})});
        }
        if (trial % 3 == 1) problem.base = LambertianBase{pick({0.0, 0.5, 1.0})};
        if (trial % 3 == 2) problem.base = MetalBase{{pick({0.0, 0.05, 2.0}), pick({0.0, 3.0, 10.0})}};
        if (trial % 3 == 2 && std::get<MetalBase>(problem.base).refractive_index == 0.0) continue;
        const Reflection r = solver_named("doubling").reflection(problem, {.streams = 5});
        for (const Eigen::MatrixXd& mode : r.modes)
            ASSERT_TRUE(mode.allFinite()) << trial << " tau " << problem.layers.back().optical_thickness << " albedo "
                                          << problem.layers.back().single_scattering_albedo;
        const Eigen::VectorXd total = reflectance(problem, r);
        // Five nodes in air leave 1e-8 in the fluxes of the thinnest totally reflected segment.
        EXPECT_LT(total.maxCoeff(), 1.0 + 1e-9) << trial;
        EXPECT_GT(total.minCoeff(), -1e-9) << trial;
    }
}

TEST(Reflection, DoesNotDependOnTheNumberOfThreads) {
    const Problem problem{1.0, {{0.8, 0.99, physical_expansion(4), 1.5}}, MetalBase{{0.96, 6.69}}};
    const auto solve = [&](int threads) {
        set_thread_count(threads);
        Reflection r = solver_named("doubling").reflection(problem, {.streams = 8, .fourier_tolerance = 1e-3});
        set_thread_count(0);
        return r;
    };
    const Reflection one = solve(1), two = solve(2);
    ASSERT_EQ(one.modes.size(), two.modes.size());
    EXPECT_LT(one.modes.size(), 9u);
    for (std::size_t m = 0; m < one.modes.size(); ++m) EXPECT_EQ(one.modes[m], two.modes[m]);
}

// A peak that the streams cannot carry counts as unscattered, and the diagnostics say so.
TEST(Reflection, PeaksBeyondTheStreamsAreTruncatedAndReported) {
    const auto solve = [](double g, int streams) {
        optics::ExpansionCoefficients x = physical_expansion(1);
        for (auto* list : {&x.alpha1, &x.alpha2, &x.alpha3, &x.alpha4, &x.beta1, &x.beta2}) list->assign(70, 0.0);
        for (int l = 0; l < 70; ++l) x.alpha1[l] = (2 * l + 1) * std::pow(g, l);
        return solver_named("doubling")
            .reflection({1.0, {{1.0, 1.0, x, 1.0}}, BlackBase{}}, {.streams = streams, .most_fourier_orders = 1});
    };
    EXPECT_EQ(solve(0.7, 4).diagnostics.notes.size(), 1u);
    EXPECT_TRUE(solve(0.995, 2).diagnostics.converged);
    EXPECT_TRUE(solve(0.7, 36).diagnostics.notes.empty());
}

// A zero-weight direction placed on a node must see what the node sees.
TEST(Field, AgreesWithTheReflectionAtItsNodes) {
    const std::vector<Problem> problems{
        {1.0, {{0.8, 0.99, physical_expansion(4), 1.5}}, MetalBase{{0.96, 6.69}}},
        {1.0,
         {{0.8, 1.0, physical_expansion(4), 1.4},
          {std::numeric_limits<double>::infinity(), 1.0, physical_expansion(5), 1.6}},
         BlackBase{}},
        {1.0, {{0.8, 1.0, physical_expansion(4), 1.0}, {0.5, 0.5, physical_expansion(5), 1.3}}, LambertianBase{0.4}}};
    const SolveOptions options{.streams = 6, .fourier_tolerance = 0.0};
    for (const Problem& problem : problems) {
        const Reflection r = solver_named("doubling").reflection(problem, options);
        for (int i : {0, 3, 5})
            for (int column = 0; column < 4; ++column) {
                FieldRequest request{r.mu[i], optics::Stokes::Unit(column), {0.0}, r.mu, {0.7}};
                const Field field = solver_named("doubling").field(problem, request, options);
                for (std::size_t o = 0; o < r.mu.size(); ++o) {
                    optics::Stokes expected = optics::Stokes::Zero();
                    for (std::size_t m = 0; m < r.modes.size(); ++m) {
                        const double c = (m ? 2 : 1) * std::cos(0.7 * m), s = (m ? 2 : 1) * std::sin(0.7 * m);
                        const optics::Stokes f = r.modes[m].block<4, 1>(4 * o, 4 * i + column);
                        if (column < 2)
                            expected += optics::Stokes(c * f[0], c * f[1], s * f[2], s * f[3]);
                        else
                            expected += optics::Stokes(-s * f[0], -s * f[1], c * f[2], c * f[3]);
                    }
                    EXPECT_LT((field.upward[0][o][0] - pi * r.mu[i] * expected).cwiseAbs().maxCoeff(), 1e-11);
                }
            }
    }
}

TEST(Field, OfScatteringInEveryLayerIsContinuousAcrossACut) {
    const auto x = physical_expansion(3);
    const Problem whole{1.0, {{2.0, 0.9, x, 1.5}}, LambertianBase{0.5}};
    const Problem parts{1.0, {{0.5, 0.9, x, 1.5}, {0.0, 0.3, x, 1.5}, {1.5, 0.9, x, 1.5}}, LambertianBase{0.5}};
    const FieldRequest request{0.7, {1, 0.2, 0.1, -0.3}, {0.0, 0.3, 0.5, 1.0, 2.0}, {0.0, 0.2, 0.7, 1.0}, {0.0, 1.0}};
    const Field a = solver_named("doubling").field(whole, request, {.streams = 8});
    const Field b = solver_named("doubling").field(parts, request, {.streams = 8});
    for (std::size_t d = 0; d < 5; ++d)
        for (std::size_t o = 0; o < 4; ++o)
            for (std::size_t p = 0; p < 2; ++p) {
                EXPECT_LT((a.upward[d][o][p] - b.upward[d][o][p]).norm(), 1e-11) << d << " " << o;
                EXPECT_LT((a.downward[d][o][p] - b.downward[d][o][p]).norm(), 1e-11) << d << " " << o;
            }
}

}  // namespace
}  // namespace patina::rt
