#include "patina/optics/fresnel.h"

#include "patina/core/constants.h"

namespace patina::optics {
namespace {

TEST(Fresnel, NothingOfPIsReflectedAtBrewstersAngle) {
    for (auto [n1, n2] : {std::pair{1.0, 1.5}, {1.5, 1.0}, {1.0, 2.75}}) {
        const double cos_b = std::cos(std::atan(n2 / n1));
        EXPECT_NEAR(std::abs(fresnel_amplitudes(cos_b, n1, n2).r_p), 0.0, 1e-15);
        // Light reflected there is fully s-polarized: Q = -I.
        const Stokes reflected = fresnel_reflection(cos_b, n1, n2) * Stokes(1, 0, 0, 0);
        EXPECT_NEAR(reflected[1] / reflected[0], -1.0, 1e-14);
    }
}

TEST(Fresnel, NormalIncidence) {
    for (Complex n2 : {Complex(1.5), Complex(2.75), Complex(0.791, 5.86)}) {
        const FresnelAmplitudes f = fresnel_amplitudes(1.0, 1.0, n2);
        const Complex r = (n2 - 1.0) / (n2 + 1.0);
        EXPECT_NEAR(std::abs(f.r_p - r), 0.0, 1e-15);
        EXPECT_NEAR(std::abs(f.r_s + r), 0.0, 1e-15);
        // A mirror at normal incidence is diag(1, 1, -1, -1) times its reflectance.
        const Mueller expected = std::norm(r) * Mueller(Eigen::Vector4d(1, 1, -1, -1).asDiagonal());
        EXPECT_NEAR((fresnel_reflection(1.0, 1.0, n2) - expected).norm(), 0.0, 1e-15);
    }
}

TEST(Fresnel, GrazingIncidenceReflectsEverything) {
    // R -> 1 - O(cos_i); at exactly 90 degrees the limit.
    for (Complex n2 : {Complex(1.5), Complex(1.0 / 1.5), Complex(0.791, 5.86)}) {
        const Mueller at_limit = fresnel_reflection(0.0, 1.0, n2);
        EXPECT_NEAR(at_limit(0, 0), 1.0, 1e-15);
        EXPECT_NEAR((fresnel_reflection(1e-9, 1.0, n2) - at_limit).norm(), 0.0, 1e-7);
    }
    EXPECT_EQ(fresnel_transmission(0.0, 1.0, 1.5), Mueller::Zero());
}

TEST(Fresnel, ReflectionPlusRefractionConserveEnergy) {
    for (auto [n1, n2] : {std::pair{1.0, 1.5}, {1.5, 1.0}, {1.495, 1.0}, {1.33, 1.52}})
        for (double cos_i : {1e-6, 0.05, 0.3, 0.6, 0.7454, 0.75, 0.9, 1.0}) {
            const Mueller sum = fresnel_reflection(cos_i, n1, n2) + fresnel_transmission(cos_i, n1, n2);
            // For every polarization the first row of the sum is (1, 0, 0, 0); the steep cosine near the critical
            // angle, 0.7454, costs a digit.
            EXPECT_NEAR((sum.row(0) - Eigen::RowVector4d(1, 0, 0, 0)).norm(), 0.0, 1e-13) << n1 << n2 << cos_i;
        }
}

// With c2 = i|c2|, r_p = exp(-2i atan(n1 |c2| / (n2 c1))) and r_s = exp(-2i atan(n2 |c2| / (n1 c1))), hence r_p r_s* =
// exp(-i delta), tan(delta/2) = c1 sqrt(sin^2 - n^2)/sin^2, n = n2/n1 (Born & Wolf 1999, section 1.5.4, eq. 61): the
// sign decides on that of V.
TEST(Fresnel, TotalReflectionRetards) {
    const double n1 = 1.51, n2 = 1.0;
    for (double angle : {45.0, 48.62, 54.62, 60.0, 75.0, 89.0}) {
        const double c = std::cos(radians(angle)), s2 = 1 - c * c;
        const double half = std::atan(c * std::sqrt(s2 - n2 * n2 / (n1 * n1)) / s2);
        const Mueller m = fresnel_reflection(c, n1, n2);
        EXPECT_NEAR(m(0, 0), 1.0, 1e-14);
        EXPECT_NEAR(m(0, 1), 0.0, 1e-14);
        EXPECT_NEAR(m(2, 2), std::cos(2 * half), 1e-14) << angle;
        EXPECT_NEAR(m(2, 3), -std::sin(2 * half), 1e-14) << angle;
        EXPECT_NEAR(m(3, 2), std::sin(2 * half), 1e-14) << angle;
    }
    // Fresnel's rhomb of glass n = 1.51 retards by 45 degrees at 48 deg 37' and 54 deg 37' (op. cit.): minutes are its
    // precision.
    for (double angle : {48 + 37 / 60.0, 54 + 37 / 60.0}) {
        const Mueller m = fresnel_reflection(std::cos(radians(angle)), n1, n2);
        EXPECT_NEAR(degrees(std::atan2(m(3, 2), m(2, 2))), 45.0, 0.02);
    }
}

// Flux into a direction and back: T12 for radiance/n^2 equals T21, and |R| is the same from both sides (Stokes'
// relations).
TEST(Fresnel, IsReciprocal) {
    const double n1 = 1.0, n2 = 1.495;
    for (double cos_1 : {0.05, 0.4, 0.8, 1.0}) {
        const double cos_2 = refracted_cosine(cos_1, n1, n2);
        const Mueller q = reversal();
        const Mueller down = fresnel_transmission(cos_1, n1, n2), up = fresnel_transmission(cos_2, n2, n1);
        // Rounding: the refracted cosine enters twice.
        EXPECT_NEAR((down - q * up.transpose() * q).norm(), 0.0, 1e-13) << cos_1;
        const FresnelAmplitudes out = fresnel_amplitudes(cos_1, n1, n2), back = fresnel_amplitudes(cos_2, n2, n1);
        EXPECT_NEAR(std::abs(out.r_p + back.r_p), 0.0, 1e-13);
        EXPECT_NEAR(std::abs(out.r_s + back.r_s), 0.0, 1e-13);
        EXPECT_NEAR(std::abs(out.t_s * back.t_s - (1.0 - out.r_s * out.r_s)), 0.0, 1e-13);
        EXPECT_NEAR(std::abs(out.t_p * back.t_p - (1.0 - out.r_p * out.r_p)), 0.0, 1e-13);
    }
    const Mueller r = fresnel_reflection(0.4, 1.0, Complex(0.791, 5.86)), q = reversal();
    EXPECT_NEAR((r - q * r.transpose() * q).norm(), 0.0, 1e-15);
}

// A metal: r_s = a/b from the vector form k_z of the refracted wave (Born & Wolf 1999, section 14.2), by real
// arithmetic on u + iv = sqrt(n^2 - sin^2): R_s = ((u - c)^2 + v^2)/((u + c)^2 + v^2), R_p = R_s ((u - s t)^2 +
// v^2)/((u + s t)^2 + v^2), t = tan.
TEST(Fresnel, MetalReflectance) {
    const double n = 0.958, k = 6.69;
    for (double angle : {0.0, 20.0, 45.0, 70.0, 85.0}) {
        const double c = std::cos(radians(angle)), s = std::sin(radians(angle)), st = s * s / c;
        const double real = n * n - k * k - s * s, imag = 2 * n * k, modulus = std::hypot(real, imag);
        const double u = std::sqrt(0.5 * (modulus + real)), v = std::sqrt(0.5 * (modulus - real));
        const double r_s = ((u - c) * (u - c) + v * v) / ((u + c) * (u + c) + v * v);
        const double r_p = r_s * ((u - st) * (u - st) + v * v) / ((u + st) * (u + st) + v * v);
        const FresnelAmplitudes f = fresnel_amplitudes(c, 1.0, Complex(n, k));
        EXPECT_NEAR(std::norm(f.r_s), r_s, 1e-14) << angle;
        EXPECT_NEAR(std::norm(f.r_p), r_p, 1e-14) << angle;
        EXPECT_LT(fresnel_reflection(c, 1.0, Complex(n, k))(0, 0), 1.0);
    }
}

// Of many pairs of indices some round to a cosine above 1, which nothing may be asked of.
TEST(Fresnel, TheNormalStaysTheNormal) {
    for (int i = 0; i < 2000; ++i) {
        const double n1 = 1.0 + 0.00037 * i, n2 = 1.3 + 0.00011 * i;
        const double cosine = refracted_cosine(1.0, n1, n2);
        EXPECT_LE(cosine, 1.0);
        EXPECT_NEAR(cosine, 1.0, 1e-15);
    }
}

TEST(Fresnel, MatchedMediaDoNotReflect) {
    for (double cos_i : {1e-9, 0.3, 1.0}) {
        EXPECT_NEAR(fresnel_reflection(cos_i, 1.495, 1.495).norm(), 0.0, 1e-30);
        EXPECT_NEAR((fresnel_transmission(cos_i, 1.495, 1.495) - Mueller::Identity()).norm(), 0.0, 1e-14);
    }
    EXPECT_EQ(fresnel_reflection(0.0, 1.495, 1.495).norm(), 0.0);
}

}  // namespace
}  // namespace patina::optics
