// What holds of light transport as a whole: reciprocity, the sense of rotation on both sides of a path, and pictures
// that do not depend on the number of threads.

#include <gtest/gtest.h>

#include "patina/core/parallel.h"
#include "patina/render/integrators/agreement_support.h"

namespace patina::render {
namespace {

using namespace test;

Node optic(const char* type, const Vector3d& at, std::vector<Value> values) {
    return node("shape", "rectangle", {{"to_world", Eigen::Matrix4d(translate(at) * scale(0.6, 0.6, 1))}},
                {node("bsdf", type, std::move(values))});
}

// Two equal squares that look down from both sides of the scene, each behind plates of its own; between them rough
// gold, glass and a diffuse wall. One shines, the other is a meter.
Node two_ends(bool first_shines, double theta_deg = 80) {
    const auto end = [&](double x, bool shines) {
        const Node bsdf = node("bsdf", "diffuse", {uniform("reflectance", 0.2)});
        const Node role =
            shines ? node("emitter", "area", {uniform("radiance", 10)})
                   : node("sensor", "irradiancemeter", {},
                          {node("film", "hdrfilm", {{"width", std::int64_t{size}}, {"height", std::int64_t{size}}},
                                {node("rfilter", "box")})});
        return node("shape", "rectangle",
                    {{"to_world", Eigen::Matrix4d(translate({x, 0, 2}) * rotate_x(180) * scale(0.4, 0.4, 1))}},
                    {bsdf, role});
    };
    return scene(
        {path(7), end(-1, first_shines), end(1, !first_shines), optic("polarizer", {-1, 0, 1.8}, {{"theta", 25.0}}),
         optic("retarder", {1, 0, 1.6}, {{"theta", 60.0}, {"delta", 100.0}}),
         optic("polarizer", {1, 0, 1.8}, {{"theta", theta_deg}}),
         node("shape", "rectangle", {{"to_world", scale(2, 2, 1)}}, {rough(0.3)}), wall(node("bsdf", "diffuse")),
         ball(-0.5, node("bsdf", "dielectric", {{"int_ior", 1.5}})), ball(0.6, rough(0.3))});
}

// Helmholtz: of the power that one end sends, the other gets what it would send back, through polarizers, plates, glass
// and polarizing metal (Chandrasekhar 1960, section 52). Only the intensity is compared: the ends are diffuse.
TEST(Transport, IsReciprocal) {
    const auto intensity = [](const Measurements& all) {
        Measurements first;
        for (std::size_t i = 0; i < all.size(); i += 4) first.push_back(all[i]);
        return first;
    };
    const auto there = build_scene(*two_ends(true), {}), back = build_scene(*two_ends(false), {});
    // Pixels of a meter are its places, which the two ends have in common only as a mean.
    const auto whole = [&](const Measurements& all) {
        Measurements mean(4, std::vector<double>(replicates, 0.0));
        const Measurements blocks = intensity(all);
        for (const auto& block : blocks)
            for (int r = 0; r < replicates; ++r)
                for (auto& of : mean) of[r] += block[r] / static_cast<double>(blocks.size());
        return mean;
    };
    const Measurements by_path = whole(measure(*there, "path", 768));
    expect_agreement(by_path, whole(measure(*back, "path", 768, "", 300)), "path there, path back");
    expect_agreement(by_path, whole(measure(*back, "bidirectional", 128, "", 300)), "path there, bidirectional back");
    EXPECT_LT(relative_error(by_path), 0.03);

    // A polarizer turned by a right angle is found.
    const auto turned = build_scene(*two_ends(false, 170), {});
    EXPECT_LT(corrected_p(by_path, whole(measure(*turned, "path", 768, "", 300))), false_alarm_rate);
}

// Light that a polarizer and a plate have made elliptic, over two rough metal surfaces to the camera: its sense of
// rotation decides what the second metal makes of it.
Node elliptic_scene(double delta_deg) {
    return scene({path(5), camera(), lamp(8, 0.5), optic("polarizer", {0, 0, 1.8}, {{"theta", 0.0}}),
                  optic("retarder", {0, 0, 1.6}, {{"theta", 45.0}, {"delta", delta_deg}}),
                  node("shape", "rectangle", {{"to_world", scale(2, 2, 1)}}, {rough(0.3)}), wall(rough(0.4)),
                  ball(0.5, rough())});
}

TEST(Transport, SenseOfRotationIsTheSameFromBothEnds) {
    const auto scene = build_scene(*elliptic_scene(70), {});
    const Measurements by_path = measure(*scene, "path", 128), by_both = measure(*scene, "bidirectional", 64, "", 100);
    expect_agreement(by_path, by_both, "path, bidirectional");
    expect_agreement(by_path, measure(*scene, "light", 256, "", 200), "path, light");
    EXPECT_GT(significance(by_both, 3), 20);

    // A wrong sign of the retardance on one side is found.
    const auto mirrored = build_scene(*elliptic_scene(-70), {});
    EXPECT_LT(corrected_p(by_path, measure(*mirrored, "bidirectional", 64, "", 100)), false_alarm_rate);
}

// The same seed, the same bits; every integrator, the film larger than a tile and than a batch of splats.
TEST(Transport, PicturesDoNotDependOnThreads) {
    const Node few_patches = diffuse_scene();
    few_patches->children[0].node =
        node("integrator", "radiosity", {{"patches", std::int64_t{60}}, {"rays", std::int64_t{64}}});
    const auto polarized = build_scene(*specular_scene(), {}), diffuse = build_scene(*few_patches, {});
    for (const char* integrator :
         {"path", "light", "bidirectional", "appel", "whitted", "distribution", "volumetric", "radiosity"}) {
        const bool only_diffuse = std::string(integrator) == "radiosity";
        StokesImage first;
        for (int threads : {1, 2}) {
            set_thread_count(threads);
            RenderOptions options;
            options.integrator = integrator;
            options.size = {40, 40};
            options.samples_per_pixel = 3;
            const StokesImage image = render(only_diffuse ? *diffuse : *polarized, options);
            if (threads == 1) first = image;
            EXPECT_EQ(first.spectral, image.spectral) << integrator;
            EXPECT_EQ(first.variance, image.variance) << integrator;
        }
    }
    set_thread_count(0);
}

}  // namespace
}  // namespace patina::render
