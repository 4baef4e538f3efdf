// What scenes of other people use beside the plain models: textures of light and roughness, cylinders, filters with
// lobes, further channels. Each against a closed form.

#include "render_scenes.h"
#include <gtest/gtest.h>

#include "patina/render/bsdf_set.h"
#include "patina/render/film.h"

namespace patina::render::test {
namespace {

using Eigen::Vector3d;

constexpr double visible_nm = 400;  // 380 .. 780 nm

SceneResources with_picture(Bitmap picture) {
    SceneResources resources;
    const auto shared = std::make_shared<const Bitmap>(std::move(picture));
    resources.load_bitmap = [shared](const std::string&, bool) { return shared; };
    return resources;
}
Node bitmap(std::vector<Value> values = {}) {
    values.push_back({"filename", std::string("picture")});
    return node("texture", "bitmap", std::move(values));
}
Node named(Node parent, std::size_t child, std::string name) {
    parent->children[child].name = std::move(name);
    return parent;
}
Node black() {
    return node("bsdf", "diffuse", {uniform("reflectance", 0)});
}
// A meter of irradiance at a place, of 256 pixels, whose outside is +z turned by `to_world`.
Node irradiance_meter(const Eigen::Matrix4d& to_world) {
    return node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(to_world * scale(1e-3, 1e-3, 1))}},
                {black(), node("sensor", "irradiancemeter")});
}
double irradiance(const Node& tree, const std::string& integrator, int samples, const SceneResources& resources = {}) {
    RenderOptions options;
    options.integrator = integrator;
    options.samples_per_pixel = samples;
    return render_parts(*build_scene(*tree, resources), options).measurement->radiometric[0] / visible_nm;
}

// Irradiance under a corner of a parallel rectangle of radiance 1 (Siegel & Howell, configuration 3).
double under_corner(double width, double length, double height) {
    const double x = width / height, y = length / height, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
    return 0.5 * (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry));
}

// A square lamp over the meter, corner above it, that shines with 3 on the side of u < 1/2 and not on the other.
TEST(TexturedLamp, IlluminatesByTheIntegralOfItsTexture) {
    const double height = 1.2;
    const Node emitter = named(
        node("emitter", "area", {}, {bitmap({{"raw", true}, {"filter_type", std::string("nearest")}})}), 0, "radiance");
    const Node lamp =
        node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(translate({0, 0, height}) * rotate_x(180))}},
             {black(), emitter});
    const SceneResources halves = with_picture({"halves", 2, 1, {"Y"}, {3.0f, 0.0f}});
    // The bright half is 1 wide along x and 2 long.
    for (const auto& [x, expected] : {std::pair{-1.0, 3 * under_corner(1, 2, height)},
                                      {1.0, 3 * (under_corner(2, 2, height) - under_corner(1, 2, height))}})
        for (const char* integrator : {"path", "bidirectional", "light"}) {
            const Node tree = scene({path(2), irradiance_meter(translate({x, -1, 0})), lamp});
            // 256 x 256 points of an integrand that varies by its own size: 0.4 %, less for what is stratified; 4 sigma
            // for the light of one kind of sampling alone.
            EXPECT_NEAR(irradiance(tree, integrator, 256, halves), expected, 0.016 * expected)
                << integrator << " x = " << x;
        }
}

// The floor under the same lamp, seen by a meter beside the lamp: paths from the meter and from the lamp agree.
TEST(TexturedLamp, ShinesAlikeFromEitherEnd) {
    const Node emitter = named(
        node("emitter", "area", {}, {bitmap({{"raw", true}, {"filter_type", std::string("nearest")}})}), 0, "radiance");
    const SceneResources halves = with_picture({"halves", 2, 1, {"Y"}, {3.0f, 0.0f}});
    const Node tree =
        scene({path(3), irradiance_meter(translate({-1.5, 0, 1}) * rotate_x(180)),
               node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(scale(2, 2, 1))}},
                    {node("bsdf", "diffuse", {uniform("reflectance", 0.8)})}),
               node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(translate({0, 0, 1.2}) * rotate_x(180))}},
                    {black(), emitter})});
    const double expected = irradiance(tree, "path", 256, halves);
    // 65536 paths each, whose weights vary by a few times their mean: 4 sigma of some 1 % and a half.
    EXPECT_NEAR(irradiance(tree, "light", 256, halves), expected, 0.06 * expected);
    EXPECT_GT(expected, 0.1);
}

// On a sphere and on a cylinder: a texture that is the same everywhere is a number.
TEST(TexturedLamp, OfOneColourIsAPlainLamp) {
    const SceneResources two = with_picture({"two", 2, 2, {"Y"}, {2.0f, 2.0f, 2.0f, 2.0f}});
    for (const char* shape : {"sphere", "disk", "cube", "cylinder"}) {
        const auto lamp = [&](Node emitter) {
            return scene({path(2), irradiance_meter(translate({3, 0.1, 3}) * rotate_x(180)),
                          node("shape", shape, {}, {emitter})});
        };
        const Node plain = node("emitter", "area", {uniform("radiance", 2)});
        const Node textured = named(node("emitter", "area", {}, {bitmap({{"raw", true}})}), 0, "radiance");
        // The very same rays.
        for (const char* integrator : {"path", "light"})
            EXPECT_NEAR(irradiance(lamp(textured), integrator, 4, two), irradiance(lamp(plain), integrator, 4),
                        1e-5 * irradiance(lamp(plain), integrator, 4))
                << shape << " " << integrator;
    }
}

// Radiosity has one radiance a patch, and says so.
TEST(TexturedLamp, IsRefusedByRadiosity) {
    const SceneResources two = with_picture({"two", 2, 1, {"Y"}, {2.0f, 0.0f}});
    const Node textured = named(node("emitter", "area", {}, {bitmap({{"raw", true}})}), 0, "radiance");
    EXPECT_THROW(irradiance(scene({path(2), irradiance_meter(translate({0, 0, -1})),
                                   node("shape", "rectangle", {}, {black(), textured})}),
                            "radiosity", 1, two),
                 Error);
}

// A black cylinder of radius 1 and length l that shines with 1, seen by an element at the distance d from its axis, in
// the plane of its end, that looks at the axis (Howell, A catalog of radiation heat transfer configuration factors,
// B-31).
TEST(Cylinder, GivesItsViewFactor) {
    const double d = 2, l = 1.5, a = (d + 1) * (d + 1) + l * l, b = (d - 1) * (d - 1) + l * l;
    const double factor =
        std::atan(l / std::sqrt(d * d - 1)) / (pi * d) +
        l / pi *
            ((a - 2 * d) / (d * std::sqrt(a * b)) * std::atan(std::sqrt(a * (d - 1) / (b * (d + 1)))) -
             std::atan(std::sqrt((d - 1) / (d + 1))) / d);
    // The meter looks along +z towards a cylinder along x.
    const Node tree = scene({path(2), irradiance_meter(Eigen::Matrix4d::Identity()),
                             node("shape", "cylinder", {{"p0", Vector3d(0, 0, d)}, {"p1", Vector3d(l, 0, d)}},
                                  {black(), node("emitter", "area", {uniform("radiance", 1)})})});
    // As above; both of the path tracer's ways.
    EXPECT_NEAR(irradiance(tree, "path", 256), pi * factor, 0.01 * pi * factor);
}

// Its normal is that of the cylinder, not of a facet, and its texture coordinates run around and along.
TEST(Cylinder, IsRound) {
    const Node tree = scene({node("integrator", "aov", {{"aovs", std::string("n:sh_normal,d:depth,t:uv")}}, {path(2)}),
                             needle({5 * std::cos(0.3), 5 * std::sin(0.3), 0.75}, {0, 0, 0.75}, {0, 0, 1}, 4, 1),
                             node("shape", "cylinder", {{"radius", 2.0}}), constant_light()});
    const StokesImage image = render_tree(tree);
    const auto value = [&](const std::string& name) {
        for (const ImageLayer& layer : image.layers)
            if (layer.name == name) return layer.values[0];
        return std::nanf("");
    };
    // The needle's eye sees 4e-4 of the normal's circle; a facet turns it by 1.2e-2.
    EXPECT_NEAR(value("n.X"), std::cos(0.3), 2e-4);
    EXPECT_NEAR(value("n.Y"), std::sin(0.3), 2e-4);
    EXPECT_NEAR(value("n.Z"), 0, 1e-5);
    // Facets of the cylinder's area reach from 2.5e-5 below it to 1.3e-5 above.
    EXPECT_NEAR(value("d.T"), 3, 5e-5);
    EXPECT_NEAR(value("t.U"), 0.3 / (2 * pi), 1e-4);
    EXPECT_NEAR(value("t.V"), 0.75, 1e-4);
}

TEST(Aov, HoldsWhatTheCameraSeesFirst) {
    const Node tree = scene(
        {node("integrator", "aov",
              {{"aovs", std::string("a:albedo, dd.y:depth, p:position, g:geo_normal, s:shape_index")}},
              {node("integrator", "stokes", {}, {path(2)})}),
         needle({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 64, 1), node("shape", "sphere", {{"center", Vector3d(0, 0, -20)}}),
         node("shape", "sphere", {}, {node("bsdf", "diffuse", {uniform("reflectance", 0.3)})}), constant_light()});
    const StokesImage image = render_tree(tree);
    // The four wavelengths of 64 samples weigh the albedo: their colour is known as in
    // Radiometry.UniformSpectrumHasItsLinearSrgb.
    const std::pair<const char*, double> expected[] = {{"a.R", 0.3}, {"a.G", 0.3}, {"a.B", 0.3}, {"dd.y.T", 4},
                                                       {"p.X", 0},   {"p.Y", 0},   {"p.Z", 1},   {"g.X", 0},
                                                       {"g.Y", 0},   {"g.Z", 1},   {"s.I", 1}};
    ASSERT_EQ(image.layers.size(), std::size(expected));
    for (std::size_t i = 0; i < image.layers.size(); ++i) {
        EXPECT_EQ(image.layers[i].name, expected[i].first);
        EXPECT_NEAR(image.layers[i].values[0], expected[i].second, i < 3 ? 6e-3 : 1e-3) << image.layers[i].name;
    }
    EXPECT_THROW(build_scene(*scene({node("integrator", "aov", {{"aovs", std::string("a:depht")}}, {path(2)})}), {}),
                 Error);
    EXPECT_THROW(build_scene(*scene({node("integrator", "aov", {{"aovs", std::string("S0:albedo")}}, {path(2)})}), {}),
                 Error);
}

const char* const lobed_filters[] = {"mitchell", "catmullrom", "lanczos"};

// Mitchell & Netravali (1988) and Lanczos, written out again.
double filter_value(const std::string& name, double x) {
    x = std::abs(x);
    if (name == "lanczos")
        return x == 0 ? 1 : x < 3 ? 3 * std::sin(pi * x) * std::sin(pi * x / 3) / (pi * pi * x * x) : 0;
    const double b = name == "mitchell" ? 1.0 / 3 : 0, c = name == "mitchell" ? 1.0 / 3 : 0.5;
    if (x < 1) return (2 - 1.5 * b - c) * x * x * x + (-3 + 2 * b + c) * x * x + 1 - b / 3;
    if (x < 2) return (-b / 6 - c) * x * x * x + (b + 5 * c) * x * x + (-2 * b - 8 * c) * x + 4 * b / 3 + 4 * c;
    return 0;
}
double integral(const std::string& name, double from, double to) {
    constexpr int steps = 6000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) sum += filter_value(name, from + (to - from) * (i + 0.5) / steps);
    return sum * (to - from) / steps;
}

// Whatever the places of the samples, a constant picture is constant.
TEST(LobedFilter, LeavesAConstantPictureConstant) {
    for (const char* filter : lobed_filters) {
        const StokesImage image = render_tree(scene(
            {path(1), perspective(look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}), 30, 8, 8, 16, filter), constant_light()}));
        for (std::size_t p = 0; p < image.pixel_count(); ++p) {
            double mean = 0;
            for (int b = 0; b < image.bin_count(); ++b) mean += image.stokes(p, b)[0] / image.bin_count();
            // Each path's four wavelengths have the weight of the path: rounding is left.
            EXPECT_NEAR(mean, 1, 1e-5) << filter;
        }
    }
}

// Across the edge of a lamp the picture is the filter's integral: darker than nothing and brighter than the lamp.
TEST(LobedFilter, RingsAtAnEdgeAsItsIntegralSays) {
    // An orthographic film of 8 x 8 pixels; the lamp covers the left half of the picture, which is +x for the camera.
    for (const char* filter : lobed_filters)
        for (const char* integrator : {"path", "light"}) {
            const Node sensor = node("sensor", "orthographic", {{"to_world", look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0})}},
                                     {node("film", "hdrfilm", {{"width", std::int64_t{8}}, {"height", std::int64_t{8}}},
                                           {node("rfilter", filter)})});
            RenderOptions options;
            options.integrator = integrator;
            options.samples_per_pixel = 4096;
            const StokesImage image = render_tree(
                scene({sensor, node("shape", "rectangle",
                                    {{"to_world", Eigen::Matrix4d(translate({-0.9, 0, 0}) * scale(0.9, 1.8, 1))}},
                                    {black(), node("emitter", "area", {uniform("radiance", 1)})})}),
                options);
            const double whole = integral(filter, -3, 3);
            for (int x = 0; x < 8; ++x) {
                double mean = 0;
                for (int y = 0; y < 8; ++y)
                    for (int b = 0; b < image.bin_count(); ++b)
                        mean += image.stokes(image.pixel_index(x, y), b)[0] / (8 * image.bin_count());
                // The edge lies between pixels 3 and 4.
                const double expected = integral(filter, -3, 4 - (x + 0.5)) / whole;
                // Stratified; from the lamp 20000 splats a column and lobes of both signs, 4 times some 1.2 %.
                EXPECT_NEAR(mean, expected, integrator == std::string("path") ? 4e-3 : 5e-2)
                    << filter << " " << integrator << " pixel " << x;
            }
        }
}

// A place on the film is drawn with the density of the filter's modulus and carries its sign.
TEST(LobedFilter, DrawsPlacesByItsModulus) {
    for (const char* name : lobed_filters) {
        const PixelFilter filter(*node("rfilter", name));
        ASSERT_TRUE(filter.has_lobes());
        EXPECT_NEAR(filter.value({0.3f, -0.8f}),
                    filter_value(name, 0.3) * filter_value(name, 0.8) / std::pow(integral(name, -3, 3), 2), 1e-4);
        constexpr int n = 1000;
        double weights = 0, second_moment = 0, misplaced = 0;
        for (int i = 0; i < n * n; ++i) {
            const auto [offset, weight] = filter.sample({(i % n + 0.5f) / n, (i / n + 0.5f) / n});
            weights += weight / (n * n);
            second_moment += weight * offset.x() * offset.x() / (n * n);
            misplaced += weight * filter.value(offset) < -1e-3 ? 1.0 / (n * n) : 0.0;
        }
        // The midpoint rule of 1000 points: each step of the weight lies within one of them. A table of 1024 steps
        // bridges each gap between lobes once.
        EXPECT_NEAR(weights, filter.mean_weight(), 3e-3) << name;
        EXPECT_LT(misplaced, 0.008) << name;
        const double whole = integral(name, -3, 3);
        double expected = 0;
        constexpr int steps = 6000;
        for (int i = 0; i < steps; ++i) {
            const double x = -3 + 6 * (i + 0.5) / steps;
            expected += x * x * filter_value(name, x) * 6 / steps / whole;
        }
        EXPECT_NEAR(second_moment / weights, expected, 0.03) << name;
    }
}

TEST(TexelGrid, WrapsAsItIsTold) {
    TexelGrid grid;
    grid.width = 4, grid.height = 1;
    const auto ramp = [&](float u) {
        return grid.at({u, 0.5f}).blend([](std::size_t texel) { return static_cast<float>(texel); });
    };
    using Wrap = TexelGrid::Wrap;
    for (float u : {-3.3f, -0.7f, -0.1f, 0.05f, 0.4f, 0.95f, 1.2f, 2.6f}) {
        // Between centres texel k stands at (k + 1/2)/4.
        const auto clamped = [](float x) { return std::clamp(4 * x - 0.5f, 0.0f, 3.0f); };
        grid.wrap = Wrap::clamp;
        EXPECT_NEAR(ramp(u), clamped(std::clamp(u, 0.0f, 1.0f)), 1e-5) << u;
        grid.wrap = Wrap::mirror;
        const float folded = std::abs(u - 2 * std::round(0.5f * u));
        EXPECT_NEAR(ramp(u), clamped(folded), 1e-5) << u;
        grid.wrap = Wrap::repeat;
        const float x = 4 * (u - std::floor(u)) - 0.5f;
        // The last texel and the first are neighbours.
        const float expected = x < 0 ? -3 * x : x > 3 ? 3 * (4 - x) : x;
        EXPECT_NEAR(ramp(u), expected, 1e-5) << u;
        grid.nearest = true;
        EXPECT_EQ(ramp(u), std::floor(4 * (u - std::floor(u)))) << u;
        grid.nearest = false;
    }
}

// The picture's first row lies at v = 0: at the bottom of a rectangle, at the pole +z of a sphere.
TEST(BitmapTexture, HasMitsubasOrientation) {
    const SceneResources rows = with_picture({"rows", 1, 2, {"Y"}, {0.8f, 0.2f}});
    const auto brightness = [&](const std::string& shape, const Vector3d& from, const Vector3d& to) {
        const Node diffuse =
            named(node("bsdf", "diffuse", {}, {bitmap({{"filter_type", std::string("nearest")}})}), 0, "reflectance");
        return mean_stokes(render_tree(
            scene({path(2), needle(from, to, {0, 1, 0}, 16, 1), constant_light(), node("shape", shape, {}, {diffuse})}),
            {}, rows))[0];
    };
    EXPECT_NEAR(brightness("rectangle", {0, -0.5, 5}, {0, -0.5, 0}), 0.8, 1e-3);
    EXPECT_NEAR(brightness("rectangle", {0, 0.5, 5}, {0, 0.5, 0}), 0.2, 1e-3);
    EXPECT_NEAR(brightness("sphere", {0.1, 0, 5}, {0.1, 0, 0}), 0.8, 1e-3);
    EXPECT_NEAR(brightness("sphere", {0.1, 0, -5}, {0.1, 0, 0}), 0.2, 1e-3);
}

// A picture of roughness is, at the centre of each texel, the model of that roughness.
TEST(TexturedRoughness, IsTheModelOfEachTexel) {
    const SceneResources resources = with_picture({"alpha", 2, 1, {"Y"}, {0.15f, 0.45f}});
    std::map<std::string, std::string> notes;
    BsdfBuilder builder{&resources, {}, &notes};
    const Wavelengths w = Wavelengths::sample(0.3f);
    const Vec3 o = Vec3(0.3f, 0.1f, 0.8f).normalized(), i = Vec3(-0.1f, 0.2f, 0.9f).normalized();
    for (const char* model : {"roughconductor", "roughdielectric", "roughplastic", "pplastic"}) {
        const Bsdf textured =
            build_bsdf(*named(node("bsdf", model, {}, {bitmap({{"raw", true}})}), 0, "alpha"), builder);
        for (const auto& [u, alpha] : {std::pair{0.25f, 0.15}, {0.75f, 0.45}}) {
            const Bsdf plain = build_bsdf(*node("bsdf", model, {{"alpha", alpha}}), builder);
            const ShadingPoint point{&w, {u, 0.5f}, nullptr};
            BsdfValue a, b;
            ASSERT_TRUE(bsdf_evaluate(textured, point, o, i, a) && bsdf_evaluate(plain, point, o, i, b)) << model;
            EXPECT_NEAR(a.pdf, b.pdf, 1e-5 * b.pdf) << model;
            EXPECT_LT((a.f.matrix(0) - b.f.matrix(0)).norm(), 1e-5 * b.f.matrix(0).norm()) << model;
        }
    }
    EXPECT_THROW(build_bsdf(*node("bsdf", "roughconductor", {{"alpha", 0.0}}), builder), Error);
}

// Bouguer (1729), Beer (1852): through two units of a medium that only absorbs exp(-2 sigma_t) is left.
TEST(ConstantVolume, IsACoefficientOfAMedium) {
    const auto volume = [](double value) { return node("volume", "constvolume", {uniform("value", value)}); };
    const Node medium =
        named(named(node("medium", "homogeneous", {}, {volume(0.7), volume(0)}), 0, "sigma_t"), 1, "albedo");
    const Node cube = named(node("shape", "cube", {}, {node("bsdf", "null"), medium}), 1, "interior");
    const Node tree = scene({node("integrator", "volpath", {{"samples_per_pass", std::int64_t{4}}}), cube,
                             constant_light(), needle({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 64)});
    // Absorption is counted exactly or drawn: 1024 paths of probability 1/4.
    EXPECT_NEAR(mean_stokes(render_tree(tree))[0], std::exp(-1.4), 4 * std::sqrt(0.25 * 0.75 / 1024));
}

// What only looks at the mean or the variance of a picture leaves it as it is.
TEST(Moment, IsItsInnerIntegrator) {
    const auto seen = [](const Node& integrator) {
        return mean_stokes(
            render_tree(scene({integrator, constant_light(3), needle({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 1)})));
    };
    EXPECT_NEAR(seen(node("integrator", "moment", {}, {path(2)}))[0], 3, 1e-5);
    EXPECT_THROW(seen(node("integrator", "moment")), Error);
}

}  // namespace
}  // namespace patina::render::test
