// Integrators against each other: equal means by a t test whose false-alarm rate is stated, over all scenes, blocks of
// pixels and Stokes components together.
//
// Each picture is rendered several times with independent seeds; blocks of it are compared by Welch's t with its
// degrees of freedom, and the smallest p of a pair of pictures is judged by Bonferroni's rule at 1e-5 a pair: with some
// thirty pairs in this file a false alarm has a chance below 3e-4. The seeds are fixed, so what passes once, passes.

#include <algorithm>

#include <gtest/gtest.h>

#include "patina/core/parallel.h"
#include "patina/render/test_support.h"

namespace patina::render {
namespace {

using namespace test;
using Eigen::Vector3d;

constexpr double false_alarm_rate = 1e-5;
constexpr int replicates = 8, size = 8, block = 4;

// Two-sided tail of Student's distribution, by Simpson's rule on t = sqrt(n) tan(a): the density is cos^(n-1).
double student_tail(double t, double n) {
    const double edge = std::atan(std::abs(t) / std::sqrt(n));
    const auto integral = [&](double a, double b) {
        constexpr int steps = 2000;
        double sum = 0;
        for (int i = 0; i <= steps; ++i)
            sum += (i == 0 || i == steps ? 1 : i % 2 ? 4 : 2) * std::pow(std::cos(a + (b - a) * i / steps), n - 1);
        return sum * (b - a) / steps;
    };
    const double quarter = std::acos(0.0) - 1e-12;
    return integral(edge, quarter) / integral(0, quarter);
}

// [quantity][replicate]: mean over blocks of 4 x 4 pixels and all wavelengths, of each Stokes component.
using Measurements = std::vector<std::vector<double>>;

void append(const StokesImage& image, Measurements& all) {
    const int across = size / block;
    all.resize(across * across * 4);
    std::vector<double> sums(all.size(), 0.0);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            for (int b = 0; b < image.bin_count(); ++b)
                for (int k = 0; k < 4; ++k)
                    sums[((y / block) * across + x / block) * 4 + k] +=
                        image.stokes(image.pixel_index(x, y), b)[k] / (image.bin_count() * block * block);
    for (std::size_t i = 0; i < sums.size(); ++i) all[i].push_back(sums[i]);
}

Measurements measure(const Scene& scene, const std::string& integrator, int samples, const std::string& part = "",
                     int first_seed = 0) {
    Measurements all;
    for (int r = 0; r < replicates; ++r) {
        RenderOptions options;
        options.integrator = integrator;
        options.samples_per_pixel = samples;
        options.seed = 1000 + first_seed + r;
        if (!part.empty()) options.light_paths = {{"part", part}};
        const Pictures pictures = render_parts(scene, options);
        append(part.empty() ? pictures.whole : pictures.parts[0].second, all);
    }
    return all;
}

// The smallest p value of all comparisons times their number; where both are exact (nothing varies) they must be equal.
double corrected_p(const Measurements& a, const Measurements& b) {
    double smallest = 1;
    for (std::size_t i = 0; i < a.size(); ++i) {
        double mean[2] = {0, 0}, variance[2] = {0, 0};
        const std::vector<double>* values[2] = {&a[i], &b[i]};
        for (int j = 0; j < 2; ++j) {
            for (double v : *values[j]) mean[j] += v / replicates;
            for (double v : *values[j])
                variance[j] += (v - mean[j]) * (v - mean[j]) / (replicates * (replicates - 1.0));
        }
        const double spread = variance[0] + variance[1], difference = mean[0] - mean[1];
        // Single precision leaves 1e-6 of the intensity.
        if (std::abs(difference) < 1e-6 * (1e-3 + std::abs(a[i / 4 * 4][0]))) continue;
        if (spread == 0) return 0;
        const double freedom =
            spread * spread / ((variance[0] * variance[0] + variance[1] * variance[1]) / (replicates - 1.0));
        const double p = student_tail(difference / std::sqrt(spread), freedom);
        smallest = std::min(smallest, p * static_cast<double>(a.size()));
    }
    return smallest;
}

void expect_agreement(const Measurements& a, const Measurements& b, const std::string& what) {
    EXPECT_GT(corrected_p(a, b), false_alarm_rate) << what;
}

// How well the mean picture is known: the largest standard error of a block's intensity over the mean intensity. A test
// that knows nothing cannot fail.
double relative_error(const Measurements& a) {
    double largest = 0, total = 0;
    for (std::size_t i = 0; i < a.size(); i += 4) {
        double mean = 0, variance = 0;
        for (double v : a[i]) mean += v / replicates;
        for (double v : a[i]) variance += (v - mean) * (v - mean) / (replicates * (replicates - 1.0));
        largest = std::max(largest, std::sqrt(variance));
        total += mean / (a.size() / 4.0);
    }
    return largest / total;
}

// By how many standard errors a Stokes component differs from zero, in the block where it does most.
double significance(const Measurements& a, int component) {
    double largest = 0;
    for (std::size_t i = component; i < a.size(); i += 4) {
        double mean = 0, variance = 0;
        for (double v : a[i]) mean += v / replicates;
        for (double v : a[i]) variance += (v - mean) * (v - mean) / (replicates * (replicates - 1.0));
        if (variance > 0) largest = std::max(largest, std::abs(mean) / std::sqrt(variance));
    }
    return largest;
}

Node lamp(double radiance, double half_width = 0.5) {
    return node(
        "shape", "rectangle",
        {{"to_world", Eigen::Matrix4d(translate({0, 0, 2}) * rotate_x(180) * scale(half_width, half_width, 1))}},
        {node("emitter", "area", {uniform("radiance", radiance)})});
}
Node floor(double reflectance) {
    return node("shape", "rectangle", {{"to_world", scale(2, 2, 1)}},
                {node("bsdf", "diffuse", {uniform("reflectance", reflectance)})});
}
Node wall(Node bsdf) {
    return node("shape", "rectangle",
                {{"to_world", Eigen::Matrix4d(translate({0, 2, 1}) * rotate_x(90) * scale(2, 2, 1))}},
                {std::move(bsdf)});
}
Node ball(double x, Node bsdf) {
    return node("shape", "sphere", {{"center", Vector3d(x, 0.3, 0.5)}, {"radius", 0.5}}, {std::move(bsdf)});
}
Node rough(double alpha = 0.3) {
    return node("bsdf", "roughconductor", {{"material", std::string("Au")}, {"alpha", alpha}});
}
Node camera() {
    return perspective(look_at({0.4, -4, 1.6}, {0, 0.5, 0.5}, {0, 0, 1}), 40, size, size, 4);
}

// Diffuse: area and point light, sky.
Node diffuse_scene() {
    return scene({path(5), camera(), lamp(4), floor(0.7), wall(node("bsdf", "diffuse", {uniform("reflectance", 0.5)})),
                  ball(0, node("bsdf", "diffuse", {uniform("reflectance", 0.8)})),
                  node("emitter", "constant", {uniform("radiance", 0.2)}),
                  node("emitter", "point", {{"position", Vector3d(-1.5, -1, 1.5)}, uniform("intensity", 1)}),
                  node("emitter", "directional", {{"direction", Vector3d(1, 1, -1)}, uniform("irradiance", 0.3)})});
}

// Polarized: rough gold surfaces light each other, at oblique angles.
Node glossy_scene() {
    return scene(
        {path(4), camera(), lamp(6, 0.8), floor(0.6), wall(rough(0.4)), ball(0.5, rough()), ball(-0.6, rough(0.5))});
}

// Polarized and specular: a glass and a gold ball, a polarizer and a quarter-wave plate before the lamp's light.
Node specular_scene() {
    const Node plate =
        node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(translate({0, 0, 1.6}) * scale(1.5, 1.5, 1))}},
             {node("bsdf", "polarizer", {{"theta", 30.0}})});
    const Node wave =
        node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(translate({0, 0, 1.4}) * scale(1.5, 1.5, 1))}},
             {node("bsdf", "retarder", {{"theta", 80.0}, {"delta", 90.0}})});
    return scene({path(6), camera(), lamp(6, 0.8), plate, wave, floor(0.6), wall(rough(0.4)),
                  ball(0.6, node("bsdf", "dielectric", {{"int_ior", 1.5}})),
                  ball(-0.6, node("bsdf", "conductor", {{"material", std::string("Al")}}))});
}

TEST(Agreement, DiffuseScene) {
    const auto scene = build_scene(*diffuse_scene(), {});
    const Measurements by_path = measure(*scene, "path", 128), by_both = measure(*scene, "bidirectional", 64, "", 100),
                       by_light = measure(*scene, "light", 256, "", 200);
    expect_agreement(by_path, by_both, "path, bidirectional");
    expect_agreement(by_path, by_light, "path, light");
    EXPECT_LT(relative_error(by_path), 0.01);
    EXPECT_LT(relative_error(by_both), 0.01);
    EXPECT_LT(relative_error(by_light), 0.03);
}

TEST(Agreement, PolarizedInterreflection) {
    const auto scene = build_scene(*glossy_scene(), {});
    const Measurements by_path = measure(*scene, "path", 128), by_both = measure(*scene, "bidirectional", 64, "", 100),
                       by_light = measure(*scene, "light", 256, "", 200);
    expect_agreement(by_path, by_both, "path, bidirectional");
    expect_agreement(by_path, by_light, "path, light");
    EXPECT_LT(relative_error(by_both), 0.02);

    // There is polarization to be compared.
    EXPECT_GT(significance(by_both, 1), 20);
    EXPECT_GT(significance(by_both, 2), 20);
}

TEST(Agreement, PolarizedSpecularScene) {
    const auto scene = build_scene(*specular_scene(), {});
    const Measurements by_both = measure(*scene, "bidirectional", 128, "", 100);
    expect_agreement(measure(*scene, "path", 256), by_both, "path, bidirectional");
    for (int component : {1, 2, 3}) EXPECT_GT(significance(by_both, component), 10) << component;

    // Light tracing has no E S ... L, but for what is seen directly.
    expect_agreement(measure(*scene, "path", 64, "E((D|G).*)?L"), measure(*scene, "light", 64, "", 200), "path, light");
    // The same part of the paths in both directions of work.
    expect_agreement(measure(*scene, "path", 64, "LSS+.*DE"), measure(*scene, "bidirectional", 32, "LSS+.*DE", 100),
                     "caustics");
}

// Lamps of every kind, each polarized in another way, over rough metal.
Node polarized_lamps_scene() {
    const Value linear{"polarization", std::string("linear")}, circular{"polarization", std::string("circular")};
    const Node area =
        node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(translate({0, 0, 2}) * rotate_x(180))}},
             {node("emitter", "area", {uniform("radiance", 1), {"stokes", std::string("1, 0.5, 0.3, 0.6")}})});
    const Node point =
        node("emitter", "point", {{"position", Vector3d(-1.5, -1, 1.5)}, uniform("intensity", 1), linear});
    const Node spot = node("emitter", "spot",
                           {{"to_world", look_at({1.5, -2, 2}, {0.3, 0, 0}, {0, 0, 1})},
                            {"cutoff_angle", 40.0},
                            uniform("intensity", 3),
                            circular});
    const Node sun =
        node("emitter", "directional", {{"direction", Vector3d(1, 1, -1)}, uniform("irradiance", 0.3), linear});
    const Node sky = node("emitter", "constant", {uniform("radiance", 0.2), {"polarization", std::string("rayleigh")}});
    return scene({path(4), camera(), area, point, spot, sun, sky, floor(0.6), wall(rough(0.4)), ball(0.5, rough()),
                  ball(-0.6, rough(0.5))});
}

// The state of the light reaches the camera alike from hits, light sampling and light paths.
TEST(Agreement, PolarizedLamps) {
    const auto lit = build_scene(*polarized_lamps_scene(), {});
    const Measurements by_path = measure(*lit, "path", 96), by_both = measure(*lit, "bidirectional", 48, "", 100);
    expect_agreement(by_path, by_both, "path, bidirectional");
    expect_agreement(by_path, measure(*lit, "light", 192, "", 200), "path, light");
    expect_agreement(measure(*lit, "appel", 8), measure(*lit, "path", 8, "E(D|G)L", 100), "appel");
    expect_agreement(measure(*lit, "distribution", 4), measure(*lit, "path", 16, "E(S|G)*(D|G)?L", 100),
                     "distribution");
    for (int component : {1, 2, 3}) EXPECT_GT(significance(by_path, component), 10) << component;
}

Node normal_mapped(Node bsdf) {
    const Node map = node("bsdf", "normalmap", {},
                          {std::move(bsdf), node("texture", "bitmap", {{"filename", std::string("waves")}})});
    map->children[1].name = "normalmap";
    return map;
}
// Normals up to some 17 degrees from upright.
std::shared_ptr<const Bitmap> waves() {
    Bitmap image{"waves", 8, 8, {"R", "G", "B"}, {}};
    for (int i = 0; i < 64; ++i) {
        const auto x = static_cast<float>(0.5 + 0.15 * std::sin(i * 0.7)),
                   y = static_cast<float>(0.5 + 0.1 * std::cos(i * 0.4));
        image.data.insert(image.data.end(), {x, y, 0.97f});
    }
    return std::make_shared<const Bitmap>(std::move(image));
}

// Turned normals are not reciprocal: light paths have to weigh them otherwise than camera paths.
TEST(Agreement, NormalMaps) {
    SceneResources resources;
    resources.load_bitmap = [](const std::string&, bool) { return waves(); };
    const Node mirror = normal_mapped(node("bsdf", "conductor", {{"material", std::string("Al")}}));
    const auto lit =
        build_scene(*scene({path(4), camera(), lamp(6, 0.8), floor(0.6), wall(mirror),
                            ball(0.6, normal_mapped(rough(0.4))), ball(-0.6, normal_mapped(node("bsdf", "diffuse")))}),
                    resources);
    const Measurements by_both = measure(*lit, "bidirectional", 64, "", 100);
    expect_agreement(measure(*lit, "path", 128), by_both, "path, bidirectional");
    expect_agreement(measure(*lit, "path", 128, "E(D|G).*L"), measure(*lit, "light", 128, "E(D|G).*L", 200),
                     "path, light");
    EXPECT_LT(relative_error(by_both), 0.02);
}

TEST(Agreement, RayTreesAreThePathsOfTheirGrammar) {
    for (const Node& tree : {glossy_scene(), specular_scene(), diffuse_scene()}) {
        const auto scene = build_scene(*tree, {});
        expect_agreement(measure(*scene, "appel", 8), measure(*scene, "path", 8, "E(D|G)L", 100), "appel");
        expect_agreement(measure(*scene, "whitted", 8), measure(*scene, "path", 16, "ES*(D|G)L", 100), "whitted");
        expect_agreement(measure(*scene, "distribution", 4), measure(*scene, "path", 16, "E(S|G)*(D|G)?L", 100),
                         "distribution");
    }
}

// A lens and a filter wider than a pixel, for the light path's way to the film.
TEST(Agreement, ThinLensAndFilter) {
    const Node tree = glossy_scene();
    tree->children[1].node =
        node("sensor", "thinlens",
             {{"to_world", look_at({0.4, -4, 1.6}, {0, 0.5, 0.5}, {0, 0, 1})},
              {"fov", 40.0},
              {"aperture_radius", 0.3},
              {"focus_distance", 3.0}},
             {node("film", "hdrfilm", {{"width", std::int64_t{size}}, {"height", std::int64_t{size}}},
                   {node("rfilter", "gaussian")})});
    const auto scene = build_scene(*tree, {});
    // The whole film, where the filter reaches over the edge, and a window in the middle of a larger one.
    for (const bool window : {false, true}) {
        Measurements by_path, by_light;
        for (int r = 0; r < replicates; ++r) {
            RenderOptions options;
            if (window) {
                options.size = {16, 16};
                options.crop = {4, 4, 12, 12};
            }
            options.seed = 77 + r;
            options.samples_per_pixel = 32;
            options.integrator = "path";
            append(render(*scene, options), by_path);
            options.seed = 770 + r;
            options.samples_per_pixel = 128;
            options.integrator = "light";
            append(render(*scene, options), by_light);
        }
        expect_agreement(by_path, by_light, window ? "window" : "whole film");
    }
}

TEST(Agreement, RadiosityOfTheDiffuseScene) {
    const Node tree = diffuse_scene();
    tree->children[0].node = path(-1);
    const auto scene = build_scene(*tree, {});
    const Measurements by_path = measure(*scene, "path", 64), by_patches = measure(*scene, "radiosity", 64, "", 100);
    expect_agreement(by_path, by_patches, "path, radiosity");
}

Node closed_sphere(const std::string& solver, double reflectance) {
    const Node inside = node("shape", "sphere", {{"flip_normals", true}},
                             {node("bsdf", "diffuse", {uniform("reflectance", reflectance)}),
                              node("emitter", "area", {uniform("radiance", 1)})});
    return scene(
        {node("integrator", "radiosity",
              {{"solver", solver}, {"gather", false}, {"patches", std::int64_t{100}}, {"rays", std::int64_t{64}}}),
         perspective(look_at({0, 0.2, 0}, {1, 0, 0}, {0, 0, 1}), 60, 2, 2, 1), inside});
}

// A closed room of one reflectance that shines: L = L_e / (1 - rho), and patches have it exactly, for the rows of form
// factors add up to one.
TEST(Radiosity, FurnaceIsExactWithEverySolver) {
    for (const char* solver : {"lu", "jacobi", "gauss_seidel", "neumann"}) {
        const StokesImage image = render(*build_scene(*closed_sphere(solver, 0.75), {}), {});
        // The mean over all bins has no noise of wavelengths. 1e-5: single precision of what is stored.
        double mean = 0;
        for (std::size_t i = 0; i < image.spectral.size(); i += 4)
            mean += 4 * image.spectral[i] / image.spectral.size();
        EXPECT_NEAR(mean, 4, 4e-5) << solver;
    }
}

TEST(Radiosity, RefusesWhatItCannotDo) {
    RenderOptions options;
    options.integrator = "radiosity";
    const auto message = [&](const Node& tree, const RenderOptions& with) {
        try {
            render(*build_scene(*tree, {}), with);
        } catch (const std::exception& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(message(glossy_scene(), options).find("the scene has a \"roughconductor\""), std::string::npos);
    options.neumann_terms = 3;
    EXPECT_NE(message(diffuse_scene(), options).find("does not follow single paths"), std::string::npos);
    EXPECT_NE(message(closed_sphere("cholesky", 0.5), {}).find("unknown solver"), std::string::npos);
}

// The test itself finds a wrong picture: reflectance off by 3 %.
TEST(Agreement, FindsAnErrorOfThreePercent) {
    const Node wrong = diffuse_scene();
    wrong->children[3].node = floor(0.72);
    EXPECT_LT(corrected_p(measure(*build_scene(*diffuse_scene(), {}), "path", 128),
                          measure(*build_scene(*wrong, {}), "bidirectional", 64, "", 100)),
              false_alarm_rate);
}

TEST(Agreement, SplatsDoNotDependOnThreads) {
    const auto scene = build_scene(*specular_scene(), {});
    for (const char* integrator : {"light", "bidirectional", "distribution"}) {
        std::vector<float> first;
        for (int threads : {1, 2}) {
            set_thread_count(threads);
            RenderOptions options;
            options.integrator = integrator;
            options.size = {40, 40};
            options.samples_per_pixel = 2;
            const StokesImage image = render(*scene, options);
            if (threads == 1) first = image.spectral;
            EXPECT_EQ(first, image.spectral) << integrator;
        }
    }
    set_thread_count(0);
}

}  // namespace
}  // namespace patina::render
