// Media in closed form: Beer's law, furnaces, single scattering, and wavelengths that do not disturb each other.

#include <gtest/gtest.h>

#include "patina/render/test_support.h"

namespace patina::render::test {
namespace {

using Eigen::Vector3d;

Node homogeneous(std::vector<Value> values, Node phase = node("phase", "isotropic")) {
    return node("medium", "homogeneous", std::move(values), {std::move(phase)});
}
Node filled(Node shape, Node medium) {
    shape->children.push_back({"interior", std::move(medium)});
    return shape;
}
// A ball of a medium with nothing at its surface.
Node cloud(Node medium, double radius = 1) {
    return filled(node("shape", "sphere", {{"radius", radius}}, {node("bsdf", "null")}), std::move(medium));
}
Node volumetric(int max_depth = -1) {
    return node("integrator", "volumetric", {{"max_depth", std::int64_t{max_depth}}});
}
// Looks along +y at the origin, every pixel in the same direction to 1e-4.
Node needle(int samples, int pixels = 8) {
    return perspective(look_at({0, -20, 0}, {0, 0, 0}, {0, 0, 1}), 0.001, pixels, pixels, samples);
}
Node all_around(double radiance = 1) {
    return node("emitter", "constant", {uniform("radiance", radiance)});
}
StokesImage picture(std::vector<Node> children, RenderOptions options = {}) {
    return render(*build_scene(*scene(std::move(children)), {}), options);
}
// Mean Stokes vector of a spectral bin over the picture.
Eigen::Vector4d mean(const StokesImage& image, int bin) {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (std::size_t p = 0; p < image.pixel_count(); ++p)
        sum += Eigen::Map<const Eigen::Vector4f>(image.stokes(p, bin)).cast<double>();
    return sum / static_cast<double>(image.pixel_count());
}
Eigen::Vector4d mean(const StokesImage& image) {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (int b = 0; b < image.bin_count(); ++b) sum += mean(image, b);
    return sum / image.bin_count();
}

TEST(Volumetric, AbsorbsByBeersLawAtEveryWavelength) {
    const auto image =
        picture({volumetric(), needle(512), all_around(2),
                 cloud(homogeneous({sampled("sigma_t", {380, 780}, {0.1, 2.1}), uniform("albedo", 0)}))});
    for (int b = 0; b < image.bin_count(); ++b) {
        // A bin of 25 nm: the mean of exp(-2 sigma) over it.
        double expected = 0;
        for (int i = 0; i < 25; ++i) expected += 2 * std::exp(-2 * (0.1 + 2.0 * (25 * b + i + 0.5) / 400)) / 25;
        // Which wavelengths fall into a bin is random: 4096 paths with four each in 16 bins, stratified; and a path
        // that meets a particle brings nothing. Some 1 %.
        EXPECT_NEAR(mean(image, b)[0], expected, 0.06 * expected + 0.01) << b;
    }
}

// A medium that absorbs nothing is not to be seen in uniform light, whatever its phase function; polarization averages
// out. With a dark environment and a lamp all around, light sampling and its weights are tested by the same law.
TEST(Volumetric, NothingIsLostInTheFurnace) {
    const auto lamp = [] {
        return node(
            "shape", "sphere", {{"radius", 30.0}, {"flip_normals", true}},
            {node("emitter", "area", {uniform("radiance", 1)}), node("bsdf", "diffuse", {uniform("reflectance", 0)})});
    };
    for (const Node& phase : {node("phase", "isotropic"), node("phase", "rayleigh"), node("phase", "hg", {{"g", 0.7}})})
        for (const Node& light : {all_around(), lamp()}) {
            const auto image = picture({volumetric(), needle(64), light,
                                        cloud(homogeneous({uniform("sigma_t", 2.5), uniform("albedo", 1)}, phase))});
            const Eigen::Vector4d found = mean(image);
            // Every path brings 1 when found by chance; with a lamp's samples and their weights the spread is about 0.5
            // a path: 4096 paths.
            EXPECT_NEAR(found[0], 1, 0.03) << phase->type << " " << light->category;
            EXPECT_LT(found.tail<3>().norm(), 0.03);
        }
}

// Extinction that varies strongly with the wavelength: each wavelength sees what it would see alone.
TEST(Volumetric, WavelengthsDoNotDisturbEachOther) {
    const auto ball = [](const Value& sigma_t) {
        return cloud(homogeneous({sigma_t, uniform("albedo", 0.9)}, node("phase", "hg", {{"g", 0.5}})));
    };
    const auto lamp = [] {
        return node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(translate({0, 0, -6}) * scale(4, 4, 1))}},
                    {node("emitter", "area", {uniform("radiance", 1)})});
    };
    const auto together =
        picture({volumetric(), needle(2048), all_around(0.2), lamp(), ball(sampled("sigma_t", {380, 780}, {0.0, 8.0}))});
    for (int b : {0, 5, 15}) {
        RenderOptions one_bin;
        one_bin.bin_edges_nm = {380, 780};
        const double sigma_t = 8 * (25 * b + 12.5) / 400;
        const auto alone =
            picture({volumetric(), needle(512), all_around(0.2), lamp(), ball(uniform("sigma_t", sigma_t))}, one_bin);
        // 131072 paths with a quarter of a wavelength each in the bin, and 32768: 0.6 %; the bin's width 0.3 %.
        EXPECT_NEAR(mean(together, b)[0] / mean(alone, 0)[0], 1, 0.02) << sigma_t;
    }
}

// Sunlit air: the Stokes vector of single scattering is that of one dipole, at every angle.
TEST(Volumetric, ThinRayleighCloudLooksLikeTheSky) {
    const double sigma = 0.01, irradiance = 10;
    for (double angle_deg : {60.0, 90.0, 120.0}) {
        const double theta = radians(angle_deg);
        // Light travels so that it must turn by theta to go to the camera, which looks along +y with x right, z up.
        const Vector3d travel(std::sin(theta), -std::cos(theta), 0);
        const auto image =
            picture({volumetric(2), needle(2048),
                     node("emitter", "directional", {{"direction", travel}, uniform("irradiance", irradiance)}),
                     cloud(homogeneous({uniform("sigma_t", sigma), uniform("albedo", 1)}, node("phase", "rayleigh")))});
        const Eigen::Vector4d found = mean(image);
        const double c2 = std::cos(theta) * std::cos(theta), s2 = 1 - c2;
        // Radiance = E P/(4 pi) sigma times the chord of 2, less the losses of some 1 % on the way; 2600 of the paths
        // meet a particle: 2 %, better for being stratified.
        EXPECT_NEAR(found[0] / (irradiance * 0.75 * (1 + c2) / (4 * pi) * sigma * 2), 1, 0.05);
        // It vibrates across the plane of scattering, which is horizontal: S1 < 0 upright. No statistics here.
        EXPECT_NEAR(found[1] / found[0], -s2 / (1 + c2), 2e-4) << "single precision and the needle's width";
        EXPECT_NEAR(found[2] / found[0], 0, 2e-4);
        EXPECT_NEAR(found[3] / found[0], 0, 1e-6);
    }
}

// The axis of polarization turns with the sun: it stays across the plane of scattering.
TEST(Volumetric, SkylightVibratesAcrossThePlaneOfScattering) {
    const Vector3d travel(-std::sqrt(0.75), 0, -0.5);  // from the upper right of the picture, at 30 degrees
    const auto image = picture(
        {volumetric(2), needle(16), node("emitter", "directional", {{"direction", travel}, uniform("irradiance", 1)}),
         cloud(homogeneous({uniform("sigma_t", 0.01), uniform("albedo", 1)}, node("phase", "rayleigh")))});
    const Eigen::Vector4d found = mean(image);
    // At 120 degrees from right towards up.
    EXPECT_NEAR(found[1] / found[0], std::cos(radians(240.0)), 2e-4);
    EXPECT_NEAR(found[2] / found[0], std::sin(radians(240.0)), 2e-4);
}

TEST(Volumetric, ScatteringInAMediumIsAnEventOfItsOwn) {
    RenderOptions options;
    options.light_paths = {{"direct", "EL"}, {"once", "EVL"}, {"more", "EVV+L"}, {"surfaces", "E.*(D|G|S).*L"}};
    const auto tree = scene(
        {volumetric(), needle(16, 4), all_around(), cloud(homogeneous({uniform("sigma_t", 1), uniform("albedo", 1)}))});
    const Pictures pictures = render_parts(*build_scene(*tree, {}), options);
    const auto part = [&](std::size_t i) { return mean(pictures.parts[i].second)[0]; };
    EXPECT_NEAR(part(0), std::exp(-2.0), 0.06);  // 256 paths
    EXPECT_GT(part(1), 0.1);
    EXPECT_GT(part(2), 0.1);
    EXPECT_EQ(part(3), 0);  // `null` is no event
    for (std::size_t i = 0; i < pictures.whole.spectral.size(); ++i)
        ASSERT_EQ(pictures.whole.spectral[i], pictures.parts[0].second.spectral[i] +
                                                  pictures.parts[1].second.spectral[i] +
                                                  pictures.parts[2].second.spectral[i]);
}

// Without media it is path tracing.
TEST(Volumetric, IsPathTracingWithoutMedia) {
    const auto with = [](Node integrator) {
        return picture(
            {std::move(integrator), perspective(look_at({0, -5, 1.5}, {0, 0, 0}, {0, 0, 1}), 30, 8, 8, 256),
             all_around(0.3), node("emitter", "point", {{"position", Vector3d(2, -3, 4)}, uniform("intensity", 30)}),
             node("shape", "sphere", {}, {node("bsdf", "dielectric", {{"int_ior", std::string("water")}})}),
             node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(translate({0, 0, -1}) * scale(5, 5, 1))}},
                  {node("bsdf", "roughconductor", {{"material", std::string("Au")}, {"alpha", 0.3}})})});
    };
    const Eigen::Vector4d a = mean(with(path(6))), b = mean(with(volumetric(6)));
    // 16384 paths of about unit spread.
    EXPECT_NEAR(b[0] / a[0], 1, 0.02);
    EXPECT_LT((b - a).tail<3>().norm(), 0.02 * a[0]);
}

// The camera in a fog: the sun's glare at single scattering, in closed form.
TEST(Volumetric, CameraMayStandInAMedium) {
    const Node fog = homogeneous({uniform("sigma_t", 0.5), uniform("albedo", 0)});
    const auto sensor = needle(64);
    sensor->children.push_back({"", fog});
    const auto wall = node("shape", "rectangle",
                           {{"to_world", Eigen::Matrix4d(translate({0, -17, 0}) * rotate_x(90) * scale(9, 9, 1))}},
                           {node("emitter", "area", {uniform("radiance", 3)})});
    EXPECT_NEAR(mean(picture({volumetric(), sensor, wall}))[0], 3 * std::exp(-0.5 * 3), 0.05);  // 4096 paths
}

TEST(Volumetric, OtherIntegratorsRefuseMedia) {
    EXPECT_THROW(picture({path(5), needle(1, 1), all_around(), cloud(homogeneous({}))}), Error);
    // None named: the one that can.
    EXPECT_NO_THROW(picture({needle(1, 1), all_around(), cloud(homogeneous({}))}));
}

TEST(Volumetric, BadMediaAreNamed) {
    const auto fails = [](Node medium) {
        EXPECT_THROW(picture({volumetric(), needle(1, 1), all_around(), cloud(std::move(medium))}), Error);
    };
    fails(homogeneous({uniform("sigma_t", -1)}));
    fails(homogeneous({uniform("albedo", 1.5)}));
    fails(homogeneous({uniform("sigma_t", 1), uniform("sigma_s", 1)}));
    fails(homogeneous({{"scale", -2.0}}));
    fails(homogeneous({{"scales", 2.0}}));
    fails(homogeneous({}, node("phase", "hg", {{"g", 1.5}})));
    fails(homogeneous({}, node("phase", "rayleigh", {{"depolarization", 0.9}})));
    fails(homogeneous({}, node("phase", "mie", {{"radius_um", 0.1}})));
    fails(homogeneous({}, node("phase", "mie", {{"radius_um", -0.1}, uniform("eta", 2), uniform("k", 0)})));
    fails(homogeneous({}, node("phase", "rayleig")));
    fails(node("bsdf", "diffuse"));
}

}  // namespace
}  // namespace patina::render::test
