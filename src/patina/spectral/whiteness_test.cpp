#include "patina/spectral/whiteness.h"

#include "patina/core/contract.h"
#include "patina/spectral/colorimetry.h"
#include "patina/spectral/illuminants.h"

namespace patina::spectral {
namespace {

using Eigen::Vector3d;
constexpr Observer two = Observer::cie1931_2deg, ten = Observer::cie1964_10deg;

// The perfect diffuser has whiteness 100, no tint, no yellowness; the standard's white points carry four decimals,
// which 1700 times 5e-5 turns into 0.1 of whiteness, and its coefficients make the yellowness of white vanish to 0.05.
TEST(Whiteness, OfThePerfectDiffuser) {
    const Spectrum d65 = illuminant_d65();
    for (Observer observer : {two, ten}) {
        const Vector3d white = white_point(d65, observer);
        const Whiteness w = astm_e313_whiteness(white, WhitenessLight::d65, observer);
        EXPECT_NEAR(w.index, 100.0, 0.13);
        EXPECT_NEAR(w.tint, 0.0, 0.09);
        EXPECT_TRUE(w.valid);
        EXPECT_NEAR(astm_e313_yellowness(white, WhitenessLight::d65, observer), 0.0, 0.05);
    }
    // Illuminant C by its published tristimulus values (ASTM E308).
    EXPECT_NEAR(astm_e313_yellowness({0.98074, 1.0, 1.18232}, WhitenessLight::c, two), 0.0, 0.01);
    EXPECT_NEAR(astm_e313_yellowness({0.97285, 1.0, 1.16145}, WhitenessLight::c, ten), 0.0, 0.01);
    EXPECT_NEAR(astm_e313_whiteness({0.98074, 1.0, 1.18232}, WhitenessLight::c, two).index, 100.0, 0.13);
}

TEST(Whiteness, ABluerWhiteIsWhiterAndAYellowerOneYellower) {
    const Spectrum d65 = illuminant_d65();
    const auto tinted = [&](double slope) {
        return xyz_of_reflectance([slope](double nm) { return 0.85 + slope * (nm - 580.0) / 200.0; }, d65, ten);
    };
    const Vector3d bluish = tinted(-0.04), grey = tinted(0.0), yellowish = tinted(0.04);
    const auto whiteness = [](const Vector3d& xyz) { return astm_e313_whiteness(xyz, WhitenessLight::d65, ten).index; };
    const auto yellowness = [](const Vector3d& xyz) { return astm_e313_yellowness(xyz, WhitenessLight::d65, ten); };
    EXPECT_GT(whiteness(bluish), whiteness(grey) + 5.0);
    EXPECT_LT(whiteness(yellowish), whiteness(grey) - 5.0);
    EXPECT_LT(yellowness(bluish), -2.0);
    EXPECT_GT(yellowness(yellowish), 2.0);
    // Yellowness is a ratio: every grey has that of white. Whiteness of a grey is its Y.
    EXPECT_NEAR(yellowness(0.5 * grey), yellowness(grey), 1e-12);
    EXPECT_NEAR(whiteness(grey), 85.0, 0.13);
    EXPECT_FALSE(astm_e313_whiteness(0.3 * grey, WhitenessLight::d65, ten).valid);
    EXPECT_THROW(yellowness(Vector3d::Zero()), ContractViolation);
}

}  // namespace
}  // namespace patina::spectral
