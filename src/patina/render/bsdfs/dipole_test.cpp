// The dipole's profile against its closed form, and the points it is sampled at against quadrature over surfaces.

#include "patina/render/bsdfs/dipole.h"

#include <gtest/gtest.h>

#include "patina/render/integrators/subsurface_probe.h"
#include "patina/render/random.h"
#include "patina/render/shape_builder.h"
#include "patina/render/test_support.h"

namespace patina::render::test {
namespace {

// Four wavelengths that differ: nearly no absorption, little, much, and blue against red.
DipoleProfile profile() {
    return {Float4{1e-4f, 0.05f, 2.0f, 0.3f}, Float4{5.0f, 4.0f, 3.0f, 8.0f}, splat(0.6f)};
}

// Integral of g(r) R_d(r) over a plane, or a sphere seen from one of its points (chord r: dA = 2 pi r dr for both).
template <class Function>
double surface_integral(const DipoleProfile& p, int lane, double r_max, const Function& g) {
    constexpr int steps = 40'000;
    double sum = 0;
    const double low = std::log(1e-4), high = std::log(r_max);
    for (int i = 0; i < steps; ++i) {
        const double r = std::exp(low + (high - low) * (i + 0.5) / steps);
        sum += 2 * pi * r * r * p.at(static_cast<float>(r))[lane] * g(r) * (high - low) / steps;
    }
    return sum;
}

// Jensen et al. (2001), eq. 7.
TEST(Dipole, AlbedoOfASearchlightIsTheClosedForm) {
    const DipoleProfile p = profile();
    const double a = (1 + 0.6) / (1 - 0.6);
    for (int lane = 0; lane < 4; ++lane) {
        const double albedo = p.albedo[lane], root = std::sqrt(3 * (1 - albedo));
        const double closed = albedo / 2 * (1 + std::exp(-4.0 / 3 * a * root)) * std::exp(-root);
        EXPECT_NEAR(p.total[lane], closed, 5e-5);  // single precision
        // The tail beyond the range is (z_r + z_v) / (2 r) at most.
        EXPECT_NEAR(surface_integral(p, lane, 1e4, [](double) { return 1.0; }), closed, 2e-4);
    }
}

TEST(Dipole, RadiiAreDrawnFromTheProfile) {
    const DipoleProfile p = profile();
    constexpr int draws = 4000;
    for (int lane = 0; lane < 4; ++lane)
        for (double limit : {0.1, 0.3, 1.0, 4.0}) {
            int below = 0;
            for (int i = 0; i < draws; ++i) below += p.sample_radius(lane, (i + 0.5f) / draws) < limit ? 1 : 0;
            const double expected = surface_integral(p, lane, limit, [](double) { return 1.0; }) / p.total[lane];
            // Equidistant draws: two ends of the range, one a source.
            EXPECT_NEAR(below, draws * expected, 4) << lane << " " << limit;
        }
}

Geometry one_shape(const Node& shape) {
    Geometry geometry;
    append_shape(*shape, {}, geometry);
    geometry.commit();
    return geometry;
}
// What the estimator gives for the integral of R_d(r) g(r) over the surface about a point of it.
template <class Function>
Float4 estimate(const Geometry& geometry, const Ray& ray, const DipoleProfile& p, const Function& g) {
    Hit hit;
    EXPECT_TRUE(geometry.intersect(ray, hit));
    const SurfacePoint from = geometry.surface(ray, hit);
    constexpr int samples = 1 << 16;
    Float4 sum = splat(0);
    for (int i = 0; i < samples; ++i) {
        Sampler sampler(3, static_cast<std::uint32_t>(i), 5);
        const float u_axis = sampler.next(), u_hit = sampler.next();
        SubsurfaceEntry entry;
        if (sample_subsurface(geometry, p, from, Float4{0.1f, 0.2f, 0.3f, 0.4f}, u_axis, sampler.next2(), u_hit, entry))
            sum += entry.weight * static_cast<float>(g((entry.point.position - from.position).norm()));
    }
    return sum / static_cast<float>(samples);
}

TEST(SubsurfaceProbe, FindsAllPointsOfAPlane) {
    const DipoleProfile p = profile();
    const Geometry plane = one_shape(node("shape", "rectangle", {{"to_world", scale(300, 300, 1)}}));
    const auto g = [](double r) { return std::exp(-0.5 * r); };
    const Float4 found = estimate(plane, {{0, 0, 5}, {0, 0, -1}}, p, g);
    for (int lane = 0; lane < 4; ++lane) {
        const double expected = surface_integral(p, lane, 300, g);
        // Half of the lines run along the plane and find nothing; the rest differ by their wavelengths: a spread of
        // about the mean itself, 65536 draws, better for being stratified.
        EXPECT_NEAR(found[lane] / expected, 1, 0.015) << lane;
    }
}

TEST(SubsurfaceProbe, FindsAllPointsOfASphere) {
    const DipoleProfile p = profile();
    const Geometry ball = one_shape(node("shape", "sphere", {{"radius", 0.7}}));
    const Float4 found = estimate(ball, {{0, 0, 5}, {0, 0, -1}}, p, [](double) { return 1.0; });
    for (int lane = 0; lane < 4; ++lane)
        EXPECT_NEAR(found[lane] / surface_integral(p, lane, 1.4, [](double) { return 1.0; }), 1, 0.015) << lane;
}

// A wide plane in even light shows the same whether light leaves where it entered or elsewhere.
TEST(Dipole, WidePlaneShowsItsAlbedo) {
    const auto picture = [](const std::string& integrator) {
        const auto tree =
            scene({node("integrator", integrator), node("emitter", "constant"),
                   perspective(look_at({0, -8, 5}, {0, 0, 0}, {0, 0, 1}), 0.01, 8, 8, 256),
                   node("shape", "rectangle", {{"to_world", scale(200, 200, 1)}},
                        {node("bsdf", "dipole", {uniform("sigma_a", 0.1), uniform("sigma_s", 20), {"g", 0.5}})})});
        const StokesImage image = render(*build_scene(*tree, {}), {});
        Eigen::Vector4d sum = Eigen::Vector4d::Zero();
        for (std::size_t i = 0; i < image.spectral.size(); i += 4)
            sum += Eigen::Map<const Eigen::Vector4f>(&image.spectral[i]).cast<double>();
        return Eigen::Vector4d(sum * 4 / static_cast<double>(image.spectral.size()));
    };
    const Eigen::Vector4d here = picture("path"), elsewhere = picture("volumetric");
    // 16384 paths that bring 0 or about 2: 1 %.
    EXPECT_NEAR(elsewhere[0] / here[0], 1, 0.03);
    EXPECT_LT((elsewhere - here).tail<3>().norm(), 0.01 * here[0]);
    EXPECT_GT(std::abs(here[1]), 0.005);
}

TEST(Dipole, RefusesWhatDoesNotDiffuse) {
    const auto build = [](std::vector<Value> values) {
        build_scene(
            *scene({node("emitter", "constant"), perspective(look_at({0, -8, 5}, {0, 0, 0}, {0, 0, 1}), 1, 1, 1, 1),
                    node("shape", "sphere", {}, {node("bsdf", "dipole", std::move(values))})}),
            {});
    };
    EXPECT_THROW(build({uniform("sigma_s", 0)}), Error);
    EXPECT_THROW(build({uniform("sigma_a", -1)}), Error);
    EXPECT_THROW(build({{"g", 1.0}}), Error);
    EXPECT_THROW(build({{"filename", std::string("paint.toml")}}), Error);  // no reader
    EXPECT_NO_THROW(build({}));
}

}  // namespace
}  // namespace patina::render::test
