// Light through a picture, and textured lamps that are sampled where they shine. Against closed forms.

#include "render_scenes.h"
#include <gtest/gtest.h>

namespace patina::render::test {
namespace {

using Eigen::Vector3d;

SceneResources with_picture(Bitmap picture) {
    SceneResources resources;
    const auto shared = std::make_shared<const Bitmap>(std::move(picture));
    resources.load_bitmap = [shared](const std::string&, bool) { return shared; };
    return resources;
}
Node holding(Node parent, Node child, const std::string& name) {
    parent->children.push_back({name, std::move(child)});
    return parent;
}
Node bitmap(std::vector<Value> values = {}) {
    values.push_back({"filename", std::string("picture")});
    values.push_back({"filter_type", std::string("nearest")});
    values.push_back({"raw", true});
    return node("texture", "bitmap", std::move(values));
}
// The radiance of a white diffuse wall in the plane z = 0 at (x, y): irradiance / pi.
double on_the_wall(double x, double y, const Node& light, const SceneResources& resources,
                   const std::string& integrator = "path") {
    RenderOptions options;
    options.integrator = integrator;
    const Node wall = node("shape", "rectangle", {{"to_world", scale(3, 3, 1)}},
                           {node("bsdf", "diffuse", {uniform("reflectance", 1)})});
    const Node tree = scene({path(2), wall, light, needle({x, y, 1}, {x, y, 0}, {0, 1, 0}, 64)});
    return mean_stokes(render_tree(tree, options, resources))[0];
}
// Looks down at the wall from z = 2, its image's top towards +y.
const Eigen::Matrix4d from_above = look_at({0, 0, 2}, {0, 0, 0}, {0, 1, 0});

// Four pixels: top left 1, top right 2, below 3 and 4.
const Bitmap quarters{"quarters", 2, 2, {"Y"}, {1, 2, 3, 4}};

// Mitsuba's projector: irradiance pi times the picture on a plane at distance 1, the same all over it, and 1/4 of that
// at distance 2; turned as a camera would see it. A field of view of 90 degrees reaches as far as the distance.
TEST(Projector, ThrowsItsPictureUprightAndEven) {
    const Node light = holding(node("emitter", "projector", {{"to_world", from_above}, {"fov", 90.0}, {"scale", 8.0}}),
                               bitmap(), "irradiance");
    const SceneResources resources = with_picture(quarters);
    // What a camera in its place sees on the left: x of look_at points to the left.
    const double left = from_above(0, 0);
    for (double away : {0.1, 1.0, 1.9}) {
        // A single shadow ray a sample, the same each time: rounding, and upsampling of greys (1e-3).
        const double tolerance = 2e-3 * 8;
        EXPECT_NEAR(on_the_wall(left * away, away, light, resources), 8.0 / 4 * 1, tolerance);
        EXPECT_NEAR(on_the_wall(-left * away, away, light, resources), 8.0 / 4 * 2, tolerance);
        EXPECT_NEAR(on_the_wall(left * away, -away, light, resources), 8.0 / 4 * 3, tolerance);
        EXPECT_NEAR(on_the_wall(-left * away, -away, light, resources), 8.0 / 4 * 4, tolerance);
    }
    EXPECT_EQ(on_the_wall(2.1, 0.5, light, resources), 0);
}

// A picture twice as wide as high keeps its shape.
TEST(Projector, KeepsTheAspectOfItsPicture) {
    const Node light =
        holding(node("emitter", "projector", {{"to_world", from_above}, {"fov", 90.0}}), bitmap(), "irradiance");
    const SceneResources resources = with_picture({"wide", 4, 2, {"Y"}, std::vector<float>(8, 1.0f)});
    EXPECT_GT(on_the_wall(1.9, 0.9, light, resources), 0.2);
    EXPECT_EQ(on_the_wall(1.9, 1.1, light, resources), 0);
}

// Mitsuba's spot: u grows along its x and v along its y, 0 .. 1 over the square about the cone.
TEST(Spot, ShinesThroughItsPicture) {
    const Bitmap shares{"shares", 2, 2, {"Y"}, {0.1f, 0.2f, 0.4f, 0.8f}};
    const Node light =
        holding(node("emitter", "spot",
                     {{"to_world", from_above}, {"cutoff_angle", 40.0}, {"beam_width", 39.0}, uniform("intensity", 1)}),
                bitmap(), "texture");
    const SceneResources resources = with_picture(shares);
    const double x = from_above(0, 0), d = 0.5, r2 = 4 + 2 * d * d, cos = 2 / std::sqrt(r2), plain = cos / r2 / pi;
    EXPECT_NEAR(on_the_wall(-x * d, -d, light, resources), 0.1 * plain, 2e-3 * plain);
    EXPECT_NEAR(on_the_wall(x * d, -d, light, resources), 0.2 * plain, 2e-3 * plain);
    EXPECT_NEAR(on_the_wall(-x * d, d, light, resources), 0.4 * plain, 2e-3 * plain);
    EXPECT_NEAR(on_the_wall(x * d, d, light, resources), 0.8 * plain, 2e-3 * plain);
}

// Light traced forward finds what light sampling finds: flux through a meter under the light.
TEST(Projector, ShinesAlikeFromEitherEnd) {
    const Node light =
        holding(node("emitter", "projector", {{"to_world", from_above}, {"fov", 60.0}}), bitmap(), "irradiance");
    const SceneResources resources = with_picture(quarters);
    const Node meter = node("shape", "rectangle", {{"to_world", scale(3, 3, 1)}},
                            {node("bsdf", "diffuse", {uniform("reflectance", 0.5)}), node("sensor", "fluxmeter")});
    RenderOptions options;
    options.samples_per_pixel = 64;
    const auto flux = [&](const char* integrator) {
        options.integrator = integrator;
        const Node tree = scene({path(3), meter, light});
        return render_parts(*build_scene(*tree, resources), options).measurement->radiometric[0] / 400;
    };
    // The picture's mean 5/2 times pi over the square of half side tan 30 at distance 1. 16384 samples of a picture
    // that fills a ninth part of the meter, stratified.
    const double expected = pi * 2.5 * 4 / 3;
    for (const char* integrator : {"path", "light", "bidirectional"})
        EXPECT_NEAR(flux(integrator), expected, 0.03 * expected) << integrator;
}

// A lamp that is dark but for 1/256 of its area. The light at a point before it is the closed form of a small patch;
// samples drawn uniformly would mostly miss it.
struct Speck {
    const char* shape;
    double u, v;        // of the bright texel's middle
    Vector3d position;  // on the shape
};

void PrintTo(const Speck& speck, std::ostream* out) {
    *out << speck.shape;
}

class TexturedLampSampling : public testing::TestWithParam<Speck> {};

TEST_P(TexturedLampSampling, FindsWhatIsBright) {
    const Speck& speck = GetParam();
    constexpr int side = 16;
    std::vector<float> texels(side * side, 0.0f);
    texels[static_cast<std::size_t>(speck.v * side) * side + static_cast<std::size_t>(speck.u * side)] = 100;
    const SceneResources resources = with_picture({"speck", side, side, {"Y"}, texels});
    const Node lamp = node("shape", speck.shape, {{"to_world", Eigen::Matrix4d(translate({0, 0, 2}) * rotate_x(180))}},
                           {holding(node("emitter", "area"), bitmap(), "radiance")});
    // rotate_x turns y and z over.
    const Vector3d at(speck.position.x(), -speck.position.y(), 2);
    const double area = std::string(speck.shape) == "rectangle"
                            ? 4.0 / (side * side)
                            : pi * (std::pow(speck.u + 0.5 / side, 2) - std::pow(speck.u - 0.5 / side, 2)) / side;
    const double expected = 100 * area * 4 / std::pow(at.squaredNorm(), 2);
    // The patch is small: the closed form of its middle holds to (size / distance)^2. 1024 samples, 9 in 10 of which
    // meet it, of values within 10 %: 1 in 100; drawn uniformly, 4 of 1024 would, 50 % of noise. By one method of
    // drawing and by several with their weights.
    for (const char* integrator : {"path", "bidirectional"})
        EXPECT_NEAR(pi * on_the_wall(0, 0, lamp, resources, integrator), expected, 0.05 * expected) << integrator;
}

// Of a disk u is the radius and v the azimuth, of a rectangle both are Cartesian.
INSTANTIATE_TEST_SUITE_P(
    Shapes, TexturedLampSampling,
    testing::Values(Speck{"rectangle", 10.5 / 16, 3.5 / 16, {2 * 10.5 / 16 - 1, 2 * 3.5 / 16 - 1, 0}},
                    Speck{"disk",
                          11.5 / 16,
                          2.5 / 16,
                          {11.5 / 16 * std::cos(2 * pi * 2.5 / 16), 11.5 / 16 * std::sin(2 * pi * 2.5 / 16), 0}}));

}  // namespace
}  // namespace patina::render::test
