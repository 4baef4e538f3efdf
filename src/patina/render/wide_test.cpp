// Paths in the lanes of a vector do what each would do alone.

#include "patina/render/wide.h"

#include <gtest/gtest.h>

#include "patina/brdf/tabulate.h"
#include "patina/render/geometry.h"
#include "patina/render/paint_table.h"
#include "patina/render/random.h"

namespace patina::render {
namespace {

TEST(WidePaths, DrawTheNumbersThatEachSamplerDraws) {
    SamplerBlock block;
    for (int lane = 0; lane < wide_lanes; ++lane)
        block.set(lane, Sampler(static_cast<std::uint32_t>(977 * lane), static_cast<std::uint32_t>(lane * lane), 42));
    for (std::uint32_t draw : {0u, 3u, 71u}) {
        FloatLanes single, x, y;
        single.store(block.next(draw));
        block.next2(draw, x, y);
        for (int lane = 0; lane < wide_lanes; ++lane) {
            Sampler sampler(static_cast<std::uint32_t>(977 * lane), static_cast<std::uint32_t>(lane * lane), 42);
            sampler.seek(draw);
            EXPECT_EQ(sampler.next(), single[lane]);
            sampler.seek(draw);
            const Vec2 pair = sampler.next2();
            EXPECT_EQ(pair.x(), x[lane]);
            EXPECT_EQ(pair.y(), y[lane]);
        }
    }
}

// Two spheres, one about the rays' origins, a rectangle and a disk.
Geometry shapes() {
    Geometry geometry;
    const Eigen::Matrix3f upright = Eigen::Matrix3f::Identity();
    using Kind = AnalyticShape::Kind;
    geometry.analytic = {AnalyticShape::sphere({0, 0, 0}, 1, upright), AnalyticShape::sphere({3, 0, 0}, 0.7f, upright),
                         AnalyticShape::plane(Kind::parallelogram, {0, 0, -2}, {2, 0.5f, 0}, {0, 3, 0}),
                         AnalyticShape::plane(Kind::disk, {0, 2, 0}, {0, 0, 1.5f}, {1.5f, 0, 0})};
    for (int i = 0; i < 4; ++i) {
        geometry.analytic[i].shape = i;
        geometry.shapes.push_back({.first = i, .count = 1});
    }
    geometry.commit();
    return geometry;
}

TEST(WidePaths, MeetWhatEachRayMeets) {
    const Geometry geometry = shapes();
    Sampler sampler(1, 1, 1);
    int met = 0, shadowed = 0;
    for (int block = 0; block < 1024 / wide_lanes; ++block) {
        RayBlock rays, shadows;
        std::vector<Ray> all;
        for (int lane = 0; lane < wide_lanes; ++lane) {
            const Vec2 u = sampler.next2(), v = sampler.next2();
            // Some reach no further than two units.
            all.push_back({Vec3(6 * u.x() - 3, 6 * u.y() - 3, 4 * v.x() - 2), uniform_sphere(sampler.next2()),
                           lane % 3 ? INFINITY : 2.0f});
            rays.set(lane, all.back());
            shadows.set(lane, all.back());
        }
        Hit hits[wide_lanes];
        geometry.intersect(rays, wide_lanes, hits);
        const std::uint32_t blocked = geometry.occluded(shadows, wide_lanes);
        for (int lane = 0; lane < wide_lanes; ++lane) {
            Hit hit;
            const bool found = geometry.intersect(all[lane], hit);
            ASSERT_EQ(found, hits[lane].shape >= 0);
            EXPECT_EQ(found, (blocked >> lane & 1) != 0);
            met += found;
            shadowed += blocked >> lane & 1;
            if (!found) continue;
            EXPECT_EQ(hit.primitive, hits[lane].primitive);
            // The compiler may fuse other products and sums for one ray than for many; on a sphere's limb the root
            // of the discriminant makes an error of 1e-7 one of 3e-4.
            EXPECT_NEAR(hit.t, hits[lane].t, 4e-4f);
            EXPECT_NEAR(hit.u, hits[lane].u, 1e-4f);
            EXPECT_NEAR(hit.v, hits[lane].v, 1e-4f);
        }
    }
    EXPECT_GT(met, 200);
    EXPECT_EQ(met, shadowed);
}

TEST(PaintSampling, IsWithinATenthOfAPerfectTable) {
    // The weight f cos / pdf of a perfect table is the albedo whatever is drawn: its mean square is the square of its
    // mean. Cells and the viewer's two angles cost something, which must stay below a tenth.
    const PaintTable table(brdf::tabulate(brdf::single_rayleigh_body(1.0),
                                          {.wavelengths_nm = {380, 480, 580, 680, 780}, .nodes = 24, .orders = 3}));
    const Wavelengths w = Wavelengths::sample(0.125f);
    for (float theta_deg : {0.0f, 20.0f, 45.0f, 65.0f, 80.0f, 87.0f}) {
        const float theta = theta_deg * pi_f / 180;
        const Vec3 outgoing(std::sin(theta), 0, std::cos(theta));
        double mean_weight = 0, mean_square = 0;
        int unlike = 0;
        constexpr int samples = 4096;
        for (int i = 0; i < samples; ++i) {
            Sampler sampler(5, static_cast<std::uint32_t>(i), 9);
            float density = 0;
            const Vec2 u = sampler.next2();
            const Vec3 incident = table.sample(outgoing, u, sampler.next(), density);
            unlike += std::abs(density - table.pdf(outgoing, incident)) > 1e-3f * density;
            ScatteringMatrix f;
            table.evaluate(w, outgoing, incident, true, f);
            const double weight = mean(f.m[0]) * incident.z() / density;
            mean_weight += weight / samples;
            mean_square += weight * weight / samples;
        }
        EXPECT_LT(mean_square, 1.1 * mean_weight * mean_weight) << theta_deg << " degrees";
        // Rounding may put a direction on the border of two cells into the other one.
        EXPECT_LE(unlike, samples / 500);
    }
}

TEST(PaintTableColumns, TheFirstAloneIsThatOfTheWhole) {
    const PaintTable table(
        brdf::tabulate(brdf::single_rayleigh_body(1.0), {.wavelengths_nm = {380, 580, 780}, .nodes = 16, .orders = 3}));
    const Wavelengths w = Wavelengths::sample(0.7f);
    Sampler sampler(3, 1, 4);
    for (int i = 0; i < 200; ++i) {
        const Vec3 outgoing = cosine_hemisphere(sampler.next2()), incident = cosine_hemisphere(sampler.next2());
        ScatteringMatrix whole, first;
        table.evaluate(w, outgoing, incident, false, whole);
        table.evaluate(w, outgoing, incident, true, first);
        // The same sixteen products are added up in another order.
        for (int row = 0; row < 4; ++row)
            for (int k = 0; k < 4; ++k) EXPECT_NEAR(whole.m[row][k], first.m[row][k], 1e-6f * whole.m[0][k]);
    }
}

}  // namespace
}  // namespace patina::render
