#include "patina/optics/scattering/external_particles.h"

#include "patina/core/error.h"
#include "patina/optics/scattering/expansion.h"

namespace patina::optics {
namespace {

ExternalParticles from(const ScatteringProperties& p, double wavelength_nm) {
    return {"spheres.csv",
            p.mean_volume_um3,
            {{wavelength_nm, p.expansion}},
            {{wavelength_nm, p.extinction_um2, p.scattering_um2}}};
}

TEST(ExternalParticles, AreLinearBetweenTheirWavelengths) {
    ExternalParticles p{"p", 1.0, {}, {{400.0, 2.0, 1.0}, {600.0, 4.0, 2.0}}};
    p.laws = {{400.0, {{1, 0, 0.5}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}},
              {600.0, {{1, 0.4, 0.1}, {0, 0, 1}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}};
    const ScatteringProperties middle = scatter(p, 450.0, Extrapolation::refuse);
    EXPECT_DOUBLE_EQ(middle.extinction_um2, 2.5);
    EXPECT_DOUBLE_EQ(middle.scattering_um2, 1.25);
    EXPECT_DOUBLE_EQ(middle.absorption_um2, 1.25);
    EXPECT_DOUBLE_EQ(middle.expansion.alpha1[1], 0.1);
    EXPECT_DOUBLE_EQ(middle.expansion.alpha1[2], 0.4);
    EXPECT_DOUBLE_EQ(middle.expansion.alpha2[2], 0.25);
    EXPECT_EQ(scatter(p, 600.0, Extrapolation::refuse).expansion.alpha1[1], 0.4);
    EXPECT_THROW(scatter(p, 601.0, Extrapolation::refuse), Error);
    EXPECT_EQ(scatter(p, 900.0, Extrapolation::hold).extinction_um2, 4.0);
}

TEST(ExternalParticles, WithoutAWavelengthHoldAtAll) {
    const ExternalParticles p = from(scatter(2.7, 1.5, 550.0, {Monodisperse{0.1}}), 0.0);
    EXPECT_EQ(scatter(p, 400.0, Extrapolation::refuse).scattering_um2,
              scatter(p, 800.0, Extrapolation::refuse).scattering_um2);
}

// Spheres brought as coefficients pack like the spheres themselves.
TEST(ExternalParticles, PackLikeSpheresOfTheirVolume) {
    const ScatteringOptions packed{.tolerance = 1e-9, .packing_fraction = 0.2};
    const ScatteringProperties alone = scatter(2.7, 1.5, 550.0, {Monodisperse{0.15}}, {.tolerance = 1e-9});
    const ScatteringProperties expected = scatter(2.7, 1.5, 550.0, {Monodisperse{0.15}}, packed);
    const ScatteringProperties p = pack(scatter(from(alone, 550.0), 550.0, Extrapolation::refuse), 0.2, 1.5, 550.0);
    // Coefficients below 1e-9 were dropped on the way.
    EXPECT_NEAR(p.scattering_um2, expected.scattering_um2, 1e-7 * expected.scattering_um2);
    EXPECT_LT(p.scattering_um2, 0.8 * alone.scattering_um2);
    for (int l = 0; l <= 6; ++l) {
        EXPECT_NEAR(p.expansion.alpha1[l], expected.expansion.alpha1[l], 1e-6);
        EXPECT_NEAR(p.expansion.beta2[l], expected.expansion.beta2[l], 1e-6);
    }
}

}  // namespace
}  // namespace patina::optics
