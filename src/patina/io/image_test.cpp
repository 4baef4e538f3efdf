#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "patina/core/constants.h"
#include "patina/core/error.h"
#include "patina/io/image_compare.h"
#include "patina/io/image_legend.h"
#include "patina/io/image_mosaic.h"
#include "patina/io/image_optics.h"
#include "patina/io/image_stokes.h"
#include "patina/io/image_tone.h"
#include "patina/io/image_views.h"
#include "patina/io/pixel_font.h"
#include "patina/spectral/colorimetry.h"

namespace patina::io {
namespace {

using Eigen::Vector3f;
using Eigen::Vector4d;
using Eigen::Vector4f;

// Matrices are made of sines and cosines in double.
constexpr double rounding = 1e-14;

StokesPlane plane_of(std::vector<Vector4f> pixels) {
    const int width = static_cast<int>(pixels.size());
    return {width, 1, std::move(pixels)};
}

// A picture whose grey RGB planes and single bin are the given Stokes vectors.
StokesImage image_of(const std::vector<Vector4f>& pixels) {
    StokesImage image;
    image.width = image.full_width = static_cast<int>(pixels.size());
    image.height = image.full_height = 1;
    image.bin_edges_nm = {500, 600};
    for (const Vector4f& stokes : pixels)
        for (int k = 0; k < 4; ++k) {
            image.spectral.push_back(stokes[k]);
            for (int c = 0; c < 3; ++c) image.rgb.push_back(stokes[k]);
        }
    return image;
}

Vector3f color_at(const Bitmap& picture, int x) {
    return Eigen::Map<const Vector3f>(picture.pixel(x, 0));
}

TEST(ImageOptics, MalusLaw) {
    // Fully polarized light at angle a behind a polarizer at b: cos^2(a - b).
    for (double a = 0; a < 180; a += 15)
        for (double b = 0; b < 360; b += 35) {
            const Vector4d light(1, std::cos(2 * radians(a)), std::sin(2 * radians(a)), 0);
            const Vector4d behind = polarizer_mueller(b) * light;
            EXPECT_NEAR(behind[0], std::pow(std::cos(radians(a - b)), 2), rounding);
            // What passes is fully polarized along the polarizer.
            EXPECT_NEAR(behind[1], behind[0] * std::cos(2 * radians(b)), rounding);
            EXPECT_NEAR(behind[2], behind[0] * std::sin(2 * radians(b)), rounding);
        }
    EXPECT_NEAR((polarizer_mueller(33) * Vector4d(1, 0, 0, 0))[0], 0.5, rounding);
}

TEST(ImageOptics, QuarterAndHalfWavePlates) {
    // Jones calculus: fields (Ex, Ey) with time factor exp(-i w t); a retarder takes phase off its fast axis. S3 > 0 is
    // clockwise for the camera, where Ey leads Ex by a quarter period: Ex = 1, Ey = -i, so S3 = -2 Im(conj(Ex) Ey).
    using Complex = std::complex<double>;
    const auto stokes_of = [](Complex x, Complex y) {
        return Vector4d(std::norm(x) + std::norm(y), std::norm(x) - std::norm(y), 2 * (std::conj(x) * y).real(),
                        -2 * (std::conj(x) * y).imag());
    };
    const Complex x(0.8, 0.1), y(-0.3, 0.7);
    for (const double retardance_deg : {37.0, 90.0, 180.0})
        for (const double axis_deg : {0.0, 20.0, 135.0}) {
            // Into the plate's axes, delay the slow one (a later field has phase +delta under exp(-i w t)), and back.
            const double c = std::cos(radians(axis_deg)), s = std::sin(radians(axis_deg));
            const Complex fast = c * x + s * y;
            const Complex slow = (-s * x + c * y) * std::polar(1.0, radians(retardance_deg));
            const Vector4d expected = stokes_of(c * fast - s * slow, s * fast + c * slow);
            const Vector4d plate = retarder_mueller(axis_deg, retardance_deg) * stokes_of(x, y);
            EXPECT_LT((plate - expected).norm(), rounding) << axis_deg << " " << retardance_deg;
        }
    // A quarter-wave plate with a horizontal fast axis makes 45 degree light left circular.
    EXPECT_NEAR((retarder_mueller(0, 90) * Vector4d(1, 0, 1, 0))[3], -1, rounding);
}

TEST(ImageOptics, CrossedPolarizersWithAPlateBetweenPassSinSquared) {
    // I = (1/2) sin^2(2 a) sin^2(delta / 2) behind crossed polarizers, for unpolarized light of unit power.
    for (const double axis_deg : {10.0, 45.0, 70.0})
        for (const double delta_deg : {30.0, 90.0, 180.0}) {
            const Vector4d out = polarizer_mueller(90) * retarder_mueller(axis_deg, delta_deg) * polarizer_mueller(0) *
                                 Vector4d(1, 0, 0, 0);
            const double expected =
                0.5 * std::pow(std::sin(2 * radians(axis_deg)) * std::sin(radians(delta_deg) / 2), 2);
            EXPECT_NEAR(out[0], expected, rounding);
        }
}

TEST(ImageOptics, EveryBandOfAPictureGoesThroughTheElement) {
    StokesImage image = image_of({{2, 1, 0.5f, -0.25f}, {1, 0, 0, 1}});
    image.variance.assign(8, 1.0f);
    const StokesImage behind = apply_mueller(image, polarizer_mueller(0));
    // Halves are exact in float.
    EXPECT_EQ(behind.spectral, (std::vector<float>{1.5f, 1.5f, 0, 0, 0.5f, 0.5f, 0, 0}));
    EXPECT_EQ(behind.stokes_rgb(0)[5], 1.5f);
    EXPECT_TRUE(behind.variance.empty());
}

TEST(ImageOptics, MosaicPixelsSeeTheirPolarizers) {
    StokesPlane plane{2, 2, std::vector<Vector4f>(4, Vector4f(1, 1, 0, 0))};
    const Bitmap sensor = polarization_mosaic(plane);
    // Horizontal light behind 90, 45, 135 and 0 degrees, to a float's rounding.
    const float expected[] = {0.0f, 0.5f, 0.5f, 1.0f};
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(sensor.data[i], expected[i], 1e-6f);
}

TEST(ImageStokes, MeasuresOfPureStates) {
    const Vector4f at_60_deg(2, std::cos(2.0944f), std::sin(2.0944f), 0);
    EXPECT_NEAR(dolp(at_60_deg), 0.5, 1e-6);
    EXPECT_NEAR(aolp_deg(at_60_deg), 60, 1e-3);  // 2.0944 is 120 degrees to 5 digits
    EXPECT_EQ(aolp_deg({1, -1, -0.0f, 0}), 90);
    EXPECT_EQ(aolp_deg({1, 0, -1, 0}), 135);
    EXPECT_EQ(docp({2, 0, 0, -1}), -0.5f);
    EXPECT_EQ(dop({0, 0, 0, 0}), 0);
}

TEST(ImageStokes, BandsAreLuminanceBinOrColour) {
    const StokesImage image = image_of({{2, 1, 0.5f, -0.25f}});
    // The luminance weights add up to one.
    EXPECT_LT((select_band(image).pixels[0] - Vector4f(2, 1, 0.5f, -0.25f)).norm(), 1e-6f);
    EXPECT_EQ(select_band(image, {550.0, {}}).pixels[0], Vector4f(2, 1, 0.5f, -0.25f));
    EXPECT_EQ(select_band(image, {600.0, {}}).pixels[0][0], 2);
    EXPECT_THROW(select_band(image, {700.0, {}}), Error);
    EXPECT_THROW(select_band(image, {{}, 3}), Error);
}

TEST(ImageViews, AnglesAreHuesOver180Degrees) {
    const StokesPlane plane =
        plane_of({{1, 1, 0, 0}, {1, -0.5f, 0.8660254f, 0}, {1, -0.5f, -0.8660254f, 0}, {1, 0.5f, 0, 0}});
    const Bitmap full = aolp_view(plane, AolpStyle::full), dark = aolp_view(plane, AolpStyle::dark),
                 light = aolp_view(plane, AolpStyle::light);
    // 0 degrees red, 60 green, 120 blue; rounding of the angle moves a hue by less than a code.
    EXPECT_LT((color_at(full, 0) - Vector3f(1, 0, 0)).norm(), 1e-5f);
    EXPECT_LT((color_at(full, 1) - Vector3f(0, 1, 0)).norm(), 1e-3f);
    EXPECT_LT((color_at(full, 2) - Vector3f(0, 0, 1)).norm(), 1e-3f);
    // Half polarized: half the value, or half the saturation, in encoded sRGB.
    const auto half = static_cast<float>(spectral::srgb_decode(0.5));
    EXPECT_LT((color_at(dark, 3) - Vector3f(half, 0, 0)).norm(), 1e-5f);
    EXPECT_LT((color_at(light, 3) - Vector3f(1, half, half)).norm(), 1e-5f);
}

TEST(ImageViews, TypeAndChirality) {
    const StokesPlane plane = plane_of({{1, 1, 0, 0}, {1, 0, 0, 1}, {1, 0, 0, -1}, {1, 0, 0, 0}});
    const Bitmap type = type_view(plane), chirality = chirality_view(plane), circular = docp_view(plane);
    EXPECT_EQ(color_at(type, 0), Vector3f(0, 1, 1));       // linear: cyan
    EXPECT_EQ(color_at(type, 1), Vector3f(1, 1, 0));       // circular: yellow
    EXPECT_EQ(color_at(type, 3), Vector3f(0, 0, 0));       // unpolarized: black
    EXPECT_EQ(color_at(chirality, 1), Vector3f(0, 0, 1));  // right: blue
    EXPECT_EQ(color_at(chirality, 2), Vector3f(1, 1, 0));  // left: yellow
    EXPECT_GT(color_at(circular, 1)[0], color_at(circular, 1)[2]);
    EXPECT_LT(color_at(circular, 2)[0], color_at(circular, 2)[2]);
}

TEST(ImageViews, ZeroIsTheMiddleOfTheDivergingMap) {
    float range = 0;
    const StokesPlane plane = plane_of({{1, 0.5f, 0, 0}, {1, -0.5f, 0, 0}, {1, 0, 0, 0}, {1, std::nanf(""), 0, 0}});
    const Bitmap view = stokes_view(plane, 1, false, 0.5f, range);
    EXPECT_EQ(range, 0.5f);
    const Vector3f middle = color_at(view, 2);
    EXPECT_EQ(middle[0], middle[2]);
    EXPECT_EQ(color_at(view, 0), color_of(ColorMap::diverging, 1));
    EXPECT_EQ(color_at(view, 1), color_of(ColorMap::diverging, 0));
    EXPECT_EQ(color_at(view, 3), not_a_number_color());
    stokes_view(plane, 1, false, 0, range);
    EXPECT_EQ(range, 0.5f);  // found from the picture
}

Bitmap grey_picture(int side) {
    return {"", side, side, {"R", "G", "B"}, std::vector<float>(static_cast<std::size_t>(side) * side * 3, 0.25f)};
}

// Whether some pixel beside the picture has the colour, to what an 8-bit PNG holds.
bool legend_shows(const Bitmap& wide, int picture_width, const Vector3f& color) {
    for (int y = 0; y < wide.height; ++y)
        for (int x = picture_width; x < wide.width; ++x)
            if ((Eigen::Map<const Vector3f>(wide.pixel(x, y)) - color).norm() < 4e-3f) return true;
    return false;
}

TEST(ImageLegend, ABarSpansItsColours) {
    const Bitmap wide = with_legend(grey_picture(64), bar_legend("", ColorMap::viridis, -1, 1));
    EXPECT_EQ(wide.height, 64);
    EXPECT_EQ(wide.pixel(63, 63)[0], 0.25f);
    const Vector3f top = Eigen::Map<const Vector3f>(wide.pixel(64 + 8 + 2, 8)),
                   bottom = Eigen::Map<const Vector3f>(wide.pixel(64 + 8 + 2, 55));
    EXPECT_EQ(top, color_of(ColorMap::viridis, 1));
    EXPECT_EQ(bottom, color_of(ColorMap::viridis, 0));
}

// Light that vibrates along a direction of the picture has the colour that the disc has in that direction: horizontal
// light that of its right and left ends, and so on. A pixel of a disc of 64 is 2 degrees wide at its rim.
TEST(ImageLegend, TheDiscOfAnglesShowsWhatTheViewShows) {
    for (const AolpStyle style : {AolpStyle::full, AolpStyle::light, AolpStyle::dark}) {
        const Legend legend = aolp_legend(style);
        for (int angle_deg = 0; angle_deg < 360; angle_deg += 15)
            for (const float degree : {0.25f, 0.99f}) {
                const double angle = radians(angle_deg);
                const auto x = static_cast<float>(degree * std::cos(angle)),
                           y = static_cast<float>(degree * std::sin(angle));
                const Vector4f light(1, degree * static_cast<float>(std::cos(2 * angle)),
                                     degree * static_cast<float>(std::sin(2 * angle)), 0);
                // Rounding of the angle moves a hue by less than a code.
                EXPECT_LT(
                    (*legend.color(0.5f + 0.5f * x, 0.5f + 0.5f * y) - color_at(aolp_view(plane_of({light}), style), 0))
                        .norm(),
                    4e-3f)
                    << angle_deg;
            }
        EXPECT_FALSE(legend.color(0.0f, 0.0f));  // the corner lies outside
    }
}

TEST(ImageLegend, EveryKeyHasTheColoursOfItsView) {
    const Bitmap picture = grey_picture(256);
    const auto view_of = [](auto view, const Vector4f& stokes) { return color_at(view(plane_of({stokes})), 0); };
    const Bitmap type = with_legend(picture, type_legend()), chirality = with_legend(picture, chirality_legend()),
                 circular = with_legend(picture, docp_legend());
    for (const Vector4f& light : {Vector4f(1, 1, 0, 0), Vector4f(1, 0, 0, 1)})
        EXPECT_TRUE(legend_shows(type, 256, view_of(type_view, light)));
    for (const Vector4f& light : {Vector4f(1, 0, 0, 1), Vector4f(1, 0, 0, -1)}) {
        EXPECT_TRUE(legend_shows(chirality, 256, view_of(chirality_view, light)));
        EXPECT_TRUE(legend_shows(circular, 256, view_of(docp_view, light)));
    }
}

TEST(ImageLegend, EveryWordCanBeDrawn) {
    for (const Legend& legend : {aolp_legend(AolpStyle::dark), type_legend(), docp_legend(), chirality_legend(),
                                 bar_legend("noise S0/S0", ColorMap::grey, -1.23e-30f, 4.56e+07f),
                                 bar_legend("error S0/S0", ColorMap::grey, 0, 789)}) {
        EXPECT_TRUE(has_glyphs_for(legend.title)) << legend.title;
        for (const Legend::Mark& mark : legend.marks) EXPECT_TRUE(has_glyphs_for(mark.text)) << mark.text;
    }
    EXPECT_FALSE(has_glyphs_for("?"));
}

// The picture itself is never touched, and a height is never changed: pictures of a row stay in line.
TEST(ImageLegend, LeavesThePictureAlone) {
    for (const int side : {1, 16, 40, 100, 700})
        for (const Legend& legend : {aolp_legend(AolpStyle::light), type_legend(), docp_legend()}) {
            const Bitmap picture = grey_picture(side), wide = with_legend(picture, legend);
            ASSERT_EQ(wide.height, side);
            ASSERT_GE(wide.width, side);
            for (int y = 0; y < side; ++y)
                for (int x = 0; x < side; ++x) ASSERT_EQ(wide.pixel(x, y)[0], 0.25f);
        }
}

TEST(ToneMap, TheCurveIsSmoothMonotoneAndBounded) {
    EXPECT_EQ(roll_off(0.3), 0.3);
    const double h = 1e-6;
    // The slope is 1 on both sides of the shoulder; a one-sided difference is off by h / (2 * 0.4).
    EXPECT_NEAR((roll_off(0.6 + h) - roll_off(0.6)) / h, 1, 2e-6);
    for (double y = 0; y < 20; y += 0.1) EXPECT_LE(roll_off(y), roll_off(y + 0.1));
    EXPECT_LE(roll_off(1e9), 1);
}

TEST(ToneMap, AUniformSpectrumBecomesGreyWithEqualEnergyBalance) {
    StokesImage image = image_of({{1, 0, 0, 0}});
    const Eigen::Vector3d uniform = spectral::xyz_to_linear_srgb({1, 1, 1});
    for (int c = 0; c < 3; ++c) image.stokes_rgb(0)[c] = static_cast<float>(0.5 * uniform[c]);
    const Bitmap picture = tone_map(image, {0.0, false, WhiteBalance::equal_energy, true});
    // The picture is stored in float.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.data[c], 0.5, 1e-6);
    EXPECT_NEAR(tone_map(image, {0.0, false, WhiteBalance::none, true}).data[0], 0.5 * 1.205, 1e-3);
    // One stop more of exposure doubles the light and ends on the curve.
    EXPECT_NEAR(tone_map(image, {1.0, false, WhiteBalance::equal_energy, true}).data[1], roll_off(1.0), 1e-6);
    EXPECT_NEAR(tone_map(image, {0.0, true, WhiteBalance::equal_energy, true}).data[1], roll_off(0.8), 1e-6);
}

// Grey under D65 and grey under a uniform lamp are both grey, each by what the picture says of its light.
TEST(ToneMap, WhiteIsThatOfTheScenesLight) {
    StokesImage image = image_of({{1, 0, 0, 0}});
    const Eigen::Vector3d uniform = spectral::xyz_to_linear_srgb({1, 1, 1});
    ToneOptions tone;
    tone.automatic_exposure = false;
    for (const bool daylight : {true, false}) {
        image.metadata["white"] = daylight ? "D65" : "E";
        for (int c = 0; c < 3; ++c) image.stokes_rgb(0)[c] = static_cast<float>(0.5 * (daylight ? 1.0 : uniform[c]));
        const Bitmap picture = tone_map(image, tone);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.data[c], 0.5, 1e-6) << daylight;
    }
}

TEST(ToneMap, EverythingFitsTheScreenAndKeepsItsLuminance) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(-0.2f, 5.0f);
    StokesImage image = image_of(std::vector<Vector4f>(200, Vector4f(1, 0, 0, 0)));
    for (float& value : image.rgb) value = uniform(random);
    image.stokes_rgb(7)[0] = std::nanf("");
    const Bitmap picture = tone_map(image, {0.0, false, WhiteBalance::none, true});
    for (const float value : picture.data) EXPECT_TRUE(value >= 0 && value <= 1);
    EXPECT_EQ(color_at(picture, 7), not_a_number_color());
    for (int x = 0; x < 5; ++x) {
        const double before =
            spectral::linear_srgb_to_xyz(Eigen::Map<const Vector3f>(image.stokes_rgb(x)).cast<double>())[1];
        const double after = spectral::linear_srgb_to_xyz(color_at(picture, x).cast<double>())[1];
        // Drawn to the grey of the same luminance, in float.
        EXPECT_NEAR(after, roll_off(before), 1e-6);
    }
}

TEST(ImageCompare, MetricsOfAKnownDifference) {
    const StokesImage a = image_of({{1, 0.5f, 0, 0}, {2, 0, 0, 0}, {1, 0, 0, 0}}),
                      b = image_of({{1, 0, 0, 0}, {1, 0, 0, 0}, {1, 0, 0, 1}});
    const ImageDifference difference = compare_images(a, b);
    EXPECT_EQ(difference.bands, "spectral");
    EXPECT_NEAR(difference.stokes[0].root_mean_square, std::sqrt(1.0 / 3), 1e-15);
    EXPECT_EQ(difference.stokes[0].largest_x, 1);
    EXPECT_NEAR(difference.stokes[1].mean, 0.5 / 3, 1e-15);
    EXPECT_EQ(difference.stokes[2].largest, 0);
    EXPECT_NEAR(difference.stokes[3].mean, -1.0 / 3, 1e-15);

    // Channels of colour are told apart: one of three pixels differs by 0.3 in green of S2, and nothing else does.
    StokesImage greener = b;
    greener.stokes_rgb(1)[2 * 3 + 1] -= 0.3f;
    const ImageDifference by_channel = compare_images(b, greener);
    // Float holds 0.3 to 3e-8.
    EXPECT_NEAR(by_channel.rgb[2][1].root_mean_square, 0.3 / std::sqrt(3.0), 1e-7);
    EXPECT_NEAR(by_channel.rgb[2][1].mean, 0.1, 1e-7);
    EXPECT_EQ(by_channel.rgb[2][1].largest_x, 1);
    EXPECT_EQ(by_channel.rgb[2][0].largest, 0);
    EXPECT_EQ(by_channel.rgb[1][1].largest, 0);
    EXPECT_EQ(by_channel.stokes[2].largest, 0);

    // An image without bins is compared by its colours.
    StokesImage coloured = b;
    coloured.bin_edges_nm.clear();
    coloured.spectral.clear();
    coloured.rgb[0] = std::nanf("");
    const ImageDifference by_colour = compare_images(a, coloured);
    EXPECT_EQ(by_colour.bands, "rgb");
    EXPECT_EQ(by_colour.not_finite, 1u);
    EXPECT_EQ(by_colour.stokes[2].largest, 0);
    EXPECT_EQ(by_colour.stokes[3].largest, 1);
    EXPECT_EQ(subtract_images(a, b).stokes(2, 0)[3], -1);
    EXPECT_THROW(compare_images(a, image_of({{1, 0, 0, 0}})), Error);
}

TEST(ImageViews, ErrorAndNoiseAreSharesOfTheIntensity) {
    StokesImage a = image_of({{1.2f, 0.5f, 0, 0}, {2, 0, 0, 0}, {0, 0, 0, 0}});
    const StokesImage b = image_of({{1, 0.4f, 0, 0}, {2, 0, 0, 0}, {0, 0, 0, 0}});
    // 0.2 and 0.1 of S0 = 1; no light, no error.
    const std::vector<float> error0 = relative_errors(a, b, 0), error1 = relative_errors(a, b, 1);
    EXPECT_NEAR(error0[0], 0.2, 1e-6);
    EXPECT_NEAR(error1[0], 0.1, 1e-6);
    EXPECT_EQ(error0[1], 0);
    EXPECT_EQ(error0[2], 0);
    a.variance = {0.09f, 0.01f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    EXPECT_NEAR(relative_noise(a, 0)[0], 0.3 / 1.2, 1e-6);
    EXPECT_NEAR(relative_noise(a, 1)[0], 0.1 / 1.2, 1e-6);
    a.variance.clear();
    EXPECT_THROW(relative_noise(a, 0), Error);
    float range = 0;
    const Bitmap view = share_view(a, error0, 0.2f, range);
    EXPECT_EQ(color_at(view, 0), color_of(ColorMap::inferno, 1));
    EXPECT_EQ(color_at(view, 1), color_of(ColorMap::inferno, 0));
}

TEST(ImageCompare, SummaryCountsWhatIsImpossible) {
    const ImageSummary summary =
        summarize_image(image_of({{1, 1, 0, 0}, {1, 2, 0, 0}, {2, 0, 0, 0}, {std::nanf(""), 0, 0, 0}}));
    EXPECT_EQ(summary.not_finite, 1u);
    EXPECT_EQ(summary.over_polarized, 1u);
    // Float sums of luminance weights.
    EXPECT_NEAR(summary.mean[0], 4.0 / 3, 1e-6);
    EXPECT_NEAR(summary.mean_dolp, 0.75, 1e-6);
    EXPECT_NEAR(summary.largest_dolp, 2, 1e-6);
}

}  // namespace
}  // namespace patina::io
