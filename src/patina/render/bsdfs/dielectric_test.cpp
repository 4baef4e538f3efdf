// The two ways of light at a smooth interface: integrators may choose between them by probabilities of their own.

#include <gtest/gtest.h>

#include "patina/render/bsdf_set.h"

namespace patina::render {
namespace {

template <class Model>
Model of_index(float interior, float exterior) {
    Model model;
    model.interior_index = Spectrum(interior);
    model.exterior_index = Spectrum(exterior);
    model.specular_reflectance = model.specular_transmittance = Texture(Spectrum(1.0f));
    return model;
}

// The smallest number of a lobe reflects and the largest refracts, wherever either can be; each with its probability as
// the density, and what both carry adds up to all the flux.
template <class Model>
void expect_two_ways(const Model& model, float refracted_scale) {
    const Wavelengths w = Wavelengths::sample(0.3f);
    const ShadingPoint point{&w};
    for (float theta : {0.01f, 0.4f, 0.72f, 0.8f, 1.2f, 1.55f})
        for (float side : {1.0f, -1.0f}) {
            const Vec3 outgoing(std::sin(theta), 0, side * std::cos(theta));
            BsdfSample low, high;
            ASSERT_TRUE(model.sample(point, outgoing, 0.0f, {0.5f, 0.5f}, low));
            ASSERT_TRUE(model.sample(point, outgoing, 1 - 0x1p-24f, {0.5f, 0.5f}, high));
            EXPECT_GT(low.incident.z() * side, 0) << theta;
            if (low.pdf == 1) continue;  // total reflection
            EXPECT_LT(high.incident.z() * side, 0) << theta;
            // Single precision. Refracted radiance scales by the index squared.
            const float scale = side > 0 ? refracted_scale : 1 / refracted_scale;
            EXPECT_NEAR(low.pdf + high.pdf, 1, 1e-6);
            EXPECT_NEAR(low.weight.m[0][0] * low.pdf + high.weight.m[0][0] * high.pdf * scale, 1, 2e-6) << theta;
        }
}

TEST(TwoWays, NumbersOfTheLobeAreInOrderAndFluxIsComplete) {
    expect_two_ways(of_index<Dielectric>(1.5f, 1.0f), 2.25f);
    expect_two_ways(of_index<Dielectric>(1.0f, 1.33f), 1 / (1.33f * 1.33f));
    expect_two_ways(of_index<ThinDielectric>(1.5f, 1.0f), 1.0f);
}

}  // namespace
}  // namespace patina::render
