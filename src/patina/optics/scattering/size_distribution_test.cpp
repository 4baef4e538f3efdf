#include "patina/optics/scattering/size_distribution.h"

#include "patina/core/constants.h"
#include "patina/core/error.h"

namespace patina::optics {
namespace {

double moment(const SizeDistribution& d, double power) {
    const RadiusRule rule = radius_rule(d, relevant_range(d, 10.0, 1e-12), 1024);
    double sum = 0.0, number = 0.0;
    for (std::size_t i = 0; i < rule.radii_um.size(); ++i) {
        sum += rule.weights[i] * std::pow(rule.radii_um[i], power);
        number += rule.weights[i];
    }
    return sum / number;
}

// What tails of 1e-13 leave in the third moment.
constexpr double tight = 1e-10;

TEST(SizeDistribution, LogNormalMoments) {
    const double r = 0.125, s = std::log(1.3);
    const SizeDistribution d{LogNormal{r, 1.3}};
    for (double p : {1.0, 2.0, 3.0})
        EXPECT_NEAR(moment(d, p) / (std::pow(r, p) * std::exp(0.5 * p * p * s * s)), 1.0, tight);
    EXPECT_NEAR(mean_volume_um3(d) / (4.0 / 3.0 * pi * r * r * r * std::exp(4.5 * s * s)), 1.0, tight);
    EXPECT_NEAR(effective_radius_um(d) / (r * std::exp(2.5 * s * s)), 1.0, tight);
}

// Hatch & Choate (1929): a log-normal distribution by volume is one by number with the median divided by exp(3 ln^2
// sigma).
TEST(SizeDistribution, WeightingsOfALogNormal) {
    const double s2 = std::pow(std::log(1.5), 2);
    const SizeDistribution volume{LogNormal{0.3, 1.5}, SizeWeighting::volume},
        number{LogNormal{0.3 * std::exp(-3 * s2), 1.5}};
    const SizeDistribution area{LogNormal{0.3 * std::exp(-s2), 1.5}, SizeWeighting::area};
    for (double p : {1.0, 2.0, 3.0}) {
        EXPECT_NEAR(moment(volume, p) / moment(number, p), 1.0, tight) << p;
        EXPECT_NEAR(moment(area, p) / moment(number, p), 1.0, tight) << p;
    }
}

// Hansen & Travis (1974), eqs 2.53-2.57: effective radius and variance are the parameters.
TEST(SizeDistribution, GammaHasItsEffectiveRadiusAndVariance) {
    for (double v : {0.01, 0.1, 0.3, 0.45}) {
        const SizeDistribution d{Gamma{0.7, v}};
        EXPECT_NEAR(effective_radius_um(d), 0.7, 1e-9) << v;
        EXPECT_NEAR(moment(d, 4) * moment(d, 2) / std::pow(moment(d, 3), 2) - 1.0, v, 1e-6) << v;
        const double mean = 0.7 * (1 - 2 * v);
        // For v near 1/2 the mean falls where the many small particles are cut: 1e-8.
        EXPECT_NEAR(moment(d, 1) / mean, 1.0, 1e-8) << v;
    }
}

// <r^p> = r_c^p (gamma/alpha)^(p/gamma) Gamma((alpha+1+p)/gamma)/Gamma((alpha+1)/gamma).
TEST(SizeDistribution, ModifiedGammaMoments) {
    const double alpha = 2, gamma = 0.5, r = 0.07;
    const SizeDistribution d{ModifiedGamma{alpha, gamma, r}};
    for (double p : {1.0, 2.0, 3.0}) {
        const double expected = std::pow(r, p) * std::pow(gamma / alpha, p / gamma) *
                                std::tgamma((alpha + 1 + p) / gamma) / std::tgamma((alpha + 1) / gamma);
        EXPECT_NEAR(moment(d, p) / expected, 1.0, 1e-9) << p;
    }
}

TEST(SizeDistribution, PowerLawMoments) {
    const double a = 0.05, b = 2.0, e = 3.5;
    const SizeDistribution d{PowerLaw{e, a, b}};
    const auto integral = [&](double p) { return (std::pow(b, p + 1 - e) - std::pow(a, p + 1 - e)) / (p + 1 - e); };
    for (double p : {1.0, 2.0, 3.0}) EXPECT_NEAR(moment(d, p) / (integral(p) / integral(0)), 1.0, 1e-12) << p;
}

// By volume: the mean of r is scale Gamma(1 + 1/spread); number^-1 moments follow: <r^4>/<r^3>.
TEST(SizeDistribution, RosinRammlerByVolume) {
    for (double spread : {0.8, 1.5, 4.0}) {
        const SizeDistribution d{RosinRammler{0.5, spread}, SizeWeighting::volume};
        // Where the number diverges only ratios of high moments exist.
        EXPECT_NEAR(moment(d, 4) / moment(d, 3) / (0.5 * std::tgamma(1 + 1 / spread)), 1.0, 1e-7) << spread;
    }
}

TEST(SizeDistribution, HistogramMoments) {
    const SizeDistribution d{Histogram{{0.1, 0.2, 0.3, 0.6}, {2.0, 0.0, 1.0}}};
    const auto mean = [](double p, double a, double b) {
        return (std::pow(b, p) - std::pow(a, p)) / (p * std::log(b / a));
    };
    for (double p : {1.0, 2.0, 3.0})
        EXPECT_NEAR(moment(d, p) / ((2 * mean(p, 0.1, 0.2) + mean(p, 0.3, 0.6)) / 3), 1.0, 1e-12) << p;
    const SizeDistribution v{Histogram{{0.1, 0.2, 0.3, 0.6}, {2.0, 0.0, 1.0}}, SizeWeighting::volume};
    EXPECT_NEAR(1 / moment(v, 3) / ((2 * mean(-3, 0.1, 0.2) + mean(-3, 0.3, 0.6)) / 3), 1.0, 1e-12);
}

TEST(SizeDistribution, RulesNest) {
    for (const SizeDistribution& d : {SizeDistribution{LogNormal{0.1, 1.4}}, SizeDistribution{PowerLaw{3, 0.1, 1}},
                                      SizeDistribution{Histogram{{0.1, 0.2, 0.4}, {1, 2}}}}) {
        const RadiusRange range = relevant_range(d, 10.0, 1e-6);
        const auto number = [](const RadiusRule& rule) {
            return std::accumulate(rule.weights.begin(), rule.weights.end(), 0.0);
        };
        const RadiusRule coarse = radius_rule(d, range, 32), fine = radius_rule(d, range, 64),
                         added = radius_rule(d, range, 64, true);
        EXPECT_EQ(fine.radii_um.size(), coarse.radii_um.size() + added.radii_um.size());
        EXPECT_NEAR(number(fine), 0.5 * number(coarse) + number(added), 1e-14 * number(fine));
    }
}

TEST(SizeDistribution, TheRangeHoldsTheTails) {
    // Rayleigh regime: scattering ~ r^6, whose median is exp(6 ln^2 sigma) above that of number.
    const double s = std::log(1.5);
    const RadiusRange range = relevant_range({LogNormal{0.001, 1.5}}, 1.0, 1e-5);
    EXPECT_NEAR(std::log(range.min_um / 0.001) / s, -std::sqrt(2 * std::log(1e6)), 0.01);
    EXPECT_NEAR(std::log(range.max_um / 0.001) / s, 6 * s + std::sqrt(2 * std::log(1e6)), 0.01);
}

TEST(SizeDistribution, RefusesWhatIsNotPhysical) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const SizeDistribution& d :
         {SizeDistribution{Monodisperse{0}}, SizeDistribution{Monodisperse{nan}}, SizeDistribution{LogNormal{-1, 1.3}},
          SizeDistribution{LogNormal{0.1, 1.0}}, SizeDistribution{LogNormal{0.1, 99}},
          SizeDistribution{LogNormal{0.1, nan}}, SizeDistribution{Gamma{1, 0.5}}, SizeDistribution{Gamma{1, 0}},
          SizeDistribution{ModifiedGamma{-1, 1, 1}}, SizeDistribution{ModifiedGamma{1, 0, 1}},
          SizeDistribution{PowerLaw{3, 1, 0.1}}, SizeDistribution{PowerLaw{nan, 0.1, 1}},
          SizeDistribution{RosinRammler{1, 0}}, SizeDistribution{Histogram{{1, 2}, {1, 2}}},
          SizeDistribution{Histogram{{2, 1}, {1}}}, SizeDistribution{Histogram{{1, 2}, {-1}}},
          SizeDistribution{Histogram{{1, 2}, {0}}}, SizeDistribution{Histogram{}}}) {
        try {
            validate(d, {"paint.toml", 7, 3});
            ADD_FAILURE() << "accepted a distribution of kind " << d.shape.index();
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input);
            EXPECT_THAT(error.what(), testing::StartsWith("paint.toml:7:3"));
        }
    }
}

}  // namespace
}  // namespace patina::optics
