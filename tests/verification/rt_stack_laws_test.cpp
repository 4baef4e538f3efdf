// Laws of whole stacks with known answers: Chandrasekhar's semi-infinite atmosphere, a stack turned upside down, a
// layer in slices.

#include <cmath>

#include <gtest/gtest.h>

#include "patina/core/constants.h"
#include "patina/math/quadrature.h"
#include "patina/optics/stokes.h"
#include "patina/rt/solver.h"
#include "patina/rt/test_problems.h"

namespace patina::rt {
namespace {

using optics::Mueller;
using testing_problems::physical_expansion;

constexpr double infinite = HUGE_VAL;

// Chandrasekhar's H function of isotropic scattering (1960, Radiative Transfer, chapter V, eq. 37 in the form that
// converges also at albedo 1): 1/H = sqrt(1 - w) + w/2 int H(m) m/(m + mu) dm.
class ChandrasekharH {
  public:
    explicit ChandrasekharH(double albedo) : albedo_(albedo), rule_(math::gauss_legendre(64, 0.0, 1.0)), h_(64, 1.0) {
        for (int step = 0; step < 400; ++step) {
            std::vector<double> next(h_.size());
            for (std::size_t i = 0; i < h_.size(); ++i) next[i] = 0.5 * (h_[i] + (*this)(rule_.nodes[i]));
            h_ = next;
        }
    }
    double operator()(double mu) const {
        double sum = 0.0;
        for (int k = 0; k < rule_.size(); ++k) sum += rule_.weights[k] * h_[k] * rule_.nodes[k] / (rule_.nodes[k] + mu);
        return 1.0 / (std::sqrt(1.0 - albedo_) + 0.5 * albedo_ * sum);
    }

  private:
    double albedo_;
    math::Quadrature rule_;
    std::vector<double> h_;
};

// His table XI gives H(0.1), H(0.5) and H(1) of a conservative atmosphere.
TEST(SemiInfinite, ChandrasekharsTableIsMet) {
    const ChandrasekharH h(1.0);
    EXPECT_NEAR(h(0.1), 1.24735, 5e-6);
    EXPECT_NEAR(h(0.5), 2.01278, 5e-6);
    EXPECT_NEAR(h(1.0), 2.90781, 5e-6);
}

// I = w/4 F mu0 / (mu + mu0) H(mu) H(mu0) for flux pi F, and its plane albedo 1 - sqrt(1 - w) H(mu0). The H functions
// here are good to the 64 nodes' 1e-7; 24 streams integrate the radiance, singular at grazing angles, to 1e-6.
TEST(SemiInfinite, IsotropicScatteringFollowsTheHFunctions) {
    const optics::ExpansionCoefficients isotropic{{1.0}, {0.0}, {0.0}, {0.0}, {0.0}, {0.0}};
    for (const auto* solver : {"doubling", "eigenmodes"})
        for (double albedo : {0.3, 0.9, 1.0}) {
            const ChandrasekharH h(albedo);
            const Problem problem{1.0, {{infinite, albedo, isotropic, 1.0}}, BlackBase{}};
            const std::vector<double> views{0.0, 0.1, 0.5, 1.0};
            const Field field =
                solver_named(solver).field(problem, {0.4, {1, 0, 0, 0}, {0.0}, views, {0.0}}, {.streams = 24});
            for (std::size_t o = 0; o < views.size(); ++o)
                EXPECT_NEAR(field.upward[0][o][0][0], 0.25 * albedo * 0.4 / (views[o] + 0.4) * h(views[o]) * h(0.4),
                            2e-6)
                    << solver << " " << albedo << " " << views[o];
            const Reflection r = solver_named(solver).reflection(problem, {.streams = 24, .most_fourier_orders = 1});
            for (std::size_t i = 0; i < r.mu.size(); ++i) {
                double reflected = 0.0;
                for (std::size_t o = 0; o < r.mu.size(); ++o)
                    reflected += 2.0 * pi * r.weights[o] * r.mu[o] * r.modes[0](4 * o, 4 * i);
                // Exactly 1 when nothing absorbs; else to the quadrature of the most grazing rays.
                EXPECT_NEAR(reflected, 1.0 - std::sqrt(1.0 - albedo) * h(r.mu[i]), albedo == 1.0 ? 1e-11 : 3e-5);
            }
        }
}

// The transmission matrices of a stack between two directions at some azimuths, 1/sr: downward diffuse light at its
// bottom.
std::vector<Mueller> transmission(const Problem& problem, double mu_i, double mu_o, const std::vector<double>& phi) {
    double total = 0.0;
    for (const Layer& layer : problem.layers) total += layer.optical_thickness;
    std::vector<Mueller> result(phi.size());
    for (int column = 0; column < 4; ++column) {
        const Field field = solver_named("doubling")
                                .field(problem, {mu_i, optics::Stokes::Unit(column), {total}, {mu_o}, phi},
                                       {.streams = 6, .fourier_tolerance = 0.0});
        for (std::size_t p = 0; p < phi.size(); ++p) result[p].col(column) = field.downward[0][0][p] / (pi * mu_i);
    }
    return result;
}

// Light that takes its way back: t(i, o) / n_o^2 of a stack is Q t(o, i)^T Q / n_i^2 of the stack turned upside down
// (turning about a horizontal axis keeps Stokes vectors and relative azimuths). A clear layer gives the turned stack
// its air; what it absorbs is put back.
TEST(Stack, TurnedUpsideDownTransmitsTheSame) {
    const Layer upper{0.6, 0.95, physical_expansion(2, 4), 1.5}, lower{0.4, 1.0, physical_expansion(4, 4), 1.33};
    const Layer air{0.01, 0.0, physical_expansion(2, 4), 1.0};
    const Problem stack{1.0, {upper, lower}, BlackBase{}}, turned{1.33, {lower, upper, air}, BlackBase{}};
    const std::vector<double> phi{0.0, 0.8, 2.5};
    const auto there = transmission(stack, 0.7, 0.45, phi), back = transmission(turned, 0.45, 0.7, phi);
    for (std::size_t p = 0; p < phi.size(); ++p) {
        const Mueller expected = there[p] / (1.33 * 1.33), found = std::exp(0.01 / 0.7) * back[p];
        EXPECT_LT((expected - optics::reversal() * found.transpose() * optics::reversal()).cwiseAbs().maxCoeff(),
                  1e-11 * expected.cwiseAbs().maxCoeff())
            << phi[p];
    }
    // The azimuth's sense shows.
    EXPECT_GT(std::abs(there[1](2, 0)), 1e-3 * there[1](0, 0));
}

// One layer, two halves, ten slices: what leaves and what is inside.
TEST(Stack, OfSlicesIsTheLayer) {
    const Layer whole{1.4, 0.97, physical_expansion(5), 1.5};
    const auto sliced = [&](int count) {
        Layer slice = whole;
        slice.optical_thickness /= count;
        return Problem{1.0, std::vector<Layer>(static_cast<std::size_t>(count), slice), MetalBase{{0.9, 6.0}}};
    };
    const FieldRequest request{0.6, {1.0, 0.2, 0.3, 0.4}, {0.0, 0.7, 1.4}, {0.3, 0.9}, {0.9}};
    const auto field = [&](int count) {
        return solver_named("doubling").field(sliced(count), request, {.streams = 8});
    };
    const Field expected = field(1);
    for (int count : {2, 10}) {
        const Field found = field(count);
        for (std::size_t d = 0; d < 3; ++d)
            for (std::size_t o = 0; o < 2; ++o) {
                EXPECT_LT((found.upward[d][o][0] - expected.upward[d][o][0]).norm(), 1e-11) << count;
                EXPECT_LT((found.downward[d][o][0] - expected.downward[d][o][0]).norm(), 1e-11) << count;
            }
    }
}

}  // namespace
}  // namespace patina::rt
