#include "patina/coating/kubelka_munk.h"

#include <cmath>

namespace patina::coating {
namespace {

const KubelkaMunk white{1e-5, 1.0}, grey{0.05, 0.3}, dark{2.0, 0.1};

TEST(KubelkaMunk, ConservativeFilmReflectsSdOverOnePlusSd) {
    for (const double power : {0.01, 1.0, 50.0})
        EXPECT_NEAR(kubelka_munk_reflectance({0.0, 2.0}, power / 2.0, 0.0), power / (1.0 + power), 1e-15);
    EXPECT_EQ(kubelka_munk_reflectivity({0.0, 2.0}), 1.0);
}

// Two films on top of each other are one of the sum of their thicknesses.
TEST(KubelkaMunk, FilmsAddUp) {
    for (const KubelkaMunk& film : {white, grey, dark})
        for (const double background : {0.0, 0.4, 1.0}) {
            const double lower = kubelka_munk_reflectance(film, 1.7, background);
            EXPECT_NEAR(kubelka_munk_reflectance(film, 0.6, lower), kubelka_munk_reflectance(film, 2.3, background),
                        1e-14);
        }
}

TEST(KubelkaMunk, LimitsOfThickness) {
    for (const KubelkaMunk& film : {white, grey, dark}) {
        EXPECT_EQ(kubelka_munk_reflectance(film, 0.0, 0.37), 0.37);
        // exp(-2 b S d) of the weakest absorber, b S = 4.5e-3, is 1e-39 at 1e4.
        EXPECT_NEAR(kubelka_munk_reflectance(film, 1e4, 0.37), kubelka_munk_reflectivity(film), 1e-12);
    }
}

// K/S = (1 - R)^2 / 2R, the remission function.
TEST(KubelkaMunk, ReflectivityObeysTheRemissionFunction) {
    for (const KubelkaMunk& film : {white, grey, dark}) {
        const double r = kubelka_munk_reflectivity(film);
        EXPECT_NEAR((1 - r) * (1 - r) / (2 * r) / (film.k / film.s), 1.0, 1e-11);
    }
}

TEST(KubelkaMunk, CoefficientsComeBackFromReflectances) {
    for (const KubelkaMunk& film : {white, grey, dark})
        for (const double thickness : {0.1, 1.0}) {
            const auto back = kubelka_munk_from(kubelka_munk_reflectance(film, thickness, 0.0),
                                                kubelka_munk_reflectivity(film), thickness);
            ASSERT_TRUE(back);
            // Rounding of 1 - R, 4e-3 for the white, enters K squared.
            EXPECT_NEAR(back->k / film.k, 1.0, 1e-11);
            EXPECT_NEAR(back->s / film.s, 1.0, 1e-11);
        }
}

TEST(KubelkaMunk, ReflectancesOfNoFilmGiveNoCoefficients) {
    EXPECT_FALSE(kubelka_munk_from(0.5, 0.5, 1.0));
    EXPECT_FALSE(kubelka_munk_from(0.6, 0.5, 1.0));
    EXPECT_FALSE(kubelka_munk_from(0.0, 0.5, 1.0));
    EXPECT_FALSE(kubelka_munk_from(0.5, 1.01, 1.0));
}

// Judd 1942, J. Res. Natl. Bur. Stand. 29, 329: 0.596 inside and 0.092 outside for n = 1.5, three printed digits.
TEST(SurfaceReflection, OfDiffuseLightAtIndexOneAndAHalf) {
    EXPECT_NEAR(diffuse_reflection_from_inside(1.5), 0.596, 5e-4);
    EXPECT_NEAR(diffuse_reflection_from_outside(1.5), 0.092, 5e-4);
    EXPECT_NEAR(surface_reflection(1.5, 8.0).k1, 0.04, 1e-4);  // ((n-1)/(n+1))^2 along the normal, flat around it
}

// The integral in closed form (Walsh 1926; Duntley 1942, J. Opt. Soc. Am. 32, 61).
double walsh(double n) {
    const double n2 = n * n, n4 = n2 * n2;
    return 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
           n2 * (n2 - 1) * (n2 - 1) / std::pow(n2 + 1, 3) * std::log((n - 1) / (n + 1)) -
           2 * n2 * n * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
           8 * n4 * (n4 + 1) / ((n2 + 1) * (n4 - 1) * (n4 - 1)) * std::log(n);
}

TEST(SurfaceReflection, OfDiffuseLightAgreesWithWalsh) {
    // The closed form itself loses digits to cancellation near n = 1.
    for (const double n : {1.33, 1.5, 1.7, 2.4}) EXPECT_NEAR(diffuse_reflection_from_outside(n), walsh(n), 1e-9) << n;
    EXPECT_EQ(diffuse_reflection_from_outside(1.0), 0.0);
}

TEST(Saunderson, IsUndoneAndKeepsEnergy) {
    const SurfaceReflection surface = surface_reflection(1.5, 8.0);
    for (const double inner : {0.0, 0.1, 0.5, 0.99})
        EXPECT_NEAR(saunderson_to_inner(saunderson_from_inner(inner, surface), surface), inner, 1e-15);
    // A film that loses nothing loses nothing behind its surface.
    EXPECT_NEAR(saunderson_from_inner(1.0, surface) + surface.k1, 1.0, 1e-15);
    EXPECT_EQ(saunderson_from_inner(0.3, {0.0, 0.0}), 0.3);
}

}  // namespace
}  // namespace patina::coating
