// Meshes, hierarchies, environment maps: each against something simpler that must look the same.

#include "render_scenes.h"
#include <gtest/gtest.h>

namespace patina::render::test {
namespace {

using Eigen::Vector3d;
using Vec3 = Eigen::Vector3f;

Node gold() {
    return node("bsdf", "roughconductor", {{"material", std::string("Au")}, {"alpha", 0.3}});
}
Node corner_view(int samples) {
    return perspective(look_at({3, -4, 3}, {0, 0, 0}, {0, 0, 1}), 50, 24, 24, samples);
}

// The faces of the cube -1 .. 1 as twelve triangles with corners of their own.
std::shared_ptr<const TriangleMesh> cube_mesh() {
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->name = "cube";
    for (int axis = 0; axis < 3; ++axis)
        for (float side : {-1.0f, 1.0f}) {
            const Vec3 n = side * Vec3::Unit(axis), u = Vec3::Unit((axis + 1) % 3),
                       v = side * Vec3::Unit((axis + 2) % 3);
            const auto first = static_cast<std::uint32_t>(mesh->positions.size());
            for (const Vec3& corner : {Vec3(n - u - v), Vec3(n + u - v), Vec3(n + u + v), Vec3(n - u + v)})
                mesh->positions.push_back(corner);
            mesh->triangles.push_back({first, first + 1, first + 2});
            mesh->triangles.push_back({first, first + 2, first + 3});
        }
    return mesh;
}

double largest_difference(const StokesImage& a, const StokesImage& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) largest = std::max<double>(largest, std::abs(a.rgb[i] - b.rgb[i]));
    return largest;
}

std::vector<Node> around(std::vector<Node> shapes) {
    shapes.push_back(path(4));
    shapes.push_back(corner_view(16));
    shapes.push_back(node("emitter", "point", {{"position", Vector3d(2, -5, 6)}, uniform("intensity", 40)}));
    shapes.push_back(constant_light(0.2));
    return shapes;
}

// The same random numbers take the same paths; only rays within rounding of an edge may differ, and rounding itself.
TEST(Geometry, MeshOfACubeLooksLikeTheCube) {
    SceneResources resources;
    resources.load_mesh = [](const std::string&, const std::string&) { return cube_mesh(); };
    const auto exact = render_tree(scene(around({node("shape", "cube", {}, {gold()})})));
    const auto mesh = render_tree(
        scene(
            around({node("shape", "obj", {{"filename", std::string("cube.obj")}, {"face_normals", true}}, {gold()})})),
        {}, resources);
    EXPECT_LT(largest_difference(exact, mesh), 2e-3);
    // A mirroring transform keeps the outside outside.
    const auto mirrored = render_tree(
        scene(
            around({node("shape", "obj",
                         {{"filename", std::string("cube.obj")}, {"face_normals", true}, {"to_world", scale(-1, 1, 1)}},
                         {gold()})})),
        {}, resources);
    double sum = 0, sum_mirrored = 0;
    for (std::size_t p = 0; p < exact.pixel_count(); ++p)
        sum += exact.stokes_rgb(p)[1], sum_mirrored += mirrored.stokes_rgb(p)[1];
    EXPECT_NEAR(sum_mirrored / sum, 1, 0.02);  // other tangents, other random directions
}

TEST(Geometry, ManyShapesGoThroughTheHierarchyUnchanged) {
    std::vector<Node> few = {
        node("shape", "sphere", {}, {gold()}),
        node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(translate({0, 0, -1}) * scale(5, 5, 5))}})};
    std::vector<Node> many = few;
    for (int i = 0; i < 40; ++i)  // out of sight and below the floor
        many.push_back(node("shape", i % 2 ? "sphere" : "disk", {{"to_world", translate({0.01 * i, 0, -50})}}));
    // The offset of rays from surfaces grows with the scene.
    EXPECT_LT(largest_difference(render_tree(scene(around(few))), render_tree(scene(around(many)))), 2e-3);
}

SceneResources sky(std::vector<float> data, int width, int height) {
    SceneResources resources;
    resources.load_bitmap = [=](const std::string&, bool) {
        return std::make_shared<Bitmap>(Bitmap{"sky", width, height, {"R", "G", "B"}, data});
    };
    return resources;
}
Node sky_light() {
    return node("emitter", "envmap", {{"filename", std::string("sky.exr")}});
}

// A white picture shines like D65 of luminance 1: linear sRGB (1, 1, 1), directly and from a white diffuse sphere,
// though there light and scattering are both sampled.
TEST(EnvironmentMap, WhiteFurnace) {
    const auto image = render_tree(
        scene({path(-1, {{"rr_depth", std::int64_t{100}}}),
               perspective(look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}), 20, 8, 8, 256),
               node("shape", "sphere", {}, {node("bsdf", "diffuse", {uniform("reflectance", 1)})}), sky_light()}),
        {}, sky(std::vector<float>(8 * 4 * 3, 1.0f), 8, 4));
    for (int c = 0; c < 3; ++c) {
        double mean = 0;
        for (std::size_t p = 0; p < image.pixel_count(); ++p) mean += image.stokes_rgb(p)[c] / image.pixel_count();
        // 16384 samples: mixing two techniques leaves a spread of about a half.
        EXPECT_NEAR(mean, 1.0, 0.02);
    }
}

// One bright texel: where it is seen, and that sampling finds it. u = 0.5 + .. is the direction +z after Mitsuba's
// atan2(x, -z); column 4 of 8 covers azimuths 180 .. 225 degrees, row 1 of 4 polar angles 45 .. 90 degrees from +y.
TEST(EnvironmentMap, HasMitsubasOrientationAndIsSampledWhereItShines) {
    std::vector<float> data(64 * 32 * 3, 0.0f);
    for (int y = 8; y < 16; ++y)
        for (int x = 32; x < 40; ++x)
            for (int c = 0; c < 3; ++c) data[(y * 64 + x) * 3 + c] = 10;
    const SceneResources resources = sky(data, 64, 32);
    const double azimuth = radians(202.5), polar = radians(67.5);
    const Vector3d towards(std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth));
    const auto seen =
        render_tree(scene({path(1), needle({0, 0, 0}, towards, {0, 1, 0}, 64), sky_light()}), {}, resources);
    EXPECT_NEAR(seen.stokes_rgb(0)[1], 10, 1);  // wavelengths are sampled
    EXPECT_NEAR(render_tree(scene({path(1), needle({0, 0, 0}, -towards, {0, 1, 0}, 4), sky_light()}), {}, resources)
                    .stokes_rgb(0)[1],
                0, 1e-6);

    // Irradiance on a floor facing +y: L times the integral of cos over the patch, here 10 (pi/4) (sin^2 90 - sin^2
    // 45)/2.
    const auto lit = render_tree(scene({path(2), needle({0, 3, 0.1}, {0, 0, 0}, {0, 0, 1}, 256),
                                        node("shape", "rectangle", {{"to_world", rotate_x(-90)}},
                                             {node("bsdf", "diffuse", {uniform("reflectance", 1)})}),
                                        sky_light()}),
                                 {}, resources);
    const double expected = 10 * (pi / 4) * 0.25 / pi;
    double mean = 0;
    for (std::size_t p = 0; p < lit.pixel_count(); ++p) mean += lit.stokes_rgb(p)[1] / lit.pixel_count();
    // Texels at the patch's edge are interpolated to zero: the patch is blurred, its integral is kept to a few per cent
    // of one texel in eight; 4096 samples.
    EXPECT_NEAR(mean, expected, 0.03 * expected);
}

TEST(BadMeshes, AreRefused) {
    SceneResources resources;
    const auto message = [&](const std::function<void(TriangleMesh&)>& spoil) -> std::string {
        resources.load_mesh = [&](const std::string&, const std::string&) {
            auto mesh = std::make_shared<TriangleMesh>(*cube_mesh());
            spoil(*mesh);
            return mesh;
        };
        try {
            build_scene(
                *scene({corner_view(1), constant_light(), node("shape", "ply", {{"filename", std::string("a.ply")}})}),
                resources);
        } catch (const Error& error) {
            return error.what();
        }
        return "accepted";
    };
    using testing::HasSubstr;
    EXPECT_EQ(message([](TriangleMesh&) {}), "accepted");
    EXPECT_THAT(message([](TriangleMesh& m) { m.positions[3].x() = NAN; }), HasSubstr("vertex 3"));
    EXPECT_THAT(message([](TriangleMesh& m) { m.triangles[2][1] = 99; }), HasSubstr("triangle 2"));
    EXPECT_THAT(message([](TriangleMesh& m) { m.triangles.clear(); }), HasSubstr("no triangles"));
    EXPECT_THAT(message([](TriangleMesh& m) {
                    for (auto& p : m.positions) p.setZero();
                }),
                HasSubstr("no area"));
}

}  // namespace
}  // namespace patina::render::test
