#include <limits>

#include <gtest/gtest.h>

#include "patina/rt/kernel.h"
#include "patina/rt/nodes.h"
#include "patina/rt/solver.h"
#include "patina/rt/solvers/signed_cholesky.h"
#include "patina/rt/solvers/tanh_doubling.h"
#include "patina/rt/test_problems.h"

namespace patina::rt {
namespace {

using testing_problems::physical_expansion;

constexpr double infinite = std::numeric_limits<double>::infinity();

TransferSystem<long double> widened(const TransferSystem<double>& s) {
    return {s.h.cast<long double>(),
            s.g.cast<long double>(),
            s.signature.cast<long double>(),
            s.quadrature,
            s.views,
            s.isotropic.cast<long double>(),
            s.flux.cast<long double>(),
            s.smallest_mu};
}

// The same equations in 64-bit mantissas show what rounding does to the double ones.
TEST(TanhDoubling, AgreesWithExtendedPrecisionAtAlbedo1) {
    const Problem problem{1.0, {{1.0, 1.0, physical_expansion(1), 1.5}}, BlackBase{}};
    const Medium medium = medium_of(quadrature_rays(problem, 6), 1.5);
    const LayerKernel kernel(problem.layers[0], medium);
    for (const auto& [m, components] :
         {std::pair{0, Components{0, 2}}, {0, Components{2, 2}}, {1, Components{0, 4}}, {5, Components{0, 4}}}) {
        const TransferSystem<double> system = kernel.system(m, components);
        const auto wide = widened(system);
        for (double tau : {1e-6, 0.01, 1.0, 30.0, 1000.0, infinite}) {
            const auto a = tanh_doubling<double>(system, {tau, true});
            const auto b = tanh_doubling<long double>(wide, {tau, true});
            // 1e-13 is the distance from double's rounding after some 30 steps; 1e-11 is what users are promised.
            EXPECT_LT((a.reflection.cast<long double>() - b.reflection).cwiseAbs().maxCoeff(), 1e-12L)
                << m << " " << tau;
            if (tau < infinite) {
                EXPECT_LT((a.transmission.cast<long double>() - b.transmission).cwiseAbs().maxCoeff(), 1e-12L)
                    << m << " " << tau;
            }
        }
    }
}

// The start (continued fraction of a layer within reach) against one a thousand times thinner, both in long double:
// what the choice of the number of doublings costs.
TEST(TanhDoubling, StartsAccuratelyEnough) {
    const Problem problem{1.0, {{1.0, 0.95, physical_expansion(2), 1.0}}, BlackBase{}};
    const Medium medium = medium_of(quadrature_rays(problem, 8), 1.0);
    const auto system = widened(LayerKernel(problem.layers[0], medium).system(1, {0, 4}));
    TransferSystem<long double> careful = system;
    careful.smallest_mu = system.smallest_mu / 1000;
    for (double tau : {0.001, 0.03, 0.3, 1.0, 10.0}) {
        const auto a = tanh_doubling<long double>(system, {tau, true}),
                   b = tanh_doubling<long double>(careful, {tau, true});
        EXPECT_LT((a.reflection - b.reflection).cwiseAbs().maxCoeff(), 1e-15L) << tau;
        EXPECT_LT((a.transmission - b.transmission).cwiseAbs().maxCoeff(), 1e-15L) << tau;
    }
}

// A thick enough layer is semi-infinite: e^(-k tau) with k of the order of sqrt(3 (1 - albedo)(1 - g)) = 0.3.
TEST(TanhDoubling, ThickLayerTendsToTheSemiInfiniteOne) {
    const Problem problem{1.0, {{1.0, 0.95, physical_expansion(2), 1.0}}, BlackBase{}};
    const Medium medium = medium_of(quadrature_rays(problem, 8), 1.0);
    const auto system = LayerKernel(problem.layers[0], medium).system(0, {0, 2});
    const auto thick = tanh_doubling<double>(system, {500.0, true}),
               all = tanh_doubling<double>(system, {infinite, true});
    EXPECT_LT((thick.reflection - all.reflection).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_EQ(all.transmission.size(), 0);
}

// A conservative layer of thickness tau reflects all but 4/(3 (1-g) tau) of diffuse light (van de Hulst 1980, 5.3).
TEST(TanhDoubling, ConservativeTransmissionFallsAsOneOverThickness) {
    const auto expansion = physical_expansion(1);
    const Problem problem{1.0, {{1.0, 1.0, expansion, 1.0}}, BlackBase{}};
    const Medium medium = medium_of(quadrature_rays(problem, 12), 1.0);
    const auto system = LayerKernel(problem.layers[0], medium).system(0, {0, 2});
    const double tau = 1e5;
    const auto layer = tanh_doubling<double>(system, {tau, true});
    const double transmitted = system.flux.dot(layer.transmission * system.flux) / system.flux.squaredNorm();
    EXPECT_NEAR(transmitted * tau * 3 * (1 - expansion.asymmetry()) / 4, 1.0, 1e-4);  // next term: 1.42/((1-g) tau)
}

TEST(SignedCholesky, InvertsAndRefusesAsItShould) {
    constexpr int n = 40;
    Eigen::VectorXd signature = Eigen::VectorXd::Ones(n);
    for (int i = 3; i < n; i += 4) signature[i] = -1;
    std::srand(3);
    const Eigen::MatrixXd a = Eigen::MatrixXd::Random(n, n);
    Eigen::MatrixXd s = 0.3 * (a + a.transpose());
    s += 12.0 * Eigen::MatrixXd(signature.asDiagonal());
    SignedCholesky cholesky;
    ASSERT_TRUE(cholesky.compute(s, signature));
    Eigen::MatrixXd inverse;
    cholesky.inverse(inverse);
    EXPECT_LT((inverse * s - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(), 1e-14);
    const Eigen::MatrixXd b = a * a.transpose();
    Eigen::MatrixXd difference = b;
    cholesky.parallel_difference(difference, 2.0);
    EXPECT_LT((difference - 2 * (b - b * inverse * b)).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_FALSE(cholesky.compute(s, Eigen::VectorXd::Ones(n)));
    EXPECT_FALSE(cholesky.compute(std::nan("") * s, signature));
}

// Two methods without a line in common beyond kernel and boundaries. The eigenvalues k^2 have errors of 1e-16 times the
// norm of G H, some 1e5 here, which a layer multiplies by its thickness squared; eigenvectors add their condition.
TEST(Eigenmodes, AgreeWithDoubling) {
    const std::vector<Problem> problems{
        {1.0, {{1.0, 0.9999, physical_expansion(1), 1.0}}, BlackBase{}},
        {1.0, {{1.0, 1.0, physical_expansion(1), 1.0}}, BlackBase{}},
        {1.0, {{20.0, 1.0, physical_expansion(2), 1.5}}, MetalBase{{0.96, 6.69}}},
        {1.0, {{5.0, 1.0 - 1e-9, physical_expansion(3), 1.5}}, LambertianBase{1.0}},
        {1.0, {{infinite, 1.0, physical_expansion(5), 1.0}}, BlackBase{}},
        {1.0, {{0.7, 0.9, physical_expansion(2), 1.5}}, MetalBase{{0.96, 6.69}}},
        {1.0, {{30.0, 0.99, physical_expansion(3), 1.5}}, LambertianBase{0.5}},
        {1.0,
         {{0.2, 0.9999, physical_expansion(4), 1.4}, {3.0, 0.5, physical_expansion(5), 1.6}},
         MetalBase{{0.2, 3.0}}},
        {1.0, {{infinite, 0.8, physical_expansion(6), 1.33}}, BlackBase{}},
        {1.33, {{1.0, 0.0, physical_expansion(6), 1.5}, {1.0, 0.9, physical_expansion(7), 1.2}}, LambertianBase{1.0}}};
    const SolveOptions options{.streams = 8, .fourier_tolerance = 0.0};
    for (std::size_t k = 0; k < problems.size(); ++k) {
        const Reflection a = solver_named("doubling").reflection(problems[k], options);
        const Reflection b = solver_named("eigenmodes").reflection(problems[k], options);
        ASSERT_EQ(a.modes.size(), b.modes.size());
        for (std::size_t m = 0; m < a.modes.size(); ++m)
            EXPECT_LT((a.modes[m] - b.modes[m]).cwiseAbs().maxCoeff(), 1e-8) << "problem " << k << " order " << m;
    }
}

TEST(Eigenmodes, AgreeWithDoublingInsideTheStack) {
    const Problem problem{
        1.0, {{0.4, 1.0, physical_expansion(4), 1.4}, {2.0, 0.5, physical_expansion(5), 1.6}}, MetalBase{{0.2, 3.0}}};
    const FieldRequest request{
        0.6, {1, 0.3, -0.2, 0.4}, {0.0, 0.2, 0.4, 1.0, 2.4}, {0.0, 0.3, 0.6, 1.0}, {0.0, 0.9, 3.0}};
    const Field a = solver_named("doubling").field(problem, request, {.streams = 6});
    const Field b = solver_named("eigenmodes").field(problem, request, {.streams = 6});
    for (std::size_t d = 0; d < 5; ++d)
        for (std::size_t o = 0; o < 4; ++o)
            for (std::size_t p = 0; p < 3; ++p) {
                EXPECT_LT((a.upward[d][o][p] - b.upward[d][o][p]).norm(), 1e-8) << d << " " << o << " " << p;
                EXPECT_LT((a.downward[d][o][p] - b.downward[d][o][p]).norm(), 1e-8) << d << " " << o << " " << p;
            }
}

TEST(Registry, NamesItsSolversAndSuggests) {
    EXPECT_EQ(solvers().front()->name(), "doubling");
    try {
        solver_named("doublin");
        FAIL();
    } catch (const std::exception& error) {
        EXPECT_NE(std::string(error.what()).find("doubling"), std::string::npos);
    }
}

}  // namespace
}  // namespace patina::rt
