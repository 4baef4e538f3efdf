// The path tracer against closed forms of radiometry.

#include "render_scenes.h"
#include <gtest/gtest.h>

#include "patina/core/parallel.h"

namespace patina::render::test {
namespace {

using Eigen::Vector3d;

Node diffuse(double reflectance) {
    return node("bsdf", "diffuse", {uniform("reflectance", reflectance)});
}
Node floor(Node bsdf) {
    return node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(scale(50, 50, 50))}}, {std::move(bsdf)});
}

// A closed surface that shines with L and reflects rho shows L / (1 - rho) everywhere.
TEST(Furnace, ClosedDiffuseSphereSumsTheGeometricSeries) {
    const auto image = render_tree(scene({
        path(-1),
        perspective(look_at({0, 0, 0}, {0, 0, 1}, {0, 1, 0}), 60, 8, 8, 256),
        node("shape", "sphere", {{"flip_normals", true}},
             {diffuse(0.5), node("emitter", "area", {uniform("radiance", 1)})}),
    }));
    // 16384 paths whose lengths are geometric: standard error of the mean below 2 sqrt(0.5) / sqrt(16384) = 1.1e-2; 3
    // sigma.
    EXPECT_NEAR(mean_stokes(image)[0], 2.0, 0.033);
    EXPECT_LT(mean_stokes(image).tail<3>().norm(), 1e-12);
}

// In surroundings of radiance 1, what reflects everything cannot be told from them.
TEST(Furnace, WhiteDiffuseSphereVanishes) {
    const auto image = render_tree(scene({path(-1, {{"rr_depth", std::int64_t{100}}}),
                                          perspective(look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}), 20, 8, 8, 8),
                                          node("shape", "sphere", {}, {diffuse(1.0)}), constant_light()}));
    // A convex surface: one bounce of weight exactly 1, whatever the sample; each puts four wavelengths into equal
    // bins, so their mean is 1 for every pixel, but for the rounding of sums in single precision.
    for (std::size_t p = 0; p < image.pixel_count(); ++p) {
        double mean = 0;
        for (int b = 0; b < image.bin_count(); ++b) mean += image.stokes(p, b)[0] / image.bin_count();
        EXPECT_NEAR(mean, 1.0, 2e-6);
    }
}

TEST(Furnace, GlassSphereVanishesAndStaysUnpolarizedOnAverage) {
    const auto image = render_tree(
        scene({path(-1, {{"rr_depth", std::int64_t{1000}}}),
               perspective(look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}), 20, 16, 16, 256),
               node("shape", "sphere", {}, {node("bsdf", "dielectric", {{"int_ior", 1.5}})}), constant_light()}));
    const Eigen::Vector4d mean = mean_stokes(image);
    // The equilibrium field is unpolarized. 65536 paths whose weights vary by a few tenths: 4 sigma below 4 * 0.5 /
    // 256.
    EXPECT_NEAR(mean[0], 1.0, 8e-3);
    EXPECT_LT(mean.tail<3>().norm(), 8e-3);
}

// No light fades in a white closed sphere, and roulette is put off for a million segments: the picture is made in a
// blink all the same. It is black, as no lamp is inside.
TEST(Furnace, PathsInAWhiteClosedSphereEnd) {
    for (const char* method : {"path", "volumetric", "distribution", "bidirectional"}) {
        const auto image = render_tree(
            scene({node("integrator", method, {{"rr_depth", std::int64_t{1'000'000}}}),
                   perspective(look_at({0, 0, 0}, {0, 0, 1}, {0, 1, 0}), 60, 4, 4, 1),
                   node("shape", "sphere", {}, {node("bsdf", "twosided", {}, {diffuse(1.0)})}), constant_light()}));
        EXPECT_EQ(mean_stokes(image)[0], 0.0) << method;
    }
}

TEST(Furnace, PerfectMirrorVanishes) {
    const auto image = render_tree(
        scene({path(-1, {{"rr_depth", std::int64_t{100}}}),
               perspective(look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}), 20, 8, 8, 4),
               node("shape", "sphere", {}, {node("bsdf", "conductor", {{"material", std::string("none")}})}),
               constant_light()}));
    // Single precision amplitudes of modulus one.
    EXPECT_NEAR(mean_stokes(image)[0], 1.0, 1e-5);
    EXPECT_LT(mean_stokes(image).tail<3>().norm(), 1e-5);
}

// E = I cos / r^2 under a point of intensity I = Phi / (4 pi); radiance rho E / pi. Doubling the distance quarters it.
TEST(Radiometry, PointLightObeysTheInverseSquareAndCosineLaws) {
    for (double height : {2.0, 4.0}) {
        const auto image = render_tree(
            scene({path(2), needle({0, 0, 9}, {0, 0, 0}, {0, 1, 0}, 16), floor(diffuse(0.8)),
                   node("emitter", "point", {{"position", Vector3d(1.5, 0, height)}, uniform("intensity", 3)})}));
        const double r2 = 1.5 * 1.5 + height * height, cos = height / std::sqrt(r2);
        // No randomness but the place in the pixel (1e-4 of the picture's width); the bins are filled by chance: 16
        // samples a pixel put 4 into each bin, in equal numbers by stratification.
        EXPECT_NEAR(mean_stokes(image)[0], 0.8 / pi * 3 * cos / r2, 1e-4 * 0.8 * 3 / r2);
    }
}

// Irradiance under a parallel square of half width a at height h: four times the view factor of a corner (Siegel &
// Howell, configuration 1), both ways of sampling mixed.
TEST(Radiometry, AreaLightGivesItsViewFactor) {
    const double a = 1.0, h = 1.3;
    const auto image = render_tree(
        scene({path(2), needle({0, -4, 4}, {0, 0, 0}, {0, 0, 1}, 1024), floor(diffuse(0.6)),
               node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(translate({0, 0, h}) * rotate_x(180))}},
                    {diffuse(0.0), node("emitter", "area", {uniform("radiance", 2)})})}));
    const double s = a / h, t = s / std::sqrt(1 + s * s);
    const double corner = (t * std::atan(t) + t * std::atan(t)) / (2 * pi);
    // 16384 stratified samples of an integrand that varies by its own size: below 3 / sqrt(16384) even unstratified.
    EXPECT_NEAR(mean_stokes(image)[0], 0.6 * 2 * 4 * corner, 0.6 * 2 * 4 * corner * 0.01);
}

// A sphere of radiance L and radius R at distance d: E = pi L (R/d)^2.
TEST(Radiometry, SphereLightGivesItsSolidAngle) {
    const auto image = render_tree(scene({path(2), needle({0, -4, 4}, {0, 0, 0}, {0, 0, 1}, 256), floor(diffuse(0.5)),
                                          node("shape", "sphere", {{"center", Vector3d(0, 0, 3)}, {"radius", 0.7}},
                                               {node("emitter", "area", {uniform("radiance", 5)})})}));
    const double expected = 0.5 * 5 * 0.49 / 9;
    EXPECT_NEAR(mean_stokes(image)[0], expected, 0.01 * expected);
}

// Colour of a uniform spectrum without white balance (the numbers users compare with).
TEST(Radiometry, UniformSpectrumHasItsLinearSrgb) {
    const auto image = render_tree(scene({path(1), needle({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 256, 8), constant_light()}));
    const Eigen::Vector3d expected(1.205, 0.948, 0.909);
    for (int c = 0; c < 3; ++c) {
        double mean = 0;
        for (std::size_t p = 0; p < image.pixel_count(); ++p) mean += image.stokes_rgb(p)[c] / image.pixel_count();
        // Given to three decimals; wavelengths are stratified in 256 steps a pixel.
        EXPECT_NEAR(mean, expected[c], 2e-3);
    }
}

TEST(Determinism, SameSeedGivesTheSameBitsForOneAndTwoThreads) {
    const Node tree = scene({path(6), perspective(look_at({0, -6, 4}, {0, 0, 1}, {0, 0, 1}), 40, 40, 24, 8, "gaussian"),
                             floor(diffuse(0.6)),
                             node("shape", "sphere", {{"center", Vector3d(0, 0, 1)}},
                                  {node("bsdf", "roughconductor", {{"material", std::string("Au")}, {"alpha", 0.2}})}),
                             node("emitter", "point", {{"position", Vector3d(3, -3, 5)}, uniform("intensity", 30)}),
                             constant_light(0.1)});
    set_thread_count(1);
    const auto one = render_tree(tree);
    set_thread_count(2);
    const auto two = render_tree(tree);
    set_thread_count(0);
    EXPECT_EQ(one.spectral, two.spectral);
    EXPECT_EQ(one.rgb, two.rgb);
    RenderOptions other_seed;
    other_seed.seed = 1;
    EXPECT_NE(one.spectral, render_tree(tree, other_seed).spectral);
}

Node small_scene() {
    return scene({path(3), perspective(look_at({0, -6, 4}, {0, 0, 1}, {0, 0, 1}), 40, 20, 12, 64), floor(diffuse(0.6)),
                  node("emitter", "point", {{"position", Vector3d(3, -3, 5)}, uniform("intensity", 30)}),
                  constant_light()});
}

// A crop is the very window of the whole picture.
TEST(Determinism, CropHasThePixelsOfTheWhole) {
    RenderOptions options;
    const auto whole = render_tree(small_scene(), options);
    options.crop = {5, 3, 17, 9};
    const auto crop = render_tree(small_scene(), options);
    ASSERT_EQ(crop.width, 12);
    ASSERT_EQ(crop.height, 6);
    EXPECT_EQ(crop.crop_x, 5);
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 12; ++x)
            for (int i = 0; i < 12; ++i)
                EXPECT_EQ(crop.stokes_rgb(crop.pixel_index(x, y))[i],
                          whole.stokes_rgb(whole.pixel_index(x + 5, y + 3))[i]);
}

TEST(Stopping, LeavesThePassesDoneAndSaysSo) {
    CancelToken cancel;
    JobControl control;
    control.cancel = &cancel;
    control.progress = [&](const ProgressReport& report) {
        if (report.done >= 4) cancel.request_stop();
    };
    const auto image = render(*build_scene(*small_scene(), {}), {}, control);
    EXPECT_EQ(image.metadata.at("stopped"), "yes");
    EXPECT_EQ(image.sample_count[0], 4u);
    EXPECT_GT(image.stokes_rgb(0)[1], 0);

    RenderOptions options;
    options.noise_target = 0.05;
    const auto quiet = render_tree(small_scene(), options);
    EXPECT_LE(std::stod(quiet.metadata.at("relative_noise")), 0.05);
    EXPECT_EQ(quiet.metadata.count("stopped"), 0u);
}

TEST(BadScenes, AreRefusedWithTheNearestName) {
    const auto message = [](const Node& tree) -> std::string {
        try {
            build_scene(*tree, {});
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input);
            return error.what();
        }
        return "accepted";
    };
    const auto with = [](Node extra) {
        return scene({needle({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 1), constant_light(), extra});
    };
    using testing::HasSubstr;
    EXPECT_THAT(message(with(node("shape", "spher"))), HasSubstr("sphere"));
    EXPECT_THAT(message(with(node("shape", "sphere", {{"radus", 1.0}}))), HasSubstr("radius"));
    EXPECT_THAT(message(with(node("shape", "sphere", {{"radius", -1.0}}))), HasSubstr("positive"));
    EXPECT_THAT(message(with(node("shape", "sphere", {{"to_world", Eigen::Matrix4d(scale(1, 2, 1))}}))),
                HasSubstr("stretched"));
    EXPECT_THAT(message(with(node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(scale(0, 1, 1))}}))),
                HasSubstr("degenerate"));
    EXPECT_THAT(message(with(node("shape", "sphere", {}, {node("bsdf", "conducter")}))), HasSubstr("conductor"));
    EXPECT_THAT(message(with(node("shape", "sphere", {}, {diffuse(1.5)}))), HasSubstr("1.5"));
    EXPECT_THAT(message(with(node("shape", "sphere", {}, {node("bsdf", "roughconductor", {{"alpha", 0.0}})}))),
                HasSubstr("roughness"));
    EXPECT_THAT(message(with(node("emitter", "area"))), HasSubstr("shape"));
    EXPECT_THAT(message(scene({constant_light()})), HasSubstr("sensor"));
    EXPECT_THAT(message(scene({needle({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 1)})), HasSubstr("dark"));
}

}  // namespace
}  // namespace patina::render::test
