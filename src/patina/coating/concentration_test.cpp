#include "patina/coating/concentration.h"

namespace patina::coating {
namespace {

using enum ConcentrationKind;

TEST(Concentration, OfVolumesAndNumbers) {
    const Concentration pigments[] = {
        {volume_fraction, 0.1, 0, {}}, {pvc_percent, 15, 0, {}}, {number_density_um3, 40, 0.005, {}}};
    const std::vector<double> f = volume_fractions(pigments, {});
    EXPECT_DOUBLE_EQ(f[0], 0.1);
    EXPECT_DOUBLE_EQ(f[1], 0.15);
    EXPECT_DOUBLE_EQ(f[2], 0.2);
}

// 50 % of titania (4 g/cm3) in a binder of 1 g/cm3: in 2 g of film 0.25 cm3 of pigment and 1 cm3 of binder.
TEST(Concentration, OfOneWeight) {
    const Concentration pigment[] = {{weight_percent, 50, 0, 4.0}};
    EXPECT_DOUBLE_EQ(volume_fractions(pigment, 1.0)[0], 0.25 / 1.25);
}

// However they are given, the masses of the film add up: what comes out has the weights and volumes that went in.
TEST(Concentration, MixedWaysAgreeWithTheMassesOfTheFilm) {
    const double binder = 1.18;
    const Concentration pigments[] = {{weight_percent, 30, 0, 4.2},
                                      {volume_fraction, 0.05, 0, 2.7},
                                      {weight_percent, 12, 0, 2.65},
                                      {number_density_um3, 4, 0.01, 5.2}};
    const std::vector<double> f = volume_fractions(pigments, binder);
    double mass = binder, whole = 0.0;
    for (std::size_t i = 0; i < f.size(); ++i) {
        mass += f[i] * (*pigments[i].density_g_cm3 - binder);
        whole += f[i];
    }
    EXPECT_LT(whole, 1.0);
    EXPECT_NEAR(f[0] * 4.2 / mass, 0.30, 1e-15);
    EXPECT_NEAR(f[2] * 2.65 / mass, 0.12, 1e-15);
    EXPECT_DOUBLE_EQ(f[1], 0.05);
    EXPECT_DOUBLE_EQ(f[3], 0.04);
}

}  // namespace
}  // namespace patina::coating
