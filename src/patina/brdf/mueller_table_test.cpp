#include "patina/brdf/mueller_table.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "patina/brdf/interpolation.h"
#include "patina/brdf/tabulate.h"
#include "patina/core/constants.h"
#include "patina/math/quadrature.h"
#include "patina/math/wigner_d.h"
#include "patina/optics/fresnel.h"

namespace patina::brdf {
namespace {

using optics::Mueller;

MuellerTable rayleigh_table(int nodes = 8) {
    return tabulate([](double, double mu_o, double mu_i,
                       double phi) -> Mueller { return rayleigh_phase_matrix(mu_o, mu_i, phi) / (4 * pi); },
                    {.wavelengths_nm = {450, 650}, .nodes = nodes, .orders = 3});
}

TEST(BarycentricInterpolation, ReproducesPolynomialsOfTheNodesDegree) {
    const math::Quadrature rule = math::gauss_legendre(48, 0, 1);
    const BarycentricInterpolation interpolation(rule.nodes);
    for (double x : {0.0, 1e-9, 0.3, rule.nodes[5], 1.0}) {
        const Eigen::VectorXd weights = interpolation.weights(x);
        double value = 0;
        for (int k = 0; k < 48; ++k) value += weights[k] * std::pow(rule.nodes[k], 20);
        // Rounding times the Lebesgue constant of 48 Gauss nodes at the ends, of the order sqrt(48).
        EXPECT_NEAR(value, std::pow(x, 20), 1e-14) << x;
    }
}

// Electric fields in explicit frames against the solver's expansion in Wigner d functions: this pins the sense of U and
// of the azimuth. With polar angles from the outward normal the solver's kernel is Z^m(-mu_o, mu_i): its polar axis is
// the inward normal. Rayleigh: alpha2_2 = 3, beta1_2 = sqrt(6)/2, alpha1_2 = 1/2, alpha4_1 = 3/2 (Mishchenko et al.
// 2002).
Mueller expansion_mode(int m, double u, double v) {
    const auto d_matrix = [m](int l, double x) {
        const double p = math::wigner_d(l, m, 0, x)[l], plus = math::wigner_d(l, m, 2, x)[l];
        const double minus = math::wigner_d(l, m, -2, x)[l], r = -(minus + plus) / 2, t = -(minus - plus) / 2;
        Mueller result;
        result << p, 0, 0, 0, 0, r, t, 0, 0, t, r, 0, 0, 0, 0, p;
        return result;
    };
    Mueller s0 = Mueller::Zero(), s1 = Mueller::Zero(), s2 = Mueller::Zero();
    s0(0, 0) = 1;
    s1(3, 3) = 1.5;
    s2(0, 0) = 0.5;
    s2(1, 1) = 3;
    s2(0, 1) = s2(1, 0) = std::sqrt(6.0) / 2;
    Mueller sum = Mueller::Zero();
    const Mueller coefficients[] = {s0, s1, s2};
    for (int l = m; l <= 2; ++l) sum += d_matrix(l, u) * coefficients[l] * d_matrix(l, v).transpose();
    return sum;
}

TEST(MuellerTable, ModesOfRayleighScatteringAreTheSolversExpansion) {
    const MuellerTable table = rayleigh_table();
    for (int m = 0; m <= 2; ++m)
        for (int o : {0, 3, 7})
            for (int i : {1, 6}) {
                const Mueller expected = expansion_mode(m, -table.mu[o], table.mu[i]) / (4 * pi);
                const Mueller found = table.body[0].modes[m].block<4, 4>(4 * o, 4 * i);
                EXPECT_LT((found - expected).norm(), 1e-14) << m << "\n" << found << "\n\n" << expected;
            }
}

// Each mode of Rayleigh scattering is a polynomial of degree 2 in mu, times sqrt(1 - mu^2) for m = 1: exact with 8
// nodes.
TEST(MuellerTable, EvaluatesRayleighScatteringExactlyOffTheNodes) {
    const MuellerTable table = rayleigh_table();
    for (double mu_o : {0.0, 0.01, 0.4, table.mu[3], 0.999, 1.0})
        for (double mu_i : {1e-3, 0.7, table.mu[0], 1.0})
            for (double phi : {0.0, 0.6, 2.5, -1.0}) {
                const Mueller expected = rayleigh_phase_matrix(mu_o, mu_i, phi) / (4 * pi);
                EXPECT_LT((table.evaluate(500, mu_o, mu_i, phi) - expected).norm(), 1e-13);
            }
}

TEST(MuellerTable, GridAgreesWithSingleEvaluations) {
    MuellerTable table = tabulate(single_rayleigh_body(2.0), {.wavelengths_nm = {400, 700}, .nodes = 10, .orders = 3});
    table.body[1].modes.pop_back();  // wavelengths may carry different numbers of modes
    const std::vector<double> mu_o = {0.05, 0.5, 1.0}, mu_i = {0.2, 0.9}, phi = {0.0, 1.0, 2.0, 3.0};
    const MuellerGrid grid = table.evaluate_grid(480, mu_o, mu_i, phi);
    for (int o = 0; o < 3; ++o)
        for (int i = 0; i < 2; ++i)
            for (int p = 0; p < 4; ++p)
                EXPECT_LT((grid.at(o, i, p) - table.evaluate(480, mu_o[o], mu_i[i], phi[p])).norm(), 1e-14);
}

TEST(MuellerTable, IsLinearInWavelengthAndClampedAtTheEnds) {
    MuellerTable table = tabulate([](double nm, double, double, double) -> Mueller { return nm * Mueller::Identity(); },
                                  {.wavelengths_nm = {400, 500, 700}, .nodes = 4, .orders = 1});
    for (auto [asked, effective] : {std::pair{400., 400.}, {450., 450.}, {640., 640.}, {300., 400.}, {900., 700.}})
        EXPECT_NEAR(table.evaluate(asked, 0.3, 0.4, 1.0)(0, 0), effective, 1e-9);
}

TEST(MuellerTable, AlbedoOfALambertianSurfaceIsItsReflectance) {
    const MuellerTable table = tabulate(lambertian_body(0.7), {.nodes = 4, .orders = 1});
    for (double mu_i : {0.0, 0.3, 1.0}) EXPECT_NEAR(table.body_albedo(550, mu_i), 0.7, 1e-13);
    EXPECT_NEAR(table.body_albedo(550, 0.5, {1, 0.5, -0.5, 0.7}), 0.7, 1e-13);
}

// The flux reflected by a table with polarizance and diattenuation, against a brute-force sum over directions.
TEST(MuellerTable, AlbedoIsTheCosineWeightedIntegralOverTheHemisphere) {
    const MuellerTable table = rayleigh_table();
    const optics::Stokes incident(1, 0.6, -0.3, 0.1);
    double flux = 0;
    const math::Quadrature rule = math::gauss_legendre(12, 0, 1);
    for (int k = 0; k < rule.size(); ++k)
        for (int p = 0; p < 9; ++p)
            flux += 2 * pi / 9 * rule.weights[k] * rule.nodes[k] *
                    table.evaluate(450, rule.nodes[k], 0.35, 2 * pi * p / 9).row(0).dot(incident);
    EXPECT_NEAR(table.body_albedo(450, 0.35, incident), flux, 1e-13);
}

// Fresnel reflection stored at whole degrees, asked for between them. Tolerance: the end interval of a cubic errs by
// 0.04 h^4 f with h = 1 deg and, at grazing where R ~ exp(-8 cos theta), f = 8^4.
TEST(MuellerTable, SpecularAddsBothPartsAndIsSmoothInTheAngle) {
    MuellerTable table = tabulate(lambertian_body(0.5), {.wavelengths_nm = {400, 600}, .nodes = 2, .orders = 1});
    for (int w = 0; w < 2; ++w)
        for (int angle = 0; angle <= 90; ++angle) {
            table.specular_surface[w][angle] = optics::fresnel_reflection(std::cos(radians(angle)), 1.0, 1.5 + 0.1 * w);
            table.specular_coherent[w][angle] = Mueller::Constant(1000);
        }
    for (double theta_deg : {0.0, 0.3, 45.5, 60.0, 88.5, 89.7}) {
        const double mu = std::cos(radians(theta_deg));
        const Mueller mean = (optics::fresnel_reflection(mu, 1.0, 1.5) + optics::fresnel_reflection(mu, 1.0, 1.6)) / 2;
        EXPECT_LT((table.specular(500, mu) - Mueller::Constant(1000) - mean).norm(), 2e-5) << theta_deg;
    }
}

TEST(MuellerTable, ValidateNamesWhatIsWrong) {
    using testing::HasSubstr, testing::Property;
    const MuellerTable good = rayleigh_table(3);
    EXPECT_NO_THROW(good.validate());
    const auto expect_error = [&](auto spoil, const char* words) {
        MuellerTable table = good;
        spoil(table);
        EXPECT_THROW(
            {
                try {
                    table.validate({"paint.h5"});
                } catch (const Error& error) {
                    EXPECT_EQ(error.kind(), ErrorKind::input);
                    EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("paint.h5"), HasSubstr(words)));
                    throw;
                }
            },
            Error);
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    expect_error([](MuellerTable& t) { t.wavelengths_nm = {650, 450}; }, "wavelengths_nm does not ascend");
    expect_error([](MuellerTable& t) { t.mu = {0.5}; }, "mu has 1");
    expect_error([&](MuellerTable& t) { t.mu[1] = nan; }, "mu[1]");
    expect_error([](MuellerTable& t) { t.mu_weights.pop_back(); }, "mu_weights");
    expect_error([](MuellerTable& t) { t.body.pop_back(); }, "body");
    expect_error([](MuellerTable& t) { t.body[1].modes.clear(); }, "650 nm");
    expect_error([](MuellerTable& t) { t.body[0].modes[2].resize(4, 4); }, "4 x 4");
    expect_error([&](MuellerTable& t) { t.body[0].modes[2](1, 1) = nan; }, "NaN or infinity at 450 nm");
    expect_error([](MuellerTable& t) { t.specular_surface[1].pop_back(); }, "specular_surface");
    expect_error([&](MuellerTable& t) { t.specular_coherent[0][3](0, 0) = nan; }, "specular_coherent");
    expect_error([](MuellerTable& t) { t.error_estimate = {1e-4}; }, "error_estimate");
}

}  // namespace
}  // namespace patina::brdf
