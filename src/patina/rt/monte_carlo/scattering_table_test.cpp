#include "patina/rt/monte_carlo/scattering_table.h"

#include "patina/math/wigner_d.h"

namespace patina::rt::monte_carlo {
namespace {

// Coefficients without symmetry, decaying so that a1 > 0 everywhere.
optics::ExpansionCoefficients generic(int order) {
    optics::ExpansionCoefficients c;
    for (int l = 0; l <= order; ++l) {
        const double decay = std::pow(0.5, l), polar = l < 2 ? 0.0 : decay;
        c.alpha1.push_back(decay);
        c.alpha2.push_back(0.8 * polar);
        c.alpha3.push_back(0.5 * polar);
        c.alpha4.push_back(0.7 * decay);
        c.beta1.push_back(0.2 * polar);
        c.beta2.push_back(-0.1 * polar);
    }
    return c;
}

// Two ways to the same functions: Jacobi polynomials here, the recurrence in l of Mishchenko et al. there.
TEST(ScatteringTable, SumsTheExpansionLikeWignerDFunctionsDo) {
    const auto c = generic(40);
    for (double x : {-1.0, -0.93, -0.2, 0.0, 0.41, 0.999, 1.0}) {
        double a1 = 0, plus = 0, minus = 0, b1 = 0, b2 = 0;
        const auto d00 = math::wigner_d(40, 0, 0, x), d02 = math::wigner_d(40, 0, 2, x),
                   d22 = math::wigner_d(40, 2, 2, x), d2m2 = math::wigner_d(40, 2, -2, x);
        for (std::size_t l = 0; l <= 40; ++l) {
            a1 += c.alpha1[l] * d00[l];
            plus += (c.alpha2[l] + c.alpha3[l]) * d22[l];
            minus += (c.alpha2[l] - c.alpha3[l]) * d2m2[l];
            b1 -= c.beta1[l] * d02[l];
            b2 -= c.beta2[l] * d02[l];
        }
        const ScatteringElements f = sum_expansion(c, x);
        EXPECT_NEAR(f.a1, a1, 1e-13);  // sums of order 1 to rounding
        EXPECT_NEAR(f.a2 + f.a3, plus, 1e-13);
        EXPECT_NEAR(f.a2 - f.a3, minus, 1e-13);
        EXPECT_NEAR(f.b1, b1, 1e-13);
        EXPECT_NEAR(f.b2, b2, 1e-13);
    }
}

TEST(ScatteringTable, InterpolatesTheExpansion) {
    const auto c = generic(30);
    const ScatteringTable table(c);
    for (double x = -1.0; x <= 1.0; x += 0.0137) {
        const ScatteringElements exact = sum_expansion(c, x), f = table.at(x);
        // h^2/8 F'' with h <= 2/3968 and |F''| below 30.
        EXPECT_NEAR(f.a1, exact.a1, 1e-6);
        EXPECT_NEAR(f.a2, exact.a2, 1e-6);
        EXPECT_NEAR(f.b1, exact.b1, 1e-6);
        EXPECT_NEAR(f.b2, exact.b2, 1e-6);
    }
}

// 200 000 angles in 40 bins of equal probability by quantiles of the exact density: chi-square of 39 degrees of freedom
// exceeds 85 with probability 3e-5.
TEST(ScatteringTable, SamplesTheDensity) {
    const auto c = generic(30);
    const ScatteringTable table(c);
    RandomStream random(5, 0);
    std::vector<double> expected(40, 0.0), found(40, 0.0);
    const int fine = 4000, draws = 200'000;
    for (int bin = 0; bin < 40; ++bin)
        for (int i = 0; i < fine / 40; ++i) {
            const double x = -1.0 + (2.0 * (bin * fine / 40 + i) + 1.0) / fine;
            expected[static_cast<std::size_t>(bin)] += sum_expansion(c, x).a1 / fine * draws;
        }
    for (int i = 0; i < draws; ++i) found[static_cast<std::size_t>((table.sample_cosine(random) + 1.0) * 20.0)] += 1.0;
    double chi2 = 0.0;
    for (std::size_t bin = 0; bin < 40; ++bin) chi2 += std::pow(found[bin] - expected[bin], 2) / expected[bin];
    EXPECT_LT(chi2, 85.0);
}

}  // namespace
}  // namespace patina::rt::monte_carlo
