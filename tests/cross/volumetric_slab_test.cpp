// The random walk in space against the solvers of the plane-parallel equation: wide slabs, all four Stokes components.

#include <gtest/gtest.h>

#include "patina/coating/spectral_medium.h"
#include "patina/core/constants.h"
#include "patina/jobs/solve.h"
#include "patina/jobs/validation/siewert.h"
#include "patina/render/stokes_frames.h"
#include "patina/render/test_support.h"
#include "patina/rt/solver.h"

namespace patina::render::test {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

optics::ExpansionCoefficients rayleigh() {
    return {{1, 0, 0.5}, {0, 0, 3}, {0, 0, 0}, {0, 1.5, 0}, {0, 0, std::sqrt(6.0) / 2}, {0, 0, 0}};
}
// A slab one unit thick below z = 0, a hundred wide: what comes in at the sides has no way to the middle.
Node slab(Node bsdf) {
    const Node shape =
        node("shape", "cube", {{"to_world", Eigen::Matrix4d(translate({0, 0, -0.5}) * scale(50, 50, 0.5))}},
             {std::move(bsdf)});
    shape->children.push_back({"interior", node("medium", "paint", {{"filename", std::string("given")}})});
    return shape;
}
// The medium of a rt::Layer of unit thickness, at every wavelength.
SceneResources with_medium(const rt::Layer& layer) {
    SceneResources resources;
    resources.load_medium = [layer](const std::string&, int) {
        auto medium = std::make_shared<optics::SpectralMedium>();
        medium->first_nm = 550;
        medium->media.push_back({layer.optical_thickness, layer.optical_thickness * layer.single_scattering_albedo,
                                 layer.optical_thickness * (1 - layer.single_scattering_albedo), layer.expansion});
        medium->host_index.push_back(1.0);
        return medium;
    };
    return resources;
}

struct Seen {
    Vector4d mean = Vector4d::Zero(), error = Vector4d::Zero();
};
// A needle's view of the middle of the slab along light that leaves it into k; errors from the scatter of the pixels.
Seen look(std::vector<Node> scene_nodes, const SceneResources& resources, const Vector3d& k, int samples,
          const std::string& integrator = "volumetric") {
    constexpr int pixels = 8;
    scene_nodes.push_back(perspective(look_at(30 * k, {0, 0, 0}, {0, 0, 1}), 0.001, pixels, pixels, samples));
    RenderOptions options;
    options.integrator = integrator;
    options.bin_edges_nm = {380, 780};
    const StokesImage image = render(*build_scene(*scene(std::move(scene_nodes)), resources), options);
    Seen seen;
    Vector4d squares = Vector4d::Zero();
    for (std::size_t p = 0; p < image.pixel_count(); ++p) {
        const Vector4d s = Eigen::Map<const Eigen::Vector4f>(image.stokes(p, 0)).cast<double>();
        seen.mean += s / image.pixel_count();
        squares += s.cwiseAbs2() / image.pixel_count();
    }
    seen.error = ((squares - seen.mean.cwiseAbs2()) / (image.pixel_count() - 1.0)).cwiseMax(0).cwiseSqrt();
    return seen;
}

struct Direction {
    double mu, phi_deg;
    bool up;
};

void expect_field(const rt::Problem& problem, const std::vector<Direction>& directions, int samples, double least_v) {
    constexpr double mu_i = 0.6;
    const SceneResources resources = with_medium(problem.layers.front());
    double significance_of_v = 0;
    for (const Direction& d : directions) {
        rt::FieldRequest request;
        request.mu_i = mu_i;
        request.optical_depths = {0, problem.layers.front().optical_thickness};
        request.mu_o = {d.mu};
        request.phi = {radians(d.phi_deg)};
        const rt::Field field = rt::solvers().front()->field(problem, request, {});
        // The picture's x is e_phi, a right angle from e_theta: Q and U change their signs.
        Vector4d expected = from_solver(d.up ? field.upward[0][0][0] : field.downward[1][0][0]);
        expected[1] *= -1, expected[2] *= -1;

        const double sine = std::sqrt(1 - d.mu * d.mu), phi = radians(d.phi_deg);
        const Vector3d k(sine * std::cos(phi), sine * std::sin(phi), d.up ? d.mu : -d.mu);
        const Seen seen =
            look({slab(node("bsdf", "null")),
                  node("emitter", "directional",
                       {{"direction", Vector3d(std::sqrt(1 - mu_i * mu_i), 0, -mu_i)}, uniform("irradiance", pi)})},
                 resources, k, samples);
        for (int s = 0; s < 4; ++s)
            // Five standard errors, themselves known to 9 % from 64 pixels; and what single precision and the offset of
            // rays from faces (1e-4 units) change.
            EXPECT_NEAR(seen.mean[s], expected[s], 5 * seen.error[s] + 3e-4 * expected[0])
                << "mu " << d.mu << " phi " << d.phi_deg << " component " << s;
        EXPECT_LT(seen.error[0], 0.012 * expected[0]);
        significance_of_v = std::max(significance_of_v, std::abs(expected[3]) / seen.error[3]);
    }
    EXPECT_GE(significance_of_v, least_v) << "a wrong sign of V would not be seen";
}

TEST(VolumetricSlab, RayleighSlabAgreesWithTheSolver) {
    const rt::Problem problem{1.0, {{0.5, 1.0, rayleigh(), 1.0}}, rt::BlackBase{}};
    expect_field(problem, {{0.5, 60, true}, {0.9, 150, true}, {0.4, -100, false}}, 200, 0);
}

// Siewert's problem IIA: spheroids, whose matrix has six different elements, and the largest V of the published cases.
TEST(VolumetricSlab, SpheroidsOfSiewertAgreeWithTheSolver) {
    const rt::Problem problem = jobs::validation::siewert_problem();
    expect_field(problem, {{0.3, 90, true}, {0.5, 40, true}, {0.3, -90, false}}, 600, 7);
}

constexpr const char* paint_text = R"(
[interface]
type = "smooth"
[[layers]]
thickness_um = 1
binder = { n = 1.5 }
[[layers.pigments]]
material = { n = 2.7, k = 0.01 }
volume_fraction = 0.2
size = { distribution = "mono", radius_um = 0.12 }
[base]
type = "lambertian"
reflectance = 0.5
)";

// The same recipe as a table of its BRDF, and as particles in a slab of binder with a smooth surface over a base: what
// a lamp and the surroundings show of both.
TEST(VolumetricSlab, WalkThroughAPaintAgreesWithItsTable) {
    const coating::Recipe recipe = coating::parse_recipe(paint_text, "paint.toml", ".");
    SceneResources resources;
    resources.load_brdf_table = [&](const std::string&) {
        jobs::SolveRequest request;
        request.wavelengths_nm = {550};
        return std::make_shared<const brdf::MuellerTable>(jobs::solve(recipe, request).table);
    };
    resources.load_medium = [&](const std::string&, int layer) {
        return std::make_shared<const optics::SpectralMedium>(coating::spectral_medium(recipe, layer, 550, 1, 1));
    };
    const auto lights = [] {
        // A wide lamp at one side, for some U; no lamp is in the mirror direction.
        return std::vector<Node>{
            node("shape", "rectangle",
                 {{"to_world", Eigen::Matrix4d(look_at({60, 60, 90}, {0, 0, 0}, {0, 0, 1}) * scale(40, 40, 1))}},
                 {node("emitter", "area", {uniform("radiance", 4)})}),
            node("emitter", "constant", {uniform("radiance", 0.5)})};
    };
    for (const Vector3d& direction : {Vector3d(1, 0, 0.7), Vector3d(-0.3, 0.6, 0.8)}) {
        const Vector3d k = direction.normalized();
        std::vector<Node> walk = lights(), table = lights();
        walk.push_back(slab(node("bsdf", "dielectric", {{"int_ior", 1.5}, {"ext_ior", 1.0}})));
        walk.push_back(node("shape", "rectangle",
                            {{"to_world", Eigen::Matrix4d(translate({0, 0, -0.999}) * scale(49, 49, 1))}},
                            {node("bsdf", "diffuse", {uniform("reflectance", 0.5)})}));
        table.push_back(node("shape", "rectangle", {{"to_world", scale(49, 49, 1)}},
                             {node("bsdf", "paint", {{"table", std::string("given.h5")}})}));
        const Seen found = look(walk, resources, k, 1000), expected = look(table, resources, k, 100, "path");
        for (int s = 0; s < 4; ++s)
            // Five standard errors of the difference, and what the run-time table's interpolation leaves (2e-3).
            EXPECT_NEAR(found.mean[s], expected.mean[s],
                        5 * std::hypot(found.error[s], expected.error[s]) + 3e-3 * expected.mean[0])
                << k.transpose() << " component " << s;
        EXPECT_LT(found.error[0], 0.02 * expected.mean[0]);
        EXPECT_GT(std::abs(expected.mean[1]), 0.02 * expected.mean[0]);
    }
}

}  // namespace
}  // namespace patina::render::test
