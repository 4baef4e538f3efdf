// Values of a mesh's vertices and faces as textures: under a sky of radiance 1 a diffuse surface shows its reflectance.

#include "render_scenes.h"
#include <gtest/gtest.h>

#include "patina/core/error.h"

namespace patina::render::test {
namespace {

using Eigen::Vector3d;

// The triangle (0,0) (4,0) (0,4) and, beside it, (4,0) (4,4) (0,4), facing +z, under the plane z = `height`.
TriangleMesh two_triangles(double height = 0) {
    TriangleMesh mesh;
    mesh.name = "two";
    const auto z = static_cast<float>(height);
    mesh.positions = {{0, 0, z}, {4, 0, z}, {0, 4, z}, {4, 4, z}};
    mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
    mesh.attributes = {
        {"vertex_share", false, 1, {0.1f, 0.4f, 0.8f, 0.2f}},
        {"face_share", true, 1, {0.3f, 0.7f}},
        {"vertex_color", false, 3, {0.6f, 0.1f, 0.1f, 0.1f, 0.6f, 0.1f, 0.1f, 0.1f, 0.6f, 0.5f, 0.5f, 0.5f}}};
    return mesh;
}
SceneResources with(TriangleMesh mesh) {
    SceneResources resources;
    const auto shared = std::make_shared<const TriangleMesh>(std::move(mesh));
    resources.load_mesh = [shared](const std::string&, const std::string&) { return shared; };
    return resources;
}
Node attribute(const std::string& name, double scale = 1) {
    return node("texture", "mesh_attribute", {{"name", name}, {"scale", scale}});
}
Node holding(Node parent, Node texture, const std::string& name) {
    parent->children.push_back({name, std::move(texture)});
    return parent;
}
Node mesh(std::vector<Node> children) {
    return node("shape", "ply", {{"filename", std::string("two.ply")}}, std::move(children));
}
Node diffuse(Node texture) {
    return holding(node("bsdf", "diffuse"), std::move(texture), "reflectance");
}
double seen_at(double x, double y, std::vector<Node> shapes, const SceneResources& resources, int depth = 2) {
    shapes.push_back(path(depth));
    shapes.push_back(constant_light());
    shapes.push_back(needle({x, y, 5}, {x, y, 0}, {0, 1, 0}, 16));
    return mean_stokes(render_tree(scene(std::move(shapes)), {}, resources))[0];
}

// A grey of the sigmoid model differs from its number by less than 1e-3.
constexpr double of_upsampling = 1e-3;

TEST(MeshAttribute, OfVerticesIsLinearOverTriangles) {
    const SceneResources two = with(two_triangles());
    const auto at = [&](double x, double y) {
        return seen_at(x, y, {mesh({diffuse(attribute("vertex_share"))})}, two);
    };
    // f = 0.1 + 0.3 x/4 + 0.7 y/4 on the first triangle; from its corners 0.4, 0.2, 0.8 on the second.
    EXPECT_NEAR(at(1, 1), 0.1 + 0.075 + 0.175, of_upsampling);
    EXPECT_NEAR(at(0.4, 2.8), 0.1 + 0.03 + 0.49, of_upsampling);
    EXPECT_NEAR(at(3, 3), (0.4 + 0.2 * 2 + 0.8) / 4, of_upsampling);
}

TEST(MeshAttribute, OfFacesIsConstantOverEach) {
    const SceneResources two = with(two_triangles());
    for (const auto& [x, expected] : {std::pair{0.5, 0.3}, {1.9, 0.3}, {2.1, 0.7}, {3.5, 0.7}})
        EXPECT_NEAR(seen_at(x, x, {mesh({diffuse(attribute("face_share"))})}, two), expected, of_upsampling);
    EXPECT_NEAR(seen_at(1, 1, {mesh({diffuse(attribute("face_share", 0.5))})}, two), 0.15, of_upsampling);
}

TEST(MeshAttribute, OfThreeChannelsIsAColour) {
    const SceneResources two = with(two_triangles());
    const auto image = [&](double x, double y) {
        return render_tree(scene({path(2), constant_light(), needle({x, y, 5}, {x, y, 0}, {0, 1, 0}, 16),
                                  mesh({diffuse(attribute("vertex_color"))})}),
                           {}, two);
    };
    // Bins of 25 nm: 3 begins at 455 nm, in the blue, 9 at 605 nm, in the red.
    const StokesImage red = image(0.05, 0.05), blue = image(0.05, 3.9);
    EXPECT_GT(mean_stokes(red, 9)[0], 3 * mean_stokes(red, 3)[0]);
    EXPECT_GT(mean_stokes(blue, 3)[0], 3 * mean_stokes(blue, 9)[0]);
}

// One material on two meshes: each shows its own values, also where it is nested, and in copies.
TEST(MeshAttribute, IsOfTheMeshTheMaterialIsOn) {
    SceneResources resources;
    resources.load_mesh = [](const std::string& path, const std::string&) {
        TriangleMesh mesh = two_triangles(path == "dark.ply" ? 1 : 0);
        if (path == "dark.ply") mesh.attributes[1].values = {0.05f, 0.05f};
        return std::make_shared<const TriangleMesh>(std::move(mesh));
    };
    const Node shared = node("bsdf", "twosided", {}, {diffuse(attribute("face_share"))});
    const Node bright = node("shape", "ply", {{"filename", std::string("bright.ply")}}, {shared});
    const Node dark =
        node("shape", "ply", {{"filename", std::string("dark.ply")}, {"to_world", translate({10, 0, 0})}}, {shared});
    const std::vector<Node> both{shared, bright, dark};
    EXPECT_NEAR(seen_at(1, 1, both, resources), 0.3, of_upsampling);
    EXPECT_NEAR(seen_at(11, 1, both, resources), 0.05, of_upsampling);
    const Node group = node("shape", "shapegroup", {}, {mesh({diffuse(attribute("face_share"))})});
    const Node copy = node("shape", "instance", {{"to_world", translate({-10, 0, 0})}}, {group});
    EXPECT_NEAR(seen_at(-9, 1, {group, copy}, resources), 0.3, of_upsampling);
}

// As a lamp's radiance it is what the camera sees, and what light sampling finds: the mean radiance 1/2 of two halves
// of a square that covers the half space lights as a uniform square does.
TEST(MeshAttribute, IsARadiance) {
    const SceneResources two = with(two_triangles());
    const Node lamp = holding(node("emitter", "area"), attribute("face_share", 10), "radiance");
    EXPECT_NEAR(seen_at(1, 1, {mesh({lamp})}, two, 1), 3, 0.01);
    EXPECT_NEAR(seen_at(3, 3, {mesh({lamp})}, two, 1), 7, 0.01);
}

// A square of two triangles of which one shines: at the point before its middle half of what the whole square sends
// (Siegel & Howell, configuration 3, of its quarters), whatever the share of samples each triangle has.
TEST(MeshAttribute, OfALampLightsWhatItFaces) {
    TriangleMesh mesh_of_one = two_triangles();
    mesh_of_one.attributes[1].values = {0, 10};
    const SceneResources one = with(std::move(mesh_of_one));
    const double height = 1.5, x = 2 / height, r = std::sqrt(1 + x * x);
    const double under_corner = x / r * std::atan(x / r);
    const Node lamp = mesh({node("bsdf", "diffuse", {uniform("reflectance", 0)}),
                            holding(node("emitter", "area"), attribute("face_share"), "radiance")});
    const Node wall =
        node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(translate({2, 2, height}) * rotate_x(180))}},
             {node("bsdf", "diffuse", {uniform("reflectance", 1)})});
    for (const char* integrator : {"path", "bidirectional"}) {
        RenderOptions options;
        options.integrator = integrator;
        const Node tree = scene({path(2), lamp, wall, needle({2, 2, 0.5}, {2, 2, height}, {0, 1, 0}, 256)});
        // 4096 samples, stratified, of an integrand that varies by its own size: 4 standard errors of 1/64.
        EXPECT_NEAR(pi * mean_stokes(render_tree(tree, options, one))[0], 5 * 4 * under_corner,
                    0.06 * 20 * under_corner)
            << integrator;
    }
}

TEST(MeshAttribute, ThatIsNotThereIsNamed) {
    const auto message = [](const std::vector<Node>& shapes) {
        try {
            seen_at(1, 1, shapes, with(two_triangles()));
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    EXPECT_NE(message({mesh({diffuse(attribute("vertex_colour"))})}).find("did you mean \"vertex_color\"?"),
              std::string::npos)
        << message({mesh({diffuse(attribute("vertex_colour"))})});
    EXPECT_NE(message({node("shape", "sphere", {}, {diffuse(attribute("vertex_color"))})}).find("only meshes"),
              std::string::npos);
}

// A checkerboard of a picture and a number.
TEST(Checkerboard, TakesTextures) {
    const SceneResources two = with(two_triangles());
    Node board = node("texture", "checkerboard", {uniform("color1", 0.9)});
    board = holding(board, attribute("face_share"), "color0");
    // Texture coordinates of a mesh without any are the corners' weights: (1/8, 1/8) is of the first square, (5/8, 1/8)
    // of its neighbour.
    EXPECT_NEAR(seen_at(0.5, 0.5, {mesh({diffuse(board)})}, two), 0.3, of_upsampling);
    EXPECT_NEAR(seen_at(2.5, 0.5, {mesh({diffuse(board)})}, two), 0.9, of_upsampling);
}

}  // namespace
}  // namespace patina::render::test
