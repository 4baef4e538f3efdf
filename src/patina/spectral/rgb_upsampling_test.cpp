#include "patina/spectral/rgb_upsampling.h"

#include "patina/core/error.h"
#include "patina/spectral/colorimetry.h"
#include "patina/spectral/illuminants.h"
#include "patina/spectral/scene_spectrum.h"

namespace patina::spectral {
namespace {

using Eigen::Vector3d;

Vector3d colour_under_d65(const SpectralFunction& reflectance) {
    static const Spectrum d65 = illuminant_d65();
    return xyz_to_linear_srgb(xyz_of_reflectance(reflectance, d65));
}

// What the header promises, on the whole cube with its corners and edges, finer towards black.
TEST(RgbUpsampling, ReflectanceReturnsItsColourOverTheWholeGamut) {
    const double levels[] = {0.0, 0.001, 0.01, 0.05, 0.18, 0.35, 0.5, 0.65, 0.8, 0.95, 0.999, 1.0};
    for (double r : levels)
        for (double g : levels)
            for (double b : levels) {
                const Vector3d rgb(r, g, b);
                const SigmoidReflectance reflectance = upsampled_reflectance(rgb);
                EXPECT_LT((colour_under_d65(reflectance) - rgb).cwiseAbs().maxCoeff(), 1e-3) << rgb.transpose();
                for (double nm = 360; nm <= 830; nm += 47) {
                    const double value = reflectance(nm);
                    EXPECT_TRUE(value >= 0.0 && value <= 1.0) << rgb.transpose() << " at " << nm;
                }
            }
}

TEST(RgbUpsampling, GreysAreConstantAndTheEndsExact) {
    for (double grey : {0.0, 0.2, 1.0})
        for (double nm : {300.0, 400.0, 595.0, 800.0})
            EXPECT_NEAR(upsampled_reflectance(Vector3d::Constant(grey))(nm), grey, 1e-15);
    EXPECT_EQ(upsampled_reflectance({2, 3, 4})(500), 1.0);
    EXPECT_EQ(upsampled_reflectance({-2, -3, -4})(500), 0.0);
}

// Ordinary colours have ordinary spectra: no step within 20 nm larger than a third.
TEST(RgbUpsampling, SpectraOfModerateColoursAreSmooth) {
    for (const Vector3d& rgb :
         {Vector3d(0.6, 0.3, 0.2), Vector3d(0.2, 0.5, 0.3), Vector3d(0.2, 0.3, 0.7), Vector3d(0.7, 0.7, 0.3)}) {
        const SigmoidReflectance reflectance = upsampled_reflectance(rgb);
        for (double nm = 380; nm < 760; nm += 5)
            EXPECT_LT(std::abs(reflectance(nm + 20) - reflectance(nm)), 0.33) << nm;
    }
}

// White is D65 itself, whose sRGB is (1, 1, 1) to the four decimals of the standard's white point (3e-4).
TEST(RgbUpsampling, EmissionIsD65TimesTheColour) {
    const Spectrum d65 = illuminant_d65();
    const SpectralFunction white = upsampled_emission({1, 1, 1});
    EXPECT_NEAR(xyz_of_radiance(white)[1], 1.0, 1e-12);
    EXPECT_NEAR(white(450) / white(600), d65(450) / d65(600), 1e-12);
    EXPECT_EQ(upsampled_emission({0, 0, 0})(500), 0.0);
    for (const Vector3d& rgb : {Vector3d(1, 1, 1), Vector3d(12, 7, 3), Vector3d(0.1, 0.2, 0.9), Vector3d(100, 0, 0),
                                Vector3d(1e-6, 2e-6, 0)}) {
        const Vector3d colour = xyz_to_linear_srgb(xyz_of_radiance(upsampled_emission(rgb)));
        EXPECT_LT((colour - rgb).cwiseAbs().maxCoeff(), 1e-3 * rgb.maxCoeff()) << rgb.transpose();
    }
}

// The colour of a property of matter is a linear functional of its spectrum, whatever its brightness.
TEST(SceneSpectrum, AColourOfMatterIsASmoothSpectrumOfThatColour) {
    using Kind = SpectrumSpec::Kind;
    const Vector3d aluminium_k(9.22387, 6.26952, 4.837);
    const SpectralFunction k = property_spectrum({Kind::rgb, {}, {aluminium_k[0], aluminium_k[1], aluminium_k[2]}});
    // The upsampling's own 1e-3, at the scale of twice the brightest component.
    EXPECT_LT((colour_under_d65(k) - aluminium_k).cwiseAbs().maxCoeff(), 1e-3 * 2 * aluminium_k[0]);
    EXPECT_EQ(property_spectrum({Kind::rgb, {}, {1.5, 1.5, 1.5}})(412), 1.5);
    EXPECT_THROW(property_spectrum({Kind::rgb, {}, {1.5, -1, 1.5}}), Error);
}

TEST(SceneSpectrum, MeaningDependsOnTheUse) {
    using Kind = SpectrumSpec::Kind;
    const SpectrumSpec grey{Kind::uniform, {}, {0.5}}, colour{Kind::rgb, {}, {0.5, 0.2, 0.1}};
    const SpectrumSpec sampled{Kind::sampled, {400, 700}, {0.2, 0.8}}, body{Kind::blackbody, {}, {3000, 2}};
    EXPECT_EQ(reflectance_spectrum(grey)(500), 0.5);
    EXPECT_EQ(emission_spectrum(grey)(500), 0.5);
    EXPECT_LT((colour_under_d65(reflectance_spectrum(colour)) - Vector3d(0.5, 0.2, 0.1)).norm(), 1e-3);
    EXPECT_EQ(reflectance_spectrum(sampled)(800), 0.8);
    EXPECT_EQ(property_spectrum(sampled)(300), 0.2);
    EXPECT_EQ(emission_spectrum(sampled)(800), 0.0);
    EXPECT_DOUBLE_EQ(emission_spectrum(body)(600), 2 * blackbody_radiance(600, 3000));

    const SourceLocation where{"scene.xml", 3, 5};
    EXPECT_THROW(reflectance_spectrum(body, where), Error);
    EXPECT_THROW(property_spectrum(body, where), Error);
    EXPECT_THROW(reflectance_spectrum({Kind::uniform, {}, {1.5}}, where), Error);
    EXPECT_THROW(reflectance_spectrum({Kind::rgb, {}, {0.5, 1.5, 0.5}}, where), Error);
    EXPECT_THROW(emission_spectrum({Kind::uniform, {}, {-1}}, where), Error);
    EXPECT_THROW(emission_spectrum({Kind::uniform, {}, {std::nan("")}}, where), Error);
    EXPECT_THROW(emission_spectrum({Kind::sampled, {400, 300}, {1, 1}}, where), Error);
    EXPECT_THROW(emission_spectrum({Kind::sampled, {400}, {1, 1}}, where), Error);
    EXPECT_THROW(emission_spectrum({Kind::sampled, {}, {}}, where), Error);
}

}  // namespace
}  // namespace patina::spectral
