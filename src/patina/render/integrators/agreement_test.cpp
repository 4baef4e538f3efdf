// Integrators against each other: equal means by a t test whose false-alarm rate is stated, over all scenes, blocks of
// pixels and Stokes components together (agreement_support.h).

#include "patina/render/integrators/agreement_support.h"

namespace patina::render {
namespace {

using namespace test;

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

// Surroundings of one radiance make glass invisible, also to a polarizer: what a face reflects and what it lets through
// add up to the light that would be there without it. Whatever probabilities choose between the two.
TEST(Agreement, GlassInAFurnaceIsInvisible) {
    const Node glass = node("bsdf", "dielectric", {{"int_ior", 1.7}}),
               pane = node("bsdf", "thindielectric", {{"int_ior", 1.5}});
    // No roulette before all but 1e-6 of the light has left the ball.
    const Node all = node("integrator", "path", {{"max_depth", std::int64_t{40}}, {"rr_depth", std::int64_t{41}}});
    const auto lit = build_scene(
        *scene({all, camera(), ball(0.4, glass), wall(pane), node("emitter", "constant", {uniform("radiance", 1)})}),
        {});
    const Measurements measured = measure(*lit, "path", 512);
    Measurements exact(measured.size(), std::vector<double>(replicates, 0.0));
    for (std::size_t i = 0; i < exact.size(); i += 4) exact[i].assign(replicates, 1.0);
    expect_agreement(exact, measured, "furnace");
    EXPECT_LT(relative_error(measured), 0.003);
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

// Many lamps, which are chosen by where the light falls: panes that face away, candles and balls alike.
TEST(Agreement, ManyLamps) {
    std::vector<Node> all = {camera(), floor(0.6), wall(node("bsdf", "roughconductor", {{"alpha", 0.3}})),
                             ball(0.5, node("bsdf", "roughplastic", {{"alpha", 0.2}}))};
    for (int i = 0; i < 24; ++i) {
        const double x = -1.5 + 0.6 * (i % 6), y = -0.8 + 0.8 * (i / 6), z = 1.2 + 0.4 * (i % 3);
        const Eigen::Matrix4d to_world =
            translate({x, y, z}) * rotate_x(i % 4 == 1 ? 0 : 150) * scale(0.15, 0.15, 0.15);
        if (i % 3 == 0)
            all.push_back(
                node("emitter", "point", {{"position", Vector3d(x, y, z)}, uniform("intensity", 0.1 + 0.02 * i)}));
        else
            all.push_back(node("shape", i % 3 == 1 ? "rectangle" : "sphere", {{"to_world", to_world}},
                               {node("emitter", "area", {uniform("radiance", 1 + 0.1 * i)})}));
    }
    const auto lit = build_scene(*scene(std::move(all)), {});
    const Measurements by_path = measure(*lit, "path", 128), by_both = measure(*lit, "bidirectional", 64, "", 100);
    expect_agreement(by_path, by_both, "path, bidirectional");
    expect_agreement(by_path, measure(*lit, "light", 256, "", 200), "path, light");
    expect_agreement(by_path, measure(*lit, "volumetric", 128, "", 300), "path, volumetric");
    EXPECT_LT(relative_error(by_path), 0.02);
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

}  // namespace
}  // namespace patina::render
