// Copies of groups, and shapes that move while the shutter is open.

#include "render_scenes.h"
#include <gtest/gtest.h>

namespace patina::render::test {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;

Node gold() {
    return node("bsdf", "roughconductor", {{"material", std::string("Au")}, {"alpha", 0.3}});
}
Node floor() {
    return node("shape", "rectangle", {{"to_world", scale(4, 4, 1)}},
                {node("bsdf", "diffuse", {uniform("reflectance", 0.5)})});
}
Node camera(std::vector<Value> shutter = {}) {
    shutter.push_back({"to_world", look_at({0, -6, 3}, {0, 0, 0.7}, {0, 0, 1})});
    shutter.push_back({"fov", 40.0});
    return node("sensor", "perspective", shutter,
                {node("film", "hdrfilm", {{"width", std::int64_t{24}}, {"height", std::int64_t{16}}}),
                 node("sampler", "independent", {{"sample_count", std::int64_t{16}}})});
}
Node sun() {
    return node("emitter", "directional", {{"direction", Vector3d(1, 1, -2)}, uniform("irradiance", 1)});
}

std::shared_ptr<const TriangleMesh> tetrahedron() {
    TriangleMesh mesh;
    mesh.positions = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    return std::make_shared<const TriangleMesh>(mesh);
}
SceneResources resources() {
    SceneResources given;
    given.load_mesh = [](const std::string&, const std::string&) { return tetrahedron(); };
    return given;
}
Node mesh(const Matrix4d& to_world) {
    return node("shape", "ply", {{"filename", std::string("t.ply")}, {"to_world", to_world}, {"face_normals", true}},
                {gold()});
}

// The largest difference of two pictures over the mean intensity.
double difference(const StokesImage& a, const StokesImage& b) {
    double largest = 0, sum = 0;
    for (std::size_t i = 0; i < a.spectral.size(); ++i) {
        largest = std::max(largest, std::abs(static_cast<double>(a.spectral[i]) - b.spectral[i]));
        if (i % 4 == 0) sum += 4 * a.spectral[i] / static_cast<double>(a.spectral.size());
    }
    return largest / sum;
}

// Every kind of shape, through a group and its copies, is the shape itself put there: turned, stretched, mirrored.
TEST(Instances, LookLikeTheShapesThemselves) {
    const Matrix4d left = translate({-1.2, 0, 0.8}) * rotate_x(25) * scale(0.5, 0.7, -0.6),
                   right = translate({1.2, 0, 0.8}) * rotate_x(-40) * scale(0.6, 0.6, 0.6);
    const auto cube = [&](const Matrix4d& m) {
        return node("shape", "cube", {{"to_world", Matrix4d(m * translate({0, 0, 0.5}) * scale(0.5, 0.5, 0.5))}},
                    {gold()});
    };
    const auto copy = [&](const Matrix4d& m, const Node& group) {
        return node("shape", "instance", {{"to_world", m}}, {group});
    };
    const Matrix4d here = Matrix4d::Identity();
    for (const bool with_mesh : {false, true}) {
        const auto shapes = [&](const Matrix4d& m) -> Node { return with_mesh ? mesh(m) : cube(m); };
        const Node group = node("shape", "shapegroup", {}, {shapes(here)});
        const StokesImage direct =
            render_tree(scene({path(3), camera(), floor(), shapes(left), shapes(right), sun(), constant_light(0.2)}),
                        {}, resources());
        const StokesImage copied = render_tree(scene({path(3), camera(), floor(), group, copy(left, group),
                                                      copy(right, group), sun(), constant_light(0.2)}),
                                               {}, resources());
        // The same samples; rounding moves a few of 16 over an edge. Without the copies the difference is above 1.
        std::size_t equal = 0;
        for (std::size_t i = 0; i < direct.spectral.size(); ++i)
            equal += std::abs(direct.spectral[i] - copied.spectral[i]) < 1e-4f * (1 + std::abs(direct.spectral[i]));
        EXPECT_GT(static_cast<double>(equal) / static_cast<double>(direct.spectral.size()), 0.98) << with_mesh;
        EXPECT_LT(difference(direct, copied), 0.5) << with_mesh;
        const StokesImage none =
            render_tree(scene({path(3), camera(), floor(), group, sun(), constant_light(0.2)}), {}, resources());
        EXPECT_GT(difference(direct, none), 0.5);
    }
}

// A sphere seen through a stretched copy is the ellipsoid: its silhouette and its normals.
TEST(Instances, StretchASphereToAnEllipsoid) {
    const Node group =
        node("shape", "shapegroup", {},
             {node("shape", "sphere", {}, {node("bsdf", "conductor", {{"material", std::string("none")}})})});
    const Vector3d axes(2, 1, 0.5);
    const Node ellipsoid = node("shape", "instance", {{"to_world", scale(axes.x(), axes.y(), axes.z())}}, {group});
    // A mirror's normal at a point, from the direction in which a small lamp shows.
    for (const Vector3d& unit : {Vector3d(0.3, 0.2, 1).normalized(), Vector3d(0.7, -0.3, 0.6).normalized()}) {
        const Vector3d point = unit.cwiseProduct(axes), normal = unit.cwiseQuotient(axes).normalized();
        const Vector3d view = (Vector3d(0.1, 0.2, 1)).normalized(), mirrored = 2 * normal.dot(view) * normal - view;
        const auto tree = scene({path(3), needle(point + 10 * view, point, {0, 1, 0}, 4, 1), group, ellipsoid,
                                 node("shape", "sphere", {{"center", Vector3d(point + 20 * mirrored)}, {"radius", 0.2}},
                                      {node("emitter", "area", {uniform("radiance", 1)})})});
        EXPECT_NEAR(mean_stokes(render_tree(tree))[0], 1, 1e-6);
    }
}

Node animation(const std::vector<std::pair<double, Matrix4d>>& keys) {
    const Node result = node("animation", "transform");
    for (std::size_t i = 0; i < keys.size(); ++i) {
        result->entries.push_back({"time_" + std::to_string(i), keys[i].first, {}});
        result->entries.push_back({"transform_" + std::to_string(i), keys[i].second, {}});
    }
    return result;
}
Node moving(Node shape, const std::vector<std::pair<double, Matrix4d>>& keys) {
    shape->children.push_back({"to_world", animation(keys)});
    return shape;
}

// A black plate that slides over a lit field covers each place for the time it takes to pass.
TEST(Motion, CoversForTheTimeItTakes) {
    const auto share = [&](double open_s, double close_s) {
        const Node plate =
            moving(node("shape", "rectangle", {}, {node("bsdf", "diffuse", {uniform("reflectance", 0)})}),
                   {{0.0, translate({-2, 0, 0})}, {1.0, translate({2, 0, 0})}});
        const Node eye = node("sensor", "perspective",
                              {{"to_world", look_at({0.5, 0, 5}, {0.5, 0, 0}, {0, 1, 0})},
                               {"fov", 0.01},
                               {"shutter_open", open_s},
                               {"shutter_close", close_s}},
                              {node("film", "hdrfilm", {{"width", std::int64_t{1}}, {"height", std::int64_t{1}}}),
                               node("sampler", "independent", {{"sample_count", std::int64_t{1024}}})});
        return mean_stokes(render_tree(scene({path(3), eye, plate, constant_light()})))[0];
    };
    // The plate's edges pass x = 0.5 at 4 t - 2 = -0.5 and 1.5: from t = 0.375 to 0.875. Stratified times: 1 / 1024.
    EXPECT_NEAR(share(0, 1), 0.5, 2e-3);
    EXPECT_NEAR(share(0, 0.5), 1 - 0.25, 2e-3);
    EXPECT_NEAR(share(0.4, 0.8), 0, 1e-6);
    EXPECT_NEAR(share(0.9, 2), 1, 1e-6);    // and stays where it was
    EXPECT_NEAR(share(0.5, 0.5), 0, 1e-6);  // a moment
}

// Both halves of a bidirectional path, and shadows, see the same moment.
TEST(Motion, IsTheSameForEveryIntegrator) {
    const auto tree = [&] {
        const Node ball =
            moving(node("shape", "sphere", {{"radius", 0.5}}, {gold()}),
                   {{0.0, translate({-1, 0, 0.6})}, {0.5, translate({0, 0, 1})}, {1.0, translate({1, 0, 0.6})}});
        const Node box = moving(node("shape", "cube", {}, {gold()}),
                                 {{0.0, translate({0, 1, 0.5}) * scale(0.4, 0.1, 0.4)},
                                  {1.0, translate({0, 1, 0.5}) * rotate_x(80) * scale(0.4, 0.1, 0.4)}});
        return scene({path(4), camera({{"shutter_close", 1.0}}), floor(), ball, box,
                      node("shape", "rectangle", {{"to_world", Matrix4d(translate({0, 0, 4}) * rotate_x(180))}},
                           {node("emitter", "area", {uniform("radiance", 3)})})});
    };
    const auto rows = [&](const char* integrator, int samples) {
        RenderOptions options;
        options.integrator = integrator;
        options.samples_per_pixel = samples;
        const StokesImage image = render_tree(tree(), options);
        std::vector<double> sums(8, 0.0);  // vertical stripes of 3 pixels
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 24; ++x)
                for (int b = 0; b < image.bin_count(); ++b)
                    sums[x / 3] += image.stokes(image.pixel_index(x, y), b)[0] / (48.0 * image.bin_count());
        return sums;
    };
    const auto by_path = rows("path", 256), by_both = rows("bidirectional", 128), at_volume = rows("volumetric", 256);
    for (int i = 0; i < 8; ++i) {
        // 48 pixels of 128 samples whose spread is about twice their mean: 2.5 %. Where the ball is at the first moment
        // alone its reflection is off by half.
        EXPECT_NEAR(by_both[i], by_path[i], 0.09 * by_path[i]) << i;
        EXPECT_NEAR(at_volume[i], by_path[i], 0.09 * by_path[i]) << i;
    }
}

TEST(Instances, SayWhatTheyNeed) {
    const auto message = [&](std::vector<Node> nodes) {
        nodes.push_back(camera());
        nodes.push_back(sun());
        try {
            build_scene(*scene(nodes), {});
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const auto has = [&](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
    const Node ball = node("shape", "sphere");
    const Node lamp = node("shape", "sphere", {}, {node("emitter", "area")});
    const Node group = node("shape", "shapegroup", {}, {ball});
    EXPECT_PRED2(has, message({node("shape", "instance")}), "it names none");
    EXPECT_PRED2(has, message({node("shape", "instance", {}, {ball})}), "it names a \"sphere\"");
    EXPECT_PRED2(has, message({node("shape", "shapegroup")}), "no shapes");
    EXPECT_PRED2(has, message({node("shape", "shapegroup", {}, {node("shape", "instance", {}, {group})})}),
                 "plain shapes");
    EXPECT_PRED2(has, message({node("shape", "shapegroup", {}, {lamp})}), "no emitter can stand");
    EXPECT_PRED2(has, message({node("shape", "instance", {{"to_world", scale(1, 0, 1)}}, {group})}), "degenerate");
}

}  // namespace
}  // namespace patina::render::test
