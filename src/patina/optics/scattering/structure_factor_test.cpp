#include "patina/optics/scattering/structure_factor.h"

#include "patina/core/constants.h"
#include "patina/optics/scattering/particle_ensemble.h"

namespace patina::optics {
namespace {

TEST(PercusYevick, Limits) {
    for (double f : {0.01, 0.1, 0.3, 0.5, 0.64}) {
        EXPECT_NEAR(percus_yevick(f, 0.0), std::pow(1 - f, 4) / std::pow(1 + 2 * f, 2), 1e-15) << f;
        // 1 - S ~ 1/x^2 with a contact value below 30 in front.
        EXPECT_NEAR(percus_yevick(f, 1e5), 1.0, 1e-6) << f;
    }
    for (double x : {0.0, 0.3, 3.0, 30.0}) EXPECT_EQ(percus_yevick(0.0, x), 1.0);
}

TEST(PercusYevick, SeriesMeetsTheClosedForm) {
    // On both sides of the change at x = 2; S' < 1.
    for (double f : {0.05, 0.3, 0.6})
        EXPECT_NEAR(percus_yevick(f, 2.0 - 1e-14), percus_yevick(f, 2.0 + 1e-14), 2e-14) << f;
}

// First order in f: S = 1 - f 24 (sin x - x cos x)/x^3, the excluded volume of two spheres (the Fourier transform of a
// ball of radius d).
TEST(PercusYevick, DiluteLimitIsTheExcludedVolume) {
    const double f = 1e-6;
    for (double x : {0.5, 1.5, 4.0, 10.0}) {
        const double excluded = 24 * (std::sin(x) - x * std::cos(x)) / (x * x * x);
        // Second order in f has coefficients up to 50.
        EXPECT_NEAR((1 - percus_yevick(f, x)) / f, excluded, 1e-4) << x;
    }
}

// The contact value 1 + int (S-1) sin(x)/x x^2 dx / (12 pi f)... is hard to sum; the first peak instead. Ashcroft &
// Lekner (1966), Phys. Rev. 145, 83: at the packing 0.45 of liquid metals the main peak is 2.5 high at q d = 6.9.
TEST(PercusYevick, MainPeakOfALiquid) {
    double height = 0.0, position = 0.0;
    for (double x = 5.0; x < 9.0; x += 0.01)
        if (const double s = percus_yevick(0.45, x); s > height) height = s, position = x;
    EXPECT_NEAR(height, 2.5, 0.1);
    EXPECT_NEAR(position, 6.9, 0.15);
}

// Crowding of white paint: (1-g) C_sca of TiO2 spheres, r = 0.1 um, n = 2.75 in 1.495 at 550 nm, relative to
// independent ones, by an independent prototype.
TEST(PercusYevick, CrowdingOfWhitePaint) {
    const SizeDistribution size{Monodisperse{0.1}};
    const auto transport = [&](double f) {
        const ScatteringProperties p = scatter(2.75, 1.495, 550, size, {.packing_fraction = f});
        EXPECT_EQ(p.absorption_um2, 0.0);
        EXPECT_NEAR(p.expansion.alpha1[0], 1.0, 1e-13);
        return p.scattering_um2 * (1.0 - p.asymmetry());
    };
    const double independent = transport(0.0);
    // Three printed digits.
    EXPECT_NEAR(transport(0.05) / independent, 0.950, 6e-4);
    EXPECT_NEAR(transport(0.10) / independent, 0.896, 6e-4);
    EXPECT_NEAR(transport(0.20) / independent, 0.779, 6e-4);
    EXPECT_NEAR(transport(0.30) / independent, 0.647, 6e-4);
}

TEST(PercusYevick, LeavesAbsorptionAndPolarizationAlone) {
    const SizeDistribution size{LogNormal{0.125, 1.3}};
    const ScatteringProperties one = scatter({3.19, 0.48}, 1.495, 550, size);
    const ScatteringProperties many = scatter({3.19, 0.48}, 1.495, 550, size, {.packing_fraction = 0.2});
    EXPECT_DOUBLE_EQ(one.absorption_um2, many.absorption_um2);
    EXPECT_LT(many.scattering_um2, one.scattering_um2);
    EXPECT_DOUBLE_EQ(many.extinction_um2, many.scattering_um2 + many.absorption_um2);
}

}  // namespace
}  // namespace patina::optics
