#include "patina/optics/scattering/mie.h"

#include "patina/core/constants.h"

namespace patina::optics {
namespace {

using Complex = std::complex<double>;

struct Row {
    Complex m;                          // 0: perfect conductor
    double x, q_ext, q_sca, g;          // NaN: not tabulated
    double ext_unit, sca_unit, g_unit;  // one unit of the last printed digit
};
constexpr double none = std::numeric_limits<double>::quiet_NaN();

MieSphere sphere_of(const Row& row) {
    return row.m == 0.0 ? MieSphere::perfect_conductor(row.x) : MieSphere(row.x, row.m);
}

class MieTable : public testing::TestWithParam<Row> {};

// A printed value is within one unit of its last digit, rounding or truncation alike.
TEST_P(MieTable, AgreesToTheLastPrintedDigit) {
    const Row& row = GetParam();
    const MieSphere sphere = sphere_of(row);
    EXPECT_NEAR(sphere.scattering_efficiency(), row.q_sca, row.sca_unit);
    if (!std::isnan(row.q_ext)) {
        EXPECT_NEAR(sphere.extinction_efficiency(), row.q_ext, row.ext_unit);
    }
    if (!std::isnan(row.g)) {
        EXPECT_NEAR(sphere.asymmetry(), row.g, row.g_unit);
    }
}

// Wiscombe (1979), NCAR/TN-140+STR, test cases of MIEV0, whose index is n - i k. For the conductor of x = 0.099 its
// asymmetry is that of a power series in x, -0.397357; the exact one is -0.397369 (40-digit arithmetic).
INSTANTIATE_TEST_SUITE_P(Wiscombe, MieTable,
                         testing::Values(Row{0.0, 0.001, none, 3.3333e-12, none, 0, 1e-16, 0},
                                         Row{0.0, 0.099, none, 0.000321, -0.397369, 0, 1e-6, 1e-6},
                                         Row{0.0, 0.101, 0.000348, 0.000348, -0.397262, 1e-6, 1e-6, 1e-6},
                                         Row{0.0, 100, none, 2.008102, 0.500926, 0, 1e-6, 1e-6},
                                         Row{0.0, 10000, none, 2.000289, 0.500070, 0, 1e-6, 1e-6},
                                         Row{0.75, 0.099, none, 0.000007, 0.001448, 0, 1e-6, 1e-6},
                                         Row{0.75, 0.101, none, 0.000008, 0.001507, 0, 1e-6, 1e-6},
                                         Row{0.75, 10, none, 2.232265, 0.896473, 0, 1e-6, 1e-6},
                                         Row{0.75, 1000, none, 1.997908, 0.844944, 0, 1e-6, 1e-6},
                                         Row{{1.33, 1e-5}, 1, none, 0.093923, 0.184517, 0, 1e-6, 1e-6},
                                         Row{{1.33, 1e-5}, 100, none, 2.096594, 0.868959, 0, 1e-6, 1e-6},
                                         Row{{1.33, 1e-5}, 10000, none, 1.723857, 0.907840, 0, 1e-6, 1e-6},
                                         Row{{1.5, 1}, 0.055, 0.101491, 0.000011, 0.000491, 1e-6, 1e-6, 1e-6},
                                         Row{{1.5, 1}, 0.056, 0.1033467, 0.000012, 0.000509, 1e-7, 1e-6, 1e-6},
                                         Row{{1.5, 1}, 1, 2.336321, 0.6634538, 0.192136, 1e-6, 1e-7, 1e-6},
                                         Row{{1.5, 1}, 100, 2.097502, 1.283697, 0.850252, 1e-6, 1e-6, 1e-6},
                                         Row{{1.5, 1}, 10000, 2.004368, 1.236575, 0.846309, 1e-6, 1e-6, 1e-6},
                                         Row{{10, 10}, 1, none, 2.049405, -0.110664, 0, 1e-6, 1e-6},
                                         Row{{10, 10}, 100, none, 1.836785, 0.556215, 0, 1e-6, 1e-6},
                                         Row{{10, 10}, 10000, none, 1.795393, 0.548194, 0, 1e-6, 1e-6},
                                         Row{1.5, 10, none, 2.8820, none, 0, 1e-4, 0},
                                         Row{1.5, 100, none, 2.0944, none, 0, 1e-4, 0},
                                         Row{1.5, 1000, none, 2.0139, none, 0, 1e-4, 0},
                                         Row{1.5, 5000, none, 2.0086, none, 0, 1e-4, 0}));

// Hong Du (2004), Appl. Opt. 43, 1951, Table 1.
INSTANTIATE_TEST_SUITE_P(HongDu, MieTable,
                         testing::Values(Row{0.75, 0.099, 7.417859e-06, 7.417859e-06, none, 1e-12, 1e-12, 0},
                                         Row{0.75, 0.101, 8.033538e-06, 8.033538e-06, none, 1e-12, 1e-12, 0},
                                         Row{0.75, 10, 2.232265, 2.232265, none, 1e-6, 1e-6, 0},
                                         Row{0.75, 1000, 1.997908, 1.997908, none, 1e-6, 1e-6, 0},
                                         Row{{1.33, 1e-5}, 100, 2.101321, 2.096594, none, 1e-6, 1e-6, 0},
                                         Row{{1.33, 1e-5}, 10000, 2.004089, 1.723857, none, 1e-6, 1e-6, 0},
                                         Row{{1.5, 1}, 0.055, 0.10149104, 1.131687e-05, none, 1e-8, 1e-11, 0},
                                         Row{{1.5, 1}, 0.056, 0.1033467, 1.216311e-05, none, 1e-7, 1e-11, 0},
                                         Row{{1.5, 1}, 100, 2.097502, 1.283697, none, 1e-6, 1e-6, 0},
                                         Row{{1.5, 1}, 10000, 2.004368, 1.236574, none, 1e-6, 1e-6, 0},
                                         Row{{10, 10}, 1, 2.532993, 2.049405, none, 1e-6, 1e-6, 0},
                                         Row{{10, 10}, 100, 2.071124, 1.836785, none, 1e-6, 1e-6, 0},
                                         Row{{10, 10}, 10000, 2.005914, 1.795393, none, 1e-6, 1e-6, 0}));

// r = 0.525 um, lambda = 0.6328 um: Bohren & Huffman (1983), appendix A. Digits beyond theirs: eq. 4.88 in 40-digit
// arithmetic (mpmath, 20 to 25 multipoles); tolerances a few units of double precision.
TEST(Mie, BohrenHuffmanSphere) {
    const double x = 2 * pi * 0.525 / 0.6328;
    const MieSphere clear(x, 1.55);
    EXPECT_NEAR(clear.extinction_efficiency(), 3.10543, 1e-5);
    EXPECT_NEAR(clear.scattering_efficiency(), 3.10543, 1e-5);
    EXPECT_NEAR(clear.asymmetry(), 0.63314, 1e-5);
    EXPECT_NEAR(clear.backscattering_efficiency(), 2.92534, 1e-5);

    const MieSphere absorbing(x, {1.55, 0.1});
    EXPECT_NEAR(absorbing.extinction_efficiency(), 2.86165188243203965, 2e-14);
    EXPECT_NEAR(absorbing.scattering_efficiency(), 1.66424911990797298, 2e-14);
    EXPECT_NEAR(absorbing.asymmetry(), 0.801289726385350901, 1e-14);
    EXPECT_NEAR(absorbing.backscattering_efficiency(), 0.205995340811100041, 2e-14);

    const MieSphere dark(2.5, {1.5, 0.5});
    EXPECT_NEAR(dark.extinction_efficiency(), 2.56287349745533072, 1e-14);
    EXPECT_NEAR(dark.scattering_efficiency(), 1.09707181908839266, 1e-14);
    EXPECT_NEAR(dark.asymmetry(), 0.748905978948507248, 1e-14);
    EXPECT_NEAR(dark.backscattering_efficiency(), 0.123586468179618077, 1e-14);
}

// Wiscombe (1979), x = 1, m = 1.5 + i: theta, Re S1, Im S1, Re S2, Im S2. His time factor is exp(+iwt): conjugate.
TEST(Mie, AmplitudesOfWiscombe) {
    constexpr double rows[][5] = {
        {0, 0.584080, 0.190515, 0.584080, 0.190515},     {30, 0.565702, 0.187200, 0.500161, 0.145611},
        {60, 0.517525, 0.178443, 0.287964, 0.041054},    {90, 0.456340, 0.167167, 0.0362285, -0.0618265},
        {120, 0.400212, 0.156643, -0.174875, -0.122959}, {150, 0.362157, 0.149391, -0.305682, -0.143846}};
    const MieSphere sphere(1.0, {1.5, 1.0});
    for (const auto& row : rows) {
        const double cosine = std::cos(radians(row[0]));
        const MieAmplitudes s = sphere.amplitudes(std::span(&cosine, 1));
        EXPECT_NEAR(s.s1[0].real(), row[1], 1e-6) << row[0];
        EXPECT_NEAR(s.s1[0].imag(), -row[2], 1e-6) << row[0];
        EXPECT_NEAR(s.s2[0].real(), row[3], 1e-6) << row[0];
        EXPECT_NEAR(s.s2[0].imag(), -row[4], 1e-6) << row[0];
    }
}

// Bohren & Huffman (1983), appendix A, m = 1.55, x = 5.213: theta, S11/S11(0), -S12/S11, S33/S11, S34/S11 with their
// S34 = Im(S2 S1*).
TEST(Mie, MatrixOfBohrenHuffman) {
    constexpr double rows[][5] = {{0, 0.100000e01, 0.000000e00, 0.100000e01, 0.000000e00},
                                  {9, 0.785390e00, -0.459811e-02, 0.999400e00, 0.343261e-01},
                                  {18, 0.356897e00, -0.458541e-01, 0.986022e00, 0.160184e00},
                                  {27, 0.766119e-01, -0.364744e00, 0.843603e00, 0.394076e00},
                                  {36, 0.355355e-01, -0.534997e00, 0.686967e00, -0.491787e00},
                                  {45, 0.701845e-01, 0.959953e-02, 0.959825e00, -0.280434e00},
                                  {54, 0.574313e-01, 0.477927e-01, 0.985371e00, 0.163584e00},
                                  {63, 0.219660e-01, -0.440604e00, 0.648043e00, 0.621216e00},
                                  {72, 0.125959e-01, -0.831996e00, 0.203255e00, -0.516208e00},
                                  {81, 0.173750e-01, 0.341670e-01, 0.795354e00, -0.605182e00},
                                  {90, 0.124601e-01, 0.230462e00, 0.937497e00, 0.260742e00},
                                  {99, 0.679093e-02, -0.713472e00, -0.717397e-02, 0.700647e00},
                                  {108, 0.954239e-02, -0.756255e00, -0.394748e-01, -0.653085e00},
                                  {117, 0.863419e-02, -0.281215e00, 0.536251e00, -0.795835e00},
                                  {126, 0.227421e-02, -0.239612e00, 0.967602e00, 0.795798e-01},
                                  {135, 0.543998e-02, -0.850804e00, 0.187531e00, -0.490882e00},
                                  {144, 0.160243e-01, -0.706334e00, 0.495254e00, -0.505781e00},
                                  {153, 0.188852e-01, -0.891081e00, 0.453277e00, -0.226817e-01},
                                  {162, 0.195254e-01, -0.783319e00, -0.391613e00, 0.482752e00},
                                  {171, 0.301676e-01, -0.196194e00, -0.962069e00, 0.189556e00},
                                  {180, 0.383189e-01, 0.000000e00, -0.100000e01, 0.000000e00}};
    const MieSphere sphere(2 * pi * 0.525 / 0.6328, 1.55);
    double forward = 0.0;
    for (const auto& row : rows) {
        const double cosine = std::cos(radians(row[0]));
        const MieAmplitudes s = sphere.amplitudes(std::span(&cosine, 1));
        const Complex s1 = s.s1[0], s2 = s.s2[0], cross = s2 * std::conj(s1);
        const double s11 = 0.5 * (std::norm(s1) + std::norm(s2)), s12 = 0.5 * (std::norm(s2) - std::norm(s1));
        if (row[0] == 0) forward = s11;
        // The book's single precision shows in the last of its six digits: two units.
        EXPECT_NEAR(s11 / forward, row[1], 2e-6 * std::pow(10.0, std::floor(std::log10(row[1])) + 1)) << row[0];
        EXPECT_NEAR(-s12 / s11, row[2], 2e-6) << row[0];
        EXPECT_NEAR(cross.real() / s11, row[3], 2e-6) << row[0];
        EXPECT_NEAR(cross.imag() / s11, row[4], 2e-6) << row[0];
    }
}

// Im(S(0)) and Re(S(0)) know the extinction: Q_ext = 4/x^2 Re S(0) (optical theorem), by another sum than Q_ext's own.
TEST(Mie, OpticalTheorem) {
    const double forward = 1.0, backward = -1.0;
    for (Complex m : {Complex(1.33), Complex(2.75 / 1.495), Complex(0.75), Complex(3.19, 0.48), Complex(0.283, 1.66),
                      Complex(10, 10)})
        for (double x : {1e-3, 0.1, 1.0, 7.3, 60.0, 1500.0}) {
            const MieSphere sphere(x, m);
            const MieAmplitudes s = sphere.amplitudes(std::span(&forward, 1));
            const MieAmplitudes r = sphere.amplitudes(std::span(&backward, 1));
            const double theorem = 4.0 / (x * x) * s.s1[0].real();
            // Rounding of sums of x terms.
            EXPECT_NEAR(theorem / sphere.extinction_efficiency(), 1.0, 1e-12) << m << " " << x;
            EXPECT_NEAR(std::abs(s.s1[0] - s.s2[0]) / std::abs(s.s1[0]), 0.0, 1e-12) << m << " " << x;
            EXPECT_NEAR(std::abs(r.s1[0] + r.s2[0]) / std::abs(s.s1[0]), 0.0, 1e-12) << m << " " << x;
            EXPECT_GE(sphere.extinction_efficiency() * (1 + 1e-14), sphere.scattering_efficiency());
            EXPECT_NEAR(sphere.extinction_efficiency(), sphere.scattering_efficiency() + sphere.absorption_efficiency(),
                        1e-12 * sphere.extinction_efficiency());
        }
}

// Bohren & Huffman (1983), eqs 5.7-5.9: Q_sca = 8/3 x^4 |K|^2, Q_abs = 4 x Im K, K = (m^2-1)/(m^2+2); next order ~ x^2
// relatively.
TEST(Mie, SmallSpheresAreRayleighScatterers) {
    for (Complex m : {Complex(1.5), Complex(0.75), Complex(2.5, 1.0), Complex(0.423, 2.48), Complex(1.5, 1e-8)})
        for (double x : {1e-20, 1e-6, 1e-4, 1e-3}) {
            const MieSphere sphere(x, m);
            const Complex k = (m * m - 1.0) / (m * m + 2.0);
            // Coefficient of x^2 up to 10 for the strongest of these indices; rounding below.
            const double tolerance = 30 * x * x + 1e-13;
            EXPECT_NEAR(sphere.scattering_efficiency() / (8.0 / 3.0 * std::pow(x, 4) * std::norm(k)), 1.0, tolerance)
                << m << x;
            // The imaginary part of m = 1.5 + 1e-8 i has 8 digits less than m.
            if (m.imag() > 0.0 && x > 1e-20) {
                const double absorption = 4 * x * k.imag();
                EXPECT_NEAR(sphere.absorption_efficiency() / absorption, 1.0, tolerance + 3e-8) << m << x;
            }
            EXPECT_NEAR(sphere.asymmetry(), 0.0, tolerance) << m << x;
        }
}

TEST(Mie, LargeSpheresShadowTwice) {
    // Q_ext - 2 ~ x^(-2/3) (van de Hulst 1957, section 17.3; Nussenzveig & Wiscombe 1980: 1.99 x^(-2/3) for absorbers).
    const MieSphere sphere(5e4, {1.5, 0.5});
    EXPECT_NEAR(sphere.extinction_efficiency(), 2.0 + 1.9924 * std::pow(5e4, -2.0 / 3.0), 2e-4);
}

TEST(Mie, RelativeIndexOneScattersNothing) {
    EXPECT_NEAR(MieSphere(5.0, 1.0).extinction_efficiency(), 0.0, 1e-25);
}

}  // namespace
}  // namespace patina::optics
