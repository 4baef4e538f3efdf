#include "patina/spectral/colorimetry.h"

#include "patina/spectral/colour_difference.h"
#include "patina/spectral/illuminants.h"

namespace patina::spectral {
namespace {

using Eigen::Vector3d;

// Mitsuba 3 shows a uniform unit spectrum as linear sRGB (1.205, 0.948, 0.909), to the digits it is quoted with.
TEST(Colorimetry, AUniformSpectrumHasUnitLuminanceAndTheColourMitsubaGivesIt) {
    const Vector3d xyz = xyz_of_radiance(Spectrum(1.0));
    EXPECT_DOUBLE_EQ(xyz[1], 1.0);
    const Vector3d rgb = xyz_to_linear_srgb(xyz);
    EXPECT_NEAR(rgb[0], 1.205, 5e-4);
    EXPECT_NEAR(rgb[1], 0.948, 5e-4);
    EXPECT_NEAR(rgb[2], 0.909, 5e-4);
}

TEST(Colorimetry, AGreyUnderAnyLightIsThatFractionOfItsWhite) {
    for (const char* name : {"A", "D50", "D65", "E", "F2", "F11"}) {
        const Spectrum light = illuminant(name);
        for (Observer observer : {Observer::cie1931_2deg, Observer::cie1964_10deg}) {
            const Vector3d white = white_point(light, observer);
            EXPECT_DOUBLE_EQ(white[1], 1.0);
            EXPECT_TRUE(xyz_of_reflectance(Spectrum(0.25), light, observer).isApprox(0.25 * white, 1e-14));
        }
    }
}

// IEC 61966-2-1 prints the matrix to XYZ with four decimals.
TEST(Srgb, MatrixIsThatOfTheStandard) {
    EXPECT_LT((linear_srgb_to_xyz({1, 0, 0}) - Vector3d(0.4124, 0.2126, 0.0193)).cwiseAbs().maxCoeff(), 5.1e-5);
    EXPECT_LT((linear_srgb_to_xyz({0, 1, 0}) - Vector3d(0.3576, 0.7152, 0.1192)).cwiseAbs().maxCoeff(), 5.1e-5);
    EXPECT_LT((linear_srgb_to_xyz({0, 0, 1}) - Vector3d(0.1805, 0.0722, 0.9505)).cwiseAbs().maxCoeff(), 5.1e-5);
    EXPECT_TRUE(linear_srgb_to_xyz(xyz_to_linear_srgb({0.2, 0.5, 0.7})).isApprox(Vector3d(0.2, 0.5, 0.7), 1e-14));
    // The white of sRGB is D65 to the four decimals the standard keeps of its chromaticity.
    EXPECT_TRUE(xyz_to_linear_srgb(white_point(illuminant_d65())).isApprox(Vector3d::Ones(), 3e-4));
}

TEST(Srgb, TransferFunctionIsInvertibleAndContinuous) {
    for (double v : {-0.5, -0.001, 0.0, 0.002, 0.0031308, 0.18, 0.5, 1.0, 4.0})
        EXPECT_NEAR(srgb_decode(srgb_encode(v)), v, 1e-12);
    // The standard's two pieces meet to 1e-7 only: its constants are rounded.
    EXPECT_NEAR(srgb_encode(0.0031308), srgb_encode(std::nextafter(0.0031308, 1.0)), 1e-7);
    EXPECT_NEAR(srgb_encode(0.18), 0.461356, 1e-6);
    EXPECT_DOUBLE_EQ(srgb_encode(1.0), 1.0);
}

TEST(Lab, WhiteIsHundredAndInverseReturns) {
    const Vector3d white = white_point(illuminant_d65());
    EXPECT_TRUE(xyz_to_lab(white, white).isApprox(Vector3d(100, 0, 0), 1e-14));
    EXPECT_NEAR(xyz_to_lab(0.184187 * white, white)[0], 50.0, 1e-4);  // L* = 50 is Y = 18.4187 %
    for (const Vector3d& lab : {Vector3d(50, 20, -30), Vector3d(3, 1, -2), Vector3d(95, -5, 90), Vector3d(0, 0, 0)})
        EXPECT_LT((xyz_to_lab(lab_to_xyz(lab, white), white) - lab).norm(), 1e-11);
}

// The matrix from D65 to D50 published for ICC profiles (Lindbloom, seven decimals), for whites of five decimals.
TEST(Bradford, CarriesWhiteToWhiteAndMatchesThePublishedMatrix) {
    const Vector3d d65(0.95047, 1.0, 1.08883), d50(0.96422, 1.0, 0.82521);
    const Eigen::Matrix3d m = bradford_adaptation(d65, d50);
    EXPECT_TRUE((m * d65).isApprox(d50, 1e-14));
    Eigen::Matrix3d published;
    published << 1.0478112, 0.0228866, -0.0501270, 0.0295424, 0.9904844, -0.0170491, -0.0092345, 0.0150436, 0.7521316;
    EXPECT_LT((m - published).cwiseAbs().maxCoeff(), 1e-7);
    EXPECT_TRUE(bradford_adaptation(d65, d65).isIdentity(1e-14));
}

// All 34 pairs of Sharma, Wu & Dalal (2005), table 1, which prints the difference to four decimals.
TEST(ColourDifference, ReproducesTheTestPairsOfSharmaWuAndDalal) {
    struct Pair {
        double l1, a1, b1, l2, a2, b2, delta_e;
    };
    const Pair pairs[] = {
        {50, 2.6772, -79.7751, 50, 0, -82.7485, 2.0425},
        {50, 3.1571, -77.2803, 50, 0, -82.7485, 2.8615},
        {50, 2.8361, -74.0200, 50, 0, -82.7485, 3.4412},
        {50, -1.3802, -84.2814, 50, 0, -82.7485, 1.0000},
        {50, -1.1848, -84.8006, 50, 0, -82.7485, 1.0000},
        {50, -0.9009, -85.5211, 50, 0, -82.7485, 1.0000},
        {50, 0, 0, 50, -1, 2, 2.3669},
        {50, -1, 2, 50, 0, 0, 2.3669},
        {50, 2.49, -0.001, 50, -2.49, 0.0009, 7.1792},
        {50, 2.49, -0.001, 50, -2.49, 0.0010, 7.1792},
        {50, 2.49, -0.001, 50, -2.49, 0.0011, 7.2195},
        {50, 2.49, -0.001, 50, -2.49, 0.0012, 7.2195},
        {50, -0.001, 2.49, 50, 0.0009, -2.49, 4.8045},
        {50, -0.001, 2.49, 50, 0.0010, -2.49, 4.8045},
        {50, -0.001, 2.49, 50, 0.0011, -2.49, 4.7461},
        {50, 2.5, 0, 50, 0, -2.5, 4.3065},
        {50, 2.5, 0, 73, 25, -18, 27.1492},
        {50, 2.5, 0, 61, -5, 29, 22.8977},
        {50, 2.5, 0, 56, -27, -3, 31.9030},
        {50, 2.5, 0, 58, 24, 15, 19.4535},
        {50, 2.5, 0, 50, 3.1736, 0.5854, 1.0000},
        {50, 2.5, 0, 50, 3.2972, 0, 1.0000},
        {50, 2.5, 0, 50, 1.8634, 0.5757, 1.0000},
        {50, 2.5, 0, 50, 3.2592, 0.3350, 1.0000},
        {60.2574, -34.0099, 36.2677, 60.4626, -34.1751, 39.4387, 1.2644},
        {63.0109, -31.0961, -5.8663, 62.8187, -29.7946, -4.0864, 1.2630},
        {61.2901, 3.7196, -5.3901, 61.4292, 2.2480, -4.9620, 1.8731},
        {35.0831, -44.1164, 3.7933, 35.0232, -40.0716, 1.5901, 1.8645},
        {22.7233, 20.0904, -46.6940, 23.0331, 14.9730, -42.5619, 2.0373},
        {36.4612, 47.8580, 18.3852, 36.2715, 50.5065, 21.2231, 1.4146},
        {90.8027, -2.0831, 1.4410, 91.1528, -1.6435, 0.0447, 1.4441},
        {90.9257, -0.5406, -0.9208, 88.6381, -0.8985, -0.7239, 1.5381},
        {6.7747, -0.2908, -2.4247, 5.8714, -0.0985, -2.2286, 0.6377},
        {2.0776, 0.0795, -1.1350, 0.9033, -0.0636, -0.5514, 0.9082},
    };
    for (const Pair& p : pairs) {
        const Vector3d lab_1(p.l1, p.a1, p.b1), lab_2(p.l2, p.a2, p.b2);
        EXPECT_NEAR(delta_e_2000(lab_1, lab_2), p.delta_e, 5.1e-5) << lab_1.transpose() << " | " << lab_2.transpose();
        EXPECT_DOUBLE_EQ(delta_e_2000(lab_1, lab_2), delta_e_2000(lab_2, lab_1));
    }
    EXPECT_EQ(delta_e_2000({50, 10, 10}, {50, 10, 10}), 0.0);
    EXPECT_DOUBLE_EQ(delta_e_76({50, 3, 0}, {50, 0, 4}), 5.0);
}

}  // namespace
}  // namespace patina::spectral
