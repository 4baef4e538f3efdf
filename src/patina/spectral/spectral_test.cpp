#include "patina/core/error.h"
#include "patina/spectral/cie_tables.h"
#include "patina/spectral/colorimetry.h"
#include "patina/spectral/illuminants.h"
#include "patina/spectral/observer.h"
#include "patina/spectral/spectrum.h"

namespace patina::spectral {
namespace {

constexpr Observer two = Observer::cie1931_2deg, ten = Observer::cie1964_10deg;

TEST(Spectrum, IsLinearBetweenItsSamplesAndHeldOrZeroOutside) {
    const Spectrum held({400, 500, 700}, {1, 3, 0}, Outside::hold), dark({400, 500, 700}, {1, 3, 0}, Outside::zero);
    EXPECT_DOUBLE_EQ(held(450), 2);
    EXPECT_DOUBLE_EQ(held(600), 1.5);
    EXPECT_DOUBLE_EQ(held(399), 1);
    EXPECT_DOUBLE_EQ(dark(399), 0);
    EXPECT_DOUBLE_EQ(dark(400), 1);  // the ends belong to the spectrum
    EXPECT_DOUBLE_EQ(dark(700), 0);
    EXPECT_DOUBLE_EQ(Spectrum(0.3)(1234), 0.3);
    EXPECT_DOUBLE_EQ(held.scaled(2)(450), 4);
}

// The three colour matching functions of an observer have equal areas by construction, which a wrong digit would break.
TEST(Observer, ColourMatchingFunctionsHaveThePublishedAreas) {
    // 2 degrees, 380 to 780 nm: the sums of the table are 21.371524, 21.371327, 21.371540 when its values are rounded
    // to six decimals (CIE 15:2004, table T.4); the further digits here change them by up to 2e-6.
    const auto sum = [](const cie::ObserverTable& table, int first, int last) {
        return std::accumulate(table.begin() + first, table.begin() + last + 1, 0.0);
    };
    EXPECT_NEAR(sum(cie::x_2deg, 4, 84), 21.371524, 2e-6);
    EXPECT_NEAR(sum(cie::y_2deg, 4, 84), 21.371327, 2e-6);
    EXPECT_NEAR(sum(cie::z_2deg, 4, 84), 21.371540, 2e-6);
    // 10 degrees: the areas of the 1 nm table are 116.648520, 116.661877, 116.673981 nm (ISO/CIE 11664-1:2019); every
    // fifth value of so smooth a function gives them to 2e-5.
    EXPECT_NEAR(5 * sum(cie::x_10deg, 0, 94), 116.648520, 2.5e-3);
    EXPECT_NEAR(5 * sum(cie::y_10deg, 0, 94), 116.661877, 2.5e-3);
    EXPECT_NEAR(5 * sum(cie::z_10deg, 0, 94), 116.673981, 2.5e-3);
    EXPECT_NEAR(luminance_integral_nm(two), 106.857, 1e-3);
}

TEST(Observer, PhotopicEfficiencyPeaksAt555nm) {
    EXPECT_DOUBLE_EQ(photopic_efficiency(555), 1.0);
    EXPECT_LT(photopic_efficiency(550), 1.0);
    EXPECT_DOUBLE_EQ(photopic_efficiency(350), 0.0);
    EXPECT_DOUBLE_EQ(photopic_efficiency(831), 0.0);
}

// Light of a narrow line falls between the values every 5 nm: there the CIE's table every 1 nm (ISO/CIE 11664-1:2019,
// seven digits) decides, which was itself interpolated. Smooth curves of different kinds through the same values differ
// by 5/1024 of their sixth differences, which reach 0.11 (zbar at 465 nm): 5.5e-4. Straight lines are wrong by up to
// 1.4e-2 (zbar), and by 1.3e-3 in ybar.
TEST(Observer, FollowsTheTableOfOneNanometre) {
    struct Row {
        double wavelength_nm, x, y, z;
    };
    for (const Row& row : {Row{432, 0.3048965, 0.01358272, 1.4948035}, Row{443, 0.350013, 0.02695857, 1.7762637},
                           Row{452, 0.3300411, 0.041768, 1.764039}, Row{468, 0.2184072, 0.0836668, 1.3898799},
                           Row{488, 0.04115088, 0.1912735, 0.5203376}, Row{507, 0.00383656, 0.4443096, 0.1901196},
                           Row{508, 0.00517484, 0.4633944, 0.1792254}, Row{532, 0.18914, 0.8849624, 0.03693564},
                           Row{553, 0.480064, 0.999112, 0.0067854}, Row{589, 1.0180064, 0.7691547, 0.001146667},
                           Row{612, 0.9793314, 0.4780304, 0.00028316}, Row{633, 0.5811052, 0.2353344, 3.572e-5}}) {
        const Eigen::Vector3d found = colour_matching(two, row.wavelength_nm);
        constexpr double tolerance = 4e-4;
        EXPECT_NEAR(found[0], row.x, tolerance) << row.wavelength_nm;
        EXPECT_NEAR(found[1], row.y, tolerance) << row.wavelength_nm;
        EXPECT_NEAR(found[2], row.z, tolerance) << row.wavelength_nm;
    }
}

// White points of CIE 15:2004, tables T.3 (five decimals) and T.8 (lamps, four decimals).
TEST(Illuminants, HaveThePublishedChromaticities) {
    struct Case {
        const char* name;
        Observer observer;
        double x, y, rounding;
    };
    for (const Case& c : {Case{"A", two, 0.44758, 0.40745, 6e-6}, Case{"D65", two, 0.31272, 0.32903, 6e-6},
                          Case{"D50", two, 0.34567, 0.35851, 6e-6}, Case{"F2", two, 0.3721, 0.3751, 6e-5},
                          Case{"F11", two, 0.3805, 0.3769, 6e-5}, Case{"E", two, 1.0 / 3, 1.0 / 3, 6e-6},
                          Case{"A", ten, 0.45117, 0.40594, 6e-6}, Case{"D65", ten, 0.31381, 0.33098, 6e-6},
                          Case{"D50", ten, 0.34773, 0.35952, 6e-6}}) {
        const Eigen::Vector2d xy = chromaticity(white_point(illuminant(c.name), c.observer));
        EXPECT_NEAR(xy[0], c.x, c.rounding) << c.name;
        EXPECT_NEAR(xy[1], c.y, c.rounding) << c.name;
    }
}

// CIE 15:2004, table T.1: D65 every 10 nm, to six digits at most, and rows of A and D50.
TEST(Illuminants, ReproduceThePublishedTables) {
    const Spectrum d65 = illuminant_d65(), d50 = illuminant_d50(), a = illuminant_a();
    const double published_d65[] = {0.0341,  3.2945,  20.236,  37.0535, 39.9488, 44.9117, 46.6383, 52.0891, 49.9755,
                                    54.6482, 82.7549, 91.486,  93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861,
                                    115.923, 108.811, 109.354, 107.802, 104.790, 107.689, 104.405, 104.046, 100.0,
                                    96.3342, 95.788,  88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268,
                                    80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.349,  61.604,  69.8856, 75.087,
                                    63.5927, 46.4182, 66.8054, 63.3828, 64.304,  59.4519, 51.959,  57.4406, 60.3125};
    for (int i = 0; i < 54; ++i) EXPECT_NEAR(d65(300 + 10 * i), published_d65[i], 6e-4) << 300 + 10 * i;
    EXPECT_NEAR(d65(435), 95.7736, 6e-4);  // between the components' own wavelengths
    for (auto [wavelength_nm, value] :
         {std::pair{380., 24.488}, {450., 87.247}, {500., 95.722}, {560., 100.0}, {700., 91.604}, {780., 78.274}})
        EXPECT_NEAR(d50(wavelength_nm), value, 6e-3)
            << wavelength_nm;  // published to 0.001 from weights given to 0.001
    for (auto [wavelength_nm, value] :
         {std::pair{300., 0.930483}, {380., 9.79510}, {500., 59.8611}, {560., 100.0}, {700., 198.261}, {780., 241.675}})
        EXPECT_NEAR(a(wavelength_nm), value, 1e-5 * value) << wavelength_nm;
}

TEST(Illuminants, DaylightChromaticityLiesOnTheDaylightLocus) {
    for (double t : {4000.0, 5000.0, 7000.0, 10000.0, 25000.0}) {
        const Eigen::Vector2d xy = chromaticity(white_point(daylight(t)));
        // The weights M1, M2 are the CIE's inversion of the locus, with coefficients of four decimals.
        EXPECT_NEAR(xy[1], -3 * xy[0] * xy[0] + 2.87 * xy[0] - 0.275, 2e-4) << t;
    }
    EXPECT_THROW(daylight(3999), Error);
    EXPECT_THROW(daylight(std::nan("")), Error);
    EXPECT_THROW(illuminant("D66"), Error);
}

// Stefan-Boltzmann: the integral over wavelength is sigma T^4/pi (CODATA 5.670374419e-8 W m^-2 K^-4); Wien: the maximum
// is at 2.897771955e6 nm K/T.
TEST(Blackbody, ObeysStefanBoltzmannAndWien) {
    const double t = 5000.0;
    double sum = 0.0;
    // In log wavelength the integrand is analytic and decays at both ends: the trapezoidal rule converges
    // geometrically; what lies above 1e7 nm is below 1e-9 of the whole.
    const double step = 0.01;
    for (double u = std::log(30.0); u < std::log(1e7); u += step)
        sum += blackbody_radiance(std::exp(u), t) * std::exp(u) * step;
    EXPECT_NEAR(sum / (5.670374419e-8 * std::pow(t, 4) / std::numbers::pi), 1.0, 1e-8);
    const double peak = 2.897771955e6 / t;
    EXPECT_GT(blackbody_radiance(peak, t), blackbody_radiance(peak * 1.001, t));
    EXPECT_GT(blackbody_radiance(peak, t), blackbody_radiance(peak / 1.001, t));
    EXPECT_EQ(blackbody_radiance(1.0, 300.0), 0.0);  // overflow of the exponential is darkness, not NaN
    EXPECT_EQ(blackbody_radiance(500.0, 0.0), 0.0);
}

}  // namespace
}  // namespace patina::spectral
