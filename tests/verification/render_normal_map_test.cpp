// Normal and bump maps: a turned normal is a turned mirror.

#include "render_scenes.h"
#include <gtest/gtest.h>

namespace patina::render::test {
namespace {

using Eigen::Vector3d;

Node with_child(const Node& parent, const Node& child) {
    const Node copy = std::make_shared<Properties>(*parent);
    copy->children.push_back({"", child});
    return copy;
}

// A mirror in the plane z = 0 under a map, seen from above; the lamp is a small disk in the direction that a normal
// tilted by `tilt_deg` towards `towards` mirrors straight up into.
double seen(const std::string& plugin, const Bitmap& picture, const Vector3d& towards, double tilt_deg,
            std::vector<Value> values = {}, const Node& shape = node("shape", "rectangle")) {
    SceneResources resources;
    resources.load_mesh = [](const std::string&, const std::string&) {
        TriangleMesh square{"square", {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {}, {}, {{0, 1, 2}, {0, 2, 3}}};
        square.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        return std::make_shared<const TriangleMesh>(square);
    };
    resources.load_bitmap = [&](const std::string&, bool) { return std::make_shared<const Bitmap>(picture); };
    const Node map = node("bsdf", plugin, std::move(values),
                          {node("bsdf", "conductor", {{"material", std::string("none")}}),
                           node("texture", "bitmap", {{"filename", std::string("picture")}})});
    map->children[1].name = plugin;
    const double angle = 2 * radians(tilt_deg);
    const Vector3d lamp = 10 * (std::cos(angle) * Vector3d::UnitZ() + std::sin(angle) * towards);
    const auto tree = scene({path(3), needle({0.01, 0.02, 5}, {0.01, 0.02, 0}, {0, 1, 0}, 4, 1), with_child(shape, map),
                             node("shape", "sphere", {{"center", lamp}, {"radius", 0.2}},
                                  {node("emitter", "area", {uniform("radiance", 1)})})});
    return mean_stokes(render(*build_scene(*tree, resources), {}))[0];
}

TEST(NormalMap, TurnsAMirror) {
    // (n + 1)/2 for a normal 10 degrees from z towards -x, and towards +y.
    const auto s = static_cast<float>(0.5 * std::sin(radians(10))),
               c = static_cast<float>(0.5 + 0.5 * std::cos(radians(10)));
    const Bitmap along_x{"x", 1, 1, {"R", "G", "B"}, {0.5f - s, 0.5f, c}},
        along_y{"y", 1, 1, {"R", "G", "B"}, {0.5f, 0.5f + s, c}};
    // The lamp is 1.15 degrees wide on either side: half a degree of tilt misses it.
    EXPECT_NEAR(seen("normalmap", along_x, -Vector3d::UnitX(), 10), 1, 1e-6);
    EXPECT_NEAR(seen("normalmap", along_x, -Vector3d::UnitX(), 10.7), 0, 1e-6);
    EXPECT_NEAR(seen("normalmap", along_x, Vector3d::UnitX(), 10), 0, 1e-6);
    EXPECT_NEAR(seen("normalmap", along_y, Vector3d::UnitY(), 10), 1, 1e-6);
}

// Heights that grow with u turn the normal against u; v grows with the rows of the picture.
TEST(NormalMap, ReliefTurnsTheNormalDownhill) {
    // Around the middle a slope of 0.2 along u, and -0.3 along v: h = 0.2 u - 0.3 v on 64 x 64 texels.
    Bitmap relief{"relief", 64, 64, {"Y"}, {}};
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) relief.data.push_back(static_cast<float>(0.2 * x / 64 - 0.3 * y / 64));
    const Vector3d normal = Vector3d(-0.2, 0.3, 1).normalized();
    const Vector3d towards = Vector3d(-0.2, 0.3, 0).normalized();
    const double tilt_deg = degrees(std::acos(normal.z()));
    EXPECT_NEAR(seen("bumpmap", relief, towards, tilt_deg), 1, 1e-6);
    EXPECT_NEAR(seen("bumpmap", relief, -towards, tilt_deg), 0, 1e-6);
    EXPECT_NEAR(
        seen("bumpmap", relief, towards, degrees(std::atan(0.5 * std::tan(radians(tilt_deg)))), {{"scale", 0.5}}), 1,
        1e-6);
}

// The same relief on a square whose file counts v upwards, as OBJ files do, or downwards: the picture's first row lies
// at the top of the one and at the bottom of the other, and hills stay hills.
TEST(NormalMap, ReliefKnowsWhichWayTextureCoordinatesRun) {
    Bitmap relief{"relief", 64, 64, {"Y"}, {}};
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) relief.data.push_back(static_cast<float>(0.3 * y / 64));
    const double tilt_deg = degrees(std::atan(0.3));
    const Value file{"filename", std::string("square")};
    const Node obj = node("shape", "obj", {file}), ply = node("shape", "ply", {file});
    const Node flipped_ply = node("shape", "ply", {file, {"flip_tex_coords", true}});
    // Rows grow downwards on the first and upwards on the second: the normal leans to where heights fall.
    EXPECT_NEAR(seen("bumpmap", relief, Vector3d::UnitY(), tilt_deg, {}, obj), 1, 1e-6);
    EXPECT_NEAR(seen("bumpmap", relief, -Vector3d::UnitY(), tilt_deg, {}, ply), 1, 1e-6);
    EXPECT_NEAR(seen("bumpmap", relief, Vector3d::UnitY(), tilt_deg, {}, flipped_ply), 1, 1e-6);
}

TEST(NormalMap, SaysWhatItNeeds) {
    const Bitmap grey{"grey", 1, 1, {"Y"}, {0.5f}}, broken{"broken", 1, 1, {"R", "G", "B"}, {NAN, 0, 1}};
    EXPECT_THROW(seen("normalmap", grey, Vector3d::UnitX(), 1), Error);
    EXPECT_THROW(seen("normalmap", broken, Vector3d::UnitX(), 1), Error);
}

}  // namespace
}  // namespace patina::render::test
